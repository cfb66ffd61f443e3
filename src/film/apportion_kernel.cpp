// The layers of many pixels, a packet of pixels at a time.

#include "film/apportion.h"
#include "film/mean.h"
#include "math/color.h"

namespace lambent {
inline namespace LAMBENT_ISA {

ApportionLayers apportion_layers;
void apportion_layers(const ApportionTask& task) {
  constexpr int lanes = native_float_lanes;
  using F = Pack<double, lanes>;
  static_assert(sizeof(F) <= sizeof(ApportionRoom));
  const Mean<F> mean(task.samples);
  F* const layers = reinterpret_cast<F*>(task.room);
  F* const floats = layers + task.layers;
  for (std::uint32_t first = 0; first < task.pixels; first += lanes) {
    const int there = int(min(task.pixels - first, std::uint32_t(lanes)));
    float* const* const to = task.to + first;
    std::uint32_t plain = all_lane_bits<lanes>;
    for (int c = 0; c < color_channels; ++c) {
      const double* column = task.sums + std::size_t(c) * task.stride + first;
      for (int i = 0; i < task.layers; ++i, column += color_channels * task.stride)
        layers[i] = mean.of(F::load(column));
      const F total = gather<F>([&](int k) { return double(to[min(k, there - 1)][c]); });
      plain &= lane_bits(apportion_plainly(layers, task.layers, total, floats));
      for (int i = 0; i < task.layers; ++i) {
        float values[lanes];
        number_cast<float>(floats[i]).store(values);
        for (int k = 0; k < there; ++k) to[k][(i + 1) * color_channels + c] = values[k];
      }
    }
    for (int k = 0; k < there; ++k) task.left[first + std::uint32_t(k)] = !(plain >> k & 1);
  }
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
