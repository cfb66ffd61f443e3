#pragma once
// Random numbers that are no sequence but a function of place, sample and dimension: any thread may ask for
// any of them, in any order.
//
// Points come from Sobol's (0, 2)-sequence: every 2^k successive points that begin at a multiple of 2^k have
// one in each box of area 2^-k, however the box is proportioned. Owen's scrambling keeps that and makes the
// points random; by hashes it needs no tables (Laine and Karras, Stratified sampling for stochastic
// transparency, 2011; Burley, Practical hash-based Owen scrambling, JCGT 9(4), 2020; the hash's constants are
// Vegdahl's, 2021). Each pair of dimensions takes the points in an order of its own, so that pairs have
// nothing to do with each other.

#include "math/functions.h"
#include "math/pack.h"
#include "math/vec.h"

namespace lambent {
inline namespace LAMBENT_ISA {

// Bits: one std::uint32_t, or a register of them.

template <class Bits> constexpr Bits reversed_bits(Bits x) {
  x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
  x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
  x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
  x = (x >> 8 & 0x00ff00ffu) | (x & 0x00ff00ffu) << 8;
  return x >> 16 | x << 16;
}

/// Flips bits of x, each by a hash of the bits below it.
template <class Bits> constexpr Bits flipped_by_lower(Bits x, const Bits& seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// The bits of a point, the highest worth 1/2. The seeds: of the order in which the points come, and of each
/// coordinate's scrambling.
template <class Bits>
constexpr Vec2<Bits> random_bits(const Bits& index, const Bits& order, const Bits& of_x, const Bits& of_y) {
  const Bits i = reversed_bits(flipped_by_lower(reversed_bits(index), order));
  // Digit j of the second coordinate is the sum over k of (k choose j) times bit k of the index, modulo 2: in
  // five steps, as Lucas' theorem takes the binomial apart.
  Bits y = i;
  y ^= y >> 1 & 0x55555555u;
  y ^= y >> 2 & 0x33333333u;
  y ^= y >> 4 & 0x0f0f0f0fu;
  y ^= y >> 8 & 0x00ff00ffu;
  y ^= y >> 16 & 0x0000ffffu;
  return {reversed_bits(flipped_by_lower(i, of_x)), reversed_bits(flipped_by_lower(y, of_y))};
}

/// Point `index` of the pair of dimensions that `seed` stands for; both coordinates in [0, 1), multiples of
/// 2^-32.
constexpr Vec2<double> random_point(std::uint32_t index, std::uint64_t seed) {
  const std::uint64_t more = hashed(seed);
  const Vec2<std::uint32_t> bits =
      random_bits(index, std::uint32_t(seed), std::uint32_t(more), std::uint32_t(more >> 32));
  return {bits.x * 0x1p-32, bits.y * 0x1p-32};
}

/// Likewise one for each lane of packets, with the same bits.
inline Vec2<Pack<double, native_float_lanes>> random_points(const std::uint32_t* index,
                                                            const std::uint64_t* seed) {
  constexpr int lanes = native_float_lanes;
  using Bits = RawPack<std::uint32_t, lanes>::type;
  std::uint32_t order[lanes], of_x[lanes], of_y[lanes];
  for (int k = 0; k < lanes; ++k) {
    const std::uint64_t more = hashed(seed[k]);
    order[k] = std::uint32_t(seed[k]), of_x[k] = std::uint32_t(more), of_y[k] = std::uint32_t(more >> 32);
  }
  const auto load = [](const std::uint32_t* from) {
    Bits bits;
    std::memcpy(&bits, from, sizeof(bits));
    return bits;
  };
  const Vec2<Bits> bits = random_bits(load(index), load(order), load(of_x), load(of_y));
  double x[lanes], y[lanes];
  for (int k = 0; k < lanes; ++k) x[k] = bits.x[k] * 0x1p-32, y[k] = bits.y[k] * 0x1p-32;
  using F = Pack<double, lanes>;
  return {F::load(x), F::load(y)};
}

/// The pair of random numbers that chooses a sample's point of the lens. Pairs of paths are counted from 0.
inline constexpr std::uint64_t lens_pair = ~std::uint64_t{0};

/// What the random numbers of a pixel begin with.
constexpr std::uint64_t seed_of_pixel(std::int32_t x, std::int32_t y) {
  return hashed(std::uint64_t(std::uint32_t(x)) << 32 | std::uint32_t(y));
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
