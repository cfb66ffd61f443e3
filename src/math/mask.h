#pragma once
// How the lanes of a packet lie in registers, and truths of them: what comparisons of packets (pack.h) give.

#include <utility>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "math/number.h"

namespace lambent {
inline namespace LAMBENT_ISA {

// The widest registers of this translation unit's instruction set, in lanes of float.
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

/// How W lanes of T lie in registers: `parts` of them, one or two, with `part_lanes` each. (g++ 12 would take
/// a vector that is wider than the registers apart lane by lane, and it keeps an array of them in memory.)
template <class T, int W> struct Registers {
  static constexpr int native = native_float_lanes * 4 / int(sizeof(T));
  static constexpr int part_lanes = W < native ? W : native, parts = W / part_lanes;
  static_assert(parts * part_lanes == W && parts <= 2);
  using Raw = typename RawPack<T, part_lanes>::type;
};
template <class Raw, int N> struct Parts { Raw p0; };
template <class Raw> struct Parts<Raw, 2> { Raw p0, p1; };

/// Operations part by part: `f(a's part, b's part ...)`.
template <class Result, class Function, class... P> Result by_parts(const Function& f, const P&... p) {
  Result result;
  result.p0 = f(p.p0...);
  if constexpr (Result::In::parts == 2) result.p1 = f(p.p1...);
  return result;
}

template <int W> inline constexpr std::uint32_t all_lane_bits = W == 32 ? ~0u : (1u << W) - 1;

// The truths of a comparison are what the machine makes of it: bits of a number with AVX-512, elsewhere
// lanes.
#if defined(__AVX512F__) && defined(__AVX512VL__) && defined(__AVX512DQ__)

inline constexpr bool masks_are_bits = true;

/// One truth for each of W lanes, a bit each, the first lane's lowest.
template <class Int, int W> struct Mask {
  static_assert(W <= 16);
  using Bits = std::conditional_t<(W > 8), std::uint16_t, std::uint8_t>;
  Bits bits;
  Mask() = default;
  explicit Mask(bool all_lanes) : bits(Bits(all_lanes ? all_lane_bits<W> : 0)) {}
  static Mask of_bits(std::uint32_t bits) {
    Mask result;
    result.bits = Bits(bits);
    return result;
  }
  friend Mask operator&(const Mask& a, const Mask& b) { return of_bits(a.bits & b.bits); }
  friend Mask operator|(const Mask& a, const Mask& b) { return of_bits(a.bits | b.bits); }
  friend Mask operator!(const Mask& a) { return of_bits(~a.bits & all_lane_bits<W>); }
};
template <class Int, int W> std::uint32_t lane_bits(const Mask<Int, W>& m) { return m.bits; }
/// The lanes whose bits are set.
template <class M> M mask_of_bits(std::uint32_t bits) { return M::of_bits(bits); }
template <class Int, int W> bool any(const Mask<Int, W>& m) { return m.bits != 0; }

/// Whether x < y and so on, a bit for each lane of a register.
enum class Order { equal, less, at_most, greater, at_least };
template <Order order, class Raw> std::uint32_t compared(const Raw& x, const Raw& y) {
  using T = decltype(Raw{}[0] + 0);
  constexpr std::size_t size = sizeof(Raw);
  constexpr bool is_double = std::is_same_v<T, double>, is_float = std::is_same_v<T, float>;
  // An order that involves a NaN is false.
  constexpr int reals[] = {_CMP_EQ_OQ, _CMP_LT_OQ, _CMP_LE_OQ, _CMP_GT_OQ, _CMP_GE_OQ},
                wholes[] = {_MM_CMPINT_EQ, _MM_CMPINT_LT, _MM_CMPINT_LE, _MM_CMPINT_NLE, _MM_CMPINT_NLT};
  constexpr int real = reals[int(order)], whole = wholes[int(order)];
  if constexpr (is_float && size == 64) return _mm512_cmp_ps_mask(x, y, real);
  else if constexpr (is_float && size == 32) return _mm256_cmp_ps_mask(x, y, real);
  else if constexpr (is_float) return _mm_cmp_ps_mask(x, y, real);
  else if constexpr (is_double && size == 64) return _mm512_cmp_pd_mask(x, y, real);
  else if constexpr (is_double && size == 32) return _mm256_cmp_pd_mask(x, y, real);
  else if constexpr (is_double) return _mm_cmp_pd_mask(x, y, real);
  else if constexpr (sizeof(T) == 8 && size == 64)
    return _mm512_cmp_epi64_mask(__m512i(x), __m512i(y), whole);
  else if constexpr (sizeof(T) == 8 && size == 32)
    return _mm256_cmp_epi64_mask(__m256i(x), __m256i(y), whole);
  else if constexpr (sizeof(T) == 8) return _mm_cmp_epi64_mask(__m128i(x), __m128i(y), whole);
  else if constexpr (size == 64) return _mm512_cmp_epi32_mask(__m512i(x), __m512i(y), whole);
  else if constexpr (size == 32) return _mm256_cmp_epi32_mask(__m256i(x), __m256i(y), whole);
  else return _mm_cmp_epi32_mask(__m128i(x), __m128i(y), whole);
}
template <Order order, class P> typename P::Truth compared_by_parts(const P& a, const P& b) {
  std::uint32_t bits = compared<order>(a.p0, b.p0);
  if constexpr (P::In::parts == 2) bits |= compared<order>(a.p1, b.p1) << P::In::part_lanes;
  return P::Truth::of_bits(bits);
}

/// x in the lanes of a register whose bits are set, elsewhere y.
template <class Raw> Raw chosen(std::uint32_t bits, const Raw& x, const Raw& y) {
  constexpr std::size_t size = sizeof(Raw);
  if constexpr (sizeof(x[0]) == 8) {
    const auto eight = __mmask8(bits);
    if constexpr (size == 64) return Raw(_mm512_mask_blend_pd(eight, __m512d(y), __m512d(x)));
    else if constexpr (size == 32) return Raw(_mm256_mask_blend_pd(eight, __m256d(y), __m256d(x)));
    else return Raw(_mm_mask_blend_pd(eight, __m128d(y), __m128d(x)));
  } else {
    if constexpr (size == 64) return Raw(_mm512_mask_blend_ps(__mmask16(bits), __m512(y), __m512(x)));
    else if constexpr (size == 32) return Raw(_mm256_mask_blend_ps(__mmask8(bits), __m256(y), __m256(x)));
    else return Raw(_mm_mask_blend_ps(__mmask8(bits), __m128(y), __m128(x)));
  }
}
template <class P> P select_by_parts(const typename P::Truth& m, const P& a, const P& b) {
  P result;
  result.p0 = chosen(m.bits, a.p0, b.p0);
  if constexpr (P::In::parts == 2) result.p1 = chosen(m.bits >> P::In::part_lanes, a.p1, b.p1);
  return result;
}

#else

inline constexpr bool masks_are_bits = false;

/// One truth for each of W lanes: all bits of an Int set, or none. Int is as wide as the numbers that were
/// compared.
template <class Int, int W> struct Mask : Parts<typename Registers<Int, W>::Raw, Registers<Int, W>::parts> {
  using In = Registers<Int, W>;
  using Raw = typename In::Raw;
  Mask() = default;
  explicit Mask(bool all_lanes) {
    this->p0 = Raw{} - Int(all_lanes);
    if constexpr (In::parts == 2) this->p1 = this->p0;
  }
  friend Mask operator&(const Mask& a, const Mask& b) {
    return by_parts<Mask>([](Raw x, Raw y) { return x & y; }, a, b);
  }
  friend Mask operator|(const Mask& a, const Mask& b) {
    return by_parts<Mask>([](Raw x, Raw y) { return x | y; }, a, b);
  }
  friend Mask operator!(const Mask& a) {
    return by_parts<Mask>([](Raw x) { return ~x; }, a);
  }
};

/// A bit for each lane of a register, the first lane's lowest.
template <int Lanes, class Raw> std::uint32_t register_bits(const Raw& r) {
  constexpr std::size_t size = sizeof(Raw), number = size / Lanes;
#if defined(__AVX__)
  if constexpr (size == 32 && number == 4) return std::uint32_t(_mm256_movemask_ps(__m256(r)));
  else if constexpr (size == 32) return std::uint32_t(_mm256_movemask_pd(__m256d(r)));
  else
#endif
#if defined(__x86_64__)
      if constexpr (size == 16 && number == 4)
    return std::uint32_t(_mm_movemask_ps(__m128(r)));
  else if constexpr (size == 16) return std::uint32_t(_mm_movemask_pd(__m128d(r)));
  else
#endif
  {
    std::uint32_t bits = 0;
    for (int k = 0; k < Lanes; ++k) bits |= std::uint32_t(r[k] != 0) << k;
    return bits;
  }
}
template <class Int, int W> std::uint32_t lane_bits(const Mask<Int, W>& m) {
  using In = typename Mask<Int, W>::In;
  std::uint32_t bits = register_bits<In::part_lanes>(m.p0);
  if constexpr (In::parts == 2) bits |= register_bits<In::part_lanes>(m.p1) << In::part_lanes;
  return bits;
}
/// The reverse: the lanes whose bits are set.
template <class M> M mask_of_bits(std::uint32_t bits) {
  using In = typename M::In;
  using Raw = typename M::Raw;
  using Int = decltype(Raw{}[0] + 0);
  const auto part = [bits]<std::size_t... k>(int first, std::index_sequence<k...>) {
    return Raw(((Raw{} + Int(bits >> first)) & Raw{Int(Int(1) << k)...}) != Raw{});
  };
  M result;
  result.p0 = part(0, std::make_index_sequence<In::part_lanes>());
  if constexpr (In::parts == 2) result.p1 = part(In::part_lanes, std::make_index_sequence<In::part_lanes>());
  return result;
}
template <class Int, int W> bool any(const Mask<Int, W>& m) {
  using In = typename Mask<Int, W>::In;
  if constexpr (In::parts == 2) return register_bits<In::part_lanes>(m.p0 | m.p1) != 0;
  else return register_bits<In::part_lanes>(m.p0) != 0;
}

enum class Order { equal, less, at_most, greater, at_least };
template <Order order, class P> typename P::Truth compared_by_parts(const P& a, const P& b) {
  using Truths = typename P::Truth::Raw;
  const auto compare = [](const auto& x, const auto& y) {
    if constexpr (order == Order::equal) return Truths(x == y);
    else if constexpr (order == Order::less) return Truths(x < y);
    else if constexpr (order == Order::at_most) return Truths(x <= y);
    else if constexpr (order == Order::greater) return Truths(x > y);
    else return Truths(x >= y);
  };
  return by_parts<typename P::Truth>(compare, a, b);
}
template <class P> P select_by_parts(const typename P::Truth& m, const P& a, const P& b) {
  return by_parts<P>([](const auto& m, const auto& x, const auto& y) { return m ? x : y; }, m, a, b);
}

#endif

template <class Int, int W> bool all(const Mask<Int, W>& m) { return lane_bits(m) == all_lane_bits<W>; }

}  // namespace LAMBENT_ISA
}  // namespace lambent
