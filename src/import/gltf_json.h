#pragma once
// The JSON of a glTF file, and what is said about it.
//
// Places in it are JSON pointers (RFC 6901), as "/meshes/0/primitives/1/attributes/POSITION": they stand at
// the head of every message.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "lambent/diagnostics.h"

namespace lambent::gltf {

using Json = nlohmann::json;

/// Collects what is wrong with a file, and what is odd.
class Remarks {
 public:
  explicit Remarks(std::string file) : file_(std::move(file)) {}

  /// `pointer` may be empty: then it is about the whole file. Throws all errors where there are many.
  void error(const std::string& pointer, std::string message, std::string hint = {});
  /// Says the same only once, and no more after the first hundred.
  void warn(const std::string& pointer, std::string message, std::string hint = {});
  /// Throws InputError if there was an error.
  void throw_errors();
  /// The error alone, at once.
  [[noreturn]] void fail(const std::string& pointer, std::string message, std::string hint = {});

  const std::string& file() const { return file_; }
  std::vector<Diagnostic> take_warnings() { return std::move(warnings_); }

 private:
  Diagnostic diagnostic(Severity severity, const std::string& pointer, std::string message, std::string hint);

  std::string file_;
  std::vector<Diagnostic> errors_, warnings_;
};

/// The value of a JSON text. Throws InputError where it is malformed, nested too deeply, has a byte order
/// mark, or an object with two keys alike; with line and column, or for the JSON inside of a GLB (`in_glb`)
/// the byte.
Json parse_json(const std::string& file, std::string_view text, bool in_glb);

/// "/nodes/" + 3
std::string operator/(const std::string& pointer, std::size_t index);
/// The same with a key, escaped as RFC 6901 wants it.
std::string operator/(const std::string& pointer, std::string_view key);

// What is known to be well-formed is read with these: the schema is checked before.

/// The member, or a null value where there is none.
const Json& member(const Json& object, const char* key);
double number(const Json& object, const char* key, double otherwise);
/// A whole number of 0 or more.
std::uint64_t whole(const Json& object, const char* key, std::uint64_t otherwise);
std::string text(const Json& object, const char* key, const char* otherwise = "");
bool flag(const Json& object, const char* key, bool otherwise);
/// The name of what an object describes, cut off where it is longer than anybody's: what is shown often has
/// it each time.
std::string name_in(const Json& object);
/// An extension's object at this place, or a null value.
const Json& extension(const Json& object, const char* name);

}  // namespace lambent::gltf
