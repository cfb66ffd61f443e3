#include "scenefile/document.h"

#include <fmt/format.h>
#include <yaml.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "scenefile/nearest.h"

namespace lambent {
namespace {

std::vector<std::string> split_lines(std::string_view text) {
  std::vector<std::string> lines;
  for (;;) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    if (end + 1 >= text.size()) return lines;
    text.remove_prefix(end + 1);
  }
}

/// With line breaks of one kind only, which split_lines() knows.
std::string with_newlines(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool pair = text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n';
    if (!pair) result += text[i] == '\r' ? '\n' : text[i];
  }
  return result;
}

/// Whether a byte goes on with the character before it.
bool is_tail(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

/// JSON escapes a character beyond U+FFFF in two halves, YAML as one: the text with `\U0001f600` in place of
/// `\ud83d\ude00`, which is shorter.
struct JoinedEscapes {
  static constexpr std::size_t shorter = 2;  ///< In characters.
  std::string text;
  std::vector<std::pair<std::size_t, std::size_t>> spots;  ///< Line and column of each, from 0, in `text`.

  /// Of JSON: elsewhere a backslash need not begin an escape.
  explicit JoinedEscapes(std::string_view json) {
    std::size_t line = 0, column = 0;
    for (std::size_t i = 0; i < json.size();) {
      const auto upper = half(json.substr(i), 0xd800),
                 lower = half(json.substr(std::min(i + 6, json.size())), 0xdc00);
      if (upper && lower) {
        spots.emplace_back(line, column);
        text += fmt::format("\\U{:08x}", 0x10000 + (*upper << 10 | *lower));
        i += 12, column += 10;
        continue;
      }
      // An escape goes by as one, so that what follows `\\` is none.
      const std::size_t size = json[i] == '\\' && i + 1 < json.size() ? 2 : 1;
      text += json.substr(i, size);
      if (json[i] == '\n') ++line, column = 0;
      else if (!is_tail(json[i])) column += size;
      i += size;
    }
  }

 private:
  /// The ten bits of the half that the text begins with, if it is one of those from `first` on.
  static std::optional<unsigned> half(std::string_view text, unsigned first) {
    unsigned code = 0;
    if (text.size() < 6 || text.substr(0, 2) != "\\u") return {};
    if (std::from_chars(text.data() + 2, text.data() + 6, code, 16).ptr != text.data() + 6) return {};
    return code >> 10 == first >> 10 ? std::optional(code & 0x3ff) : std::nullopt;
  }
};

void put(Node& node, const Spot& spot) { static_cast<Spot&>(node) = spot; }

/// What keeps a text from being YAML.
struct NotYaml {
  Spot spot;
  std::string message, hint;
};

/// Makes spots of lines and characters, counted from 0 as libyaml's marks count them.
class Spots {
 public:
  /// `joined`: what the text that is read has shorter than `lines`.
  explicit Spots(const std::vector<std::string>& lines, const JoinedEscapes* joined = nullptr)
      : lines_(lines), joined_(joined) {}

  Spot at(const yaml_mark_t& mark) {
    std::size_t column = mark.column;
    if (joined_) {
      const auto before = [&](std::size_t of_column) {
        return std::lower_bound(joined_->spots.begin(), joined_->spots.end(),
                                std::pair(mark.line, of_column));
      };
      column += JoinedEscapes::shorter * std::size_t(before(mark.column) - before(0));
    }
    return at(mark.line, column);
  }
  Spot at(std::size_t line, std::size_t characters) {
    if (line >= lines_.size()) return in_line(lines_.size() - 1, lines_.back().size());
    const std::string& text = lines_[line];
    if (line != line_ || characters < characters_) line_ = line, characters_ = byte_ = 0;
    // From the last one on: a line may hold a whole scene.
    for (; characters_ < characters && byte_ < text.size(); ++characters_)
      for (++byte_; byte_ < text.size() && is_tail(text[byte_]);) ++byte_;
    return {int(line_) + 1, int(byte_) + 1, int(characters_) + 1};
  }
  /// Behind the first `bytes` bytes.
  Spot behind(std::size_t bytes) const {
    std::size_t line = 0;
    for (; line + 1 < lines_.size() && bytes > lines_[line].size(); ++line) bytes -= lines_[line].size() + 1;
    return in_line(line, std::min(bytes, lines_[line].size()));
  }
  /// Whether nothing follows but space.
  bool is_end(const Spot& spot) const {
    const auto blank = [](const std::string& text, std::size_t from) {
      return text.find_first_not_of(" \t", from) == std::string::npos;
    };
    return blank(lines_[std::size_t(spot.line) - 1], std::size_t(spot.column) - 1) &&
           std::all_of(lines_.begin() + spot.line, lines_.end(),
                       [&](const std::string& text) { return blank(text, 0); });
  }
  const std::string& line(const Spot& spot) const { return lines_[std::size_t(spot.line) - 1]; }
  char byte(const Spot& spot) const {
    return std::size_t(spot.column) <= line(spot).size() ? line(spot)[std::size_t(spot.column) - 1] : '\n';
  }

 private:
  Spot in_line(std::size_t line, std::size_t byte) const {
    const std::string& text = lines_[line];
    const auto tails = std::count_if(text.begin(), text.begin() + long(byte), is_tail);
    return {int(line) + 1, int(byte) + 1, int(byte) - int(tails) + 1};
  }

  const std::vector<std::string>& lines_;
  const JoinedEscapes* joined_;
  std::size_t line_ = 0, characters_ = 0, byte_ = 0;  ///< The last spot.
};

/// What to do about libyaml's terse complaints. Most are about what it found where something had to end; then
/// the place where that began says more.
struct Complaint {
  const char *context, *problem;  ///< As libyaml words them; null: any.
  const char* hint;
  bool at_context = false;  ///< Best shown where the thing began, if all of the text is in it.
};
constexpr Complaint complaints[] = {
    {"while parsing a flow sequence", nullptr,
     "a list that opens with [ must close with ], with commas between its elements", true},
    {"while parsing a flow mapping", nullptr,
     "a mapping that opens with { must close with }, with commas between its keys", true},
    {"while parsing a block mapping", nullptr,
     "keys that belong together start in the same column, each with a colon and a space"},
    {"while parsing a block collection", nullptr,
     "elements of a list start in the same column, each with '- '"},
    {"while scanning a simple key", nullptr, "a key is followed by a colon and a space, in the same line"},
    {"while scanning a quoted scalar", "found unexpected end of stream", "a quote is not closed", true},
    {"while scanning a quoted scalar", "found unexpected document indicator", "a quote is not closed", true},
    {"while parsing a quoted scalar", "found invalid Unicode character escape code",
     "a character beyond U+FFFF is written as it is, or as one escape such as \\U0001f600"},
    {"while parsing a quoted scalar", nullptr,
     "in double quotes a backslash begins an escape such as \\n; text in single quotes is taken as it is"},
    {nullptr, "mapping values are not allowed in this context",
     "text with ': ' in it needs quotes; keys that belong together start in the same column"},
    {nullptr, "block sequence entries are not allowed in this context",
     "a list begins in a line of its own, each element with '- '"},
    {nullptr, "found character that cannot start any token",
     "text that begins with a special character needs quotes"},
};

/// libyaml takes the text apart, event by event; this builds the tree.
class TreeBuilder {
 public:
  TreeBuilder(Document& document, int source, std::string_view text, const JoinedEscapes* joined = nullptr)
      : document_(document), source_(source), spots_(document.sources[std::size_t(source)].lines, joined) {
    if (!yaml_parser_initialize(&parser_)) throw std::bad_alloc();
    yaml_parser_set_encoding(&parser_, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&parser_, reinterpret_cast<const unsigned char*>(text.data()), text.size());
  }
  ~TreeBuilder() { yaml_parser_delete(&parser_); }
  TreeBuilder(const TreeBuilder&) = delete;
  TreeBuilder& operator=(const TreeBuilder&) = delete;

  /// The text's value, or null where there is none. Throws NotYaml.
  Node* build() {
    while (take_event()) {
    }
    return root_;
  }

 private:
  /// False at the end.
  bool take_event() {
    yaml_event_t event;
    if (!yaml_parser_parse(&parser_, &event)) complain();
    const std::unique_ptr<yaml_event_t, decltype(&yaml_event_delete)> kept(&event, yaml_event_delete);
    switch (event.type) {
      case YAML_DOCUMENT_START_EVENT:
        if (++documents_ > 1)
          throw NotYaml{spots_.at(event.start_mark), "a second YAML document begins here",
                        "a scene file holds one; remove the line '---' and what follows"};
        break;
      case YAML_ALIAS_EVENT:
        attach_alias(event);
        break;
      case YAML_SCALAR_EVENT:
        add_scalar(event);
        break;
      case YAML_SEQUENCE_START_EVENT:
        open(add(event, Node::Kind::list, event.data.sequence_start.anchor, event.data.sequence_start.tag));
        break;
      case YAML_MAPPING_START_EVENT:
        open(add(event, Node::Kind::mapping, event.data.mapping_start.anchor, event.data.mapping_start.tag));
        break;
      case YAML_SEQUENCE_END_EVENT:
      case YAML_MAPPING_END_EVENT:
        open_.pop_back();
        break;
      default:
        break;
    }
    return event.type != YAML_STREAM_END_EVENT;
  }

  static const char* text_of(const yaml_char_t* text) { return reinterpret_cast<const char*>(text); }

  void add_scalar(const yaml_event_t& event) {
    const auto& scalar = event.data.scalar;
    const std::string_view value(text_of(scalar.value), scalar.length);
    const bool plain = scalar.style == YAML_PLAIN_SCALAR_STYLE;
    static constexpr std::string_view nothing[] = {"", "~", "null", "Null", "NULL"};
    if (plain && !scalar.tag &&
        std::find(std::begin(nothing), std::end(nothing), value) != std::end(nothing)) {
      Node* node = add(event, Node::Kind::nothing, scalar.anchor, nullptr);
      // An empty element stands behind its dash; people look for the dash.
      const Spot before{node->line, node->column - 1, node->character - 1};
      if (value.empty() && before.column > 0 && spots_.byte(before) == '-') put(*node, before);
      return;
    }
    Node* node = add(event, Node::Kind::text, scalar.anchor, scalar.tag);
    node->text = value;
    node->quoted = scalar.tag ? node->tag.empty() : !plain;
  }
  void attach_alias(const yaml_event_t& event) {
    const std::string name = text_of(event.data.alias.anchor);
    const auto found = anchored_.find(name);
    if (found == anchored_.end())
      throw NotYaml{spots_.at(event.start_mark),
                    "this is not YAML: no value before this one is named &" + name,
                    "an alias *" + name + " repeats a value that was written as &" + name + " ..."};
    Node* node = found->second;
    if (std::find(open_.begin(), open_.end(), node) != open_.end())
      throw NotYaml{spots_.at(event.start_mark),
                    "this is not YAML: this alias stands inside the value that it names",
                    {}};
    node->shared = true;
    attach(node);
  }
  Node* add(const yaml_event_t& event, Node::Kind kind, const yaml_char_t* anchor, const yaml_char_t* tag) {
    Node& node = document_.nodes.emplace_back();
    node.kind = kind;
    node.source = source_;
    put(node, spots_.at(event.start_mark));
    if (tag && std::strcmp(text_of(tag), "!") != 0) {  // that one means "no tag: text"
      const std::string_view standard = "tag:yaml.org,2002:", whole = text_of(tag);
      node.tag = whole;
      if (whole.starts_with(standard)) node.tag.replace(0, standard.size(), "!!");
    }
    if (anchor) anchored_[text_of(anchor)] = &node;
    attach(&node);
    return &node;
  }
  void attach(Node* node) {
    if (open_.empty()) root_ = node;
    else open_.back()->children.push_back(node);
  }
  void open(Node* node) {
    constexpr std::size_t deepest = 500;  // the readers of values go as deep as these
    if (open_.size() >= deepest) throw NotYaml{*node, "the YAML is nested too deeply", {}};
    open_.push_back(node);
  }

  [[noreturn]] void complain() {
    if (parser_.error == YAML_MEMORY_ERROR) throw std::bad_alloc();
    const std::string problem = parser_.problem ? parser_.problem : "it cannot be read";
    if (parser_.error == YAML_READER_ERROR)
      throw NotYaml{spots_.behind(parser_.problem_offset), "this is not YAML: " + problem,
                    "scene files are UTF-8 text"};
    Spot spot = spots_.at(parser_.problem_mark);
    std::string message = "this is not YAML: " + problem, hint;
    const std::string context = parser_.context ? parser_.context : "";
    const std::string& line = spots_.line(spot);
    const char found = spots_.byte(spot);
    if (line.substr(0, line.find_first_not_of(" \t")).find('\t') != std::string::npos) {
      hint = "indent with spaces, not with tabs";
    } else if ((found == ']' || found == '}') && context.find("flow sequence") == std::string::npos &&
               context.find("flow mapping") == std::string::npos) {
      hint = "there is one closing bracket too many, or of the wrong kind";
    } else {
      for (const Complaint& one : complaints) {
        if ((one.context && context != one.context) || (one.problem && problem != one.problem)) continue;
        hint = one.hint;
        if (one.at_context && spots_.is_end(spot)) spot = spots_.at(parser_.context_mark);
        break;
      }
    }
    throw NotYaml{spot, std::move(message), std::move(hint)};
  }

  Document& document_;
  int source_;
  Spots spots_;
  yaml_parser_t parser_;
  int documents_ = 0;
  Node* root_ = nullptr;
  std::vector<Node*> open_;
  std::map<std::string, Node*> anchored_;
};

[[noreturn]] void fail(const Document& document, int source, const Spot& spot, std::string message,
                       std::string hint = {}) {
  Node node;
  node.source = source;
  put(node, spot);
  throw InputError(diagnostic_at(document, node, std::move(message), std::move(hint)));
}

Node* parse_into(Document& document, std::string_view text, int source) {
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos)
    fail(document, source, Spots(document.sources[std::size_t(source)].lines).behind(zero),
         "this is not a text file: it holds a byte of value 0", "scene files are UTF-8 text");
  const std::size_t nodes_before = document.nodes.size();
  try {
    try {
      return TreeBuilder(document, source, text).build();
    } catch (const NotYaml&) {
      // Of what JSON allows and libyaml does not, programs write this alone.
      if (text.find("\\u") == std::string_view::npos || !nlohmann::json::accept(text)) throw;
      document.nodes.resize(nodes_before);
      const JoinedEscapes joined(text);
      return TreeBuilder(document, source, joined.text, &joined).build();
    }
  } catch (const NotYaml& error) {
    fail(document, source, error.spot, error.message, error.hint);
  }
}

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> steps(1);
  for (const char c : path) {
    if (c == '.') steps.emplace_back();
    else steps.back() += c;
  }
  return steps;
}

