#pragma once
// rectangle: a flat light with straight sides, as a panel, a window or a softbox.
//
// Points lie evenly over its area A. From the point at distance r, at the angle theta to the light's normal,
// comes Il cos theta; the radiance is the same everywhere and in all directions, Le = pi Il / A.

#include "lights/light.h"

namespace lambent {

struct RectangleLight {
  static constexpr LightInfo info{
      "rectangle", "a flat light, a parallelogram about its centre; it shines where u x v points",
      "Il = color * intensity * cos theta"};

  Vec3<double> center{0, 0, 0};
  Vec3<double> u{1, 0, 0};
  Vec3<double> v{0, 0, 1};
  Rgb color{1, 1, 1};
  double intensity = 1;
  bool two_sided = false;
  int samples = 1;
  bool visible = true;
};

inline namespace LAMBENT_ISA {

inline double shown_area(const RectangleLight& light) { return length(cross(light.u, light.v)); }
inline LightBody body_of(const RectangleLight& light) {
  return {LightBody::Kind::parallelogram,
          light.center,
          normalize(cross(light.u, light.v)),
          light.u,
          light.v,
          0,
          light.two_sided};
}

template <class F> LightSample<F, Color<F>> sample(const RectangleLight& light, const Vec3<F>& P, F u, F v) {
  const Vec3<F> Q = broadcast<F>(light.center) + (u - F(0.5)) * broadcast<F>(light.u) +
                    (v - F(0.5)) * broadcast<F>(light.v);
  return towards_flat(body_of(light), Q, shown_area(light), emitted<F>(light.color, light.intensity), P,
                      length(light.u) + length(light.v));
}
template <class F> F density(const RectangleLight& light, const Vec3<F>& P, const Vec3<F>& Q) {
  return density_on_flat(body_of(light), shown_area(light), P, Q);
}

}  // namespace LAMBENT_ISA

template <>
inline constexpr Parameter<RectangleLight> parameters_of<RectangleLight>[] = {
    {"center", &RectangleLight::center, {}, "scene units", "Its middle.", true, Kind::point},
    {"u", &RectangleLight::u, {}, "scene units", "One side, from corner to corner.", true, Kind::direction},
    {"v",
     &RectangleLight::v,
     {},
     "scene units",
     "The other side; of a rectangle at a right angle to `u`, otherwise of a parallelogram. The light shines "
     "where u x v points: to the side from which the way from `u` to `v` is counter-clockwise.",
     true,
     Kind::direction},
    {"color", &RectangleLight::color, at_least_zero, "", "The light's colour; [1, 1, 1] is white."},
    {"intensity", &RectangleLight::intensity, at_least_zero, "",
     "A factor on the colour, of the light as a whole: a larger one of the same intensity is dimmer to look "
     "at."},
    {"two_sided", &RectangleLight::two_sided, {}, "", "Whether it shines from its back, too."},
    {"samples",
     &RectangleLight::samples,
     {1, 1024},
     "",
     "How many points of it light a surface, the same everywhere; 1 is the centre alone, and shadows are "
     "hard. `path` chooses "
     "points of its own."},
    {"visible",
     &RectangleLight::visible,
     {},
     "",
     "Whether it stands in the world: rays see it, and it blocks light."},
};

}  // namespace lambent
