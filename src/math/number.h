#pragma once
// One number: what a packet of numbers (pack.h) does lane by lane, in the same words.
//
// Code that is written with these words runs for a float, a double, a packet, and gives the same bits in
// each.

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "math/isa.h"

namespace lambent {
inline namespace LAMBENT_ISA {

template <class T>
concept Scalar = std::is_floating_point_v<T> || std::is_integral_v<T>;

template <Scalar T> constexpr T select(bool m, T a, T b) { return m ? a : b; }
constexpr bool any(bool m) { return m; }
constexpr bool all(bool m) { return m; }
/// Logic on truths of one lane or of many: `&` and `|` would make ints of bools.
template <class M> constexpr M both(M a, M b) { return a & b; }
template <class M> constexpr M either(M a, M b) { return a | b; }
template <class M, class... More> constexpr M both(M a, M b, More... more) {
  return both(both(a, b), more...);
}
template <> constexpr bool both(bool a, bool b) { return a && b; }
template <> constexpr bool either(bool a, bool b) { return a || b; }
template <Scalar T> constexpr T max(T a, T b) { return a > b ? a : b; }
template <Scalar T> constexpr T min(T a, T b) { return a < b ? a : b; }
template <Scalar T> constexpr T abs(T a) { return a < 0 ? -a : a; }
constexpr float abs(float a) { return __builtin_fabsf(a); }
constexpr double abs(double a) { return __builtin_fabs(a); }
inline float sqrt(float a) { return __builtin_sqrtf(a); }
inline double sqrt(double a) { return __builtin_sqrt(a); }

/// The bits of a double as an integer, and back.
constexpr std::int64_t to_bits(double a) { return std::bit_cast<std::int64_t>(a); }
constexpr double from_bits(std::int64_t a) { return std::bit_cast<double>(a); }

}  // namespace LAMBENT_ISA
}  // namespace lambent
