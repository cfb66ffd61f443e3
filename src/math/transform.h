#pragma once
// Affine transforms, in double. Named target_from_source: world_from_object takes an object's point into the
// world.

#include "math/functions.h"
#include "math/vec.h"

namespace lambent {

/// x -> (columns x y z) x + translation. F: a double, or a packet of them.
template <class F> struct TransformOf {
  Vec3<F> x{F(1), F(0), F(0)}, y{F(0), F(1), F(0)}, z{F(0), F(0), F(1)};  ///< Where the axes go.
  Vec3<F> translation{F(0), F(0), F(0)};
};
using Transform = TransformOf<double>;
/// Of packets, `TransformOf<F> t;` is nothing until it is set, as Vec3 (vec.h).
template <class F>
requires(!Scalar<F>) struct TransformOf<F> {
  Vec3<F> x, y, z, translation;
};

inline namespace LAMBENT_ISA {

template <class F> Vec3<F> transform_vector(const TransformOf<F>& t, const Vec3<F>& v) {
  return v.x * t.x + v.y * t.y + v.z * t.z;
}
template <class F> Vec3<F> transform_point(const TransformOf<F>& t, const Vec3<F>& p) {
  return transform_vector(t, p) + t.translation;
}
/// First b, then a.
inline Transform operator*(const Transform& a, const Transform& b) {
  return {transform_vector(a, b.x), transform_vector(a, b.y), transform_vector(a, b.z),
          transform_point(a, b.translation)};
}
inline double determinant(const Transform& t) { return dot(t.x, cross(t.y, t.z)); }
/// determinant(t) must not be zero.
inline Transform inverse(const Transform& t) {
  const double d = 1 / determinant(t);
  const Vec3<double> r0 = d * cross(t.y, t.z), r1 = d * cross(t.z, t.x), r2 = d * cross(t.x, t.y);  // rows
  Transform result{{r0.x, r1.x, r2.x}, {r0.y, r1.y, r2.y}, {r0.z, r1.z, r2.z}, {}};
  result.translation = -transform_vector(result, t.translation);
  return result;
}
/// The transpose of t's linear part applied to v: with t = object_from_world it takes an object's normal into
/// the world.
template <class F> Vec3<F> transform_normal(const TransformOf<F>& inverse_of_t, const Vec3<F>& n) {
  return {dot(inverse_of_t.x, n), dot(inverse_of_t.y, n), dot(inverse_of_t.z, n)};
}
inline bool is_identity(const Transform& t) {
  return t.x == Vec3<double>{1, 0, 0} && t.y == Vec3<double>{0, 1, 0} && t.z == Vec3<double>{0, 0, 1} &&
         t.translation == Vec3<double>{};
}

inline Transform translation(const Vec3<double>& by) { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, by}; }
inline Transform scaling(const Vec3<double>& by) { return {{by.x, 0, 0}, {0, by.y, 0}, {0, 0, by.z}, {}}; }
/// Right-handed turn about a unit axis through the origin.
inline Transform rotation(const Vec3<double>& a, double degrees) {
  const auto [s, c] = sincos_degrees(degrees);
  const double k = 1 - c;
  return {{c + k * a.x * a.x, k * a.x * a.y + s * a.z, k * a.x * a.z - s * a.y},
          {k * a.x * a.y - s * a.z, c + k * a.y * a.y, k * a.y * a.z + s * a.x},
          {k * a.x * a.z + s * a.y, k * a.y * a.z - s * a.x, c + k * a.z * a.z},
          {}};
}

/// The same about an axis through `center`.
inline Transform rotation_about(const Vec3<double>& center, const Vec3<double>& axis, double degrees) {
  Transform turn = rotation(axis, degrees);
  if (!(center == Vec3<double>{})) turn.translation = center - transform_vector(turn, center);
  return turn;
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
