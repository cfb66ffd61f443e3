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
#include "math/transform.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// What a hit is, seen closely. F: a double, or a packet of them.
template <class F> struct SurfacePoint {
  Vec3<F> P;
  Vec3<F> N;     ///< Unit shading normal, on Ng's side.
  Vec3<F> Ng;    ///< Unit geometric normal, towards the outside: a mesh's counter-clockwise side.
  Vec3<F> lift;  ///< From P to the smooth surface that the vertex normals suggest, on the side that the ray
                 ///< comes from; zero where that surface lies behind P, or where there is none.
  F t;           ///< Distance along the ray.
  F offset;      ///< Scene units.
};

namespace detail {

inline constexpr double u = 0x1p-24;

template <class F> F sum_of_abs_products(const Vec3<F>& a, const Vec3<F>& b) {
  return abs(a.x * b.x) + abs(a.y * b.y) + abs(a.z * b.z);
}

/// The offset of a flat primitive at P; `size`: the largest coordinate of the primitive.
template <class F> F flat_offset(const Vec3<F>& Ng, const Vec3<F>& P, const F& size) {
  return F(4 * u) * sum_of_abs_products(Ng, P) + F(0x1p-48) * (max_abs(P) + size);
}

/// The lanes' primitives: value(k) of each, but value(0) for all where they are `one`, which is soon done.
struct Gathering {
  bool one;

