#pragma once
// spot: a position that shines into a cone, brightest on the axis.
//
// With theta the angle between the axis and the way to the surface, a = angle / 2 and b = (1 - softness) a:
//
//   Il = color * intensity * (cos theta)^exponent * S((cos theta - cos a) / (cos b - cos a))
//
// where S(x) = 3x^2 - 2x^3 on [0, 1], 0 below and 1 above: full light up to b from the axis, none beyond a.
// With softness 0 the edge is hard: full light where cos theta >= cos a.

#include "lights/light.h"

namespace lambent {

struct SpotLight {
  static constexpr LightInfo info{
      "spot", "shines into a cone around the way from position to target",
      "Il = color * intensity * (cos theta)^exponent * S((cos theta - cos a) / (cos b - cos a))"};

  Vec3<double> position{0, 0, 0};
  Vec3<double> target{0, 0, 0};
  Rgb color{1, 1, 1};
  double intensity = 1;
  double angle = 40;
  double softness = 0.2;
  double exponent = 0;
  double max_distance = 0;
};

inline namespace LAMBENT_ISA {

template <class F> LightSample<F, Color<F>> sample(const SpotLight& light, const Vec3<F>& P, F, F) {
  auto result = towards(broadcast<F>(light.position), P);
  const F cos_theta = -dot(result.L, broadcast<F>(normalize(light.target - light.position)));
  const double cos_a = sincos_degrees(light.angle / 2).cos,
               cos_b = sincos_degrees((1 - light.softness) * light.angle / 2).cos;
  const double width = cos_b - cos_a;
  const F x = width > 0 ? max(F(0), min(F(1), (cos_theta - F(cos_a)) / F(width)))
                        : select(cos_theta >= F(cos_a), F(1), F(0));
  F falloff = x * x * (F(3) - F(2) * x);
  if (light.exponent != 0) falloff = falloff * pow(max(cos_theta, F(0)), F(light.exponent));
  result.I = falloff * emitted<F>(light.color, light.intensity);
  if (light.max_distance > 0) result.I = select(result.r <= F(light.max_distance), result.I, Color<F>{});
  return result;
}
inline bool reaches(const SpotLight& light, const Reach& box) {
  if (light.max_distance > 0 && !comes_near(box, light.position, light.max_distance)) return false;
  if (light.angle >= 180) return true;
  // The ball about the box against the cone: how far its centre lies outside of the cone's side.
  const Vec3<double> center = 0.5 * (box.lower + box.upper), way = center - light.position;
  const double radius = 0.5 * length(box.upper - box.lower) * (1 + 1e-9) + 1e-9 * length(way);
  const double along = dot(way, normalize(light.target - light.position));
  const double across = sqrt(max(dot(way, way) - along * along, 0.0));
  const auto [sine, cosine] = sincos_degrees(light.angle / 2);
  return across * cosine - along * sine <= radius;
}
inline bool has_limits(const SpotLight& light) { return light.angle < 180 || light.max_distance > 0; }

inline Beam beam_of(const SpotLight& light) {
  return {false, light.position, normalize(light.target - light.position), light.angle / 2};
}

}  // namespace LAMBENT_ISA

template <>
inline constexpr Parameter<SpotLight> parameters_of<SpotLight>[] = {
    {"position", &SpotLight::position, {}, "scene units", "Where the light is.", true, Kind::point},
    {"target",
     &SpotLight::target,
     {},
     "scene units",
     "A point on the cone's axis; not the position.",
     true,
     Kind::point},
    {"color", &SpotLight::color, at_least_zero, "", "The light's colour; [1, 1, 1] is white."},
    {"intensity", &SpotLight::intensity, at_least_zero, "", "A factor on the colour."},
    {"angle", &SpotLight::angle, {0.01, 180}, "degrees", "Full opening angle of the cone."},
    {"softness", &SpotLight::softness, zero_to_one, "",
     "The share of the half-angle over which the edge fades; 0 is a hard edge."},
    {"exponent",
     &SpotLight::exponent,
     {0, 1000},
     "",
     "Power of the cosine to the axis; 0 lights the cone evenly."},
    {"max_distance", &SpotLight::max_distance, at_least_zero, "scene units",
     "Beyond it the light does not shine; 0: it shines everywhere. Scenes of many lights are rendered faster "
     "with it."},
};

}  // namespace lambent