std::string join_steps(const std::vector<std::string>& steps, std::size_t begin, std::size_t end) {
  return join({steps.begin() + long(begin), steps.begin() + long(end)}, ".");
}

/// Walks the path of one setting.
class Setter {
 public:
  Setter(Document& document, int source, const std::string& path)
      : document_(document), source_(source), steps_(split_path(path)) {}

  void put(Node* value) {
    if (std::any_of(steps_.begin(), steps_.end(), [](const std::string& step) { return step.empty(); }))
      fail("a setting is written path.to.key=value", "for example image.samples=16");
    Node** slot = &document_.root;
    for (std::size_t i = 0; i < steps_.size();) slot = step(*slot, i);
    *slot = value;
  }

 private:
  [[noreturn]] void fail(std::string message, std::string hint) const {
    Diagnostic diagnostic;
    diagnostic.place.file = document_.sources[source_].name;
    diagnostic.message = std::move(message);
    diagnostic.hint = std::move(hint);
    throw InputError(diagnostic);
  }
  Node* create(Node::Kind kind) {
    Node& node = document_.nodes.emplace_back();
    node.kind = kind;
    node.source = source_;
    return &node;
  }
  /// A value that aliases show elsewhere too is copied before it is changed here.
  Node* own(Node*& slot) {
    if (slot->shared) {
      Node* copy = &document_.nodes.emplace_back(*slot);
      copy->shared = false;
      for (Node* child : copy->children) child->shared = true;
      slot = copy;
    }
    return slot;
  }
  /// One step down from the value in `slot`; `i` moves behind what it used of the path.
  Node** step(Node*& slot, std::size_t& i) {
    if (slot == nullptr || slot->kind == Node::Kind::nothing) slot = create(Node::Kind::mapping);
    Node* node = own(slot);
    if (node->kind == Node::Kind::text) {
      const std::string here = join_steps(steps_, 0, i);
      fail("'" + here + "' is the single value '" + node->text + "': there is no '" + steps_[i] + "' in it",
           "set '" + here + "' as a whole");
    }
    return node->kind == Node::Kind::list ? element(*node, i) : &member(*node, steps_[i++]);
  }
  Node*& member(Node& mapping, const std::string& key) {
    for (std::size_t k = 0; k + 1 < mapping.children.size(); k += 2)
      if (mapping.children[k]->kind == Node::Kind::text && mapping.children[k]->text == key)
        return mapping.children[k + 1];
    Node* name = create(Node::Kind::text);
    name->text = key;
    mapping.children.push_back(name);
    mapping.children.push_back(create(Node::Kind::nothing));
    return mapping.children.back();
  }
  Node** element(Node& list, std::size_t& i) {
    std::vector<std::string> names;
    for (const Node* child : list.children) {
      const Node* name = value_of(*child, "name");
      if (name != nullptr && name->kind == Node::Kind::text) names.push_back(name->text);
    }
    // A name may hold dots ("bunny.obj"), so the longest stretch of the path that is a name counts.
    for (std::size_t end = steps_.size(); end > i; --end) {
      const std::string wanted = join_steps(steps_, i, end);
      Node** found = nullptr;
      for (Node*& child : list.children) {
        const Node* name = value_of(*child, "name");
        if (name == nullptr || name->kind != Node::Kind::text || name->text != wanted) continue;
        if (found != nullptr)
          fail("'" + wanted + "' is the name of more than one element of '" + join_steps(steps_, 0, i) + "'",
               "use its index, from 0");
        found = &child;
      }
      if (found != nullptr) {
        i = end;
        return found;
      }
    }
    const std::string& text = steps_[i];
    std::size_t index = 0;
    const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (code == std::errc() && stop == text.data() + text.size() && index < list.children.size()) {
      ++i;
      return &list.children[index];
    }
    const std::string indices = list.children.empty() ? "the list is empty"
                                : list.children.size() == 1
                                    ? "its only index is 0"
                                    : "its indices are 0 to " + std::to_string(list.children.size() - 1);
    const std::string hint = names.empty() ? indices : suggestion(text, names);
    fail("'" + join_steps(steps_, 0, i) + "' has no element '" + text + "'", hint);
  }