  template <class F, class Value> F numbers(const Value& value) const {
    if (one) return F(value(0));
    return gather<F>(value);
  }
  template <class F, class Value> Vec3<F> points(const Value& value) const {
    if (one) return broadcast<F>(value(0));
    return gather_points<F>(value);
  }
  /// That stand in memory as floats.
  template <class F, class Value> Vec3<F> float_points(const Value& value) const {
    if (one) return broadcast<F>(cast<double>(value(0)));
    return gather_float_points<F>(value);
  }
};

/// The instances of the lanes.
template <class F> struct Placing { TransformOf<F> world_from_object, object_from_world; };

/// Corners of the lanes' triangles, and where P lies between them.
template <class F> struct Barycentric {
  Vec3<F> p[3];
  F b[3];
  MaskOf<F> valid;  ///< False where the triangle has no area in double.
};

/// Where the lanes' corners stand in memory, and their vertex normals: zero where there are none.
template <int Lanes> struct TriangleCorners {
  const Vec3<float>*point[3][Lanes], *normal[3][Lanes];
  Gathering gathering;
  bool any_normals = false;

  TriangleCorners(const Geometry* const* g, const std::int32_t* primitive, Gathering of) : gathering(of) {
    static constexpr Vec3<float> none{0, 0, 0};
    for (int k = 0; k < (of.one ? 1 : Lanes); ++k) {
      const auto& corner = corners(*g[k], primitive[k]);
      const Vec3<float>* const normals = g[k]->normals;
      any_normals |= normals != nullptr;
      for (int i = 0; i < 3; ++i) {
        point[i][k] = g[k]->vertices + corner[i];
        normal[i][k] = normals ? normals + corner[i] : &none;
      }
    }
  }
};

template <class F>
void triangle_point(const Geometry* const* g, const TriangleCorners<lanes_of<F>>& corners, const Vec3<F>& o,
                    const Vec3<F>& d, const F& t_found, SurfacePoint<F>& s, Barycentric<F>& at) {
  const F zero(0), one(1);
  for (int i = 0; i < 3; ++i)
    at.p[i] = corners.gathering.template float_points<F>(
        [&](int k) -> const Vec3<float>& { return *corners.point[i][k]; });
  const auto& p = at.p;
  const Vec3<F> e1 = p[1] - p[0], e2 = p[2] - p[0], n = cross(e1, e2);
  const F nn = dot(n, n), slope = dot(n, d), size = max(max(max_abs(p[0]), max_abs(p[1])), max_abs(p[2]));
  const F t_plane = select(slope == zero, t_found, dot(n, p[0] - o) / slope);
  const Vec3<F> q = o + t_plane * d - p[0];
  // A ray that grazes may leave the triangle between float and double: hold it inside.
  const F inverse_nn = one / nn;
  const F b1 = min(max(dot(cross(q, e2), n) * inverse_nn, zero), one),
          b2 = min(max(dot(cross(e1, q), n) * inverse_nn, zero), one - b1);
  s.P = p[0] + (b1 * e1 + b2 * e2);
  s.t = dot(s.P - o, d) / dot(d, d);
  const F outside = corners.gathering.template numbers<F>([&](int k) { return g[k]->flipped ? -1.0 : 1.0; });
  s.Ng = (outside / sqrt(nn)) * n;
  const auto flat = !(nn > zero);  // no area in double, though float's rounding gave it some
  if (any(MaskOf<F>(flat))) {
    s.P = select(flat, o + t_found * d, s.P);
    s.t = select(flat, t_found, s.t);
    s.Ng = select(flat, -normalize(d), s.Ng);
  }
  s.N = s.Ng;
  s.offset = flat_offset(s.Ng, s.P, size);
  at.b[0] = one - b1 - b2, at.b[1] = b1, at.b[2] = b2;
  at.valid = MaskOf<F>(!flat);
}

/// The shading normal and the lift of points on triangles with vertex normals. Both are made in the world: a
/// stretched object is shaded as if its corners had been taken into the world first.
template <class F>
void smooth_triangle(const TriangleCorners<lanes_of<F>>& corners, const Barycentric<F>& at,
                     const Placing<F>* placing, const Vec3<F>& d, SurfacePoint<F>& s) {
  const F zero(0), one(1);
  const Vec3<F> G = select(dot(s.Ng, d) <= zero, s.Ng, -s.Ng);
  Vec3<F> N{zero, zero, zero}, lift{zero, zero, zero};
  MaskOf<F> smooth = at.valid;
  for (int i = 0; i < 3; ++i) {
    Vec3<F> ni = corners.gathering.template float_points<F>(
        [&](int k) -> const Vec3<float>& { return *corners.normal[i][k]; });
    Vec3<F> p = at.p[i];
    smooth = both(smooth, MaskOf<F>(dot(ni, ni) > zero));  // a corner without a normal: the face is flat
    if (placing) {
      ni = normalize(transform_normal(placing->object_from_world, ni));
      p = transform_point(placing->world_from_object, p);
    }
    N = N + at.b[i] * ni;
    // Hanika, Hacking the shadow terminator, Ray Tracing Gems II, 2021: lift P to the corners' tangent
    // planes.
    const F side = select(dot(ni, G) < zero, -one, one);
    lift = lift - (at.b[i] * min(zero, side * dot(s.P - p, ni)) * side) * ni;
  }
  const F NN = dot(N, N);
  smooth = both(smooth, MaskOf<F>(NN > F(1e-12)));
  N = (one / sqrt(NN)) * N;
  s.N = select(smooth, select(dot(N, s.Ng) < zero, -N, N), s.N);
  s.lift = select(smooth, lift, s.lift);
}

template <class F>
void sphere_point(const Geometry* const* g, const std::int32_t* primitive, Gathering gathering,
                  const Vec3<F>& o, const Vec3<F>& d, const F& t_found, SurfacePoint<F>& s) {
  const auto sphere = [&](int k) -> const Sphere& { return g[k]->spheres[primitive[k]]; };
  const Vec3<F> center = gathering.points<F>([&](int k) -> const Vec3<double>& { return sphere(k).center; });
  const F radius = gathering.numbers<F>([&](int k) { return sphere(k).radius; });
  const Vec3<F> f = o - center;
  const F a = dot(d, d), middle = -dot(f, d) / a;
  const Vec3<F> l = f + middle * d;
  const F half = sqrt(max(radius * radius - dot(l, l), F(0)) / a);
  const F nearer = middle - half, farther = middle + half;
  s.t = select(abs(nearer - t_found) <= abs(farther - t_found), nearer, farther);
  s.Ng = s.N = normalize(f + s.t * d);
  s.P = center + radius * s.Ng;
  s.offset = F(32 * u) * (max_abs(s.P) + max_abs(center) + radius);
}

template <class F>
void cone_point(const Geometry* const* g, const std::int32_t* primitive, Gathering gathering,
                const Vec3<F>& o, const Vec3<F>& d, const F& t_found, SurfacePoint<F>& s) {
  const auto cone = [&](int k) -> const PlacedCone& { return g[k]->cones[primitive[k]]; };
  const Vec3<F> base = gathering.points<F>([&](int k) -> const Vec3<double>& { return cone(k).base; }),
                axis = gathering.points<F>([&](int k) -> const Vec3<double>& { return cone(k).axis; });
  const F height = gathering.numbers<F>([&](int k) { return cone(k).height; }),
          radius = gathering.numbers<F>([&](int k) { return cone(k).radius; }),
          slope = gathering.numbers<F>([&](int k) { return cone(k).slope; });
  const F zero(0), infinity(__builtin_inf());
  // As meet_cone, from the origin next to the middle of the cone.
  const F slide = -dot(o - (base + F(0.5) * height * axis), d) / dot(d, d);
  const Vec3<F> f = o + slide * d - base;
  const F fz = dot(f, axis), dz = dot(d, axis), at_f = radius + slope * fz;
  const Vec3<F> fp = f - fz * axis, dp = d - dz * axis;
  const F A = dot(dp, dp) - slope * slope * (dz * dz), B = slope * dz * at_f - dot(fp, dp),
          C = dot(fp, fp) - at_f * at_f;
  const F root = sqrt(max(B * B - A * C, zero)), q = B + select(B < zero, -root, root);
  const F t0 = C / q + slide, t1 = q / A + slide;
  // The root next to what the query found; what is not finite is not a root.
  const F miss0 = abs(t0 - t_found), miss1 = abs(t1 - t_found);
  s.t = select(miss0 < infinity, t0, t_found);
  s.t = select(both(miss1 < infinity, either(MaskOf<F>(!(miss0 < infinity)), miss1 < miss0)), t1, s.t);
  s.P = o + s.t * d;
  const Vec3<F> from_base = s.P - base;
  const F z = dot(from_base, axis);
  const Vec3<F> gradient = from_base - z * axis - (slope * (radius + slope * z)) * axis;
  const F size = dot(gradient, gradient);
  s.Ng = s.N = select(size > zero, (F(1) / sqrt(size)) * gradient, axis);  // the tip has no normal of its own
  s.offset = F(32 * u) * (max_abs(s.P) + max_abs(base) + height + max(radius, radius + slope * height));
}

template <class F>
void plane_point(const Vec3<F>& point, const Vec3<F>& normal, const Vec3<F>& o, const Vec3<F>& d,
                 const F& t_found, SurfacePoint<F>& s) {
  const F slope = dot(normal, d);
  s.t = select(slope == F(0), t_found, dot(normal, point - o) / slope);
  const Vec3<F> q = o + s.t * d;
  s.P = q - dot(normal, q - point) * normal;  // q is off the plane by the rounding of t d
  s.Ng = s.N = normal;
  s.offset = flat_offset(s.Ng, s.P, max_abs(point));
}

}  // namespace detail

