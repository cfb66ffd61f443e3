#pragma once
// What reading a file may cost: files from strangers may be made to take all there is.

#include <cstdint>

namespace lambent {

/// Limits on what is read. What goes beyond is refused with an InputError before memory is taken for it.
struct Limits {
  std::uint64_t file_bytes = std::uint64_t{8}
                             << 30;        ///< Of one file (and of the parts of it that are unpacked).
  std::uint64_t primitives = 500'000'000;  ///< Triangles, spheres, ... of one model.
  std::uint64_t pixels =
      std::uint64_t{1} << 28;  ///< Of one image, and of a scene's textures together, before they are decoded.
  /// Whether files may name other files (materials, textures, buffers, models) that lie outside their own
  /// folder and what is below it.
  bool allow_outside = false;
};

}  // namespace lambent
