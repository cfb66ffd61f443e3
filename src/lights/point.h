#pragma once
// point: a position that shines the same in all directions.

#include "lights/light.h"

namespace lambent {

struct PointLight {
  static constexpr LightInfo info{"point", "shines from one position, alike in all directions",
                                  "Il = color * intensity"};

  Vec3<double> position{0, 0, 0};
  Rgb color{1, 1, 1};
  double intensity = 1;
};

inline namespace LAMBENT_ISA {

template <class F> LightSample<F, Color<F>> sample(const PointLight& light, const Vec3<F>& P, F, F) {
  auto result = towards(broadcast<F>(light.position), P);
  result.I = emitted<F>(light.color, light.intensity);
  return result;
}

}  // namespace LAMBENT_ISA

template <>
inline constexpr Parameter<PointLight> parameters_of<PointLight>[] = {
    {"position", &PointLight::position, {}, "scene units", "Where the light is.", true, Kind::point},
    {"color", &PointLight::color, at_least_zero, "", "The light's colour; [1, 1, 1] is white."},
    {"intensity", &PointLight::intensity, at_least_zero, "", "A factor on the colour."},
};

}  // namespace lambent
