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
  double max_distance = 0;
};

inline namespace LAMBENT_ISA {

template <class F> LightSample<F, Color<F>> sample(const PointLight& light, const Vec3<F>& P, F, F) {
  auto result = towards(broadcast<F>(light.position), P);
  result.I = emitted<F>(light.color, light.intensity);
  if (light.max_distance > 0) result.I = select(result.r <= F(light.max_distance), result.I, Color<F>{});
  return result;
}
inline bool reaches(const PointLight& light, const Reach& box) {
  return !(light.max_distance > 0) || comes_near(box, light.position, light.max_distance);
}
inline bool has_limits(const PointLight& light) { return light.max_distance > 0; }

inline Beam beam_of(const PointLight& light) { return {false, light.position, {0, 0, 1}, 180}; }

}  // namespace LAMBENT_ISA

template <>
inline constexpr Parameter<PointLight> parameters_of<PointLight>[] = {
    {"position", &PointLight::position, {}, "scene units", "Where the light is.", true, Kind::point},
    {"color", &PointLight::color, at_least_zero, "", "The light's colour; [1, 1, 1] is white."},
    {"intensity", &PointLight::intensity, at_least_zero, "", "A factor on the colour."},
    {"max_distance", &PointLight::max_distance, at_least_zero, "scene units",
     "Beyond it the light does not shine; 0: it shines everywhere. Scenes of many lights are rendered faster "
     "with it."},
};

}  // namespace lambent
