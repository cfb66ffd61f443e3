#pragma once
// W numbers that behave as one: a lane for each ray, point or hit. Built on the compilers' vector extension;
// a packet that is wider than the machine's registers takes several of them. Comparisons give a Mask;
// select(mask, a, b) chooses.

#include <cstring>
#include <utility>

#include "math/mask.h"

// All that a function does to a packet in one piece of code, so that it stays in registers.
#define LAMBENT_FLATTEN __attribute__((flatten))

namespace lambent {
inline namespace LAMBENT_ISA {

template <class T, int W> struct Pack : Parts<typename Registers<T, W>::Raw, Registers<T, W>::parts> {
  using In = Registers<T, W>;
  using Raw = typename In::Raw;
  using Truth = Mask<typename IntOfSize<sizeof(T)>::type, W>;
  Pack() = default;
  Pack(T all_lanes) {
    this->p0 = all_lanes - Raw{};
    if constexpr (In::parts == 2) this->p1 = this->p0;
  }
  static Pack load(const T* from) {
    Pack result;
    std::memcpy(&result.p0, from, sizeof(Raw));
    if constexpr (In::parts == 2) std::memcpy(&result.p1, from + In::part_lanes, sizeof(Raw));
    return result;
  }
  void store(T* to) const {
    std::memcpy(to, &this->p0, sizeof(Raw));
    if constexpr (In::parts == 2) std::memcpy(to + In::part_lanes, &this->p1, sizeof(Raw));
  }

  friend Pack operator+(const Pack& a, const Pack& b) {
    return by_parts<Pack>([](Raw x, Raw y) { return x + y; }, a, b);
  }
  friend Pack operator-(const Pack& a, const Pack& b) {
    return by_parts<Pack>([](Raw x, Raw y) { return x - y; }, a, b);
  }
  friend Pack operator*(const Pack& a, const Pack& b) {
    return by_parts<Pack>([](Raw x, Raw y) { return x * y; }, a, b);
  }
  friend Pack operator/(const Pack& a, const Pack& b) {
    return by_parts<Pack>([](Raw x, Raw y) { return x / y; }, a, b);
  }
  friend Pack operator-(const Pack& a) {
    return by_parts<Pack>([](Raw x) { return -x; }, a);
  }
  friend Truth operator<(const Pack& a, const Pack& b) { return compared_by_parts<Order::less>(a, b); }
  friend Truth operator>(const Pack& a, const Pack& b) { return compared_by_parts<Order::greater>(a, b); }
  friend Truth operator<=(const Pack& a, const Pack& b) { return compared_by_parts<Order::at_most>(a, b); }
  friend Truth operator>=(const Pack& a, const Pack& b) { return compared_by_parts<Order::at_least>(a, b); }
  friend Truth operator==(const Pack& a, const Pack& b) { return compared_by_parts<Order::equal>(a, b); }
};

template <class T, int W>
Pack<T, W> select(const typename Pack<T, W>::Truth& m, const Pack<T, W>& a, const Pack<T, W>& b) {
  return select_by_parts<Pack<T, W>>(m, a, b);
}
// Written out, so that the compilers see the one instruction that each of them is.
template <class T, int W> Pack<T, W> max(const Pack<T, W>& a, const Pack<T, W>& b) {
  using Raw = typename Pack<T, W>::Raw;
  return by_parts<Pack<T, W>>([](Raw x, Raw y) { return x > y ? x : y; }, a, b);
}
template <class T, int W> Pack<T, W> min(const Pack<T, W>& a, const Pack<T, W>& b) {
  using Raw = typename Pack<T, W>::Raw;
  return by_parts<Pack<T, W>>([](Raw x, Raw y) { return x < y ? x : y; }, a, b);
}
template <class T, int W> Pack<T, W> abs(const Pack<T, W>& a) {
  using Raw = typename Pack<T, W>::Raw;
  using Int = typename IntOfSize<sizeof(T)>::type;
  using Bits = typename Registers<Int, W>::Raw;
  constexpr Int all_but_sign = Int(~(std::uint64_t(1) << (8 * sizeof(T) - 1)));
  return by_parts<Pack<T, W>>([](Raw x) { return Raw(Bits(x) & (all_but_sign - Bits{})); }, a);
}
template <class T, int W> Pack<T, W> sqrt(const Pack<T, W>& a) {
  using Raw = typename Pack<T, W>::Raw;
  return by_parts<Pack<T, W>>(
      [](Raw x) {
        for (int i = 0; i < Pack<T, W>::In::part_lanes; ++i)
          x[i] = sqrt(x[i]);  // both compilers make one instruction of this loop
        return x;
      },
      a);
}

template <int W> Pack<std::int64_t, W> to_bits(const Pack<double, W>& a) {
  using I = Pack<std::int64_t, W>;
  return by_parts<I>([](typename Pack<double, W>::Raw x) { return typename I::Raw(x); }, a);
}
template <int W> Pack<double, W> from_bits(const Pack<std::int64_t, W>& a) {
  using D = Pack<double, W>;
  return by_parts<D>([](typename Pack<std::int64_t, W>::Raw x) { return typename D::Raw(x); }, a);
}
template <int W> Pack<std::int64_t, W> operator<<(const Pack<std::int64_t, W>& a, int n) {
  return by_parts<Pack<std::int64_t, W>>([n](auto x) { return x << n; }, a);
}
template <int W> Pack<std::int64_t, W> operator>>(const Pack<std::int64_t, W>& a, int n) {
  return by_parts<Pack<std::int64_t, W>>([n](auto x) { return x >> n; }, a);
}

/// How many numbers an F holds; their reading and writing, one by one.
template <class F> inline constexpr int lanes_of = 1;
template <class T, int W> inline constexpr int lanes_of<Pack<T, W>> = W;
template <Scalar T> T lane(T a, int) { return a; }
template <class T, int W> T lane(const Pack<T, W>& a, int i) {
  T values[W];
  a.store(values);
  return values[i];
}
inline bool lane(bool a, int) { return a; }
template <class Int, int W> bool lane(const Mask<Int, W>& a, int i) { return lane_bits(a) >> i & 1; }
inline void set_lane(bool& a, int, bool value) { a = value; }
template <Scalar T>
requires(!std::is_same_v<T, bool>) void set_lane(T& a, int, T value) { a = value; }
template <class T, int W> void set_lane(Pack<T, W>& a, int i, T value) {
  T values[W];
  a.store(values);
  values[i] = value;
  a = Pack<T, W>::load(values);
}
template <class Int, int W> void set_lane(Mask<Int, W>& a, int i, bool value) {
  const std::uint32_t bit = 1u << i, others = lane_bits(a) & ~bit;
  a = mask_of_bits<Mask<Int, W>>(value ? others | bit : others);
}

template <int First, class Raw, std::size_t... k> auto half(const Raw& a, std::index_sequence<k...>) {
  return __builtin_shufflevector(a, a, (First + int(k))...);
}

/// Of a register's lanes the one that choose(a, b) leaves when halves are laid upon each other.
template <class Raw, class Choose> auto reduced(const Raw& a, const Choose& choose) {
  constexpr int lanes = sizeof(Raw) / sizeof(a[0]);
  if constexpr (lanes == 2) {
    return choose(a[0], a[1]);
  } else if constexpr (sizeof(Raw) == 16) {  // there is no smaller register
    const Raw last = choose(a, Raw(__builtin_shufflevector(a, a, 2, 3, 2, 3)));
    return choose(last[0], last[1]);
  } else {
    const auto lower = half<0>(a, std::make_index_sequence<lanes / 2>()),
               upper = half<lanes / 2>(a, std::make_index_sequence<lanes / 2>());
    return reduced(choose(lower, upper), choose);
  }
}
template <class T, int W, class Choose> T reduce(const Pack<T, W>& a, const Choose& choose) {
  if constexpr (Pack<T, W>::In::parts == 2) return reduced(choose(a.p0, a.p1), choose);
  else return reduced(a.p0, choose);
}
/// The least and the greatest lane.
template <class T, int W> T least(const Pack<T, W>& a) {
  return reduce(a, [](const auto& x, const auto& y) { return x < y ? x : y; });
}
template <class T, int W> T greatest(const Pack<T, W>& a) {
  return reduce(a, [](const auto& x, const auto& y) { return x > y ? x : y; });
}
template <Scalar T> T least(T a) { return a; }
template <Scalar T> T greatest(T a) { return a; }

/// The type of a comparison of two F.
template <class F> using MaskOf = decltype(F() < F());

/// An F of as many lanes with other numbers in them.
template <class F, class T> struct WithNumber { using type = T; };
template <class From, int W, class T> struct WithNumber<Pack<From, W>, T> { using type = Pack<T, W>; };
template <class F, class T> using With = typename WithNumber<F, T>::type;

/// F with value(k) in lane k: for numbers that lie apart in memory.
template <class F, class Value> F gather(const Value& value) {
  if constexpr (lanes_of<F> == 1) {
    return F(value(0));
  } else {
    using In = typename F::In;
    const auto part = [&]<std::size_t... k>(int first, std::index_sequence<k...>) {
      return typename F::Raw{value(first + int(k))...};
    };
    F result;
    result.p0 = part(0, std::make_index_sequence<In::part_lanes>());
    if constexpr (In::parts == 2)
      result.p1 = part(In::part_lanes, std::make_index_sequence<In::part_lanes>());
    return result;
  }
}

template <class Half, std::size_t... k> auto joined(const Half& a, const Half& b, std::index_sequence<k...>) {
  return __builtin_shufflevector(a, b, int(k)...);
}

/// Number by number the nearest of Into's. Numbers that become twice as wide do so by the one instruction
/// that does it: g++ 12 makes four of `__builtin_convertvector`, and warns of its own `_mm512_cvtps_pd`.
template <class Into, class Raw> Into converted(const Raw& x) {
  [[maybe_unused]] constexpr bool floats = std::is_same_v<decltype(Raw{}[0] + 0), float>,
                                  doubles = std::is_same_v<decltype(Into{}[0] + 0), double>;
#if defined(__AVX512F__)
  if constexpr (floats && doubles && sizeof(Into) == 64) return Into(_mm512_maskz_cvtps_pd(0xff, __m256(x)));
  else
#endif
#if defined(__AVX__)
      if constexpr (floats && doubles && sizeof(Into) == 32)
    return Into(_mm256_cvtps_pd(__m128(x)));
  else
#endif
    return __builtin_convertvector(x, Into);
}

/// Lane by lane the nearest To.
template <class To, Scalar T> To number_cast(T a) { return To(a); }
template <class To, class T, int W> Pack<To, W> number_cast(const Pack<T, W>& a) {
  using From = Registers<T, W>;
  using Into = Registers<To, W>;
  Pack<To, W> result;
  if constexpr (From::parts == Into::parts) {
    return by_parts<Pack<To, W>>([](typename From::Raw x) { return converted<typename Into::Raw>(x); }, a);
  } else if constexpr (Into::parts == 2) {  // each half of the register becomes one
    result.p0 = converted<typename Into::Raw>(half<0>(a.p0, std::make_index_sequence<W / 2>()));
    result.p1 = converted<typename Into::Raw>(half<W / 2>(a.p0, std::make_index_sequence<W / 2>()));
  } else {
    typedef To Half __attribute__((vector_size(W / 2 * sizeof(To))));
    result.p0 = joined(converted<Half>(a.p0), converted<Half>(a.p1), std::make_index_sequence<W>());
  }
  return result;
}

/// The same truths for numbers of another size.
template <class To, class From, int W> Mask<To, W> mask_cast(const Mask<From, W>& m) {
  if constexpr (masks_are_bits) {
    return mask_of_bits<Mask<To, W>>(lane_bits(m));
  } else {  // no rounding, -1 and 0 are the same in all of them
    const auto numbers = number_cast<To>(std::bit_cast<Pack<From, W>>(m));
    return std::bit_cast<Mask<To, W>>(numbers);
  }
}
template <class To> bool mask_cast(bool m) { return m; }

/// a b - c, rounded once or twice as the machine likes: for bounds that allow for either.
template <int W>
Pack<float, W> multiply_subtract_roughly(const Pack<float, W>& a, const Pack<float, W>& b,
                                         const Pack<float, W>& c) {
  using Raw = typename Pack<float, W>::Raw;
  return by_parts<Pack<float, W>>(
      [](Raw x, Raw y, Raw z) {
        [[maybe_unused]] constexpr std::size_t size = sizeof(Raw);
#if defined(__AVX512F__)
        if constexpr (size == 64) return Raw(_mm512_fmsub_ps(x, y, z));
        else
#endif
#if defined(__FMA__)
            if constexpr (size == 32)
          return Raw(_mm256_fmsub_ps(x, y, z));
        else if constexpr (size == 16) return Raw(_mm_fmsub_ps(x, y, z));
        else
#endif
          return x * y - z;
      },
      a, b, c);
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
