#pragma once
// Pictures in memory, and to and from files.

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "lambent/limits.h"

namespace lambent {

/// A linear-light picture. Row 0 is the top; `data` holds height * width * channels.size() floats, channels
/// innermost.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::string> channels{"R", "G",
                                    "B"};  ///< In the order in which `data` holds them; EXR's naming.
  std::vector<float> data;

  float* pixel(int x, int y) { return &data[(std::size_t(y) * width + x) * channels.size()]; }
  const float* pixel(int x, int y) const { return &data[(std::size_t(y) * width + x) * channels.size()]; }
};

/// Text that travels with a picture: PNG's iTXt chunks, EXR's string attributes.
using Metadata = std::vector<std::pair<std::string, std::string>>;

struct WriteOptions {
  int png_bits = 8;  ///< 8 or 16.
  bool png_encoded =
      true;  ///< Whether a PNG holds sRGB-encoded values; if not, the linear values as they are.
  int threads =
      0;  ///< That compress an EXR; 0: as many as there are processors. The file does not depend on it.
};

/// Write `image` to `path`; its ending (.png or .exr) names the format. PNG is sRGB-encoded (unless the
/// options say otherwise) and clamped to [0, 1]; EXR is linear float, every channel. The file appears under
/// its name only once it is whole: a failure leaves whatever stood there before. Throws InputError for an
/// unknown ending, Failure where the file cannot be written.
void write_image(const std::string& path, const Image& image, const Metadata& metadata = {},
                 const WriteOptions& options = {});

struct ReadImage {
  Image image;
  Metadata metadata = {};
  std::string format = {};  ///< "PNG", "JPEG", "Radiance HDR", "OpenEXR", "TGA" or "BMP".
};

/// Read a picture of any of these formats; its bytes say which. Whole numbers are decoded from sRGB to
/// linear. Throws InputError.
ReadImage read_image(const std::string& path, const Limits& limits = {});

/// How two pictures of one size differ. Values are compared as they are in memory: linear.
struct Difference {
  double largest = 0;   ///< max |a - b| over all pixels and channels.
  int x = 0, y = 0;     ///< Where it is.
  std::string channel;  ///< And in which channel.
  double mean = 0;      ///< Mean |a - b|.
  double root_mean_square = 0;
  double largest_relative = 0;       ///< max |a - b| / max(|a|, |b|), over values above 1e-6.
  int largest_8_bit = 0;             ///< max difference of the sRGB-encoded 8-bit values (R, G, B only).
  std::size_t differing_pixels = 0;  ///< Pixels of which any channel differs in any bit.
  Image picture;                     ///< |a - b| per channel.
};

/// Throws InputError where sizes or channels differ.
Difference compare_images(const Image& a, const Image& b);

/// The sRGB transfer function (IEC 61966-2-1) from linear [0, 1] to encoded [0, 1]; clamps.
double srgb_from_linear(double linear);
double linear_from_srgb(double encoded);

}  // namespace lambent
