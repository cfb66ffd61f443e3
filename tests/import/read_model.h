#pragma once
// What the tests of several readers share: a text or bytes as a file, and what a reader says of it.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "import/model.h"
#include "support.h"

namespace lambent::test {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;
using Strings = std::vector<std::string>;
using Files = std::map<std::string, std::string>;  ///< Names and what is in them.
using Reader = Model (*)(const std::string&, const ImportOptions&);

/// What a reader makes of these bytes, as a file of this name among others.
inline Model read_model(Reader reader, const std::string& name, const std::string& bytes,
                        const ImportOptions& options = {}, const Files& beside = {}) {
  const TemporaryDirectory folder;
  for (const auto& [file, content] : beside) write_text(folder.file(file), content);
  write_text(folder.file(name), bytes);
  return reader(folder.file(name), options);
}

inline const Mesh& mesh_of(const Model& model, std::size_t shape = 0) {
  return std::get<Mesh>(model.shapes.at(shape).primitives);
}

/// A diagnostic as the program prints it, without the folder.
inline std::string printed(Diagnostic diagnostic) {
  diagnostic.place.file = std::filesystem::path(diagnostic.place.file).filename().string();
  return to_string(diagnostic);
}
inline Strings printed(const std::vector<Diagnostic>& diagnostics) {
  Strings result;
  for (const Diagnostic& d : diagnostics) result.push_back(printed(d));
  return result;
}
inline Strings warnings_of(const Model& model) { return printed(model.warnings); }

/// Everything that is wrong, as the program prints it; `read` reads something.
template <class Read> Strings errors_when(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    return printed(error.diagnostics());
  }
  return {};
}

/// Numbers as bytes, in either order.
class Bytes {
 public:
  explicit Bytes(bool little) : little_(little) {}
  template <class T> Bytes& operator<<(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (little_ != (std::endian::native == std::endian::little)) std::reverse(bytes, bytes + sizeof(T));
    text.append(bytes, sizeof(T));
    return *this;
  }
  std::string text;

 private:
  bool little_;
};

}  // namespace lambent::test
