#pragma once
// Directions and discs: axes around a direction, and the unit square laid onto a disc.

#include "math/functions.h"
#include "math/pack.h"
#include "math/vec.h"

namespace lambent {
inline namespace LAMBENT_ISA {

inline constexpr double pi = 3.14159265358979323846;

/// Three unit vectors at right angles.
template <class F> struct Axes { Vec3<F> x, y, z; };

/// With z as the third, without a root and with one division (Duff et al., Building an orthonormal basis,
/// revisited, JCGT 6(1), 2017).
template <class F> Axes<F> axes_around(const Vec3<F>& z) {
  const F sign = select(z.z >= F(0), F(1), F(-1));
  const F a = F(-1) / (sign + z.z), b = z.x * z.y * a;
  return {{F(1) + sign * z.x * z.x * a, sign * b, -sign * z.x}, {b, sign + z.y * z.y * a, -z.y}, z};
}
template <class F> Vec3<F> to_world(const Axes<F>& axes, const Vec3<F>& v) {
  return v.x * axes.x + v.y * axes.y + v.z * axes.z;
}

/// The unit square laid onto the unit disc, areas in proportion and neighbours side by side, (0.5, 0.5) in
/// the centre (Shirley and Chiu, A low distortion map between disk and square, Journal of Graphics Tools
/// 2(3), 1997).
template <class F> Vec2<F> on_disc(const F& u, const F& v) {
  const F a = F(2) * u - F(1), b = F(2) * v - F(1), zero(0);
  const MaskOf<F> wide = abs(a) > abs(b);
  const F radius = select(wide, a, b), other = select(wide, b, a);
  const MaskOf<F> center = radius == zero;
  const F eighth = F(45) * select(center, zero, other / select(center, F(1), radius));
  const SinCos<F> angle = sincos_degrees(select(wide, eighth, F(90) - eighth));
  return {radius * angle.cos, radius * angle.sin};
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
