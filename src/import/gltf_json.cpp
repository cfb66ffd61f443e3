#include "import/gltf_json.h"

#include <algorithm>
#include <utility>

#include "import/text_file.h"

namespace lambent::gltf {

namespace {

constexpr std::size_t most_errors = 20, most_warnings = 100;
/// Real files have about ten levels; what visits values recursively must stay within the stack.
constexpr std::size_t deepest = 200;

const Json nothing;

/// Throws what is wrong with a JSON text at one of its bytes.
[[noreturn]] void malformed(const std::string& file, std::string_view text, bool in_glb, std::size_t at,
                            const std::string& message, const std::string& hint = {}) {
  at = std::min(at, text.size());
  if (in_glb) {
    Diagnostic diagnostic;
    diagnostic.place.file = file;
    diagnostic.message = "byte " + std::to_string(at) + " of the JSON chunk: " + message;
    diagnostic.hint = hint;
    throw InputError(std::move(diagnostic));
  }
  // Only what stands before the place counts for line and column, and what follows only for the excerpt.
  TextFile around{file, std::string(text.substr(0, std::min(text.size(), at + 200)))};
  std::replace(around.text.begin(), around.text.end(), '\0', ' ');
  throw InputError(error_at(around, std::string_view(around.text).substr(at, 0), message, hint));
}

/// Builds the value while the parser walks over the text, and remembers where that stumbled.
class Builder : public nlohmann::json_sax<Json> {
 public:
  Builder() noexcept(false) {}

  Json root;
  std::size_t stumbled_at = 0;
  std::string complaint;  ///< Empty: all is well.
  std::string twice;      ///< Where a key stands a second time.

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    if (stack_.back()->contains(name)) {
      for (const std::string& step : path_) twice = twice / std::string_view(step);
      complaint = "the key " + in_quotes(name) + " stands twice in one object";
      return false;
    }
    key_ = std::move(name);
    return true;
  }
  bool parse_error(std::size_t position, const std::string& token, const Json::exception& error) override {
    // `position` is the token's end; bytes that cannot be printed stand in it as <U+0000>.
    const std::size_t length =
        token.find("<U+") == std::string::npos ? std::max<std::size_t>(token.size(), 1) : 1;
    stumbled_at = position - std::min(position, length);
    complaint = error.what();
    // "[json.exception.parse_error.101] parse error at line 3, column 7: syntax error while ..."
    complaint.erase(0, complaint.find("] ") + 2);
    if (complaint.starts_with("parse error")) complaint.erase(0, complaint.find(": ") + 2);
    return false;
  }

 private:
  template <class V> bool add(V&& value) {
    place(Json(std::forward<V>(value)));
    return true;
  }
  bool open(Json&& empty) {
    if (!stack_.empty())
      path_.push_back(stack_.back()->is_object() ? key_ : std::to_string(stack_.back()->size()));
    stack_.push_back(place(std::move(empty)));
    return true;
  }
  bool close() {
    stack_.pop_back();
    if (!path_.empty()) path_.pop_back();
    return true;
  }
  Json* place(Json&& value) {
    if (stack_.empty()) return &(root = std::move(value));
    Json& into = *stack_.back();
    if (into.is_object()) return &(into[key_] = std::move(value));
    into.push_back(std::move(value));
    return &into.back();
  }

  std::vector<Json*> stack_;       ///< The objects and arrays that are open; only the last one grows.
  std::vector<std::string> path_;  ///< How they are reached, but for the first.
  std::string key_;
};

/// The byte of the first bracket that is nested too deeply, or npos.
std::size_t too_deep(std::string_view text) {
  std::size_t depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\') ++i;
    else if (c == '"') quoted = !quoted;
    else if (!quoted && (c == '[' || c == '{') && ++depth > deepest) return i;
    else if (!quoted && (c == ']' || c == '}') && depth > 0) --depth;
  }
  return std::string_view::npos;
}

}  // namespace

// ---- remarks

