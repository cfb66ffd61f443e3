#pragma once
// disc: a flat round light.
//
// Points lie evenly over its area A. From the point at distance r, at the angle theta to the light's normal,
// comes Il cos theta; the radiance is the same everywhere and in all directions, Le = pi Il / A.

#include "lights/light.h"

namespace lambent {

struct DiscLight {
  static constexpr LightInfo info{"disc", "a flat round light; it shines where its normal points",
                                  "Il = color * intensity * cos theta"};

  Vec3<double> center{0, 0, 0};
  Vec3<double> normal{0, -1, 0};
  double radius = 1;
  Rgb color{1, 1, 1};
  double intensity = 1;
  bool two_sided = false;
  int samples = 1;
  bool visible = true;
};

inline namespace LAMBENT_ISA {

inline double shown_area(const DiscLight& light) { return pi * light.radius * light.radius; }
inline LightBody body_of(const DiscLight& light) {
  return {LightBody::Kind::disc, light.center,   normalize(light.normal), {}, {},
          light.radius,          light.two_sided};
}

template <class F> LightSample<F, Color<F>> sample(const DiscLight& light, const Vec3<F>& P, F u, F v) {
  const LightBody body = body_of(light);
  const Axes<double> axes = axes_around(body.normal);
  const Vec2<F> at = on_disc(u, v);
  const Vec3<F> Q = broadcast<F>(light.center) + at.x * broadcast<F>(light.radius * axes.x) +
                    at.y * broadcast<F>(light.radius * axes.y);
  return towards_flat(body, Q, shown_area(light), emitted<F>(light.color, light.intensity), P, light.radius);
}
template <class F> F density(const DiscLight& light, const Vec3<F>& P, const Vec3<F>& Q) {
  return density_on_flat(body_of(light), shown_area(light), P, Q);
}

}  // namespace LAMBENT_ISA

template <>
inline constexpr Parameter<DiscLight> parameters_of<DiscLight>[] = {
    {"center", &DiscLight::center, {}, "scene units", "The centre.", true, Kind::point},
    {"normal",
     &DiscLight::normal,
     {},
     "",
     "The direction that it faces, and shines in; of any length.",
     true,
     Kind::direction},
    {"radius", &DiscLight::radius, positive, "scene units", "The radius.", true},
    {"color", &DiscLight::color, at_least_zero, "", "The light's colour; [1, 1, 1] is white."},
    {"intensity", &DiscLight::intensity, at_least_zero, "",
     "A factor on the colour, of the light as a whole: a larger one of the same intensity is dimmer to look "
     "at."},
    {"two_sided", &DiscLight::two_sided, {}, "", "Whether it shines from its back, too."},
    {"samples",
     &DiscLight::samples,
     {1, 1024},
     "",
     "How many points of it light a surface, the same everywhere; 1 is the centre alone, and shadows are "
     "hard. `path` chooses "
     "points of its own."},
    {"visible",
     &DiscLight::visible,
     {},
     "",
     "Whether it stands in the world: rays see it, and it blocks light."},
};

}  // namespace lambent