  Document& document_;
  int source_;
  std::vector<std::string> steps_;
};

/// Lets a diagnostic show a line with a caret under that column, from 1 in bytes. Of a very long line only
/// what is near is kept: there may be a thousand errors in it.
void show_line(Diagnostic& diagnostic, std::string_view line, int column) {
  constexpr std::size_t reach = 600;  // bytes: more than is shown
  const std::size_t at = std::min(std::size_t(std::max(0, column - 1)), line.size());
  std::size_t begin = at > reach ? at - reach : 0, end = std::min(line.size(), at + reach);
  while (begin < at && is_tail(line[begin])) ++begin;
  while (end < line.size() && is_tail(line[end])) ++end;
  diagnostic.excerpt = line.substr(begin, end - begin);
  diagnostic.caret_column = column > 0 ? column - int(begin) : 0;
}

}  // namespace

const Node* value_of(const Node& mapping, std::string_view key) {
  if (mapping.kind != Node::Kind::mapping) return nullptr;
  for (std::size_t k = 0; k + 1 < mapping.children.size(); k += 2)
    if (mapping.children[k]->kind == Node::Kind::text && mapping.children[k]->text == key)
      return mapping.children[k + 1];
  return nullptr;
}

Place place_of(const Document& document, const Node& node) {
  const Source& source = document.sources[std::size_t(node.source)];
  return source.is_file ? Place{source.name, node.line, node.character} : Place{source.name, 0, 0};
}

