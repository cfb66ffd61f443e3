#pragma once
// Points and transforms that lie apart in memory, brought into the lanes of a packet.

#include "math/pack.h"
#include "math/transform.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// value(k) is the Vec3 of lane k.
template <class F, class Value> Vec3<F> gather_points(const Value& value) {
  return {gather<F>([&](int k) { return value(k).x; }), gather<F>([&](int k) { return value(k).y; }),
          gather<F>([&](int k) { return value(k).z; })};
}
/// Points that stand in memory as floats, in lanes of double.
template <class F, class Value> Vec3<F> gather_float_points(const Value& value) {
  const auto points = gather_points<With<F, float>>(value);
  return {number_cast<double>(points.x), number_cast<double>(points.y), number_cast<double>(points.z)};
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
