// Scenes, broken in every way at every key: each variant must be refused, at the line that was broken.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scenefile/document.h"
#include "scenefile/errors.h"
#include "scenefile/format.h"
#include "scenefile/json_schema.h"
#include "scenefile/sample.h"
#include "support.h"

namespace lambent::test {
namespace {

/// One way of breaking a text.
struct Variant {
  std::string what;            ///< "'fov' misspelt in line 8".
  std::string text;            ///< The broken scene.
  int line = 0;                ///< Where the error must be.
  std::string message, hint;   ///< What the error must say, or empty.
  bool schema_sees_it = true;  ///< Repeated keys are gone before a schema looks.
};

/// A text that pieces are replaced in, by line and column.
class Text {
 public:
  explicit Text(const std::string& text) : text_(text) {
    starts_.push_back(0);
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n') starts_.push_back(i + 1);
  }
  std::size_t offset(const Node& node) const {
    return starts_[std::size_t(node.line) - 1] + std::size_t(node.column) - 1;
  }
  char at(const Node& node) const { return text_[offset(node)]; }
  std::string replaced(std::size_t begin, std::size_t length, const std::string& by) const {
    return std::string(text_).replace(begin, length, by);
  }
  std::size_t line_begin(int line) const { return starts_[std::size_t(line) - 1]; }
  std::size_t line_end(int line) const {
    return std::size_t(line) < starts_.size() ? starts_[std::size_t(line)] : text_.size();
  }
  std::string slice(std::size_t begin, std::size_t end) const { return text_.substr(begin, end - begin); }
  /// How many characters a value takes that begins and ends in one line; 0 if it is not of that kind.
  std::size_t length_of(const Node& node) const {
    const std::size_t begin = offset(node);
    if (node.kind == Node::Kind::text) {
      if (!node.quoted) return text_.compare(begin, node.text.size(), node.text) == 0 ? node.text.size() : 0;
      const std::size_t end = text_.find(text_[begin], begin + 1);
      return end == std::string::npos ? 0 : end + 1 - begin;
    }
    if (text_[begin] != '[' && text_[begin] != '{') return 0;
    int depth = 0;
    for (std::size_t i = begin; i < text_.size(); ++i) {
      if (text_[i] == '[' || text_[i] == '{') ++depth;
      if ((text_[i] == ']' || text_[i] == '}') && --depth == 0) return i + 1 - begin;
    }
    return 0;
  }

 private:
  std::string text_;
  std::vector<std::size_t> starts_;
};

/// A name with one letter more or less.
std::string misspelt(const std::string& name) {
  return name.size() > 3 ? name.substr(0, 1) + name.substr(2) : name + name.back();
}

bool is_number(const Node& node) {
  return node.kind == Node::Kind::text && !node.quoted && parse_number(node.text).has_value();
}

/// The fields that a mapping behind this key must have.
std::vector<std::string> required_behind(const std::string& key) {
  const Format& f = format();
  std::vector<Section> sections{f.camera, f.rotate};
  sections.insert(sections.end(), f.shapes.begin(), f.shapes.end());
  sections.insert(sections.end(), f.lights.begin(), f.lights.end());
  std::vector<std::string> names;
  for (const Section& section : sections)
    for (const Field& field : section.fields)
      if (section.name == key && field.required) names.push_back(field.name);
  return names;
}

class Breaker {
 public:
  explicit Breaker(const std::string& text) : text_(text), document_(parse_yaml(text, "scene.yaml")) {
    mapping(*document_.root, "", 1);
  }
  std::vector<Variant> variants;

 private:
  void value(const Node& node, const std::string& key, int line) {
    if (node.kind == Node::Kind::mapping) mapping(node, key, line);
    if (node.kind == Node::Kind::list)
      for (const Node* child : node.children) value(*child, "", child->line);
    if (is_number(node)) {
      const std::string where = "'" + node.text + "' in line " + std::to_string(node.line);
      replace(node, where + " is NaN", ".nan");
      replace(node, where + " is infinite", "-.inf");
      replace(node, where + " is huge", "1e300");
      replace(node, where + " is text", "abc");
      replace(node, where + " is in quotes", "\"" + node.text + "\"");
    }
  }
  void replace(const Node& node, const std::string& what, const std::string& by,
               const std::string& message = {}) {
    const std::size_t length = text_.length_of(node);
    if (length > 0)
      variants.push_back({what, text_.replaced(text_.offset(node), length, by), node.line, message, {}});
  }

  void mapping(const Node& node, const std::string& owner, int owner_line) {
    const bool flow = text_.at(node) == '{';
    for (std::size_t i = 0; i + 1 < node.children.size(); i += 2) {
      const Node& key = *node.children[i];
      const Node& inner = *node.children[i + 1];
      const std::string where = "'" + key.text + "' in line " + std::to_string(key.line);
      const std::size_t begin = text_.offset(key);

      variants.push_back({where + " misspelt", text_.replaced(begin, key.text.size(), misspelt(key.text)),
                          key.line, "unknown key '" + misspelt(key.text) + "'",
                          "did you mean '" + key.text + "'?"});
      variants.push_back({where + " with the merge key", text_.replaced(begin, key.text.size(), "<<"),
                          key.line, "merging with '<<'", "write the keys out"});
      const std::string again =
          key.text + (flow ? ": 0, " : ": 0\n" + std::string(std::size_t(key.column) - 1, ' '));
      variants.push_back({where + " repeated", text_.replaced(begin, 0, again), key.line + (flow ? 0 : 1),
                          "'" + key.text + "' stands here a second time", "remove one of them", false});
      remove(node, key, inner, flow, owner, owner_line);
      // A mapping stands in many places of the format, but never one with this key.
      replace(inner, where + " is a mapping", "{nonsense: 1}");
      if (inner.kind != Node::Kind::list) replace(inner, where + " is a list of lists", "[[]]");
      replace(inner, where + " is a tagged value", "!!int 3x", "");
      if (!variants.empty() && variants.back().what == where + " is a tagged value")
        variants.back().schema_sees_it = false;
      const std::size_t length = text_.length_of(inner);
      if (length > 0 && inner.line == key.line)
        variants.push_back({where + " is empty",
                            text_.replaced(text_.offset(inner), length, ""),
                            key.line,
                            "has no value",
                            {}});
      value(inner, key.text, key.line);
    }
  }

