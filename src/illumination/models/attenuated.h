#pragma once
// attenuated: Lambert's cosine law, with lights that fade with the square of the distance: the lecture's
// model 2.

#include "illumination/models/conventional.h"

namespace lambent {
inline namespace LAMBENT_ISA {

struct Attenuated : Conventional {
  static constexpr ModelInfo info{
      .name = "attenuated",
      .title = "Lambert's cosine, lights fade with 1/r^2",
      .equation = "Il / r^2  Kd (N.L)+",
      .source = "the lecture's model 2",
      .differs =
          "It is the lecture's second step: lights fade as physics has it, so intensities are those of real "
          "lamps and "
          "grow with the square of the scene. The ambient term does not fade, and there is no highlight.",
      .attenuation = attenuation_1_over_r2,
  };
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
