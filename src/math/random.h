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
#include "math/vec.h"

namespace lambent {
inline namespace LAMBENT_ISA {

constexpr std::uint32_t reversed_bits(std::uint32_t x) {
  x = (x >> 1 & 0x55555555) | (x & 0x55555555) << 1;
  x = (x >> 2 & 0x33333333) | (x & 0x33333333) << 2;
  x = (x >> 4 & 0x0f0f0f0f) | (x & 0x0f0f0f0f) << 4;
  x = (x >> 8 & 0x00ff00ff) | (x & 0x00ff00ff) << 8;
  return x >> 16 | x << 16;
}

/// Flips bits of x, each by a hash of the bits below it.
constexpr std::uint32_t flipped_by_lower(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adea;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56;
  x ^= x * 0x53a22864;
  return x;
}

/// Point `index` of the pair of dimensions that `seed` stands for; both coordinates in [0, 1), multiples of
/// 2^-32.
constexpr Vec2<double> random_point(std::uint32_t index, std::uint64_t seed) {
  const std::uint64_t more = hashed(seed);
  const std::uint32_t i = reversed_bits(flipped_by_lower(reversed_bits(index), std::uint32_t(seed)));
  // Digit j of the second coordinate is the sum over k of (k choose j) times bit k of the index, modulo 2: in
  // five steps, as Lucas' theorem takes the binomial apart.
  std::uint32_t y = i;
  y ^= y >> 1 & 0x55555555;
  y ^= y >> 2 & 0x33333333;
  y ^= y >> 4 & 0x0f0f0f0f;
  y ^= y >> 8 & 0x00ff00ff;
  y ^= y >> 16 & 0x0000ffff;
  return {reversed_bits(flipped_by_lower(i, std::uint32_t(more))) * 0x1p-32,
          reversed_bits(flipped_by_lower(y, std::uint32_t(more >> 32))) * 0x1p-32};
}

/// The pair of random numbers that chooses a sample's point of the lens. Pairs of paths are counted from 0.
inline constexpr std::uint64_t lens_pair = ~std::uint64_t{0};

/// What the random numbers of a pixel begin with.
constexpr std::uint64_t seed_of_pixel(std::int32_t x, std::int32_t y) {
  return hashed(std::uint64_t(std::uint32_t(x)) << 32 | std::uint32_t(y));
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
