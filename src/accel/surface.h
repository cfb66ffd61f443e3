#pragma once
// The surface point that a ray has hit, in double: one function of ray and primitive, whoever found the hit
// and how.
//
// The queries find out which primitive is hit, in float. Here the double ray meets the double primitive
// again, so that a picture's numbers have 1e-15 of rounding in them, not 1e-7: in a highlight with shininess
// n the error of R.V counts n times.
//
// Rays that leave the point start a little off the surface: at P + offset * Ng, or - on the other side. The
// queries round that origin to float, each coordinate by u |coordinate| at the most (u = 2^-24), so `offset`
// is the smallest height that is sure to remain a height:
//   flat primitives      4u sum_i |Ng_i| |P_i|, and 2^-48 (largest coordinates of P and of the primitive) for
//   P's own rounding in
//                        double: the only term left where the sum vanishes, as for a floor at y = 0
//   spheres and cones    32u (largest coordinates of P and of the primitive + its size), which also covers
//   the rounding of the
//                        primitive and keeps the sign of the constant term of its quadratic, on which the
//                        tests of intersect.h rest
// and in an instance both, in its own space and in the world.

#include "accel/traverse.h"

namespace lambent {
inline namespace LAMBENT_ISA {

struct SurfacePoint {
  Vec3<double> P;
  Vec3<double> N;   ///< Unit shading normal, on Ng's side.
  Vec3<double> Ng;  ///< Unit geometric normal, towards the outside: a mesh's counter-clockwise side.
  Vec3<double>
      lift;  ///< From P to the smooth surface that the vertex normals suggest; zero where there are none.
  double t;  ///< Distance along the ray.
  double offset;  ///< Scene units.
  std::uint32_t material;
};

namespace detail {

inline constexpr double u = 0x1p-24;

inline double sum_of_abs_products(const Vec3<double>& a, const Vec3<double>& b) {
  return abs(a.x * b.x) + abs(a.y * b.y) + abs(a.z * b.z);
}

/// The offset of a flat primitive at P; `size`: the largest coordinate of the primitive.
inline double flat_offset(const Vec3<double>& Ng, const Vec3<double>& P, double size) {
  return 4 * u * sum_of_abs_products(Ng, P) + 0x1p-48 * (max_abs(P) + size);
}

inline void triangle_point(const Geometry& g, std::int32_t primitive, const Vec3<double>& o,
                           const Vec3<double>& d, double t_found, SurfacePoint& s) {
  const std::uint32_t* v = reinterpret_cast<const std::uint32_t*>(g.triangles) + 3 * std::size_t(primitive);
  const Vec3<double> p[3] = {cast<double>(g.vertices[v[0]]), cast<double>(g.vertices[v[1]]),
                             cast<double>(g.vertices[v[2]])};
  const Vec3<double> e1 = p[1] - p[0], e2 = p[2] - p[0], n = cross(e1, e2);
  const double nn = dot(n, n), slope = dot(n, d),
               size = max(max(max_abs(p[0]), max_abs(p[1])), max_abs(p[2]));
  if (!(nn > 0)) {  // no area in double, though float's rounding gave it some
    s.t = t_found;
    s.P = o + t_found * d;
    s.N = s.Ng = -normalize(d);
    s.offset = flat_offset(s.Ng, s.P, size);
    return;
  }
  const double t_plane = dot(n, p[0] - o) / slope;
  const Vec3<double> q = o + (slope == 0 ? t_found : t_plane) * d - p[0];
  // A ray that grazes may leave the triangle between float and double: hold it inside.
  const double b1 = min(max(dot(cross(q, e2), n) / nn, 0.0), 1.0),
               b2 = min(max(dot(cross(e1, q), n) / nn, 0.0), 1.0 - b1);
  const double b[3] = {1 - b1 - b2, b1, b2};
  s.P = p[0] + (b1 * e1 + b2 * e2);
  s.t = dot(s.P - o, d) / dot(d, d);
  s.Ng = (g.flipped ? -1.0 : 1.0) / sqrt(nn) * n;
  s.N = s.Ng;
  s.offset = flat_offset(s.Ng, s.P, size);
  if (!g.normals) return;
  Vec3<double> N{}, lift{};
  for (int i = 0; i < 3; ++i) {
    const Vec3<double> ni = cast<double>(g.normals[v[i]]);
    if (dot(ni, ni) == 0) return;  // a corner without a normal: the face is flat
    N = N + b[i] * ni;
    // Hanika, Hacking the shadow terminator, Ray Tracing Gems II, 2021: lift P to the corners' tangent
    // planes.
    const double side = dot(ni, s.Ng) < 0 ? -1.0 : 1.0;
    lift = lift - (b[i] * min(0.0, side * dot(s.P - p[i], ni)) * side) * ni;
  }
  if (!(dot(N, N) > 1e-12)) return;
  N = normalize(N);
  s.N = dot(N, s.Ng) < 0 ? -N : N;
  s.lift = lift;
}

inline void sphere_point(const Sphere& sphere, const Vec3<double>& o, const Vec3<double>& d, double t_found,
                         SurfacePoint& s) {
  const Vec3<double> f = o - sphere.center;
  const double a = dot(d, d), middle = -dot(f, d) / a;
  const Vec3<double> l = f + middle * d;
  const double half = sqrt(max(sphere.radius * sphere.radius - dot(l, l), 0.0) / a);
  s.t = abs(middle - half - t_found) <= abs(middle + half - t_found) ? middle - half : middle + half;
  s.Ng = s.N = normalize(f + s.t * d);
  s.P = sphere.center + sphere.radius * s.Ng;
  s.offset = 32 * u * (max_abs(s.P) + max_abs(sphere.center) + sphere.radius);
}

inline void cone_point(const PlacedCone& cone, const Vec3<double>& o, const Vec3<double>& d, double t_found,
                       SurfacePoint& s) {
  // As meet_cone, from the origin next to the middle of the cone.
  const double slide = -dot(o - (cone.base + 0.5 * cone.height * cone.axis), d) / dot(d, d);
  const Vec3<double> f = o + slide * d - cone.base;
  const double fz = dot(f, cone.axis), dz = dot(d, cone.axis), at_f = cone.radius + cone.slope * fz;
  const Vec3<double> fp = f - fz * cone.axis, dp = d - dz * cone.axis;
  const double A = dot(dp, dp) - cone.slope * cone.slope * (dz * dz),
               B = cone.slope * dz * at_f - dot(fp, dp), C = dot(fp, fp) - at_f * at_f;
  const double root = sqrt(max(B * B - A * C, 0.0)), q = B + (B < 0 ? -root : root);
  const double t0 = C / q + slide, t1 = q / A + slide;
  s.t = t_found;
  if (abs(t0 - t_found) < __builtin_inf()) s.t = t0;
  if (abs(t1 - t_found) < abs(s.t - t_found) || !(abs(t0 - t_found) < __builtin_inf()))
    s.t = abs(t1) < __builtin_inf() ? t1 : s.t;
  s.P = o + s.t * d;
  const Vec3<double> from_base = s.P - cone.base;
  const double z = dot(from_base, cone.axis);
  const Vec3<double> gradient =
      from_base - z * cone.axis - (cone.slope * (cone.radius + cone.slope * z)) * cone.axis;
  s.Ng = s.N =
      dot(gradient, gradient) > 0 ? normalize(gradient) : cone.axis;  // the tip has no normal of its own
  s.offset = 32 * u *
             (max_abs(s.P) + max_abs(cone.base) + cone.height +
              max(cone.radius, cone.radius + cone.slope * cone.height));
}

inline void plane_point(const Vec3<double>& point, const Vec3<double>& normal, const Vec3<double>& o,
                        const Vec3<double>& d, double t_found, SurfacePoint& s) {
  const double slope = dot(normal, d), t = dot(normal, point - o) / slope;
  s.t = slope == 0 ? t_found : t;
  const Vec3<double> q = o + s.t * d;
  s.P = q - dot(normal, q - point) * normal;  // q is off the plane by the rounding of t d
  s.Ng = s.N = normal;
  s.offset = flat_offset(s.Ng, s.P, max_abs(point));
}

}  // namespace detail

/// The point where the ray o + t d (d of unit length) meets the primitive that a query named.
///   t_found  the query's distance, to choose between the roots of curved primitives
inline SurfacePoint surface_at(const WorldView& world, const HitIds<std::int32_t>& ids, const Vec3<double>& o,
                               const Vec3<double>& d, double t_found) {
  const Geometry& g = world.geometries[ids.geometry];
  const Instance* instance = ids.instance >= 0 ? &world.instances[ids.instance] : nullptr;
  const Vec3<double> local_o = instance ? transform_point(instance->object_from_world, o) : o;
  const Vec3<double> local_d = instance ? transform_vector(instance->object_from_world, d) : d;
  SurfacePoint s{};
  switch (g.kind) {
    case PrimitiveKind::triangle:
      detail::triangle_point(g, ids.primitive, local_o, local_d, t_found, s);
      break;
    case PrimitiveKind::sphere:
      detail::sphere_point(g.spheres[ids.primitive], local_o, local_d, t_found, s);
      break;
    case PrimitiveKind::cone:
      detail::cone_point(g.cones[ids.primitive], local_o, local_d, t_found, s);
      break;
    case PrimitiveKind::disc:
      detail::plane_point(g.discs[ids.primitive].center, g.discs[ids.primitive].normal, local_o, local_d,
                          t_found, s);
      break;
    case PrimitiveKind::plane:
      detail::plane_point(g.planes[ids.primitive].point, g.planes[ids.primitive].normal, local_o, local_d,
                          t_found, s);
      break;
    case PrimitiveKind::instance:
      __builtin_unreachable();
  }
  s.material = material_of(world, ids.instance, ids.geometry, ids.primitive);
  if (!instance) return s;
  const Vec3<double> normal = transform_normal(instance->object_from_world, s.Ng);
  s.P = transform_point(instance->world_from_object, s.P);
  s.offset = s.offset / length(normal);  // a height of 1 there is one of 1 / |normal| here
  s.Ng = normalize(normal);
  s.offset = s.offset + detail::flat_offset(s.Ng, s.P, max_abs(instance->world_from_object.translation));
  s.N = normalize(transform_normal(instance->object_from_world, s.N));
  s.lift = transform_vector(instance->world_from_object, s.lift);
  return s;
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
