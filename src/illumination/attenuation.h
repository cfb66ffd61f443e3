#pragma once
// How light fades with distance: the choices of the lecture, free to combine with any model.

#include "math/number.h"

namespace lambent {

/// 1 / (constant + linear r + quadratic r^2): none is {1, 0, 0}, 1/r is {0, 1, 0}, 1/r^2 is {0, 0, 1}.
struct Attenuation {
  double constant = 1, linear = 0, quadratic = 0;
  friend constexpr bool operator==(const Attenuation&, const Attenuation&) = default;
};
inline constexpr Attenuation attenuation_none{1, 0, 0}, attenuation_1_over_r{0, 1, 0},
    attenuation_1_over_r2{0, 0, 1};

/// What the ambient term Ka Ia is divided by: nothing, or the distance R that the ray has travelled since the
/// eye.
enum class AmbientAttenuation { none, one_over_R };

inline namespace LAMBENT_ISA {

/// The factor by which a light at distance r fades. `minimum` (> 0, scene units) is the distance below which
/// it fades no less: it keeps 1/r finite where a surface touches a light. A light at infinity (r infinite)
/// does not fade.
template <class F> F attenuate(const Attenuation& a, F r, F minimum) {
  if (a.linear == 0 && a.quadratic == 0) return select(r == F(__builtin_inf()), F(1), F(1 / a.constant));
  const F d = max(r, minimum);
  const F faded = F(1) / (F(a.constant) + F(a.linear) * d + F(a.quadratic) * (d * d));
  return select(r == F(__builtin_inf()), F(1), faded);
}

/// The factor of the ambient term after a way of R from the eye.
template <class F> F attenuate(AmbientAttenuation a, F R, F minimum) {
  return a == AmbientAttenuation::none ? F(1) : F(1) / max(R, minimum);
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
