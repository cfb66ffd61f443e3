#pragma once
// The bytes of glTF files: the binary container, and what URIs name.

#include <optional>
#include <string>
#include <string_view>

#include "lambent/limits.h"

namespace lambent::gltf {

/// A file, taken apart.
struct Container {
  std::string bytes;
  bool binary = false;  ///< A GLB; else the whole file is JSON.
  std::string_view json() const { return std::string_view(bytes).substr(json_begin, json_size); }
  /// The chunk of data of a GLB; nothing where there is none.
  std::optional<std::string_view> data() const {
    if (!has_data) return std::nullopt;
    return std::string_view(bytes).substr(data_begin, data_size);
  }

  std::size_t json_begin = 0, json_size = 0, data_begin = 0, data_size = 0;
  bool has_data = false;
};

/// Reads .gltf or .glb; the first bytes say which. Throws InputError, for a GLB with the byte that is wrong.
Container read_container(const std::string& path, const Limits& limits);

/// What "data:image/png;base64,iVBO..." holds.
struct DataUri {
  std::string media_type;  ///< In lower case, without parameters; may be empty.
  std::string bytes;
};
bool is_data_uri(std::string_view uri);
/// Nothing where it is malformed; `complaint` then says why.
std::optional<DataUri> read_data_uri(std::string_view uri, std::string& complaint);

/// %20 and the like resolved. Nothing where a % is not followed by two hexadecimal digits.
std::optional<std::string> percent_decoded(std::string_view uri);
/// Whether a URI names something else than a file beside this one: "https://...".
bool has_scheme(std::string_view uri);

/// "image/png", "image/jpeg", "image/webp", "image/ktx2", by the first bytes; empty for anything else.
std::string image_type(std::string_view bytes);

}  // namespace lambent::gltf