Diagnostic diagnostic_at(const Document& document, const Node& node, std::string message, std::string hint) {
  const Source& source = document.sources[std::size_t(node.source)];
  Diagnostic diagnostic;
  diagnostic.message = std::move(message);
  diagnostic.hint = std::move(hint);
  diagnostic.place = place_of(document, node);
  if (node.line >= 1 && node.line <= int(source.lines.size()))
    show_line(diagnostic, source.lines[std::size_t(node.line) - 1], node.column);
  return diagnostic;
}

void show_lines(const Document& document, std::vector<Diagnostic>& remarks) {
  const Source& file = document.sources[0];
  Spots spots(file.lines);
  for (Diagnostic& remark : remarks) {
    const Place& place = remark.place;
    if (place.file != file.name || place.line < 1 || place.line > int(file.lines.size())) continue;
    const int column =
        place.column < 1 ? 0 : spots.at(std::size_t(place.line) - 1, std::size_t(place.column) - 1).column;
    show_line(remark, file.lines[std::size_t(place.line) - 1], column);
  }
}

Document parse_yaml(std::string_view text, const std::string& name) {
  if (text.substr(0, 3) == "\xef\xbb\xbf")
    text.remove_prefix(3);  // a byte order mark would shift the first columns
  const std::string lines = with_newlines(text);
  Document document;
  document.sources.push_back({name, split_lines(lines), true});
  document.root = parse_into(document, lines, 0);
  return document;
}

void apply_setting(Document& document, const std::string& path, const std::string& value) {
  const int source = int(document.sources.size());
  document.sources.push_back({"--set " + path + "=" + value, split_lines(value), false});
  Node* node = nullptr;
  if (!value.empty() && value[0] == '#') {  // in YAML a comment, but nobody sets a comment: a colour
    node = &document.nodes.emplace_back();
    node->kind = Node::Kind::text;
    node->text = value;
    node->quoted = true;
  } else {
    node = parse_into(document, value, source);
    if (node == nullptr) node = &document.nodes.emplace_back();
  }
  node->source = source;
  node->line = std::max(1, node->line);
  node->column = std::max(1, node->column);
  Setter(document, source, path).put(node);
}

}  // namespace lambent
