#pragma once
// blinn_phong_halfway: Blinn's highlight in its cheap form, with a half-vector that is not normalised.

#include "illumination/models/conventional.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// |H| = cos of half the angle between L and V, so the highlight is dimmer than blinn_phong's, by that cosine
/// to the n.
struct BlinnPhongHalfway {
  static constexpr ModelInfo info{
      .name = "blinn_phong_halfway",
      .title = "Blinn's highlight in its cheap form, H not normalised",
      .equation = "Il / r [ Kd (N.L)+ + Ks ((N.H)+)^n ],  H = (L + V) / 2",
      .source = "the lecture, after Blinn 1977",
      .differs =
          "The lecture's cheap form of blinn_phong: (L + V) / 2 is as short as the cosine of half the angle "
          "between L and "
          "V, and its power n dims the highlight the more, the farther light and eye are apart.",
      .attenuation = attenuation_1_over_r,
      .ambient_attenuation = AmbientAttenuation::one_over_R,
      .half_vector = true,
  };
  template <class F, class C> static Terms<C> evaluate(const Surface<F, C>& s, const Arriving<F, C>& light) {
    const Vec3<F> H = F(0.5) * (light.L + s.V);
    const F highlight = pow(max(dot(s.N, H), F(0)), s.n);
    return {lambert(s, light), select(dot(s.N, light.L) > F(0), highlight, F(0)) * (s.ks * light.I)};
  }
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
