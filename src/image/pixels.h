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
/// stands for the image in messages. Throws InputError where the image is damaged or cut off, of no known
/// kind, beyond the limits, or larger than its file can plausibly hold: decoded more than 64 MiB and more
/// than 2000 times the file's size.
///
/// Colour profiles, gamma, exposure and orientation that a file may speak of are left aside. CMYK becomes
/// R G B by the plain rule, R = (1 - C) (1 - K). Palettes become R G B, a transparent colour becomes alpha.
/// An EXR is read from the first part that is flat, by its data window: R, G, B, or Y, and A; what is not a
/// number there becomes 0, what is infinite +-65504, the largest half.
Pixels read_pixels(std::string_view bytes, const std::string& name, const Limits& limits = {});

/// Its size, without decoding it. Throws likewise.
struct PixelSize {
  int width = 0, height = 0, channels = 0;
  std::string format;  ///< "PNG", "JPEG", ...
};
PixelSize pixel_size(std::string_view bytes, const std::string& name, const Limits& limits = {});

}  // namespace lambent