Diagnostic Remarks::diagnostic(Severity severity, const std::string& pointer, std::string message,
                               std::string hint) {
  Diagnostic result;
  result.severity = severity;
  result.place.file = file_;
  result.message = pointer.empty() ? std::move(message) : pointer + ": " + message;
  result.hint = std::move(hint);
  return result;
}

void Remarks::error(const std::string& pointer, std::string message, std::string hint) {
  errors_.push_back(diagnostic(Severity::error, pointer, std::move(message), std::move(hint)));
  if (errors_.size() == most_errors) throw_errors();
}

void Remarks::warn(const std::string& pointer, std::string message, std::string hint) {
  if (warnings_.size() == most_warnings) return;
  Diagnostic said = diagnostic(Severity::warning, pointer, std::move(message), std::move(hint));
  if (std::none_of(warnings_.begin(), warnings_.end(),
                   [&](const Diagnostic& other) { return other.message == said.message; }))
    warnings_.push_back(std::move(said));
}

void Remarks::throw_errors() {
  if (!errors_.empty()) throw InputError(std::move(errors_));
}

void Remarks::fail(const std::string& pointer, std::string message, std::string hint) {
  throw InputError(diagnostic(Severity::error, pointer, std::move(message), std::move(hint)));
}

// ---- JSON

Json parse_json(const std::string& file, std::string_view text, bool in_glb) {
  if (text.starts_with("\xef\xbb\xbf") || text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    malformed(file, text, in_glb, 0, "the JSON begins with a byte order mark, which glTF forbids",
              "save the file as UTF-8 without it");
  if (const std::size_t at = too_deep(text); at != std::string_view::npos)
    malformed(file, text, in_glb, at,
              "lists and objects are nested more than " + std::to_string(deepest) + " deep");
  Builder builder;
  if (!Json::sax_parse(text.begin(), text.end(), &builder)) {
    if (builder.complaint.starts_with("the key")) Remarks(file).fail(builder.twice, builder.complaint);
    malformed(file, text, in_glb, builder.stumbled_at, "the JSON is malformed: " + builder.complaint);
  }
  return std::move(builder.root);
}

std::string operator/(const std::string& pointer, std::size_t index) {
  return pointer + "/" + std::to_string(index);
}
std::string operator/(const std::string& pointer, std::string_view key) {
  std::string result = pointer + "/";
  for (const char c : key) {
    if (c == '~') result += "~0";
    else if (c == '/') result += "~1";
    else result += std::uint8_t(c) < 0x20 || c == 0x7f ? '?' : c;
    if (result.size() > pointer.size() + 100) return result + "...";
  }
  return result;
}

const Json& member(const Json& object, const char* key) {
  if (!object.is_object()) return nothing;
  const auto found = object.find(key);
  return found == object.end() ? nothing : *found;
}
double number(const Json& object, const char* key, double otherwise) {
  const Json& value = member(object, key);
  return value.is_number() ? value.get<double>() : otherwise;
}
std::uint64_t whole(const Json& object, const char* key, std::uint64_t otherwise) {
  const Json& value = member(object, key);
  return value.is_number() ? value.get<std::uint64_t>() : otherwise;
}
std::string text(const Json& object, const char* key, const char* otherwise) {
  const Json& value = member(object, key);
  return value.is_string() ? value.get<std::string>() : otherwise;
}
bool flag(const Json& object, const char* key, bool otherwise) {
  const Json& value = member(object, key);
  return value.is_boolean() ? value.get<bool>() : otherwise;
}
std::string name_in(const Json& object) {
  constexpr std::size_t longest = 200;
  std::string name = text(object, "name");
  if (name.size() <= longest) return name;
  std::size_t end = longest;
  while (end > 0 && (std::uint8_t(name[end]) & 0xc0) == 0x80) --end;  // within a character
  name.resize(end);
  return name + "...";
}
const Json& extension(const Json& object, const char* name) {
  return member(member(object, "extensions"), name);
}

}  // namespace lambent::gltf
