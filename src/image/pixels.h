#pragma once
// Images as textures want them: the numbers that a file holds, undecoded.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lambent/limits.h"

namespace lambent {

struct Pixels {
  int width = 0, height = 0;
  int channels = 0;                 ///< 1 grey, 2 grey and alpha, 3 R G B, 4 R G B alpha.
  std::vector<std::uint8_t> bytes;  ///< Row 0 is the top, channels innermost; or
  std::vector<float> floats;        ///< where 8 bits do not hold them. One of the two is empty.
  /// Whether `floats` are linear light (HDR, EXR); if not, whole numbers of 16 bits over 65535, to be read as
  /// the 8-bit ones: sRGB-encoded where they are colours.
  bool linear = false;
};

/// Reads PNG, JPEG, Radiance HDR, OpenEXR, TGA or BMP; the bytes, not a file's ending, say which. `name`
/// stands for the image in messages. Throws InputError where the image is damaged, of no known kind, or
/// beyond the limits.
Pixels read_pixels(std::string_view bytes, const std::string& name, const Limits& limits = {});

/// Its size, without decoding it. Throws likewise.
struct PixelSize {
  int width = 0, height = 0, channels = 0;
  std::string format;  ///< "PNG", "JPEG", ...
};
PixelSize pixel_size(std::string_view bytes, const std::string& name, const Limits& limits = {});

}  // namespace lambent
