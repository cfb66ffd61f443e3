#pragma once
// Fresnel's equations, exact: how much of the light that meets a smooth boundary is reflected.
//
// The cosine is that of the angle between the light and the normal, 0 to 1, on the side that the light comes
// from. Indices of refraction are those of the far side over that of the near one.

#include "math/functions.h"
#include "math/pack.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// Reflectances of light that swings across the plane of incidence, and of light that swings within it.
template <class F> struct PolarisedReflectance { F s, p; };
template <class F> F unpolarised(const PolarisedReflectance<F>& r) { return F(0.5) * (r.s + r.p); }

/// Of a boundary between two media that do not absorb. 1 from the critical angle on.
///
///   s = ((c - g) / (c + g))^2,  p = ((eta^2 c - g) / (eta^2 c + g))^2,  g = eta cos(refracted)
///     = sqrt(eta^2 - 1 + c^2)
///
/// (Born and Wolf, Principles of optics, section 1.5). What is not reflected goes through.
template <class F> PolarisedReflectance<F> polarised_fresnel_dielectric(const F& cosine, const F& eta) {
  const F eta2 = eta * eta, bend = eta2 - F(1), k = bend + cosine * cosine;
  const F g = sqrt(max(k, F(0)));
  const F s_sum = cosine + g, p_sum = eta2 * cosine + g;
  const F over = F(1) / (s_sum * p_sum);
  // c - g = (c^2 - g^2) / (c + g), which loses no digits where eta is near 1.
  const F s = bend * p_sum * over / s_sum, p = (eta2 * cosine - g) * (s_sum * over);
  const auto passes = k > F(0);
  return {select(passes, min(s * s, F(1)), F(1)), select(passes, min(p * p, F(1)), F(1))};
}
template <class F> F fresnel_dielectric(const F& cosine, const F& eta) {
  return unpolarised(polarised_fresnel_dielectric(cosine, eta));
}

/// Of a metal with the complex index eta + i k, k >= 0. With c the cosine and s2 = 1 - c^2,
///
///   a^2 + b^2 = sqrt((eta^2 - k^2 - s2)^2 + 4 eta^2 k^2),  a^2 = (a^2 + b^2 + eta^2 - k^2 - s2) / 2
///   s = (a^2 + b^2 - 2 a c + c^2) / (a^2 + b^2 + 2 a c + c^2)
///   p = s (c^2 (a^2 + b^2) - 2 a c s2 + s2^2) / (c^2 (a^2 + b^2) + 2 a c s2 + s2^2)
///
/// (Born and Wolf, section 14.2). With k = 0 it is fresnel_dielectric.
template <class F>
PolarisedReflectance<F> polarised_fresnel_conductor(const F& cosine, const F& eta, const F& k) {
  const F c2 = cosine * cosine, s2 = (F(1) - cosine) * (F(1) + cosine);
  const F real = (eta - k) * (eta + k) - s2, imaginary = F(2) * eta * k;
  const F square = sqrt(real * real + imaginary * imaginary);
  const F a = sqrt(max(F(0.5) * (square + real), F(0)));
  const F cross = F(2) * a * cosine;
  const F s_even = square + c2, p_even = c2 * square + s2 * s2, p_odd = cross * s2;
  const F s_sum = s_even + cross, p_sum = p_even + p_odd;
  const F over = F(1) / (s_sum * p_sum);
  // The differences are sums of squares; rounding may make them less than zero.
  const F s = max(s_even - cross, F(0)) * p_sum * over, p = max(p_even - p_odd, F(0)) * s_sum * over;
  const auto sensible = s_sum * p_sum > F(0);  // no medium at all, or light along the boundary
  return {select(sensible, min(s, F(1)), F(1)), select(sensible, min(s * p, F(1)), F(1))};
}
template <class F> F fresnel_conductor(const F& cosine, const F& eta, const F& k) {
  return unpolarised(polarised_fresnel_conductor(cosine, eta, k));
}

/// How much a metal reflects of light that comes along the normal: ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2).
template <class F> F fresnel_conductor_at_normal(const F& eta, const F& k) {
  const F k2 = k * k, less = eta - F(1), more = eta + F(1);
  return (less * less + k2) / (more * more + k2);
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
