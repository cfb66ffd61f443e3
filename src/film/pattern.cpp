#include "film/pattern.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace lambent {
namespace {

std::uint32_t reversed_bits(std::uint32_t a) {
  std::uint32_t result = 0;
  for (int i = 0; i < 32; ++i) result |= ((a >> i) & 1u) << (31 - i);
  return result;
}

/// The x in [0, 1] below which the share p of the filter's weight lies, stretched around the pixel's centre.
double spread(double p, Filter filter) {
  if (filter == Filter::box) return p;
  return 0.5 + (p < 0.5 ? sqrt(2 * p) - 1 : 1 - sqrt(2 * (1 - p)));
}

/// p + shift in [0, 1), round about.
double moved(double p, double shift) {
  const double a = p + shift;
  return a < 1 ? a : a - 1;
}

}  // namespace

std::vector<Vec2<double>> sample_pattern(int samples, Filter filter, const Vec2<double>& shift) {
  std::vector<std::uint32_t> order(samples);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [](auto a, auto b) { return reversed_bits(a) < reversed_bits(b); });
  std::vector<Vec2<double>> points(samples);
  for (int row = 0; row < samples; ++row) {
    const auto column = order[row];
    points[column] = {spread(moved((column + 0.5) / samples, shift.x), filter),
                      spread(moved((row + 0.5) / samples, shift.y), filter)};
  }
  return points;
}

std::vector<Vec2<double>> progressive_pattern(int samples, int start, Filter filter,
                                              const Vec2<double>& shift) {
  const Vec2<double> by{moved(0.5 / start, shift.x), moved(0.5 / start, shift.y)};
  std::vector<Vec2<double>> points(samples);
  for (int i = 0; i < samples; ++i) {
    // The second coordinate's direction numbers: v[0] = 1/2, v[k] = v[k - 1] xor v[k - 1] / 2.
    std::uint32_t y = 0, direction = 1u << 31;
    for (std::uint32_t rest = std::uint32_t(i); rest; rest >>= 1, direction ^= direction >> 1)
      if (rest & 1) y ^= direction;
    points[i] = {spread(moved(reversed_bits(std::uint32_t(i)) * 0x1p-32, by.x), filter),
                 spread(moved(y * 0x1p-32, by.y), filter)};
  }
  return points;
}

}  // namespace lambent
