#include "integrators/light_pattern.h"

#include <cmath>

namespace lambent {

Vec2<double> point_of_light(int number, int count) {
  const int side = int(std::lround(std::sqrt(double(count))));
  int row = 0;
  if (side * side == count) {
    row = number % side * side + (side - 1 - number / side);
  } else {
    // The rows in the order of the fractional parts of 1/2 + i / golden ratio, i counted from the middle.
    const auto place = [count](int i) {
      const double at = 0.5 + (i - 0.5 * (count - 1)) * 0.6180339887498949;
      return at - std::floor(at);
    };
    for (int i = 0; i < count; ++i) row += place(i) < place(number);
  }
  return {(number + 0.5) / count, (row + 0.5) / count};
}

}  // namespace lambent
