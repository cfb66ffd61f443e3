#pragma once
// mtl: the colours of Wavefront's material library, by the number that its `illum` gives.
//
//   illum 0       Kd, whatever the light
//   illum 1       Ka Ia + Kd sum (N.L)+ Il
//   illum 2       and Ks sum (N.H)+^Ns Il
//   3, 4, 6, 8, 9 as 2; what they reflect and transmit is the material's
//   5, 7          as 2, the highlight times Fresnel's factor Fr(L.H)
//   10            black: it only catches shadows

#include "illumination/halfway.h"
#include "illumination/models/conventional.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// Fr is Schlick's with Ks at L = H, since the text leaves it open: Ks + (1 - Ks) (1 - L.H)^5. The highlight
/// is zero where N.L <= 0.
struct Mtl {
  static constexpr ModelInfo info{
      .name = "mtl",
      .title = "Wavefront's material library: what its illum says",
      .equation = "Il [ Kd (N.L)+ + Ks ((N.H)+)^n Fr ],  H = (L + V) / |L + V|",
      .source =
          "Alias|Wavefront, the MTL material format, 1995; Fr: Schlick, An inexpensive BRDF model, 1994",
      .differs =
          "Nothing fades: the text knows neither 1/r nor 1/R. The highlight is Blinn's. `illum` switches the "
          "terms: 0 is "
          "Kd alone in place of the ambient term, whatever the light; 1 has no highlight; 2 and above have "
          "one; 5 and 7 "
          "multiply it by Fr = Ks + (1 - Ks) (1 - L.H)^5, Schlick's, as the text names the factor without "
          "giving it; "
          "elsewhere Fr is 1. 10 is black. The text has no shadows and lights the highlight where N.L <= 0; "
          "here both are "
          "as everywhere. What 3 to 9 reflect and refract is the material's `reflect` and `transmit`, which "
          "the reader of "
          "MTL files sets, and they do not change with the angle in 5 and 7 either. Not to be had: "
          "reflection maps (8 and "
          "9 trace the ray instead), highlights that make glass more opaque (4, 9), and the alpha of 10, "
          "which would hold "
          "its shadows.",
      .half_vector = true,
      .parameters = {{"illum", 2, 0, 10, "", "Which terms there are; the number that stands in MTL files.",
                      true}},
  };
  template <class F, class C> static C ambient(const Surface<F, C>& s, const C& Ia) {
    const F illum = s.own[0];
    return select(illum == F(0), s.kd, select(illum == F(10), grey(F(0)), s.ka * Ia));
  }
  template <class F, class C> static Terms<C> evaluate(const Surface<F, C>& s, const Arriving<F, C>& light) {
    const F illum = s.own[0];
    const auto lit = both(dot(s.N, light.L) > F(0), illum >= F(1), illum <= F(9));
    const auto highlighted = both(lit, illum >= F(2));
    const auto fresnel = either(illum == F(5), illum == F(7));
    const F highlight = pow(max(cosine_to_halfway(s.N, light.L, s.V), F(0)), s.n);
    const F miss = F(1) - max(cosine_to_halfway(light.L, light.L, s.V), F(0));  // 1 - L.H
    const F miss2 = miss * miss;
    const C one = grey(F(1));
    const C Fr = select(fresnel, s.ks + (miss2 * miss2 * miss) * (one - s.ks), one);
    const C black = grey(F(0));
    return {select(lit, lambert(s, light), black),
            select(highlighted, highlight * (s.ks * Fr * light.I), black)};
  }
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
