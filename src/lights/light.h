#pragma once
// The contract of a light.
//
// A light is a plain struct of settings, with its manual page (info), a table of parameters (what a scene
// file may say), and a function
//
//   template <class F> LightSample<F, Color<F>> sample(const TheLight&, const Vec3<F>& P, F u, F v)
//
// which answers for one point on the light, chosen by u and v in [0, 1); (0.5, 0.5) is the light's centre.
// A light that lights only part of the world may say so with `reaches` and `has_limits`, below.
//
// What it hands out is the colour Il before attenuation: how light fades with distance is the scene's choice,
// not the light's. Its settings have a `color` and an `intensity`. The lecture's name for all this is
// light_t.
//
// A light without extent also says where it stands, for those who choose among many lights:
//
//   Beam beam_of(const TheLight&)
//
// A light with extent (HasExtent, below) is a thing that shines: all of it together gives Il on its axis from
// afar, fading by 1/r^2, so that its radiance is Le = pi Il / A, with A the area that it shows there. Its
// settings have `samples`, how many of its points the lecture's sum over lights takes, and `visible`, whether
// it stands in the world; and with it stand
//
//   double shown_area(const TheLight&)       A
//   LightBody body_of(const TheLight&)       what stands in the world
//   template <class F> F density(const TheLight&, const Vec3<F>& P, const Vec3<F>& Q)
//                                            the density with which `sample` picks the direction from P to
//                                            the point Q of the light, per unit solid angle
//
// For each of its points radiance = pi I density / r^2: the mean over its points of I / r^2 is what a diffuse
// surface gets of it.

#include "math/color.h"
#include "math/directions.h"
#include "math/functions.h"
#include "math/vec.h"
#include "parameters/parameter.h"

