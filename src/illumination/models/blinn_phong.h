#pragma once
// blinn_phong: the highlight where the normal is halfway between light and eye.

#include "illumination/models/conventional.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// The highlight is zero where N.L <= 0, and where L = -V, which leaves no halfway.
struct BlinnPhong {
  static constexpr ModelInfo info{
      .name = "blinn_phong",
      .title = "Blinn's highlight, by the half-vector",
      .equation = "Il / r [ Kd (N.L)+ + Ks ((N.H)+)^n ],  H = (L + V) / |L + V|",
      .source = "Blinn, Models of light reflection for computer synthesized pictures, SIGGRAPH 1977",
      .differs =
          "The lecture's second form of the highlight: N.H in place of R.V. H leans half as far as R, so for "
          "the same n "
          "the highlight is about twice as wide; four times n brings it near to phong's.",
      .attenuation = attenuation_1_over_r,
      .ambient_attenuation = AmbientAttenuation::one_over_R,
      .half_vector = true,
  };
  template <class F, class C> static Terms<C> evaluate(const Surface<F, C>& s, const Arriving<F, C>& light) {
    const Vec3<F> sum = light.L + s.V;
    const F square = dot(sum, sum);
    const F nh = select(square > F(0), dot(s.N, sum) / sqrt(square), F(0));
    const F highlight = pow(max(nh, F(0)), s.n);
    return {lambert(s, light), select(dot(s.N, light.L) > F(0), highlight, F(0)) * (s.ks * light.I)};
  }
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
