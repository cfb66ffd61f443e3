#include "scenefile/document.h"

#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <sstream>

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

/// With line breaks of one kind only: yaml-cpp does not count a lone carriage return as a line.
std::string with_newlines(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool pair = text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n';
    if (!pair) result += text[i] == '\r' ? '\n' : text[i];
  }
  return result;
}

/// Builds the tree from yaml-cpp's events.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(Document& document, int source) : document_(document), source_(source) {}

  Node* root = nullptr;

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Node* node = add(mark, anchor, Node::Kind::nothing, {});
    if (!open_.empty() && open_.back()->kind == Node::Kind::list) go_to_dash(*node);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Node* node = anchored_.count(anchor) ? anchored_[anchor] : nullptr;
    if (node == nullptr || std::find(open_.begin(), open_.end(), node) != open_.end())
      throw YAML::ParserException(mark, "this alias stands inside the value that it names");
    node->shared = true;
    attach(node);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    Node* node = add(mark, anchor, Node::Kind::text, tag);
    node->text = value;
    node->quoted = tag == "!";
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open_.push_back(add(mark, anchor, Node::Kind::list, tag));
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open_.push_back(add(mark, anchor, Node::Kind::mapping, tag));
  }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  Node* add(const YAML::Mark& mark, YAML::anchor_t anchor, Node::Kind kind, const std::string& tag) {
    Node& node = document_.nodes.emplace_back();
    node.kind = kind;
    node.source = source_;
    node.line = mark.line + 1;
    node.column = mark.column + 1;
    if (tag != "?" && tag != "!") {  // these two mean "no tag": plain and quoted
      const std::string standard = "tag:yaml.org,2002:";
      node.tag = tag.compare(0, standard.size(), standard) == 0 ? "!!" + tag.substr(standard.size()) : tag;
    }
    if (anchor != YAML::NullAnchor) anchored_[anchor] = &node;
    attach(&node);
    return &node;
  }
  void attach(Node* node) {
    if (open_.empty()) root = node;
    else open_.back()->children.push_back(node);
  }
  /// yaml-cpp places an empty element at whatever follows it; people look for its dash.
  void go_to_dash(Node& node) const {
    const auto& lines = document_.sources[source_].lines;
    for (int line = std::min<int>(node.line, int(lines.size())); line >= 1; --line) {
      const std::string& text = lines[line - 1];
      const std::size_t comment = std::min(text.find(" #"), text.size());
      const std::size_t last = text.find_last_not_of(" \t", comment == 0 ? 0 : comment - 1);
      if (last == std::string::npos || text[last] != '-') continue;
      node.line = line;
      node.column = int(last) + 1;
      return;
    }
  }

  Document& document_;
  int source_;
  std::vector<Node*> open_;
  std::map<YAML::anchor_t, Node*> anchored_;
};

/// What to do about yaml-cpp's terse complaints.
std::string remedy(const std::string& complaint) {
  using namespace YAML::ErrorMsg;
  if (complaint == MAP_VALUE || complaint == MAP_KEY)
    return "text with ': ' in it needs quotes; keys that belong together start in the same column";
  if (complaint == END_OF_MAP)
    return "keys that belong together start in the same column, each with a colon and a space";
  if (complaint == END_OF_SEQ) return "elements of a list start in the same column, each with '- '";
  if (complaint == END_OF_MAP_FLOW)
    return "a mapping that opens with { must close with }, with commas between its keys";
  if (complaint == END_OF_SEQ_FLOW)
    return "a list that opens with [ must close with ], with commas between its elements";
  if (complaint == FLOW_END) return "there is one closing bracket too many, or of the wrong kind";
  if (complaint == TAB_IN_INDENTATION) return "indent with spaces, not with tabs";
  if (complaint == EOF_IN_SCALAR) return "a quote is not closed";
  if (complaint == UNKNOWN_TOKEN) return "text that begins with a special character needs quotes";
  return {};
}

