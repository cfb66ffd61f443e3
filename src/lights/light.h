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

#include "math/color.h"
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
};

inline namespace LAMBENT_ISA {

/// L and r for a light at `position`. At the light itself there is no direction: L is then zero, and N.L with
/// it.
template <class F> LightSample<F, Color<F>> towards(const Vec3<F>& position, const Vec3<F>& P) {
  const Vec3<F> way = position - P;
  const F r = length(way);
  return {select(r > F(0), (F(1) / r) * way, Vec3<F>{F(0), F(0), F(0)}), r, Color<F>{}, F(0)};
}

template <class F> Color<F> emitted(const Rgb& color, double intensity) {
  Color<F> result;
  for (int i = 0; i < color_channels; ++i) result[i] = F(color[i] * intensity);
  return result;
}
template <class F> Vec3<F> broadcast(const Vec3<double>& v) { return {F(v.x), F(v.y), F(v.z)}; }

/// The colour that a light sends in its brightest direction. Every light has a `color` and an `intensity`,
/// and `sample` hands out their product or, per channel by the same factor, less.
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
