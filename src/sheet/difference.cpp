// By how much one picture is brighter than another.

#include <cmath>
#include <limits>

#include "lambent/sheet.h"
#include "sheet/picture.h"

namespace lambent {
namespace {

double luminance(const float* pixel, const ColorChannels& at) {
  const double r = double(pixel[at[0]]), g = double(pixel[at[1]]), b = double(pixel[at[2]]);
  if (at[0] == at[1]) return r;  // a single channel: the weights' sum may be off 1 by a rounding
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/// a - b; 0 for equal values, infinities and NaN too; infinite where only one is NaN.
double difference_of(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  const double d = a - b;
  return std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
}

}  // namespace

SignedDifference signed_difference(const Image& a, const Image& b) {
  const auto size = [](const Image& image) {
    return std::to_string(image.width) + " x " + std::to_string(image.height);
  };
  if (a.width != b.width || a.height != b.height)
    refuse("the pictures differ in size: " + size(a) + " and " + size(b) + " pixels");
  const ColorChannels channels_of_a = color_channels_of(a), channels_of_b = color_channels_of(b);

  SignedDifference difference;
  difference.values = {a.width, a.height, {"Y"}, {}};
  std::vector<float>& values = difference.values.data;
  values.reserve(std::size_t(a.width) * std::size_t(a.height));
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const double d =
          difference_of(luminance(a.pixel(x, y), channels_of_a), luminance(b.pixel(x, y), channels_of_b));
      values.push_back(float(d));
      difference.mean += d;
      difference.mean_magnitude += std::abs(d);
      if (std::abs(d) > std::abs(difference.largest)) {
        difference.largest = d;
        difference.x = x;
        difference.y = y;
      }
    }
  if (!values.empty()) {
    difference.mean /= double(values.size());
    difference.mean_magnitude /= double(values.size());
  }
  return difference;
}

double color_bar_limit(double largest) {
  largest = std::abs(largest);
  if (!(largest > 0) || std::isinf(largest)) return 1;
  // Powers of ten by repeated steps: they have the same bits on every machine.
  double decade = 1;
  while (decade > largest) decade /= 10;
  while (10 * decade <= largest) decade *= 10;
  for (const double step : {1.0, 1.5, 2.0, 3.0, 5.0, 7.0})
    if (step * decade >= largest) return step * decade;
  return 10 * decade;
}

}  // namespace lambent
