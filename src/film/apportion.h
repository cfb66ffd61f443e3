#pragma once
// Layers of one channel as floats that add up to the pixel's own float exactly: in any order, in float or
// double. For one pixel, or for a packet of them, with the same bits.

#include <cstddef>
#include <cstdint>
#include <limits>

#include "math/pack.h"

namespace lambent {

/// Memory to apportion in, for one thread.
struct alignas(64) ApportionRoom {
  double numbers[16];  ///< A packet.
};

/// The layers of many pixels, and where they are wanted.
struct ApportionTask {
  const double* sums;  ///< A column for each layer's R, G, B in turn, with a number for each pixel;
  std::size_t stride;  ///< so many from one column to the next. They are read a packet beyond the last pixel.
  int layers;
  int samples;  ///< By which the sums are divided.
  std::uint32_t pixels;
  float* const* to;     ///< Of each pixel its channels: R, G, B, which must be there; then the layers' come.
  std::uint8_t* left;   ///< For each pixel whether it must be done by itself: some of it is not plain.
  ApportionRoom* room;  ///< Two for each layer.
};

/// A kernel of the film: packet by packet what `apportion_plainly` can do.
using ApportionLayers = void(const ApportionTask& task);

inline namespace LAMBENT_ISA {

/// Layers, none negative, become whole multiples of total's last place, u = ulp(total), so that no sum of
/// them needs rounding; each the nearest, and what is then missing or too much goes, u by u, to those that
/// were rounded most. So a layer is off by u at most, 2^-23 of the pixel's own brightness.
///   total   a float
///   floats  where the floats go
/// Returns where that could be done: where total is neither negative nor infinite, and no layer is negative.
template <class F> MaskOf<F> apportion_plainly(const F* layers, int count, const F& total, F* floats) {
  using I = decltype(to_bits(total));
  const F zero(0.0), one(1.0);
  MaskOf<F> plain = both(total >= zero, total < F(std::numeric_limits<double>::infinity()));
  for (int i = 0; i < count; ++i) plain = both(plain, layers[i] >= zero);
  // u, by total's exponent; the smallest float has it where total is subnormal, or nothing.
  const I exponent = max(to_bits(total) >> 52, I(1023 - 126));
  const F u = from_bits((exponent - I(23)) << 52), units = from_bits((I(2 * 1023 + 23) - exponent) << 52);
  F missing = total * units;  // all in units of u: whole numbers up to 2^24, which no sum rounds
  for (int i = 0; i < count; ++i) {
    const F magic(0x1.8p52);  // adding it rounds to the nearest whole number
    floats[i] = (layers[i] * units + magic) - magic;
    missing = missing - floats[i];
  }
  const MaskOf<F> black = total == zero;
  missing = select(both(plain, MaskOf<F>(!black)), missing, zero);
  for (;;) {
    const MaskOf<F> too_little = missing > zero, too_much = missing < zero;
    const MaskOf<F> uneven = either(too_little, too_much);
    if (!any(uneven)) break;
    const F step = select(too_little, one, -one);
    F most(-std::numeric_limits<double>::infinity()), best(-1.0);
    for (int i = 0; i < count; ++i) {
      const F short_by = step * (layers[i] * units - floats[i]);
      const MaskOf<F> better = both(layers[i] > zero, either(too_little, floats[i] >= one), short_by > most);
      most = select(better, short_by, most);
      best = select(better, F(double(i)), best);
    }
    for (int i = 0; i < count; ++i)
      floats[i] = floats[i] + select(both(uneven, best == F(double(i))), step, zero);
    missing = select(both(uneven, best >= zero), missing - step, zero);
  }
  for (int i = 0; i < count; ++i) floats[i] = select(black, zero, floats[i] * u);
  return plain;
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
