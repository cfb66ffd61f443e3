#pragma once
// YAML as a tree in which every value knows where it was written.
//
// libyaml takes the text apart. Libraries' own trees keep one of two equal keys in silence, and do not tell
// "3" from 3.

#include <deque>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lambent/diagnostics.h"

namespace lambent {

/// A place in a text. Lines and columns from 1; 0 where it is in none.
struct Spot {
  int line = 0;
  int column = 0;     ///< In bytes, as carets count.
  int character = 0;  ///< The column in characters, as editors count.
};

/// A value, and the spot where it begins.
struct Node : Spot {
  enum class Kind { nothing, text, list, mapping };
  Kind kind = Kind::nothing;
  bool quoted = false;          ///< Text in quotes: never a number.
  bool shared = false;          ///< Shown in several places by aliases.
  int source = 0;               ///< Index into Document::sources.
  std::string text;             ///< Of Kind::text.
  std::string tag;              ///< "!!float" and the like, or empty.
  std::vector<Node*> children;  ///< A list's elements; a mapping's keys and values, in turn.
};

/// A text that nodes come from: the scene file, or a value given on the command line.
struct Source {
  std::string name;
  std::vector<std::string> lines;
  bool is_file = true;  ///< If not, lines and columns mean nothing to people; the excerpt is the value.
};

struct Document {
  std::deque<Node> nodes;  // a deque: growing it moves no node
  std::vector<Source> sources;
  Node* root = nullptr;
  Document() = default;
  Document(Document&&) = default;
  Document& operator=(Document&&) = default;
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;
};

/// Takes YAML (or JSON) apart. Throws InputError for text that is not YAML.
Document parse_yaml(std::string_view text, const std::string& name);

/// Puts a value into the document: "lights.key.point.intensity", "4". Keys that are missing on the way are
/// created; an element of a list is named by its `name`, or by its index from 0. Throws InputError where the
/// path leads nowhere.
void apply_setting(Document& document, const std::string& path, const std::string& value);

/// Where `node` stands, for people.
Place place_of(const Document& document, const Node& node);

/// A remark about `node`, with the line it stands in.
Diagnostic diagnostic_at(const Document& document, const Node& node, std::string message,
                         std::string hint = {});

/// Lets the remarks that have places in the document's file show the lines there.
void show_lines(const Document& document, std::vector<Diagnostic>& remarks);

/// The value of a mapping's key, or null.
const Node* value_of(const Node& mapping, std::string_view key);

}  // namespace lambent
