#pragma once
// sphere: a ball that shines, as a bulb or the sun.
//
// Seen from P, at the distance r from its centre, the ball of radius R fills a cone of directions: with
// cos a = sqrt(1 - R^2 / r^2) its solid angle is 2 pi (1 - cos a). Directions lie evenly in the cone, and
// each brings
//
//   Il 2 / (1 + cos a)
//
// which is Il from afar and 2 Il at the surface. The radiance is Le = Il / R^2. It fades with the distance of
// its centre, and is dark inside.

#include "lights/light.h"

namespace lambent {

struct SphereLight {
  static constexpr LightInfo info{"sphere", "a ball that shines",
                                  "Il = color * intensity * 2 / (1 + cos a),  sin a = radius / r"};

  Vec3<double> center{0, 0, 0};
  double radius = 1;
  Rgb color{1, 1, 1};
  double intensity = 1;
  int samples = 1;
  bool visible = true;
};

inline namespace LAMBENT_ISA {

inline double shown_area(const SphereLight& light) { return pi * light.radius * light.radius; }
inline LightBody body_of(const SphereLight& light) {
  return {LightBody::Kind::sphere, light.center, {}, {}, {}, light.radius};
}

/// The cone of directions in which a sphere is seen from a distance.
template <class F> struct ConeOfSphere {
  MaskOf<F> outside;   ///< Whether it is seen from outside.
  F one_minus_cosine;  ///< 1 - cos a; 1 on the sphere and inside.
  F density;           ///< Per unit solid angle; 0 inside.

  ConeOfSphere(const F& square_of_distance, double radius) {
    const F one(1), R2(radius * radius);
    outside = square_of_distance > R2;
    const F sin2 = select(outside, R2 / select(outside, square_of_distance, one), one);
    one_minus_cosine =
        sin2 / (one + sqrt(one - sin2));  // without the difference of two that are nearly equal
    density = select(outside, one / (F(2 * pi) * one_minus_cosine), F(0));
  }
};

/// A direction in it, chosen by (u, v) evenly over the solid angle: L, and `clear` towards the sphere. r: the
/// distance of the centre.
template <class F>
LightSample<F, Color<F>> towards_sphere(const Vec3<double>& center, double radius, const Vec3<F>& P,
                                        const F& u, const F& v) {
  auto result = towards(broadcast<F>(center), P);
  const F zero(0), one(1), d = result.r;
  const ConeOfSphere<F> cone(d * d, radius);
  result.density = cone.density;
  const Vec2<F> at = on_disc(u, v);
  // 1 - cos theta grows with the area of the disc within; sin^2 theta = (1 - cos theta) (1 + cos theta).
  const F square = at.x * at.x + at.y * at.y, less = square * cone.one_minus_cosine, cosine = one - less,
          sine_by_radius = sqrt(cone.one_minus_cosine * (F(2) - less));
  result.L = to_world(axes_around(result.L), {sine_by_radius * at.x, sine_by_radius * at.y, cosine});
  // Where it meets the sphere: half the chord before the point next to the centre.
  const F aside = d * d * less * (F(2) - less), half = sqrt(max(F(radius * radius) - aside, zero));
  const F size = max_abs(P) + F(max_abs(center) + radius);
  result.clear = clear_of_sphere(d * cosine - half, half / F(radius), F(radius), size);
  return result;
}

template <class F> LightSample<F, Color<F>> sample(const SphereLight& light, const Vec3<F>& P, F u, F v) {
  auto result = towards_sphere(light.center, light.radius, P, u, v);
  const ConeOfSphere<F> cone(result.r * result.r, light.radius);
  const F more = select(cone.outside, F(2) / (F(2) - cone.one_minus_cosine), F(0));
  result.I = more * emitted<F>(light.color, light.intensity);
  return result;
}
template <class F> F density(const SphereLight& light, const Vec3<F>& P, const Vec3<F>&) {
  const Vec3<F> way = broadcast<F>(light.center) - P;
  return ConeOfSphere<F>(dot(way, way), light.radius).density;
}

}  // namespace LAMBENT_ISA

template <>
inline constexpr Parameter<SphereLight> parameters_of<SphereLight>[] = {
    {"center", &SphereLight::center, {}, "scene units", "The centre.", true, Kind::point},
    {"radius", &SphereLight::radius, positive, "scene units", "The radius.", true},
    {"color", &SphereLight::color, at_least_zero, "", "The light's colour; [1, 1, 1] is white."},
    {"intensity", &SphereLight::intensity, at_least_zero, "",
     "A factor on the colour, of the light as a whole: a larger one of the same intensity is dimmer to look "
     "at."},
    {"samples",
     &SphereLight::samples,
     {1, 1024},
     "",
     "How many points of it light a surface, the same everywhere; 1 is the centre alone, and shadows are "
     "hard. `path` chooses "
     "points of its own."},
    {"visible",
     &SphereLight::visible,
     {},
     "",
     "Whether it stands in the world: rays see it, and it blocks light."},
};

}  // namespace lambent
