#pragma once
// x^y, 2^x, log2 x, sine and cosine, written once for one double and for packets of them.
//
// The C library's are as good, but not the same everywhere: their last bit depends on the library's version
// and on the processor. These use only + - * / and moves of bits, which IEEE 754 fixes to the last bit, so a
// picture is the same on every machine. (Compile with -ffp-contract=off.)

#include <initializer_list>

#include "math/number.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// 2^p; 0 below -1022 and infinity from 1024 on.
template <class D> D exp2(D p) {
  const D lowest(-1022.0), highest(1023.9999999999999);
  const D q = min(max(p, lowest), highest);
  const D magic(0x1.8p52);  // adding it rounds to the nearest integer, which then stands in the low bits
  const D k = (q + magic) - magic;
  const D f = (q - k) * D(0x1.62e42fefa39efp-1);  // |f| <= ln(2)/2: the Taylor series below is right to 2^-53
  // Even and odd powers apart: half as many steps that wait for each other.
  const D f2 = f * f;
  D odd(1.0 / 6227020800.0), even(1.0 / 479001600.0);
  for (double c : {1.0 / 39916800.0, 1.0 / 362880.0, 1.0 / 5040.0, 1.0 / 120.0, 1.0 / 6.0, 1.0})
    odd = odd * f2 + D(c);
  for (double c : {1.0 / 3628800.0, 1.0 / 40320.0, 1.0 / 720.0, 1.0 / 24.0, 0.5, 1.0})
    even = even * f2 + D(c);
  const D s = odd * f + even;
  // 2^k in two factors, because k = 1024 would not fit into one.
  const D half_k = ((k * D(0.5) + magic) - magic);
  const D a = from_bits(to_bits(half_k + (magic + D(1023.0))) << 52);
  const D b = from_bits(to_bits((k - half_k) + (magic + D(1023.0))) << 52);
  const D result = (s * a) * b;
  return select(p < lowest, D(0.0), select(p >= D(1024.0), D(__builtin_inf()), result));
}

/// log2 x for normal x > 0.
template <class D> D log2(D x) {
  using I = decltype(to_bits(x));
  const I bits = to_bits(x);
  const I e = (bits - I(0x3fe6a09e667f3bcd)) >> 52;  // so that the mantissa falls into [sqrt(1/2), sqrt(2))
  const D m = from_bits(bits - (e << 52));
  const D q = (m - D(1.0)) / (m + D(1.0)), q2 = q * q;  // log m = 2 atanh q, |q| <= 0.1716
  const D q4 = q2 * q2;                                 // as in exp2
  D odd(1.0 / 19.0), even(1.0 / 21.0);
  for (double c : {1.0 / 15.0, 1.0 / 11.0, 1.0 / 7.0, 1.0 / 3.0}) odd = odd * q4 + D(c);
  for (double c : {1.0 / 17.0, 1.0 / 13.0, 1.0 / 9.0, 1.0 / 5.0, 1.0}) even = even * q4 + D(c);
  const D s = odd * q2 + even;
  const D exponent = from_bits(e + I(0x4338000000000000)) - D(0x1.8p52);  // int64 to double by bits alone
  return exponent + D(0x1.71547652b82fep+1) * q * s;
}

/// x^y for x >= 0 and finite y >= 0; x <= 0 counts as 0, and 0^0 = 1 (a highlight with shininess 0 is
/// everywhere).
template <class D> D pow(D x, D y) {
  const D tiny(2.2250738585072014e-308);
  const auto none = x < tiny;
  const D of_none = select(y == D(0.0), D(1.0), D(0.0));
  // Highlights that are seen nowhere in a packet, or not at all, cost nothing.
  if (!any(both(!none, y > D(0.0)))) return select(none, of_none, D(1.0));
  return select(none, of_none, exp2(y * log2(max(x, tiny))));
}
inline float pow(float x, float y) { return float(pow(double(x), double(y))); }

template <class D> struct SinCos { D sin, cos; };

/// Sine and cosine of an angle in degrees; exact at multiples of 90.
template <class D> SinCos<D> sincos_degrees(D degrees) {
  const D magic(0x1.8p52);
  const D k = (degrees * D(1.0 / 90.0) + magic) - magic;
  const D r =
      (degrees - D(90.0) * k) * D(0.017453292519943295);  // the difference is exact; |r| <= pi/4 (and a bit)
  const D r2 = r * r;
  D s = D(-1.0 / 1307674368000.0), c = D(1.0 / 20922789888000.0);
  for (double t :
       {1.0 / 6227020800.0, -1.0 / 39916800.0, 1.0 / 362880.0, -1.0 / 5040.0, 1.0 / 120.0, -1.0 / 6.0, 1.0})
    s = s * r2 + D(t);
  for (double t : {-1.0 / 87178291200.0, 1.0 / 479001600.0, -1.0 / 3628800.0, 1.0 / 40320.0, -1.0 / 720.0,
                   1.0 / 24.0, -0.5, 1.0})
    c = c * r2 + D(t);
  s = s * r;
  // Quarter turns: k mod 4 swaps and negates.
  const D quarter = k - D(4.0) * ((k * D(0.25) - D(0.375) + magic) - magic);  // 0, 1, 2, 3
  const auto odd = either(quarter == D(1.0), quarter == D(3.0));
  const D sine = select(odd, c, s), cosine = select(odd, s, c);
  return {select(quarter >= D(2.0), -sine, sine),
          select(either(quarter == D(1.0), quarter == D(2.0)), -cosine, cosine)};
}

/// Bits that have nothing to do with those of x, as far as one can see (the finalizer of Steele, Lea and
/// Flood, Fast splittable pseudorandom number generators, 2014).
constexpr std::uint64_t hashed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

/// The angle of the point (x, y) seen from the origin, in turns from the x axis towards the y axis: -1/2 to
/// 1/2; 0 at the origin.
inline double turns(double y, double x) {
  const double ax = abs(x), ay = abs(y), larger = max(ax, ay);
  if (!(larger > 0)) return 0;
  // Half the angle, twice: tan(a / 2) = tan a / (1 + sqrt(1 + tan^2 a)) <= tan(pi / 16).
  double q = min(ax, ay) / larger;
  q = q / (1 + sqrt(1 + q * q));
  q = q / (1 + sqrt(1 + q * q));
  const double q2 = q * q;
  double s = -1.0 / 23.0;
  for (double c : {1.0 / 21.0, -1.0 / 19.0, 1.0 / 17.0, -1.0 / 15.0, 1.0 / 13.0, -1.0 / 11.0, 1.0 / 9.0,
                   -1.0 / 7.0, 1.0 / 5.0, -1.0 / 3.0, 1.0})
    s = s * q2 + c;
  double angle = s * q * (4 * 0.15915494309189535);  // radians to turns
  if (ay > ax) angle = 0.25 - angle;
  if (x < 0) angle = 0.5 - angle;
  return y < 0 ? -angle : angle;
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
