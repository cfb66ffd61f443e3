#pragma once
// wavelength_specular: the lecture's last step: how strong the highlight is depends on the wavelength and on
// the angle of incidence.

#include "illumination/fresnel.h"
#include "illumination/models/conventional.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// The highlight is zero where N.L <= 0, as phong's.
struct WavelengthSpecular {
  static constexpr ModelInfo info{
      .name = "wavelength_specular",
      .title = "a highlight by wavelength and angle, exact for metals and glass",
      .equation =
          "Il / r [ Kd (N.L)+ + Ks w(lambda, theta) (cos beta)^n ],  cos theta = N.L, cos beta = (R.V)+",
      .source =
          "the lecture's model for wavelengths; w: Fresnel's equations, Born and Wolf, Principles of "
          "optics, sections 1.5 and 14.2",
      .differs =
          "The lecture leaves w open. Here it is what Fresnel's equations say of unpolarised light: for a "
          "`metal` by its measured n and k, for a `glass` by its index of refraction, for other materials by "
          "their `ior`. Ks is a factor on it. With `spectral` each wavelength has its own w; elsewhere red, "
          "green and blue each have one. It is the model of metals and glasses that name none.",
      .attenuation = attenuation_1_over_r,
      .ambient_attenuation = AmbientAttenuation::one_over_R,
      .measured = true,
  };
  template <class F, class C> static Terms<C> evaluate(const Surface<F, C>& s, const Arriving<F, C>& light) {
    const F nl = dot(s.N, light.L);
    C w;
    for (int c = 0; c < int(sizeof(C) / sizeof(F)); ++c)
      w[c] = fresnel_conductor(min(max(nl, F(0)), F(1)), s.eta[c], s.k[c]);
    const F highlight = pow(max(dot(reflect(light.L, s.N), s.V), F(0)), s.n);
    return {lambert(s, light), select(nl > F(0), highlight, F(0)) * (s.ks * w * light.I)};
  }
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