[[noreturn]] void fail(const Document& document, int source, int line, int column, std::string message,
                       std::string hint = {}) {
  Node place;
  place.source = source;
  place.line = line;
  place.column = column;
  throw InputError(diagnostic_at(document, place, std::move(message), std::move(hint)));
}

Node* parse_into(Document& document, std::string_view text, int source) {
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos) {
    const std::string_view before = text.substr(0, zero);
    const int line = 1 + int(std::count(before.begin(), before.end(), '\n'));
    const std::size_t start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
    fail(document, source, line, int(zero - start) + 1, "this is not a text file: it holds a byte of value 0",
         "scene files are UTF-8 text");
  }
  TreeBuilder builder(document, source);
  try {
    std::istringstream stream{std::string(text)};
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) return nullptr;
    Node* const root = builder.root;
    if (parser.HandleNextDocument(builder))
      fail(document, source, builder.root->line, builder.root->column, "a second YAML document begins here",
           "a scene file holds one; remove the line '---' and what follows");
    return root;
  } catch (const YAML::Exception& error) {
    // At the end of the text yaml-cpp points behind the last line.
    const auto& lines = document.sources[source].lines;
    const int line = std::clamp(error.mark.line + 1, 1, int(lines.size()));
    const int column =
        line == error.mark.line + 1 ? std::max(1, error.mark.column + 1) : int(lines[line - 1].size()) + 1;
    const std::string& text_there = lines[std::size_t(line) - 1];
    const bool tab =
        text_there.substr(0, text_there.find_first_not_of(" \t")).find('\t') != std::string::npos;
    const bool deep = dynamic_cast<const YAML::DeepRecursion*>(&error) != nullptr;
    fail(document, source, line, column,
         deep ? "the YAML is nested too deeply" : "this is not YAML: " + error.msg,
         tab ? "indent with spaces, not with tabs" : remedy(error.msg));
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

}  // namespace

const Node* value_of(const Node& mapping, std::string_view key) {
  if (mapping.kind != Node::Kind::mapping) return nullptr;
  for (std::size_t k = 0; k + 1 < mapping.children.size(); k += 2)
    if (mapping.children[k]->kind == Node::Kind::text && mapping.children[k]->text == key)
      return mapping.children[k + 1];
  return nullptr;
}

namespace {

/// Nodes count bytes, as carets do; an editor's columns are characters.
bool is_tail(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

}  // namespace

void show_line(Diagnostic& diagnostic, std::string_view line, int column) {
  constexpr std::size_t reach = 600;  // bytes: more than is shown
  const std::size_t at = std::min(std::size_t(std::max(0, column - 1)), line.size());
  std::size_t begin = at > reach ? at - reach : 0, end = std::min(line.size(), at + reach);
  while (begin < at && is_tail(line[begin])) ++begin;
  while (end < line.size() && is_tail(line[end])) ++end;
  diagnostic.excerpt = line.substr(begin, end - begin);
  diagnostic.caret_column = column > 0 ? column - int(begin) : 0;
}

Diagnostic diagnostic_at(const Document& document, const Node& node, std::string message, std::string hint) {
  const Source& source = document.sources[node.source];
  Diagnostic diagnostic;
  diagnostic.message = std::move(message);
  diagnostic.hint = std::move(hint);
  diagnostic.place.file = source.name;
  if (source.is_file) {
    diagnostic.place.line = node.line;
    diagnostic.place.column = node.column;
  }
  if (node.line >= 1 && node.line <= int(source.lines.size())) {
    const std::string& line = source.lines[std::size_t(node.line) - 1];
    show_line(diagnostic, line, node.column);
    const auto before = std::min<std::size_t>(std::size_t(std::max(0, node.column - 1)), line.size());
    if (source.is_file)
      diagnostic.place.column -= int(std::count_if(line.begin(), line.begin() + long(before), is_tail));
  }
  return diagnostic;
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
