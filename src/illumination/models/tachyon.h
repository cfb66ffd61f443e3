#pragma once
// tachyon: the shading of the Tachyon ray tracer, with highlights that distance and glass do not dim.

#include "illumination/halfway.h"
#include "illumination/model.h"

namespace lambent {
inline namespace LAMBENT_ISA {

struct Tachyon {
  static constexpr ModelInfo info{
      .name = "tachyon",
      .title = "Tachyon's shading: highlights that do not fade",
      .equation = "I Kd (N.L)+ + Il Ks f,  f = ((N.H)+)^n, ((R.V)+)^n or t / (n - n t + t), t = (N.H)+",
      .source = "John Stone's Tachyon, version 0.99, as measured",
      .differs =
          "Il is the light's colour, I what arrives of it after its cone, distance and shadow. The highlight "
          "takes Il as it "
          "is: neither the cone nor distance nor glass on the way dims it, and it is gone only in full "
          "shadow. A light is "
          "skipped whole where cone times attenuation times N.L is 1/512 or less. Nothing fades by default, "
          "not the "
          "ambient term either. Kd is Tachyon's Diffuse times the colour of the texture, Ka its Ambient "
          "times that "
          "colour, Ks its Phong with `PHONG PLASTIC`; `METAL`, which tints highlights by the surface, is "
          "left out.",
      .unfaded_light = true,
      .half_vector = true,
      .parameters = {{"highlight", 0, 0, 2, "",
                      "f: 0 is Blinn's ((N.H)+)^n, 1 is Phong's ((R.V)+)^n, 2 is the fast one, t / (n - n t "
                      "+ t) with t = "
                      "(N.H)+.",
                      true}},
  };
  static constexpr double least_contribution = 1.0 / 512;
  template <class F, class C> static Terms<C> evaluate(const Surface<F, C>& s, const Arriving<F, C>& light) {
    const F nl = dot(s.N, light.L), kind = s.own[0];
    const auto lit = both(light.faded * nl > F(least_contribution), !is_black(light.I));
    const F nh = max(cosine_to_halfway(s.N, light.L, s.V), F(0));
    const F rv = max(dot(reflect(light.L, s.N), s.V), F(0));
    const F power = pow(select(kind == F(1), rv, nh), s.n);
    const F fast = select(nh > F(0), nh / (s.n - s.n * nh + nh), F(0));
    const F highlight = select(kind == F(2), fast, power);
    const C black = grey(F(0));
    return {select(lit, nl * (s.kd * light.I), black), select(lit, highlight * (s.ks * light.Il), black)};
  }
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
