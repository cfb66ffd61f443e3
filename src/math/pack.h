#pragma once
// W numbers that behave as one: a lane for each ray, point or hit. Built on the compilers' vector extension,
// so an operation is one instruction where W is the machine's width. Comparisons give a Mask; select(mask, a,
// b) chooses.

#include <cstring>

#include "math/number.h"

namespace lambent {
inline namespace LAMBENT_ISA {

// The widest registers of this translation unit's instruction set, in lanes of float. A packet wider than the
// registers would be right too, but g++ 12 takes such packets apart lane by lane.
#if defined(__AVX512F__)
inline constexpr int native_float_lanes = 16;
#elif defined(__AVX__)
inline constexpr int native_float_lanes = 8;
#else
inline constexpr int native_float_lanes = 4;
#endif

template <class T, int W> struct RawPack { typedef T type __attribute__((vector_size(sizeof(T) * W))); };
template <int Bytes> struct IntOfSize;
template <> struct IntOfSize<4> { using type = std::int32_t; };
template <> struct IntOfSize<8> { using type = std::int64_t; };

/// One truth for each of W lanes: all bits of an Int set, or none. Int is as wide as the numbers that were
/// compared.
template <class Int, int W> struct Mask {
  using Raw = typename RawPack<Int, W>::type;
  Raw v;
  Mask() : v{} {}
  Mask(Raw raw) : v(raw) {}
  explicit Mask(bool all_lanes) : v(Raw{} - Int(all_lanes)) {}
  friend Mask operator&(Mask a, Mask b) { return a.v & b.v; }
  friend Mask operator|(Mask a, Mask b) { return a.v | b.v; }
  friend Mask operator!(Mask a) { return ~a.v; }
};
template <class Int, int W> bool any(Mask<Int, W> m) {
  std::uint64_t words[sizeof(m.v) / 8], bits = 0;
  std::memcpy(words, &m.v, sizeof(m.v));
  for (std::uint64_t word : words) bits |= word;
  return bits != 0;
}
template <class Int, int W> bool all(Mask<Int, W> m) { return !any(!m); }

template <class T, int W> struct Pack {
  using Raw = typename RawPack<T, W>::type;
  using Truth = Mask<typename IntOfSize<sizeof(T)>::type, W>;
  Raw v;
  Pack() : v{} {}
  Pack(Raw raw) : v(raw) {}
  Pack(T all_lanes) : v(Raw{} + all_lanes) {}
  static Pack load(const T* from) {
    Pack result;
    std::memcpy(&result.v, from, sizeof(Raw));
    return result;
  }
  void store(T* to) const { std::memcpy(to, &v, sizeof(Raw)); }

  friend Pack operator+(Pack a, Pack b) { return a.v + b.v; }
  friend Pack operator-(Pack a, Pack b) { return a.v - b.v; }
  friend Pack operator*(Pack a, Pack b) { return a.v * b.v; }
  friend Pack operator/(Pack a, Pack b) { return a.v / b.v; }
  friend Pack operator-(Pack a) { return -a.v; }
  friend Truth operator<(Pack a, Pack b) { return typename Truth::Raw(a.v < b.v); }
  friend Truth operator>(Pack a, Pack b) { return typename Truth::Raw(a.v > b.v); }
  friend Truth operator<=(Pack a, Pack b) { return typename Truth::Raw(a.v <= b.v); }
  friend Truth operator>=(Pack a, Pack b) { return typename Truth::Raw(a.v >= b.v); }
  friend Truth operator==(Pack a, Pack b) { return typename Truth::Raw(a.v == b.v); }
};

template <class T, int W> Pack<T, W> select(typename Pack<T, W>::Truth m, Pack<T, W> a, Pack<T, W> b) {
  return m.v ? a.v : b.v;
}
template <class T, int W> Pack<T, W> max(Pack<T, W> a, Pack<T, W> b) { return select(a > b, a, b); }
template <class T, int W> Pack<T, W> min(Pack<T, W> a, Pack<T, W> b) { return select(a < b, a, b); }
template <class T, int W> Pack<T, W> abs(Pack<T, W> a) { return select(a < Pack<T, W>(T(0)), -a, a); }
template <class T, int W> Pack<T, W> sqrt(Pack<T, W> a) {
  for (int i = 0; i < W; ++i) a.v[i] = sqrt(a.v[i]);  // both compilers make one instruction of this loop
  return a;
}
template <int W> Pack<std::int64_t, W> to_bits(Pack<double, W> a) {
  return std::bit_cast<typename RawPack<std::int64_t, W>::type>(a.v);
}
template <int W> Pack<double, W> from_bits(Pack<std::int64_t, W> a) {
  return std::bit_cast<typename RawPack<double, W>::type>(a.v);
}
template <int W> Pack<std::int64_t, W> operator<<(Pack<std::int64_t, W> a, int n) { return a.v << n; }
template <int W> Pack<std::int64_t, W> operator>>(Pack<std::int64_t, W> a, int n) { return a.v >> n; }

/// How many numbers an F holds; their reading and writing, one by one.
template <class F> inline constexpr int lanes_of = 1;
template <class T, int W> inline constexpr int lanes_of<Pack<T, W>> = W;
template <Scalar T> T lane(T a, int) { return a; }
template <class T, int W> T lane(const Pack<T, W>& a, int i) { return a.v[i]; }
inline bool lane(bool a, int) { return a; }
template <class Int, int W> bool lane(const Mask<Int, W>& a, int i) { return a.v[i] != 0; }
inline void set_lane(bool& a, int, bool value) { a = value; }
template <class Int, int W> void set_lane(Mask<Int, W>& a, int i, bool value) {
  a.v[i] = value ? Int(-1) : Int(0);
}
template <Scalar T>
requires(!std::is_same_v<T, bool>) void set_lane(T& a, int, T value) { a = value; }
template <class T, int W> void set_lane(Pack<T, W>& a, int i, T value) { a.v[i] = value; }

/// The type of a comparison of two F.
template <class F> using MaskOf = decltype(F() < F());

}  // namespace LAMBENT_ISA
}  // namespace lambent