/// The point where the ray o + t d (d of unit length) meets the primitive that a query named. All lanes of a
/// packet must have met the same kind of primitive, all or none of them in instances.
///   t_found  the query's distance, to choose between the roots of curved primitives
template <class F>
SurfacePoint<F> surface_at(const WorldView& world, const HitIds<const std::int32_t*>& ids, const Vec3<F>& o,
                           const Vec3<F>& d, const F& t_found) {
  constexpr int lanes = lanes_of<F>;
  const std::int32_t* primitive = ids.primitive;
  const detail::Gathering gathering{all_equal<lanes>(primitive) && all_equal<lanes>(ids.geometry) &&
                                    all_equal<lanes>(ids.instance)};
  const Geometry* g[lanes];
  for (int k = 0; k < lanes; ++k) g[k] = &world.geometries[ids.geometry[k]];

  // In the space of the primitives.
  const bool placed = ids.instance[0] >= 0;
  detail::Placing<F> placing;
  Vec3<F> o_there = o, d_there = d;
  if (placed) {
    const auto instance = [&](int k) -> const Instance& { return world.instances[ids.instance[k]]; };
    placing = {gather_transform<F>([&](int k) -> const Transform& { return instance(k).world_from_object; }),
               gather_transform<F>([&](int k) -> const Transform& { return instance(k).object_from_world; })};
    o_there = transform_point(placing.object_from_world, o);
    d_there = transform_vector(placing.object_from_world, d);
  }

  SurfacePoint<F> s;
  s.lift = {F(0), F(0), F(0)};
  const auto into_the_world = [&] {
    if (!placed) return;
    const Vec3<F> normal = transform_normal(placing.object_from_world, s.Ng);
    s.P = transform_point(placing.world_from_object, s.P);
    s.offset = s.offset / length(normal);  // a height of 1 there is one of 1 / |normal| here
    s.N = s.Ng = normalize(normal);
    s.offset = s.offset + detail::flat_offset(s.Ng, s.P, max_abs(placing.world_from_object.translation));
  };
  switch (g[0]->kind) {
    case PrimitiveKind::triangle: {
      const detail::TriangleCorners<lanes> corners(g, primitive, gathering);
      detail::Barycentric<F> at;
      detail::triangle_point(g, corners, o_there, d_there, t_found, s, at);
      into_the_world();
      if (corners.any_normals) detail::smooth_triangle(corners, at, placed ? &placing : nullptr, d, s);
      return s;
    }
    case PrimitiveKind::sphere:
      detail::sphere_point(g, primitive, gathering, o_there, d_there, t_found, s);
      break;
    case PrimitiveKind::cone:
      detail::cone_point(g, primitive, gathering, o_there, d_there, t_found, s);
      break;
    case PrimitiveKind::disc:
      detail::plane_point(
          gathering.points<F>([&](int k) -> const Vec3<double>& { return g[k]->discs[primitive[k]].center; }),
          gathering.points<F>([&](int k) -> const Vec3<double>& { return g[k]->discs[primitive[k]].normal; }),
          o_there, d_there, t_found, s);
      break;
    case PrimitiveKind::plane:
      detail::plane_point(
          gathering.points<F>([&](int k) -> const Vec3<double>& { return g[k]->planes[primitive[k]].point; }),
          gathering.points<F>(
              [&](int k) -> const Vec3<double>& { return g[k]->planes[primitive[k]].normal; }),
          o_there, d_there, t_found, s);
      break;
    case PrimitiveKind::instance:
      __builtin_unreachable();
  }
  into_the_world();
  return s;
}
inline SurfacePoint<double> surface_at(const WorldView& world, const HitIds<std::int32_t>& ids,
                                       const Vec3<double>& o, const Vec3<double>& d, double t_found) {
  return surface_at<double>(world, {&ids.instance, &ids.geometry, &ids.primitive}, o, d, t_found);
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
