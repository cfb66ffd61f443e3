#pragma once
// Points and transforms that lie apart in memory, brought into the lanes of a packet; vectors in other
// numbers.

#include "math/pack.h"
#include "math/transform.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// Lane by lane the nearest vector of To.
template <class To, class F> Vec3<With<F, To>> number_cast(const Vec3<F>& v) {
  return {number_cast<To>(v.x), number_cast<To>(v.y), number_cast<To>(v.z)};
}

/// value(k) is the point of lane k: anything with x, y and z.
template <class F, class Value> Vec3<F> gather_points(const Value& value) {
  return {gather<F>([&](int k) { return value(k).x; }), gather<F>([&](int k) { return value(k).y; }),
          gather<F>([&](int k) { return value(k).z; })};
}
/// Points that stand in memory as floats, in lanes of double.
template <class F, class Value> Vec3<F> gather_float_points(const Value& value) {
  return number_cast<double>(gather_points<With<F, float>>(value));
}
/// value(k) is the Transform of lane k.
template <class F, class Value> TransformOf<F> gather_transform(const Value& value) {
  return {gather_points<F>([&](int k) { return value(k).x; }),
          gather_points<F>([&](int k) { return value(k).y; }),
          gather_points<F>([&](int k) { return value(k).z; }),
          gather_points<F>([&](int k) { return value(k).translation; })};
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