  void remove(const Node& node, const Node& key, const Node& inner, bool flow, const std::string& owner,
              int owner_line) {
    std::vector<std::string> required = required_behind(owner);
    if (&node == document_.root) required = {"lambent", "camera"};
    if (std::find(required.begin(), required.end(), key.text) == required.end()) return;
    const std::size_t length = text_.length_of(inner);
    if (length == 0 || inner.line != key.line) return;
    std::size_t begin = text_.offset(key), end = text_.offset(inner) + length;
    if (flow) {
      // With the comma behind it, or else the one before.
      const std::string rest = text_.slice(end, text_.line_end(key.line));
      if (rest[0] == ',') ++end;
      else if (begin >= 2 && text_.slice(begin - 2, begin) == ", ") begin -= 2;
    } else {
      begin = text_.line_begin(key.line);
      end = text_.line_end(key.line);
    }
    // The key above a mapping does not move when a line below goes; the scene itself begins with its first
    // key.
    const int line = &node == document_.root ? document_.root->children[0]->line : owner_line;
    if (&node != document_.root && node.children.size() == 2)
      return;  // an empty block would be "has no value"
    variants.push_back({"'" + key.text + "' in line " + std::to_string(key.line) + " removed",
                        text_.replaced(begin, end - begin, ""),
                        line,
                        "needs '" + key.text + "'",
                        {}});
  }

  Text text_;
  Document document_;
};

/// Refused, with an error at the right line that says the right thing.
testing::AssertionResult is_refused(const Variant& variant, const std::string& name) {
  const std::vector<Diagnostic> errors = errors_of(variant.text, {}, name);
  if (errors.empty()) return testing::AssertionFailure() << variant.what << ": was accepted";
  const int lines = 1 + int(std::count(variant.text.begin(), variant.text.end(), '\n'));
  std::string all;
  bool found = false;
  for (const Diagnostic& error : errors) {
    all += to_string(error) + "\n";
    // A model file that a scene names has lines of its own.
    if (error.place.file == name && (error.place.line < 1 || error.place.line > lines))
      return testing::AssertionFailure() << variant.what << ": a place outside the file\n" << all;
    found = found || (error.place.line == variant.line && error.place.column > 0 && !error.excerpt.empty() &&
                      error.message.find(variant.message) != std::string::npos &&
                      error.hint.find(variant.hint) != std::string::npos);
  }
  if (found) return testing::AssertionSuccess();
  return testing::AssertionFailure() << variant.what << ": expected line " << variant.line << " \""
                                     << variant.message << "\" \"" << variant.hint << "\", but got\n"
                                     << all;
}

TEST(BrokenScenes, EveryVariantOfTheSampleIsRefusedAtItsLine) {
  ASSERT_TRUE(errors_of(sample_scene).empty());
  const std::vector<Variant> variants = Breaker(sample_scene).variants;
  EXPECT_GE(variants.size(), 800u);
  for (const Variant& variant : variants) EXPECT_TRUE(is_refused(variant, "scene.yaml"));
}

TEST(BrokenScenes, TheSchemaRefusesThemToo) {
  const JsonSchema schema(Json::parse(scene_schema()));
  EXPECT_TRUE(schema.accepts(json_of(*parse_yaml(sample_scene, "scene.yaml").root)));
  int judged = 0;
  for (const Variant& variant : Breaker(sample_scene).variants) {
    if (!variant.schema_sees_it) continue;
    const Document document = parse_yaml(variant.text, "scene.yaml");
    EXPECT_FALSE(schema.accepts(json_of(*document.root))) << variant.what;
    ++judged;
  }
  EXPECT_GE(judged, 700);
}

TEST(BrokenScenes, EveryVariantOfTheProjectsScenesIsRefusedAtItsLine) {
  const std::filesystem::path folder = std::filesystem::path(LAMBENT_SOURCE_DIR) / "scenes";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "there is no folder " << folder;
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".yaml") paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  if (paths.empty()) GTEST_SKIP() << "there are no scenes in " << folder;
  constexpr std::size_t most = 150;  // of each scene: their meshes are read every time
  for (const std::string& path : paths) {
    const std::string text = read_text(path);
    ASSERT_TRUE(errors_of(text, {}, path).empty()) << path;
    const std::vector<Variant> variants = Breaker(text).variants;
    EXPECT_GE(variants.size(), 50u) << path;
    const std::size_t stride = variants.size() / most + 1;
    for (std::size_t i = 0; i < variants.size(); i += stride)
      EXPECT_TRUE(is_refused(variants[i], path)) << path;
  }
}

TEST(BrokenScenes, ATextCutOffAnywhereNeverCrashes) {
  const std::string text = sample_scene;
  int refused = 0;
  for (std::size_t length = 0; length < text.size(); length += 7) {
    const std::vector<Diagnostic> errors = errors_of(text.substr(0, length));
    const int lines = 1 + int(std::count(text.begin(), text.begin() + long(length), '\n'));
    for (const Diagnostic& error : errors)
      EXPECT_TRUE(error.place.line >= 1 && error.place.line <= lines) << to_string(error);
    refused += !errors.empty();
  }
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace lambent::test
