#include "film/shutter.h"

#include <algorithm>
#include <numeric>

#include "math/random.h"

namespace lambent {

Shutter open_shutter(int samples, int slices) {
  const int count = std::min(samples, slices);
  // By how much each round's turn is shifted: as far from those before as can be.
  std::vector<int> shift(static_cast<std::size_t>(count));
  std::iota(shift.begin(), shift.end(), 0);
  std::sort(shift.begin(), shift.end(),
            [](int a, int b) { return reversed_bits(std::uint32_t(a)) < reversed_bits(std::uint32_t(b)); });
  std::vector<std::vector<int>> dealt(static_cast<std::size_t>(count));
  for (int i = 0; i < samples; ++i)
    dealt[std::size_t((i + shift[std::size_t(i / count % count)]) % count)].push_back(i);
  Shutter shutter;
  for (const std::vector<int>& one : dealt) {
    const auto first = int(shutter.order.size()), size = int(one.size());
    shutter.slices.push_back({first, first + size, (first + 0.5 * size) / samples});
    shutter.order.insert(shutter.order.end(), one.begin(), one.end());
  }
  return shutter;
}

}  // namespace lambent
