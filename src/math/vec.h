#pragma once
// Vectors of three numbers; the number may be a float, a double, a packet of them or a dual number.

#include "math/isa.h"
#include "math/number.h"

namespace lambent {

template <class F> struct Vec2 { F x{}, y{}; };
template <class F> struct Vec3 { F x{}, y{}, z{}; };
/// Of packets, `Vec3<F> v;` is nothing until it is set, as any number would be: zeroes would be written only
/// to be overwritten. `Vec3<F> v{}` is zero.
template <class F>
requires(!Scalar<F>) struct Vec3<F> {
  F x, y, z;
};

inline namespace LAMBENT_ISA {

template <class F> constexpr Vec3<F> operator+(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class F> constexpr Vec3<F> operator-(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class F> constexpr Vec3<F> operator-(const Vec3<F>& a) { return {-a.x, -a.y, -a.z}; }
template <class F> constexpr Vec3<F> operator*(const F& s, const Vec3<F>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class F> constexpr Vec3<F> operator*(const Vec3<F>& a, const F& s) { return s * a; }
template <class F> constexpr Vec3<F> operator/(const Vec3<F>& a, const F& s) {
  return {a.x / s, a.y / s, a.z / s};
}
template <class F> constexpr bool operator==(const Vec3<F>& a, const Vec3<F>& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

template <class F> constexpr F dot(const Vec3<F>& a, const Vec3<F>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class F> constexpr Vec3<F> cross(const Vec3<F>& a, const Vec3<F>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class F> F length(const Vec3<F>& a) { return sqrt(dot(a, a)); }
/// a / |a|, with one division; a must not be zero.
template <class F> Vec3<F> normalize(const Vec3<F>& a) { return (F(1) / length(a)) * a; }
template <class F, class M> Vec3<F> select(const M& m, const Vec3<F>& a, const Vec3<F>& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
/// The mirror image of L about N, both pointing away from the surface: R = 2 (N.L) N - L.
template <class F> Vec3<F> reflect(const Vec3<F>& L, const Vec3<F>& N) { return F(2) * dot(N, L) * N - L; }

/// The vector in every lane.
template <class F> Vec3<F> broadcast(const Vec3<double>& v) { return {F(v.x), F(v.y), F(v.z)}; }
template <class T, class F> constexpr Vec3<T> cast(const Vec3<F>& a) { return {T(a.x), T(a.y), T(a.z)}; }
template <class F> F max_abs(const Vec3<F>& a) { return max(max(abs(a.x), abs(a.y)), abs(a.z)); }

}  // namespace LAMBENT_ISA
}  // namespace lambent
