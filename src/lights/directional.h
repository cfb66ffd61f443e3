#pragma once
// directional: light from infinitely far away, as the sun's.

#include "lights/light.h"

namespace lambent {

struct DirectionalLight {
  static constexpr LightInfo info{"directional",
                                  "shines in one direction everywhere, from infinity; it does not fade",
                                  "Il = color * intensity"};

  Vec3<double> direction{0, -1, 0};
  Rgb color{1, 1, 1};
  double intensity = 1;
};

inline namespace LAMBENT_ISA {

template <class F> LightSample<F, Color<F>> sample(const DirectionalLight& light, const Vec3<F>&, F, F) {
  const F infinity(__builtin_inf());
  return {-normalize(broadcast<F>(light.direction)), infinity, emitted<F>(light.color, light.intensity), F(0),
          infinity};
}

inline Beam beam_of(const DirectionalLight& light) { return {true, {}, normalize(light.direction), 0}; }

}  // namespace LAMBENT_ISA

template <>
inline constexpr Parameter<DirectionalLight> parameters_of<DirectionalLight>[] = {
    {"direction",
     &DirectionalLight::direction,
     {},
     "",
     "The way the light travels; of any length.",
     true,
     Kind::direction},
    {"color", &DirectionalLight::color, at_least_zero, "", "The light's colour; [1, 1, 1] is white."},
    {"intensity", &DirectionalLight::intensity, at_least_zero, "", "A factor on the colour."},
};

}  // namespace lambent
