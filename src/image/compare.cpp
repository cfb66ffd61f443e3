#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "image/formats.h"
#include "image/srgb.h"
#include "lambent/image.h"

namespace lambent {
namespace {

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

InputError incomparable(const std::string& message) {
  Diagnostic diagnostic;
  diagnostic.message = message;
  return InputError(diagnostic);
}

/// For each channel of a, where b holds the one of that name.
std::vector<std::size_t> matching_channels(const Image& a, const Image& b) {
  std::vector<std::size_t> matching;
  for (const std::string& name : a.channels) {
    const auto found = std::find(b.channels.begin(), b.channels.end(), name);
    if (found == b.channels.end() || a.channels.size() != b.channels.size())
      throw incomparable("the pictures have different channels: " + listed(a.channels) + " and " +
                         listed(b.channels));
    matching.push_back(std::size_t(found - b.channels.begin()));
  }
  return matching;
}

/// |a - b|; 0 for equal values, two infinities or two NaN; infinite where only one is NaN.
double distance(float a, float b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  const double d = std::abs(double(a) - double(b));
  return std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
}

}  // namespace

Difference compare_images(const Image& a, const Image& b) {
  const auto size = [](const Image& image) {
    return std::to_string(image.width) + " x " + std::to_string(image.height);
  };
  if (a.width != b.width || a.height != b.height)
    throw incomparable("the pictures differ in size: " + size(a) + " and " + size(b) + " pixels");
  const std::vector<std::size_t> channel_of_b = matching_channels(a, b);
  const std::size_t channels = a.channels.size();
  std::vector<bool> shown;
  for (const std::string& name : a.channels) shown.push_back(name == "R" || name == "G" || name == "B");
  const SrgbQuantizer& eight_bit = srgb_quantizer(8);

  Difference difference;
  difference.picture = {a.width, a.height, a.channels, std::vector<float>(a.data.size())};
  double sum = 0, sum_of_squares = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      bool differs = false;
      for (std::size_t c = 0; c < channels; ++c) {
        const float va = a.pixel(x, y)[c], vb = b.pixel(x, y)[channel_of_b[c]];
        if (std::bit_cast<std::uint32_t>(va) == std::bit_cast<std::uint32_t>(vb)) continue;
        differs = true;
        const double d = distance(va, vb);
        difference.picture.pixel(x, y)[c] = float(d);
        sum += d;
        sum_of_squares += d * d;
        if (d > difference.largest) {
          difference.largest = d;
          difference.x = x;
          difference.y = y;
          difference.channel = a.channels[c];
        }
        const double larger = std::max(std::abs(double(va)), std::abs(double(vb)));
        if (larger > 1e-6 || std::isinf(d)) {
          const double relative = std::isinf(d) ? d : d / larger;
          difference.largest_relative = std::max(difference.largest_relative, relative);
        }
        if (shown[c])
          difference.largest_8_bit =
              std::max(difference.largest_8_bit, std::abs(eight_bit(va) - eight_bit(vb)));
      }
      if (differs) ++difference.differing_pixels;
    }
  }
  if (!a.data.empty()) {
    difference.mean = sum / double(a.data.size());
    difference.root_mean_square = std::sqrt(sum_of_squares / double(a.data.size()));
  }
  return difference;
}

}  // namespace lambent
