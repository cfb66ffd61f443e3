#pragma once
// What the formats without materials share, PLY and STL: bytes, colours, the material.

#include <bit>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <string>
#include <utility>

#include "import/model.h"
#include "import/text_file.h"

namespace lambent {

/// Grey, with a soft highlight.
inline Material neutral_material() {
  Material material;
  material.name = "default";
  material.ambient = material.diffuse = {{0.7, 0.7, 0.7}};
  material.specular = {{0.2, 0.2, 0.2}};
  material.shininess = 40;
  return material;
}
/// The same, white: for what brings colours of its own, which are factors on the material's.
inline Material coloring_material() {
  Material material = neutral_material();
  material.ambient = material.diffuse = {{1, 1, 1}};
  return material;
}

/// An error of a file without lines, or about the file as a whole.
inline Diagnostic file_error(const std::string& path, std::string message, std::string hint = {}) {
  return {Severity::error, {path, 0, 0}, std::move(message), std::move(hint), {}, 0};
}
inline Diagnostic file_warning(const std::string& path, std::string message, std::string hint = {}) {
  return {Severity::warning, {path, 0, 0}, std::move(message), std::move(hint), {}, 0};
}

/// The first `most` bytes of a file, or all there are.
inline std::string read_head(const std::string& path, std::size_t most) {
  std::string head(most, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file) return read_file(path);  // which says what is wrong
  file.read(head.data(), std::streamsize(most));
  head.resize(std::size_t(file.gcount()));
  return head;
}

/// The number whose bytes stand at `at`, whatever its alignment; `little` says in which order.
template <class T> T load_number(const char* at, bool little) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, at, sizeof(T));
  if (little != (std::endian::native == std::endian::little))
    for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

/// "1 triangle", "2 triangles".
inline std::string counted(std::uint64_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace lambent
