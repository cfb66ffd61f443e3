#pragma once
// phong: Lambert's cosine and a highlight around the mirror direction of the light: the lecture's equation.

#include "illumination/models/conventional.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// The highlight is zero where N.L <= 0: a light behind the surface must not shine through it.
struct Phong {
  static constexpr ModelInfo info{
      .name = "phong",
      .title = "the lecture's equation: a highlight around the mirrored light",
      .equation = "Il / r [ Kd (N.L)+ + Ks ((R.V)+)^n ],  R = 2 (N.L) N - L",
      .source =
          "Bui Tuong Phong, Illumination for computer generated pictures, CACM 18(6), 1975; the lecture's "
          "model",
      .differs =
          "It is the lecture's own. Three things that the notes leave open are settled here: the highlight "
          "is zero where "
          "N.L <= 0, a light in shadow gives neither diffuse nor specular light, and 1/r ends at "
          "minimum_distance.",
      .attenuation = attenuation_1_over_r,
      .ambient_attenuation = AmbientAttenuation::one_over_R,
  };
  template <class F, class C> static Terms<C> evaluate(const Surface<F, C>& s, const Arriving<F, C>& light) {
    const Vec3<F> R = reflect(light.L, s.N);
    const F highlight = pow(max(dot(R, s.V), F(0)), s.n);
    return {lambert(s, light), select(dot(s.N, light.L) > F(0), highlight, F(0)) * (s.ks * light.I)};
  }
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
