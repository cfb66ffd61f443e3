// What the colours of a difference are.

#include <cmath>

#include "lambent/diagnostics.h"
#include "lambent/sheet.h"

namespace lambent {
namespace {

/// Oklab to linear sRGB: Ottosson, A perceptual color space for image processing, 2020. Nothing but + and *,
/// so the bits are the same everywhere.
std::array<double, 3> linear_from_oklab(double L, double a, double b) {
  const auto cube = [](double v) { return v * v * v; };
  const double l = cube(L + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(L - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(L - 0.0894841775 * a - 1.2914855480 * b);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

constexpr double neutral_lightness = 0.25;
constexpr double end_lightness = 0.70;
constexpr double end_chroma = 0.15;
struct Hue {
  double cosine, sine;
};
constexpr Hue blue{-0.3420201433256687, -0.9396926207859084};  // 250 degrees
constexpr Hue orange{0.7660444431189780, 0.6427876096865394};  // 40 degrees

}  // namespace

std::array<float, 3> diverging_color(double t) {
  const double size = std::abs(t) <= 1 ? std::abs(t) : 1;  // NaN counts as 1
  const Hue& hue = t < 0 ? blue : orange;
  const double chroma = end_chroma * size;
  const std::array<double, 3> color = linear_from_oklab(
      neutral_lightness + (end_lightness - neutral_lightness) * size, chroma * hue.cosine, chroma * hue.sine);
  return {float(color[0]), float(color[1]), float(color[2])};
}

Image difference_picture(const Image& values, double limit, bool encoded) {
  Diagnostic wrong;
  if (values.channels.size() != 1) wrong.message = "a picture of differences is made of a single channel";
  else if (!(limit > 0)) wrong.message = "the scale of a difference ends above 0";
  if (!wrong.message.empty()) throw InputError(wrong);

  Image picture{values.width, values.height, {"R", "G", "B"}, {}};
  picture.data.reserve(values.data.size() * 3);
  for (const float value : values.data) {
    const double t = std::copysign(std::sqrt(std::abs(double(value)) / limit), double(value));
    for (const float channel : diverging_color(t))
      picture.data.push_back(encoded ? channel : float(srgb_from_linear(double(channel))));
  }
  return picture;
}

}  // namespace lambent
