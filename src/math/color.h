#pragma once
// Colours: one number for each channel. Three channels (linear RGB) today; nothing outside this room assumes
// so.

#include "math/isa.h"
#include "math/number.h"

namespace lambent {

inline constexpr int color_channels = 3;

template <class F, int Channels = color_channels> struct Color {
  F c[Channels]{};
  constexpr F& operator[](int i) { return c[i]; }
  constexpr const F& operator[](int i) const { return c[i]; }
};
/// Of packets, `Color<F> c;` is nothing until it is set and `Color<F> c{}` is black, as Vec3 (vec.h).
template <class F, int Channels>
requires(!Scalar<F>) struct Color<F, Channels> {
  F c[Channels];
  constexpr F& operator[](int i) { return c[i]; }
  constexpr const F& operator[](int i) const { return c[i]; }
};

/// The colour of scenes, lights and materials: linear RGB, 1 is white.
using Rgb = Color<double, 3>;

inline namespace LAMBENT_ISA {

template <class F, int C> constexpr Color<F, C> operator+(Color<F, C> a, const Color<F, C>& b) {
  for (int i = 0; i < C; ++i) a[i] = a[i] + b[i];
  return a;
}
template <class F, int C> constexpr Color<F, C> operator-(Color<F, C> a, const Color<F, C>& b) {
  for (int i = 0; i < C; ++i) a[i] = a[i] - b[i];
  return a;
}
template <class F, int C> constexpr Color<F, C> operator*(Color<F, C> a, const Color<F, C>& b) {
  for (int i = 0; i < C; ++i) a[i] = a[i] * b[i];
  return a;
}
template <class F, int C> constexpr Color<F, C> operator*(const F& s, Color<F, C> a) {
  for (int i = 0; i < C; ++i) a[i] = s * a[i];
  return a;
}
template <class F, int C> constexpr Color<F, C> operator*(const Color<F, C>& a, const F& s) { return s * a; }
template <class F, int C> constexpr Color<F, C> operator/(Color<F, C> a, const F& s) {
  for (int i = 0; i < C; ++i) a[i] = a[i] / s;
  return a;
}
template <class F, int C> constexpr bool operator==(const Color<F, C>& a, const Color<F, C>& b) {
  for (int i = 0; i < C; ++i)
    if (!(a[i] == b[i])) return false;
  return true;
}
template <class F, int C, class M>
Color<F, C> select(const M& m, const Color<F, C>& a, const Color<F, C>& b) {
  Color<F, C> result;
  for (int i = 0; i < C; ++i) result[i] = select(m, a[i], b[i]);
  return result;
}
/// The same number in every channel.
template <class F, int C = color_channels> constexpr Color<F, C> grey(const F& value) {
  Color<F, C> result;
  for (int i = 0; i < C; ++i) result[i] = value;
  return result;
}
/// The luminance of linear sRGB (ITU-R BT.709): white has 1.
template <class F> constexpr F luminance_of(const Color<F, 3>& a) {
  return F(0.2126) * a[0] + F(0.7152) * a[1] + F(0.0722) * a[2];
}
/// Whether every channel is zero; for packets lane by lane.
template <class F, int C> constexpr auto is_black(const Color<F, C>& a) {
  auto black = a[0] == F(0);
  for (int i = 1; i < C; ++i) black = both(black, a[i] == F(0));
  return black;
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
