#pragma once
// How a metallic-roughness material (glTF 2.0, appendix B) becomes the lecture's Ka, Kd, Ks and n.
//
// What glTF says, with alpha = roughness^2 (Burley's):
//
//   d    = ((ior - 1) / (ior + 1))^2 specular_color specular      what reflects without being a metal
//   F0   = (1 - metallic) d + metallic base_color                 the reflection at normal incidence
//   K    = (1 - metallic) base_color (1 - d)                      what is scattered alike in all directions;
//                                                                 of it the share `transmission` goes through
//
// and what we make of it:
//
//   n       = 2 / alpha^2 - 2               the Blinn-Phong lobe that is as wide as GGX's or Beckmann's
//   (Walter et
//                                           al., Microfacet models for refraction through rough surfaces,
//                                           2007)
//   w       = alpha^2                       a lobe as wide as Lambert's is Lambert's: this share of F0 is
//   diffuse Ks      = (1 - w) F0 (n + 2) / 8        the lobe's normalisation D = (n + 2) / (2 pi) (N.H)^n in
//   F D / 4, times pi
//                                           as Il is radiance over pi (Hoffman, Background: physics and math
//                                           of shading, SIGGRAPH 2013 course)
//   Kd      = K (1 - transmission) + w F0
//   reflect = F0 ((1 - 2 alpha)+)^2         one mirror ray can stand for a narrow lobe only
//   Ka      = Kd + (1 - w) F0 - reflect     ambient light comes from all sides: the whole albedo, but for
//   what the
//                                           mirror ray brings
//   transmit = K transmission
//
// n ends at 10,000 (roughness 0.119): points of light have no width that would spread the highlight of a
// mirror. A clear coat adds its mirror, 0.04 clearcoat ((1 - 2 alpha_c)+)^2, and takes as much from all
// below; it has no highlight of its own.

#include "math/color.h"
#include "math/functions.h"

namespace lambent {

/// The numbers of a metallic-roughness material at one point; 0 to 1 but for ior.
template <class F, class C> struct MetallicRoughnessOf {
  C base_color;
  F metallic, roughness, specular;
  C specular_color;
  F ior, transmission, clearcoat, clearcoat_roughness;
};

template <class F, class C> struct LectureMaterial {
  C ka, kd, ks, reflect, transmit;
  F n;
};

inline namespace LAMBENT_ISA {

inline constexpr double largest_exponent = 10000;

/// alpha to n; alpha 0 to 1.
template <class F> F exponent_of_alpha(const F& alpha) {
  const F a2 = max(alpha * alpha, F(2 / (largest_exponent + 2)));
  return F(2) / a2 - F(2);
}

template <class F, class C> LectureMaterial<F, C> lecture_material(const MetallicRoughnessOf<F, C>& m) {
  const F one(1), zero(0);
  const auto narrow = [&](const F& alpha) {
    const F x = max(one - F(2) * alpha, zero);
    return x * x;
  };
  const F alpha = m.roughness * m.roughness, w = alpha * alpha;
  const F ratio = (m.ior - one) / (m.ior + one), dielectric = ratio * ratio;
  const F coat = F(0.04) * m.clearcoat, below = one - coat;
  LectureMaterial<F, C> out;
  out.n = exponent_of_alpha(alpha);
  for (int c = 0; c < int(sizeof(C) / sizeof(F)); ++c) {
    const F d = min(dielectric * m.specular_color[c], one) * m.specular;
    const F F0 = (one - m.metallic) * d + m.metallic * m.base_color[c];
    const F K = (one - m.metallic) * m.base_color[c] * (one - d);
    const F reflect = F0 * narrow(alpha);
    out.ks[c] = below * ((one - w) * F0 * (out.n + F(2)) * F(0.125));
    out.kd[c] = below * (K * (one - m.transmission) + w * F0);
    out.ka[c] = out.kd[c] + below * ((one - w) * F0 - reflect);
    out.reflect[c] = below * reflect + coat * narrow(m.clearcoat_roughness * m.clearcoat_roughness);
    out.transmit[c] = below * (K * m.transmission);
  }
  return out;
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
