#pragma once
// Points and transforms that lie apart in memory, brought into the lanes of a packet; vectors in other
// numbers.

#include <type_traits>

#include "math/pack.h"
#include "math/transform.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// Whether N numbers that stand side by side are the same.
template <int N, class T> bool all_equal(const T* numbers) {
  if constexpr (N == 1) return true;
  else return all(Pack<T, N>::load(numbers) == Pack<T, N>(numbers[0]));
}

/// Where the run ends in which each of the arrays has the number that it has at `first`; at `count` at the
/// latest. W are looked at together, and as many must be there to be read.
template <int W, class... T>
std::uint32_t end_of_run(std::uint32_t first, std::uint32_t count, const T*... numbers) {
  for (std::uint32_t i = first; i < count; i += W) {
    const std::uint32_t same = (lane_bits(Pack<T, W>::load(numbers + i) == Pack<T, W>(numbers[first])) & ...);
    if (same != all_lane_bits<W>) return min(i + std::uint32_t(__builtin_ctz(~same)), count);
  }
  return count;
}

/// Lane by lane the nearest vector of To.
template <class To, class F> Vec3<With<F, To>> number_cast(const Vec3<F>& v) {
  return {number_cast<To>(v.x), number_cast<To>(v.y), number_cast<To>(v.z)};
}

/// The vector of lane k alone.
template <class F> auto lane(const Vec3<F>& v, int k) {
  return Vec3<decltype(lane(v.x, k))>{lane(v.x, k), lane(v.y, k), lane(v.z, k)};
}

/// The points of two packets in one that is twice as wide.
template <class T, int W>
Vec3<Pack<T, 2 * W>> side_by_side(const Vec3<Pack<T, W>>& lower, const Vec3<Pack<T, W>>& upper) {
  const auto both = [](const Pack<T, W>& a, const Pack<T, W>& b) {
    Pack<T, 2 * W> all;
    if constexpr (Pack<T, 2 * W>::In::parts == 2) all.p0 = a.p0, all.p1 = b.p0;
    else all.p0 = joined(a.p0, b.p0, std::make_index_sequence<2 * W>());
    return all;
  };
  return {both(lower.x, upper.x), both(lower.y, upper.y), both(lower.z, upper.z)};
}

/// Four points that stand in memory. x and y are loaded as one: a register takes those of two points.
inline Vec3<Pack<float, 4>> load_points(const Vec3<float>& a, const Vec3<float>& b, const Vec3<float>& c,
                                        const Vec3<float>& d) {
  using Raw = typename Pack<float, 4>::Raw;
  typedef double Both __attribute__((may_alias, aligned(4)));
  typedef double Pairs __attribute__((vector_size(16)));
  const auto xy = [](const Vec3<float>& p) { return *reinterpret_cast<const Both*>(&p.x); };
  const Raw ab = Raw(Pairs{xy(a), xy(b)}), cd = Raw(Pairs{xy(c), xy(d)});
  Vec3<Pack<float, 4>> points;
  points.x.p0 = __builtin_shufflevector(ab, cd, 0, 2, 4, 6);
  points.y.p0 = __builtin_shufflevector(ab, cd, 1, 3, 5, 7);
  points.z.p0 = Raw{a.z, b.z, c.z, d.z};
  return points;
}
template <int W, int First = 0, class Value> Vec3<Pack<float, W>> load_points(const Value& value) {
  if constexpr (W == 4) {
    return load_points(value(First), value(First + 1), value(First + 2), value(First + 3));
  } else {
    return side_by_side(load_points<W / 2, First>(value), load_points<W / 2, First + W / 2>(value));
  }
}

/// value(k) is the point of lane k: anything with x, y and z.
template <class F, class Value> Vec3<F> gather_points(const Value& value) {
  if constexpr (lanes_of<F> >= 4 && std::is_same_v<decltype(value(0)), const Vec3<float>&>)
    return load_points<lanes_of<F>>(value);
  else
    return {gather<F>([&](int k) { return value(k).x; }), gather<F>([&](int k) { return value(k).y; }),
            gather<F>([&](int k) { return value(k).z; })};
}
/// Points that stand in memory as floats, in lanes of double.
template <class F, class Value> Vec3<F> gather_float_points(const Value& value) {
  constexpr int half = lanes_of<F> / 2;
  if constexpr (half >= 4) {  // in halves, which a double's two registers are
    return side_by_side(number_cast<double>(load_points<half>(value)),
                        number_cast<double>(load_points<half, half>(value)));
  } else {
    return number_cast<double>(gather_points<With<F, float>>(value));
  }
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
