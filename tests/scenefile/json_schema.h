#pragma once
// Enough of JSON Schema (draft-07) to judge a scene by the project's own schema.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>
#include <string>

#include "import/text_file.h"
#include "scenefile/document.h"

namespace lambent::test {

using Json = nlohmann::json;

/// A document as JSON; unquoted text is a number or a truth value where it looks like one.
inline Json json_of(const Node& node) {
  switch (node.kind) {
    case Node::Kind::nothing:
      return nullptr;
    case Node::Kind::text: {
      if (node.quoted) return node.text;
      if (node.text == "true" || node.text == "false") return node.text == "true";
      if (const auto number = parse_number(node.text)) {
        if (*number == std::floor(*number) && std::abs(*number) < 1e15) return std::int64_t(*number);
        return *number;
      }
      return node.text;
    }
    case Node::Kind::list: {
      Json list = Json::array();
      for (const Node* child : node.children) list.push_back(json_of(*child));
      return list;
    }
    case Node::Kind::mapping: {
      Json mapping = Json::object();
      for (std::size_t i = 0; i + 1 < node.children.size(); i += 2)
        mapping[node.children[i]->text] = json_of(*node.children[i + 1]);
      return mapping;
    }
  }
  throw std::logic_error("a kind of node that there is not");
}

class JsonSchema {
 public:
  explicit JsonSchema(Json schema) : root_(std::move(schema)) {}
  bool accepts(const Json& value) const { return valid(root_, value); }

 private:
  bool valid(const Json& schema, const Json& value) const {
    if (schema.contains("$ref")) {
      const std::string path = schema["$ref"];
      return valid(root_.at(Json::json_pointer(path.substr(1))), value);
    }
    for (const auto& [keyword, argument] : schema.items())
      if (!holds(keyword, argument, schema, value)) return false;
    return true;
  }
  int count(const Json& schemas, const Json& value) const {
    return int(
        std::count_if(schemas.begin(), schemas.end(), [&](const Json& one) { return valid(one, value); }));
  }
  bool holds(const std::string& keyword, const Json& argument, const Json& schema, const Json& value) const {
    if (keyword == "type") {
      if (argument.is_array())
        return std::any_of(argument.begin(), argument.end(),
                           [&](const Json& one) { return holds(keyword, one, schema, value); });
      if (argument == "null") return value.is_null();
      if (argument == "object") return value.is_object();
      if (argument == "array") return value.is_array();
      if (argument == "string") return value.is_string();
      if (argument == "boolean") return value.is_boolean();
      if (argument == "number") return value.is_number();
      if (argument == "integer") return value.is_number_integer();
      throw std::logic_error("unknown type");
    }
    if (keyword == "properties") {
      for (const auto& [name, one] : argument.items())
        if (value.is_object() && value.contains(name) && !valid(one, value[name])) return false;
      return true;
    }
    if (keyword == "additionalProperties") {
      if (!value.is_object()) return true;
      for (const auto& [name, one] : value.items()) {
        if (schema.contains("properties") && schema["properties"].contains(name)) continue;
        if (!argument.is_object() || !valid(argument, one)) return false;
      }
      return true;
    }
    if (keyword == "required")
      return !value.is_object() || std::all_of(argument.begin(), argument.end(), [&](const Json& name) {
        return value.contains(name.get<std::string>());
      });
    if (keyword == "items")
      return !value.is_array() ||
             std::all_of(value.begin(), value.end(), [&](const Json& one) { return valid(argument, one); });
    if (keyword == "minItems") return !value.is_array() || value.size() >= argument.get<std::size_t>();
    if (keyword == "maxItems") return !value.is_array() || value.size() <= argument.get<std::size_t>();
    if (keyword == "minProperties") return !value.is_object() || value.size() >= argument.get<std::size_t>();
    if (keyword == "minLength")
      return !value.is_string() || value.get<std::string>().size() >= argument.get<std::size_t>();
    if (keyword == "minimum") return !value.is_number() || value.get<double>() >= argument.get<double>();
    if (keyword == "maximum") return !value.is_number() || value.get<double>() <= argument.get<double>();
    if (keyword == "pattern")
      return !value.is_string() ||
             std::regex_search(value.get<std::string>(), std::regex(argument.get<std::string>()));
    if (keyword == "enum") return std::find(argument.begin(), argument.end(), value) != argument.end();
    if (keyword == "oneOf") return count(argument, value) == 1;
    if (keyword == "anyOf") return count(argument, value) > 0;
    if (keyword == "allOf") return count(argument, value) == int(argument.size());
    if (keyword == "not") return !valid(argument, value);
    static const std::vector<std::string> remarks{"$schema", "title", "description", "default",
                                                  "definitions"};
    if (std::find(remarks.begin(), remarks.end(), keyword) != remarks.end()) return true;
    throw std::logic_error("the schema uses '" + keyword + "', which this test does not know");
  }

  Json root_;
};

}  // namespace lambent::test
