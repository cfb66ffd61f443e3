#pragma once
// povray: the finish of POV-Ray: a diffuse term with brilliance, and two highlights.

#include "illumination/halfway.h"
#include "illumination/model.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// Both highlights are zero where N.L <= 0.
struct Povray {
  static constexpr ModelInfo info{
      .name = "povray",
      .title = "POV-Ray's finish: brilliance, phong and specular",
      .equation = "Il [ Kd ((N.L)+)^b + Ks ((R.V)+)^n + s ((N.H)+)^(1 / roughness) ]",
      .source = "the reference of POV-Ray 3.7, sections on finish",
      .differs =
          "Kd is POV-Ray's diffuse times its pigment, Ks its phong, n its phong_size; the second highlight, "
          "its "
          "`specular`, is s = pov_specular, and b = brilliance. Nothing fades by default; POV-Ray's "
          "fade_distance d with "
          "fade_power 2 is the attenuation {constant: 0.5, quadratic: 0.5 / d^2}. Its ambient term is the "
          "pigment times "
          "ambient times ambient_light, so that Ka is the product of the first two, and does not fade with "
          "R. Highlights "
          "have the light's colour, times Ks: `metallic`, which tints them by the pigment, is left out, as "
          "are "
          "irid, crand and subsurface light.",
      .parameters = {{"pov_specular", 0, 0, 1e6, "", "s, the amount of POV-Ray's specular."},
                     {"roughness", 0.05, 1e-6, 1e6, "",
                      "The smaller, the smaller that highlight: its power is 1/roughness."},
                     {"brilliance", 1, 0, 1e6, "",
                      "b: the larger, the faster the diffuse light falls off with the angle."}},
  };
  template <class F, class C> static Terms<C> evaluate(const Surface<F, C>& s, const Arriving<F, C>& light) {
    const F nl = dot(s.N, light.L);
    const auto lit = nl > F(0);
    const F diffuse = pow(max(nl, F(0)), s.own[2]);
    const F phong = pow(max(dot(reflect(light.L, s.N), s.V), F(0)), s.n);
    const F specular = s.own[0] * pow(max(cosine_to_halfway(s.N, light.L, s.V), F(0)), F(1) / s.own[1]);
    return {select(lit, diffuse, F(0)) * (s.kd * light.I),
            select(lit, F(1), F(0)) * ((phong * s.ks + grey(specular)) * light.I)};
  }
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