namespace lambent {

struct LightInfo {
  const char* name;
  const char* title;     ///< One line.
  const char* equation;  ///< What arrives.
};

/// One point of a light, as a surface point sees it.
template <class F, class C> struct LightSample {
  Vec3<F> L;  ///< Unit vector from the surface point to the light.
  F r;        ///< Distance in scene units; infinity for a light at infinity.
  C I;        ///< Colour sent this way (linear, 1 is white), times intensity; before attenuation and shadow.
  F density;  ///< Per unit solid angle; 0 for a light without extent, which (u, v) cannot miss.
  F clear;    ///< The light arrives where nothing stands in the way from P to P + clear L: r, or for a light
              ///< with extent up to just before its surface, so that it does not block itself.
};

/// Where a light without extent stands and shines: from `position` into the cone about `axis`, or from
/// infinity along `axis`.
struct Beam {
  bool infinite;
  Vec3<double> position, axis;  ///< The axis of unit length.
  double half_angle;            ///< Degrees; 180: everywhere.
};

/// A light with extent as a thing in the world. It shines from its outside alone, or from both sides.
struct LightBody {
  enum class Kind { parallelogram, disc, sphere };
  Kind kind;
  Vec3<double> center;
  Vec3<double> normal{};  ///< Of a flat one, of unit length: to its outside.
  Vec3<double> u{}, v{};  ///< Sides of a parallelogram; u x v points to its outside.
  double radius = 0;
  bool two_sided = false;
};

inline namespace LAMBENT_ISA {

/// L and r for a light at `position`. At the light itself there is no direction: L is then zero, and N.L with
/// it.
template <class F> LightSample<F, Color<F>> towards(const Vec3<F>& position, const Vec3<F>& P) {
  LightSample<F, Color<F>> out;  // number by number: given as a list, all of it would be cleared first
  const Vec3<F> way = position - P;
  const F r = length(way);
  out.L = select(r > F(0), (F(1) / r) * way, Vec3<F>{F(0), F(0), F(0)});
  out.r = r;
  for (int c = 0; c < color_channels; ++c) out.I[c] = F(0);
  out.density = F(0);
  out.clear = r;
  return out;
}

template <class F> Color<F> emitted(const Rgb& color, double intensity) {
  Color<F> result;
  for (int i = 0; i < color_channels; ++i) result[i] = F(color[i] * intensity);
  return result;
}

/// The colour that a light sends in its brightest direction. Every light has a `color` and an `intensity`,
/// and `sample` hands out their product or, per channel by the same factor, less. (Near a sphere it is more,
/// up to twice as much.)
template <class F, class Light> Color<F> brightest(const Light& light) {
  return emitted<F>(light.color, light.intensity);
}
/// That factor: part = factor * whole; 0 where the light is black.
template <class F> F share_of(const Color<F>& part, const Color<F>& whole) {
  F p = part[0], w = whole[0];
  for (int i = 1; i < color_channels; ++i) {
    const auto more = whole[i] > w;
    p = select(more, part[i], p), w = select(more, whole[i], w);
  }
  return select(w > F(0), p / w, F(0));
}

// ---- lights with extent

template <class Light>
concept HasExtent = requires(const Light& light) {
  light.samples;
  light.visible;
};

/// How many points of it the lecture's sum over lights takes.
template <class Light> int samples_of(const Light& light) {
  if constexpr (HasExtent<Light>) return light.samples;
  else return 1;
}

/// Le, what an eye sees that looks at the light's outside.
template <HasExtent Light> Rgb radiance(const Light& light) {
  return emitted<double>(light.color, light.intensity * pi / shown_area(light));
}

/// How high above a light's surface a shadow ray has to end. The queries run in float, u = 2^-24, and `size`
/// bounds all coordinates of P and of the light, so that no way is longer than 2 sqrt(3) size. The height of
/// the ray's end over the light's surface may be off by sqrt(3) u size for the ray's origin, 2 sqrt(3) u size
/// each for its direction and its length, as much for the light's own place (corners; centre and normal), and
/// 8u of the way for the test of intersect.h: 40 u size together at the most.
template <class F> F least_height(const F& size) { return F(0x1p-18) * size; }

/// How much less than r is clear towards a flat surface, on which the light leaves at this cosine.
template <class F> F clear_of_plane(const F& r, const F& cosine, const F& size) {
  return select(cosine > F(0), max(r - least_height(size) / cosine, F(0)), r);
}
/// Towards a sphere: s before it a ray is at the height h where (R + h)^2 = R^2 + 2 s R cos + s^2.
template <class F> F clear_of_sphere(const F& r, const F& cosine, const F& radius, const F& size) {
  const F h = least_height(size), c = radius * cosine, q = h * (F(2) * radius + h);
  return max(r - q / (c + sqrt(c * c + q)), F(0));
}

/// The point Q of a flat light of area A, chosen evenly over the area: L, r, density, and I = Il cos, where
/// cos is that of the angle at which the light leaves. `size`: of the light, from the centre.
template <class F>
LightSample<F, Color<F>> towards_flat(const LightBody& body, const Vec3<F>& Q, double area,
                                      const Color<F>& Il, const Vec3<F>& P, double size) {
  auto result = towards(Q, P);
  F cosine = -dot(result.L, broadcast<F>(body.normal));
  cosine = body.two_sided ? abs(cosine) : max(cosine, F(0));
  result.I = cosine * Il;
  const auto lit = cosine > F(0);
  result.density = select(lit, result.r * result.r / (F(area) * select(lit, cosine, F(1))), F(0));
  result.clear = clear_of_plane(result.r, cosine, max_abs(P) + F(max_abs(body.center) + size));
  return result;
}
template <class F> F density_on_flat(const LightBody& body, double area, const Vec3<F>& P, const Vec3<F>& Q) {
  const Vec3<F> way = Q - P;
  const F square = dot(way, way), r = sqrt(square), height = -dot(way, broadcast<F>(body.normal));
  const F cosine_r = body.two_sided ? abs(height) : max(height, F(0));
  const auto lit = cosine_r > F(0);
  return select(lit, square * r / (F(area) * select(lit, cosine_r, F(1))), F(0));
}

// ---- lights that do not reach everywhere

/// A box in the world, with its ends.
struct Reach {
  Vec3<double> lower, upper;
};

/// Whether a light may light anything in a box: true where the light does not say. Lights that cannot reach
/// are not asked for any point in it. `sample` must hand out black wherever this says no.
template <class Light> bool reaches(const Light&, const Reach&) { return true; }
/// Whether it ever says no.
template <class Light> bool has_limits(const Light&) { return false; }

/// Whether a box comes as near to a point as `distance`.
inline bool comes_near(const Reach& box, const Vec3<double>& point, double distance) {
  const auto beyond = [](double low, double high, double at) { return max(max(low - at, at - high), 0.0); };
  const Vec3<double> gap{beyond(box.lower.x, box.upper.x, point.x), beyond(box.lower.y, box.upper.y, point.y),
                         beyond(box.lower.z, box.upper.z, point.z)};
  return dot(gap, gap) <= distance * distance * (1 + 1e-9);
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
