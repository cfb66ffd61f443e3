#pragma once
// conventional: Lambert's cosine law alone, with lights that do not fade: the lecture's model 1.

#include "illumination/model.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// Lambert 1760: the light that a matt surface sends back is proportional to the cosine between N and L.
template <class F, class C> C lambert(const Surface<F, C>& s, const Arriving<F, C>& light) {
  return max(dot(s.N, light.L), F(0)) * (s.kd * light.I);
}

struct Conventional {
  static constexpr ModelInfo info{
      .name = "conventional",
      .title = "Lambert's cosine, lights do not fade",
      .equation = "Il Kd (N.L)+",
      .source = "Lambert, Photometria, 1760; the lecture's model 1",
      .differs =
          "It is the lecture's first step: no highlight, and nothing fades, neither lights with r nor the "
          "ambient "
          "term with R.",
  };
  template <class F, class C> static Terms<C> evaluate(const Surface<F, C>& s, const Arriving<F, C>& light) {
    return {lambert(s, light), C{}};
  }
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
