#pragma once
// Everything that shines, for integrators that follow light at random: the scene's lights, surfaces whose
// material has emission, and the background. One of them is chosen by what it may bring to a surface point,
// then a point or a direction of it; and for what was found in another way it is said with which density it
// would have been chosen.
//
// Emitters that lie somewhere stand in light trees (light_tree.h), or by themselves where there are few;
// directional lights and the background lie nowhere, and are bounded by the irradiance that they bring. One
// of these roots is chosen first, by importance, but with a share of the chances in equal parts: importance
// knows nothing of what stands in the way.

#include "integrators/frame.h"
#include "integrators/light_tree.h"
#include "integrators/paint.h"
#include "math/directions.h"

namespace lambent {

enum class EmitterKind : std::uint8_t { light, surface, background };

struct Emitter {
  EmitterKind kind;
  std::int32_t light;                          ///< Index into Frame::lights,
  std::int32_t instance, geometry, primitive;  ///< or which primitive of the world.
  std::int32_t root;                           ///< Of EmitterTable::roots,
  std::uint64_t path;                          ///< and how it is found there.
};

/// Where choosing begins.
struct EmitterRoot {
  std::int32_t node;     ///< The root of a tree; -1: an emitter that lies nowhere:
  std::int32_t emitter;  ///< this one.
  Attenuation fading;    ///< Of a tree.
  double irradiance;     ///< Of what lies nowhere: the mean over the channels, on a surface that faces it.
  Vec3<double> L;        ///< Likewise; where it comes from. Zero: from all around.
};

/// How a picture around the scene is chosen from: piecewise evenly, by the mean brightness of its texels.
/// Cell (x, y) is the texel of that level of detail. Both tables hold sums from the first on, and begin with
/// 0.
struct EnvironmentChoice {
  int width = 0, height = 0;        ///< 0: there is no picture.
  const double* rows = nullptr;     ///< height + 1
  const double* columns = nullptr;  ///< For each row width + 1.
};

struct EmitterTable {
  const Emitter* emitters;
  const LightNode* nodes;
  const EmitterRoot* roots;
  int root_count;
  /// The emitter of a primitive: emitter_of[first + primitive], with the instance's first or, where there is
  /// none, its geometry's; first -1: none of them shines. -1: this one does not.
  const std::int64_t *first_of_instance, *first_of_geometry;
  const std::int32_t* emitter_of;
  const std::int32_t* emitter_of_light;  ///< For each of the frame's lights.
  std::int32_t background;               ///< Its emitter; -1: it is black.
  std::int32_t only_light;  ///< The light with extent that is all that shines; -1: there is another, or more.
  EnvironmentChoice environment;
};

/// A light that has been looked for at a surface point.
struct EmitterSample {
  Vec3<double> L{};  ///< Unit vector to it.
  double r = 0;      ///< The distance by which it fades; infinity for what lies nowhere.
  double clear = 0;  ///< The way from P to P + clear L must be free.
  /// What f |N.L| is multiplied with: its radiance over the density, or of a light without extent pi Il,
  /// faded, over the probability of its choice. Black: it does not light P.
  Rgb radiance_over_density{};
  /// Per unit solid angle, the choice of the emitter included. 0: nothing else can find this light; it has no
  /// extent, or is not visible.
  double density = 0;
  int light = -1;  ///< Of the frame's; light_count: a surface; light_count + 1: the background.
};

inline namespace LAMBENT_ISA {

namespace detail {

/// The share of the chances that all roots which may light a point have in equal parts.
inline constexpr double even_share = 0.25;

inline double importance_of_root(const Frame& frame, const EmitterRoot& root, const Vec3<double>& P,
                                 const Vec3<double>& N) {
  const EmitterTable& table = *frame.emitters;
  if (root.node >= 0) return importance(table.nodes[root.node], P, N, root.fading, frame.minimum_distance);
  const bool faces = dot(N, N) > 0 && dot(root.L, root.L) > 0;
  return faces ? root.irradiance * max(dot(N, root.L), 0.0) : root.irradiance;
}

/// Of all roots at a point: how likely each is.
///   goes_on  whether a path goes on from there, and finds what it is not looked for
///
/// A background of one colour is found as well by a path that goes on, as no other light is: chosen by the
/// material, its direction is the better choice. To look for it, too, takes from what is done for the others.
/// Let S be what these bring, B what the background brings, V its variance where it is in part hidden, as a
/// share of B^2, and p the chance of the others; then S^2 (1 / p - 1) + B^2 V / (2 - p) is the variance, and
/// least where p = 2 S / (S + B sqrt(V)): as if the background's importance were (B sqrt(V) - S) / 2. V = 1/4
/// where four fifths of it are seen.
class RootChances {
  static constexpr int remembered = 8;
  const Frame& frame_;
  const Vec3<double>&P_, &N_;
  double importances_[remembered];  ///< Of the first roots.
  int even_sky_ = -1;               ///< The root that is found otherwise,
  double sky_ = 0;                  ///< and what it counts.
  double sum_ = 0;
  int count_ = 0;  ///< Of those with some importance.

 public:
  RootChances(const Frame& frame, const Vec3<double>& P, const Vec3<double>& N, bool goes_on)
      : frame_(frame), P_(P), N_(N) {
    const EmitterTable& table = *frame.emitters;
    for (int i = 0; i < table.root_count; ++i) {
      const double one = importance_of_root(frame, table.roots[i], P, N);
      if (i < remembered) importances_[i] = one;
      if (goes_on && table.environment.width == 0 && table.roots[i].emitter == table.background &&
          table.roots[i].node < 0) {
        even_sky_ = i, sky_ = one;
      } else {
        sum_ += one, count_ += one > 0;
      }
    }
    if (even_sky_ < 0) return;
    sky_ = max(0.5 * sky_ - sum_, 0.0) * 0.5;
    sum_ += sky_, count_ += sky_ > 0;
  }
  double of(int root) const {
    const double one = root == even_sky_   ? sky_
                       : root < remembered ? importances_[root]
                                           : importance_of_root(frame_, frame_.emitters->roots[root], P_, N_);
    return one > 0 ? (1 - even_share) * (one / sum_) + even_share / count_ : 0;
  }
};

inline PickedLight pick_emitter(const Frame& frame, const Vec3<double>& P, const Vec3<double>& N, double pick,
                                bool goes_on = true) {
  const EmitterTable& table = *frame.emitters;
  const RootChances chances(frame, P, N, goes_on);
  int chosen = -1;
  double chance = 0;
  for (int i = 0; i < table.root_count; ++i) {
    const double one = chances.of(i);
    if (!(one > 0)) continue;
    if (chosen >= 0) pick -= chance;  // the one before was not it
    chosen = i, chance = one;
    if (pick < one) break;
  }
  if (chosen < 0) return {-1, 0};
  pick = min(pick / chance, below_one);
  const EmitterRoot& root = table.roots[chosen];
  if (root.node < 0) return {root.emitter, chance};
  PickedLight picked = pick_light(table.nodes, root.node, P, N, root.fading, frame.minimum_distance, pick);
  picked.probability *= chance;
  return picked;
}

inline double probability_of_emitter(const Frame& frame, std::int32_t emitter, const Vec3<double>& P,
                                     const Vec3<double>& N) {
  const EmitterTable& table = *frame.emitters;
  const Emitter& e = table.emitters[emitter];
  const EmitterRoot& root = table.roots[e.root];
  const double chance = RootChances(frame, P, N, true).of(e.root);
  if (root.node < 0 || !(chance > 0)) return chance;
  return pick_probability(table.nodes, root.node, e.path, P, N, root.fading, frame.minimum_distance) * chance;
}

/// 1 / r^2, however near.
inline constexpr Attenuation physical = attenuation_1_over_r2;

// ---- the scene's lights

inline EmitterSample sample_light(const Frame& frame, int number, const Vec3<double>& P, double u, double v) {
  return with_light(frame.lights[number], [&]<class Light>(const Light& light) {
    const LightSample<double, Rgb> s = sample(light, P, u, v);
    EmitterSample out;
    out.L = s.L, out.r = s.r, out.clear = s.clear, out.light = number;
    if (is_black(s.I)) return out;
    if constexpr (HasExtent<Light>) {
      out.radiance_over_density = (pi / (s.r * s.r)) * s.I;
      if (light.visible) out.density = s.density;
    } else {
      out.radiance_over_density = (pi * attenuate(frame.path_attenuation, s.r, frame.minimum_distance)) * s.I;
    }
    return out;
  });
}

/// With which density a light's points are chosen, seen from P, where a ray has met it in Q.
inline double density_of_light(const Frame& frame, int number, const Vec3<double>& P, const Vec3<double>& Q) {
  return with_light(frame.lights[number], [&]<class Light>(const Light& light) {
    if constexpr (HasExtent<Light>) return light.visible ? density(light, P, Q) : 0.0;
    else return 0.0;
  });
}

// ---- surfaces

/// A point of a primitive, chosen evenly over its area as it is in its own space, and its geometric normal
/// there.
struct AreaPoint {
  Vec3<double> Q, n;
};

inline Vec3<double> corner_in_world(const Geometry& g, const Instance* instance, std::uint32_t vertex) {
  const Vec3<double> p = cast<double>(g.vertices[vertex]);
  return instance ? transform_point(instance->world_from_object, p) : p;
}

inline double cone_area(const PlacedCone& cone) {
  return pi * (2 * cone.radius + cone.slope * cone.height) * cone.height * sqrt(1 + cone.slope * cone.slope);
}

/// Of a primitive in its own space that is no triangle.
inline AreaPoint point_of_primitive(const Geometry& g, std::int32_t primitive, double u, double v) {
  switch (g.kind) {
    case PrimitiveKind::sphere: {
      const Sphere& s = g.spheres[primitive];
      const double z = 1 - 2 * v, across = sqrt(max(1 - z * z, 0.0));
      const auto [sine, cosine] = sincos_degrees(360 * u);
      const Vec3<double> n{across * cosine, across * sine, z};
      return {s.center + s.radius * n, n};
    }
    case PrimitiveKind::disc: {
      const Disc& d = g.discs[primitive];
      const Axes<double> axes = axes_around(d.normal);
      const Vec2<double> at = on_disc(u, v);
      return {d.center + d.radius * (at.x * axes.x + at.y * axes.y), d.normal};
    }
    case PrimitiveKind::cone: {
      const PlacedCone& c = g.cones[primitive];
      const Axes<double> axes = axes_around(c.axis);
      // Of the radii at both ends, squares grow evenly with the area.
      const double top = c.radius + c.slope * c.height,
                   radius = sqrt(c.radius * c.radius + v * (top * top - c.radius * c.radius)),
                   z = c.radius + radius > 0 ? v * c.height * ((c.radius + top) / (c.radius + radius)) : 0;
      const auto [sine, cosine] = sincos_degrees(360 * u);
      const Vec3<double> out = cosine * axes.x + sine * axes.y;
      return {c.base + radius * out + z * c.axis, normalize(out - c.slope * c.axis)};
    }
    case PrimitiveKind::triangle:
    case PrimitiveKind::plane:
    case PrimitiveKind::instance:
      break;
  }
  __builtin_unreachable();
}
inline double area_of_primitive(const Geometry& g, std::int32_t primitive) {
  switch (g.kind) {
    case PrimitiveKind::sphere:
      return 4 * pi * g.spheres[primitive].radius * g.spheres[primitive].radius;
    case PrimitiveKind::disc:
      return pi * g.discs[primitive].radius * g.discs[primitive].radius;
    case PrimitiveKind::cone:
      return cone_area(g.cones[primitive]);
    case PrimitiveKind::triangle:
    case PrimitiveKind::plane:
    case PrimitiveKind::instance:
      break;
  }
  __builtin_unreachable();
}

/// Twice the vector area of a triangle in the world.
inline Vec3<double> double_area(const Geometry& g, const Instance* instance, std::int32_t primitive) {
  const auto& [i, j, k] = g.triangles[primitive];
  const Vec3<double> p = corner_in_world(g, instance, i);
  return cross(corner_in_world(g, instance, j) - p, corner_in_world(g, instance, k) - p);
}

/// Likewise, out of the triangle's front. Corners in the world run the other way round in a mirrored
/// instance; baked ones say so.
inline Vec3<double> outward_double_area(const Geometry& g, const Instance* instance, std::int32_t primitive) {
  const bool flipped = instance ? determinant(instance->world_from_object) < 0 : g.flipped;
  const Vec3<double> n = double_area(g, instance, primitive);
  return flipped ? -n : n;
}

/// Of any primitive but a plane, chosen evenly over its area as it is in its own space; in the world. A
/// triangle without area has no normal: zero.
inline AreaPoint point_in_world(const Geometry& g, const Instance* instance, std::int32_t primitive, double u,
                                double v) {
  if (g.kind == PrimitiveKind::triangle) {
    const auto& [i, j, k] = g.triangles[primitive];
    const double root = sqrt(u), b0 = 1 - root, b1 = root * (1 - v), b2 = root * v;
    const Vec3<double> n = outward_double_area(g, instance, primitive);
    return {b0 * corner_in_world(g, instance, i) + b1 * corner_in_world(g, instance, j) +
                b2 * corner_in_world(g, instance, k),
            dot(n, n) > 0 ? normalize(n) : Vec3<double>{}};
  }
  AreaPoint at = point_of_primitive(g, primitive, u, v);
  if (instance) {
    at.Q = transform_point(instance->world_from_object, at.Q);
    at.n = normalize(transform_normal(instance->object_from_world, at.n));
  }
  return at;
}

/// Per unit area in the world; G: the geometric normal in the world there, on either side.
inline double density_by_area(const Frame& frame, const HitIds<std::int32_t>& ids, const Vec3<double>& G) {
  const Geometry& g = frame.world.geometries[ids.geometry];
  const Instance* instance = ids.instance >= 0 ? &frame.world.instances[ids.instance] : nullptr;
  if (g.kind == PrimitiveKind::triangle) {
    const double area = 0.5 * length(double_area(g, instance, ids.primitive));
    return area > 0 ? 1 / area : 0;
  }
  const double even = 1 / area_of_primitive(g, ids.primitive);
  if (!instance) return even;
  // An area grows by |determinant| times the normal's growth, whose inverse is that of G taken back.
  return even * length(transform_normal(instance->world_from_object, G)) /
         abs(determinant(instance->world_from_object));
}

/// Whether directions towards it are chosen in its cone, as seen from outside of it. A point on the sphere
/// itself counts as inside, whichever way it was rounded (surface.h).
inline bool is_ball(const Geometry& g, const HitIds<std::int32_t>& ids, const Vec3<double>& P) {
  if (g.kind != PrimitiveKind::sphere || ids.instance >= 0) return false;
  const Sphere& s = g.spheres[ids.primitive];
  return length(P - s.center) > s.radius + 0x1p-48 * (max_abs(P) + max_abs(s.center) + s.radius);
}

/// The radiance that the surface sends from Q against d.
inline Rgb emission_at(const Frame& frame, const HitIds<std::int32_t>& ids, const Vec3<double>& Q,
                       const Vec3<double>& G, const Vec3<double>& d) {
  const std::uint32_t material = material_of(frame.world, ids.instance, ids.geometry, ids.primitive);
  const MaterialRecord& m = frame.unpainted[material];
  if (m.one_sided && dot(G, d) > 0) return {};
  if (!m.painted && !frame.world.geometries[ids.geometry].colors) {
    const double there = m.alpha == Alpha::mask ? double(m.opacity >= m.alpha_cutoff) : m.opacity;
    return there * m.emission;
  }
  const Paint here = paint_as_given(frame, ids, material, Q, G, G, d, 0);
  return here.gap ? Rgb{} : here.opacity * here.emission;
}

/// The largest coordinate that has to do with a shadow ray from P to the primitive: of P and of all places
/// where the primitive is.
inline double size_around(const Geometry& g, const Instance* instance, std::int32_t primitive) {
  double size = 0;
  switch (g.kind) {
    case PrimitiveKind::triangle:
      for (const std::uint32_t corner : g.triangles[primitive])
        size = max(size, double(max_abs(g.vertices[corner])));
      break;
    case PrimitiveKind::sphere:
      size = max_abs(g.spheres[primitive].center) + g.spheres[primitive].radius;
      break;
    case PrimitiveKind::disc:
      size = max_abs(g.discs[primitive].center) + g.discs[primitive].radius;
      break;
    case PrimitiveKind::cone: {
      const PlacedCone& c = g.cones[primitive];
      size = max_abs(c.base) + c.height + max(c.radius, c.radius + c.slope * c.height);
      break;
    }
    case PrimitiveKind::plane:
    case PrimitiveKind::instance:
      break;
  }
  if (!instance) return size;
  const Transform& t = instance->world_from_object;
  return size * (length(t.x) + length(t.y) + length(t.z)) + max_abs(t.translation);
}

inline EmitterSample sample_surface(const Frame& frame, const Emitter& e, const Vec3<double>& P, double u,
                                    double v) {
  const HitIds<std::int32_t> ids{e.instance, e.geometry, e.primitive};
  const Geometry& g = frame.world.geometries[e.geometry];
  const Instance* instance = e.instance >= 0 ? &frame.world.instances[e.instance] : nullptr;
  EmitterSample out;
  out.light = frame.light_count;
  const double size = max_abs(P) + size_around(g, instance, e.primitive);
  if (is_ball(g, ids, P)) {
    const Sphere& s = g.spheres[e.primitive];
    const auto towards = towards_sphere(s.center, s.radius, P, u, v);
    out.L = towards.L, out.clear = towards.clear, out.density = towards.density;
    // The point itself: `clear` ends before it.
    const Vec3<double> way = P - s.center;
    const double middle = -dot(way, out.L);
    const Vec3<double> aside = way + middle * out.L;
    out.r = middle - sqrt(max(s.radius * s.radius - dot(aside, aside), 0.0));
    const Vec3<double> n = normalize(way + out.r * out.L);
    out.radiance_over_density =
        (1 / out.density) * emission_at(frame, ids, s.center + s.radius * n, n, out.L);
    return out;
  }
  const AreaPoint at = point_in_world(g, instance, e.primitive, u, v);
  if (!(dot(at.n, at.n) > 0)) return out;
  const auto towards_point = towards(at.Q, P);
  out.L = towards_point.L, out.r = towards_point.r;
  const double cosine = abs(dot(at.n, out.L));
  if (!(cosine > 0)) return out;
  out.clear = clear_of_plane(out.r, cosine, size);
  out.density = density_by_area(frame, ids, at.n) * out.r * out.r / cosine;
  if (out.density > 0)
    out.radiance_over_density = (1 / out.density) * emission_at(frame, ids, at.Q, at.n, out.L);
  return out;
}

inline double density_of_surface(const Frame& frame, const HitIds<std::int32_t>& ids, const Vec3<double>& P,
                                 const Vec3<double>& Q, const Vec3<double>& G, const Vec3<double>& L) {
  const Geometry& g = frame.world.geometries[ids.geometry];
  if (is_ball(g, ids, P)) {
    const Sphere& s = g.spheres[ids.primitive];
    const Vec3<double> way = s.center - P;
    return ConeOfSphere<double>(dot(way, way), s.radius).density;
  }
  const Vec3<double> way = Q - P;
  const double cosine = abs(dot(G, L));
  return cosine > 0 ? density_by_area(frame, ids, G) * dot(way, way) / cosine : 0;
}

// ---- the background

/// Between which heights of the unit sphere a row of a picture around the scene lies.
struct Band {
  double top, bottom;
};
inline Band band_of_row(int row, int rows) {
  return {sincos_degrees(180.0 * row / rows).cos, sincos_degrees(180.0 * (row + 1) / rows).cos};
}
/// Of a cell in it, by Archimedes.
inline double solid_angle_of_cell(const Band& band, int columns) {
  return (2 * pi / columns) * (band.top - band.bottom);
}
/// The direction at that height, `along` the picture from its left to its right, 0 to 1. across: the root of
/// 1 - height^2.
inline Vec3<double> direction_in_picture(const EnvironmentRecord& environment, double along, double height,
                                         double across) {
  const auto [sine, cosine] = sincos_degrees(360 * (along - 0.5 - environment.turn));
  const Vec3<double> d{across * sine, height, -across * cosine};
  return environment.z_up ? Vec3<double>{d.x, -d.z, d.y} : d;
}

/// By the cell of the picture that is seen along a direction.
inline double density_of_environment(const Frame& frame, const Vec3<double>& along) {
  const EnvironmentChoice& e = frame.emitters->environment;
  double across;
  const Vec2<double> uv = environment_uv(frame.environment, along, across);
  const int x = min(int((uv.x - __builtin_floor(uv.x)) * e.width), e.width - 1),
            y = min(max(int((1 - uv.y) * e.height), 0), e.height - 1);
  const double* columns = e.columns + std::size_t(y) * std::size_t(e.width + 1);
  const double in_row = columns[e.width], row = e.rows[y + 1] - e.rows[y];
  if (!(in_row > 0)) return 0;
  const double share = (row / e.rows[e.height]) * ((columns[x + 1] - columns[x]) / in_row);
  return share / solid_angle_of_cell(band_of_row(y, e.height), e.width);
}

/// Where in a table of sums, which begins with 0 and has `count` steps, `at` of the last one lies: the step,
/// and how far in it.
inline int step_at(const double* sums, int count, double at, double& within) {
  const double value = at * sums[count];
  int low = 0, high = count;  // sums[low] <= value < sums[high], or high is the end
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    if (sums[middle] <= value) low = middle;
    else high = middle;
  }
  while (low > 0 && !(sums[low + 1] > sums[low])) --low;  // rounding: never a step that is none
  const double step = sums[low + 1] - sums[low];
  within = step > 0 ? min(max((value - sums[low]) / step, 0.0), below_one) : 0.5;
  return low;
}

inline Vec3<double> environment_direction(const Frame& frame, double u, double v) {
  const EnvironmentChoice& e = frame.emitters->environment;
  double down, right;
  const int y = step_at(e.rows, e.height, v, down);
  const int x = step_at(e.columns + std::size_t(y) * std::size_t(e.width + 1), e.width, u, right);
  const auto [top, bottom] = band_of_row(y, e.height);
  const double height = top + down * (bottom - top), across = sqrt(max(1 - height * height, 0.0));
  return direction_in_picture(frame.environment, (x + right) / e.width, height, across);
}

inline double density_of_background(const Frame& frame, const Vec3<double>& N, const Vec3<double>& L) {
  if (frame.emitters->environment.width > 0) return density_of_environment(frame, L);
  return dot(N, N) > 0 ? max(dot(N, L), 0.0) / pi : 1 / (4 * pi);
}

inline EmitterSample sample_background(const Frame& frame, const Vec3<double>& N, double u, double v) {
  EmitterSample out;
  out.light = frame.light_count + 1;
  out.r = out.clear = __builtin_inf();
  if (frame.emitters->environment.width > 0) {
    out.L = environment_direction(frame, u, v);
  } else if (dot(N, N) > 0) {
    // Malley's method: evenly over the disc, and up from there.
    const Vec2<double> at = on_disc(u, v);
    out.L = to_world(axes_around(N), {at.x, at.y, sqrt(max(1 - at.x * at.x - at.y * at.y, 0.0))});
  } else {
    const double z = 1 - 2 * v, across = sqrt(max(1 - z * z, 0.0));
    const auto [sine, cosine] = sincos_degrees(360 * u);
    out.L = {across * cosine, across * sine, z};
  }
  out.density = density_of_background(frame, N, out.L);
  if (out.density > 0) out.radiance_over_density = (1 / out.density) * background_along(frame, out.L, 0);
  return out;
}

}  // namespace detail

/// One emitter, chosen by `pick` in [0, 1) as it may light P, and a point or direction of it, chosen by u and
/// v in [0, 1).
///   N  the unit normal at P on which light is looked for: of what lies behind it nothing comes. Zero: light
///      counts from all around.
///   goes_on  whether a path goes on from P, too, as the densities below suppose
inline EmitterSample sample_emitters(const Frame& frame, const Vec3<double>& P, const Vec3<double>& N,
                                     double pick, double u, double v, bool goes_on = true) {
  const PickedLight picked = detail::pick_emitter(frame, P, N, pick, goes_on);
  if (picked.emitter < 0) return {};
  const Emitter& e = frame.emitters->emitters[picked.emitter];
  EmitterSample out = e.kind == EmitterKind::light     ? detail::sample_light(frame, e.light, P, u, v)
                      : e.kind == EmitterKind::surface ? detail::sample_surface(frame, e, P, u, v)
                                                       : detail::sample_background(frame, N, u, v);
  out.radiance_over_density = (1 / picked.probability) * out.radiance_over_density;
  out.density *= picked.probability;
  return out;
}

/// The density with which sample_emitters, asked at P with N, would have chosen what a ray along L has hit:
/// the primitive `ids` in the point Q with the geometric normal G (on either side). 0: never.
inline double emitter_density(const Frame& frame, const Vec3<double>& P, const Vec3<double>& N,
                              const HitIds<std::int32_t>& ids, const Vec3<double>& Q, const Vec3<double>& G,
                              const Vec3<double>& L) {
  const EmitterTable& table = *frame.emitters;
  const int light =
      frame.materials[material_of(frame.world, ids.instance, ids.geometry, ids.primitive)].light;
  std::int32_t emitter = -1;
  if (light >= 0) {
    emitter = table.emitter_of_light[light];
  } else {
    const std::int64_t first =
        ids.instance >= 0 ? table.first_of_instance[ids.instance] : table.first_of_geometry[ids.geometry];
    if (first >= 0) emitter = table.emitter_of[first + ids.primitive];
  }
  if (emitter < 0) return 0;
  const double density = light >= 0 ? detail::density_of_light(frame, light, P, Q)
                                    : detail::density_of_surface(frame, ids, P, Q, G, L);
  return density > 0 ? density * detail::probability_of_emitter(frame, emitter, P, N) : 0;
}

/// Likewise of the background, which a ray along L has reached.
inline double background_density(const Frame& frame, const Vec3<double>& P, const Vec3<double>& N,
                                 const Vec3<double>& L) {
  const std::int32_t emitter = frame.emitters->background;
  if (emitter < 0) return 0;
  return detail::density_of_background(frame, N, L) * detail::probability_of_emitter(frame, emitter, P, N);
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
