#pragma once
// Where a ray meets a primitive: one test for each kind, in float, for one ray or a packet.
//
// A test answers with a distance t in units of the ray's direction, or with "no hit". Two promises hold for
// each kind:
//
//   * A hit is reported only where t > 0 is certain in spite of rounding. Together with origins that stand
//   off their
//     surface by the bound of surface.h, this makes it impossible that a ray hits the surface it starts from.
//   * The answer depends on ray and primitive alone. The same test gives the same bits in every lane of a
//   packet.
//
// Triangles are watertight besides: no ray passes between two that share an edge or a corner.
//
// u = 2^-24 is the largest relative error of one float operation; a sum of n such errors is bounded by n u /
// (1 - n u).

#include "accel/world.h"
#include "math/gather.h"
#include "math/pack.h"

namespace lambent {
inline namespace LAMBENT_ISA {

inline constexpr float unit_roundoff = 0x1p-24f;

template <class F> Vec3<F> spread(const Vec3<float>& v) { return {F(v.x), F(v.y), F(v.z)}; }
template <class F> Vec3<F> spread(const Vec3<double>& v) {
  return {F(float(v.x)), F(float(v.y)), F(float(v.z))};
}

/// The ray in the float arithmetic of the queries. |d| is 1 up to rounding (or the scale of an instance).
/// With it stands what the tests of boxes, triangles and spheres want of it: for triangles the axis along
/// which the ray moves most, and the shear that lays the ray along that axis.
template <class F> struct QueryRay {
  Vec3<F> o, d;
  Vec3<F> inverse_d;           ///< 1 / d, but finite.
  F inverse_square;            ///< 1 / d.d
  MaskOf<F> along_x, along_y;  ///< Neither: along z.
  int axis = -1;               ///< 0, 1, 2 where it is the same in all lanes; -1 where it is not.
  F shear_x, shear_y, scale;

  QueryRay() = default;
  QueryRay(const QueryRay&) = default;
  QueryRay& operator=(const QueryRay&) = default;
  QueryRay(const Vec3<F>& origin, const Vec3<F>& direction) : o(origin), d(direction) {
    const F tiny = F(1e-18f) * max_abs(d);
    inverse_d = {invert(d.x, tiny), invert(d.y, tiny), invert(d.z, tiny)};
    inverse_square = F(1.f) / dot(d, d);
    const F x = abs(d.x), y = abs(d.y), z = abs(d.z);
    along_x = both(x > y, x > z);
    along_y = both(MaskOf<F>(!along_x), y > z);
    if (all(along_x)) axis = 0;
    else if (all(along_y)) axis = 1;
    else if (!any(either(along_x, along_y))) axis = 2;
    const Vec3<F> p = permute(d);
    scale = permute(inverse_d).z;
    shear_x = p.x * scale;
    shear_y = p.y * scale;
  }
  /// A ray that hardly moves along an axis is inside of a slab (t from -large to large) or beside it.
  static F invert(F d, F tiny) {
    const F away_from_zero = select(abs(d) < tiny, select(d < F(0.f), -tiny, tiny), d);
    return F(1.f) / away_from_zero;
  }
  /// v with its axes turned (x to y to z to x) so that z is the one the ray moves along most.
  Vec3<F> permute(const Vec3<F>& v) const {
    if (axis == 2) return v;
    if (axis == 0) return {v.y, v.z, v.x};
    if (axis == 1) return {v.z, v.x, v.y};
    return {select(along_x, v.y, select(along_y, v.z, v.x)), select(along_x, v.z, select(along_y, v.x, v.y)),
            select(along_x, v.x, select(along_y, v.y, v.z))};
  }
};

/// The ray of lane k in every lane.
template <class Into, class F> QueryRay<Into> spread_lane(const QueryRay<F>& rays, int k) {
  const auto spread_of = [k](const Vec3<F>& v) { return spread<Into>(lane(v, k)); };
  QueryRay<Into> one;
  one.o = spread_of(rays.o), one.d = spread_of(rays.d), one.inverse_d = spread_of(rays.inverse_d);
  one.inverse_square = lane(rays.inverse_square, k);
  const bool along_x = lane(rays.along_x, k), along_y = lane(rays.along_y, k);
  one.along_x = MaskOf<Into>(along_x), one.along_y = MaskOf<Into>(along_y);
  one.axis = along_x ? 0 : along_y ? 1 : 2;
  one.shear_x = lane(rays.shear_x, k), one.shear_y = lane(rays.shear_y, k), one.scale = lane(rays.scale, k);
  return one;
}

/// The ray of lane k alone.
template <class F> QueryRay<float> lane(const QueryRay<F>& rays, int k) {
  return spread_lane<float>(rays, k);
}

/// A distance and whether it is one.
template <class F> struct Meeting {
  F t;
  MaskOf<F> hit;
};

/// a.x b.y - a.y b.x, with the right sign or zero: rounding each product keeps their order.
template <class F> F edge(const Vec3<F>& a, const Vec3<F>& b) { return a.x * b.y - a.y * b.x; }

/// Where `edge` has found zero it is taken again in double, which holds products of floats exactly.
template <class F> F exact_edge(F found, const Vec3<F>& a, const Vec3<F>& b) {
  for (int i = 0; i < lanes_of<F>; ++i)
    if (lane(found, i) == 0)
      set_lane(
          found, i,
          float(double(lane(a.x, i)) * double(lane(b.y, i)) - double(lane(a.y, i)) * double(lane(b.x, i))));
  return found;
}

/// A triangle laid into the plane across a ray, which there is the origin: its corners, and what its edges
/// span with the ray. Each corner is laid there by itself, the same whatever triangle it belongs to.
template <class F> struct TriangleAcross {
  Vec3<F> a, b, c;
  F U, V, W;

  TriangleAcross(const QueryRay<F>& ray, const Vec3<F>& p0, const Vec3<F>& p1, const Vec3<F>& p2)
      : a(ray.permute(p0 - ray.o)), b(ray.permute(p1 - ray.o)), c(ray.permute(p2 - ray.o)) {
    a.x = a.x - ray.shear_x * a.z, a.y = a.y - ray.shear_y * a.z;
    b.x = b.x - ray.shear_x * b.z, b.y = b.y - ray.shear_y * b.z;
    c.x = c.x - ray.shear_x * c.z, c.y = c.y - ray.shear_y * c.z;
    U = edge(b, c), V = edge(c, a), W = edge(a, b);
  }
  /// Where the ray is inside of the triangle, and some more, as a zero passes for either sign.
  MaskOf<F> inside() const {
    const F zero(0.f);
    return either(min(min(U, V), W) >= zero, max(max(U, V), W) <= zero);
  }
};

/// Whether any ray can meet the triangle: false only where meet_triangle finds no hit, and sooner.
template <class F>
bool may_meet_triangle(const QueryRay<F>& ray, const Vec3<F>& p0, const Vec3<F>& p1, const Vec3<F>& p2) {
  return any(TriangleAcross<F>(ray, p0, p1, p2).inside());
}

/// Triangle p0 p1 p2, both sides: Woop, Benthin and Wald, Watertight ray/triangle intersection, JCGT 2(1),
/// 2013. What the edges span with the ray has an exact sign: a ray cannot pass between two triangles, nor
/// through their common corner. One triangle for all rays of a packet, or one for each.
template <class F>
Meeting<F> meet_triangle(const QueryRay<F>& ray, const Vec3<F>& p0, const Vec3<F>& p1, const Vec3<F>& p2) {
  const F zero(0.f);
  TriangleAcross<F> across(ray, p0, p1, p2);
  auto& [a, b, c, U, V, W] = across;
  MaskOf<F> hit = across.inside();
  if (!any(hit)) return {zero, hit};
  if (any(both(hit, either(either(U == zero, V == zero), W == zero)))) {
    U = exact_edge(U, b, c), V = exact_edge(V, c, a), W = exact_edge(W, a, b);
    hit = across.inside();
  }
  const F area = U + V + W;
  const F t = (U * a.z + V * b.z + W * c.z) / area * ray.scale;

  // On which side of the plane does the ray start? n is off by 3u in each product, v0 by u, the dot product
  // by 3u more: the error is at most 8u of the sum of the absolute products. n.d has the sign of area /
  // scale.
  const Vec3<F> v0 = p0 - ray.o, e1 = p1 - p0, e2 = p2 - p0, n = cross(e1, e2);
  const F height = dot(v0, n);
  const Vec3<F> size{abs(e1.y * e2.z) + abs(e1.z * e2.y), abs(e1.z * e2.x) + abs(e1.x * e2.z),
                     abs(e1.x * e2.y) + abs(e1.y * e2.x)};
  const F bound = F(8 * unit_roundoff) * (abs(v0.x) * size.x + abs(v0.y) * size.y + abs(v0.z) * size.z);
  const MaskOf<F> ahead =
      select(either(both(area > zero, ray.scale > zero), both(area < zero, ray.scale < zero)), height,
             -height) > bound;
  return {t, both(hit, ahead, t > zero, t < F(__builtin_inff()))};
}

/// Sphere, both sides. The discriminant is taken where the ray passes the centre, as the origin may be far
/// away (Haines, Guenther, Akenine-Moeller, Ray Tracing Gems, 2019, chapter 7); the nearer root as c / q,
/// which keeps the sign of c.
template <class F> Meeting<F> meet_sphere(const QueryRay<F>& ray, const Vec3<F>& center, F radius) {
  const F zero(0.f), r2 = radius * radius;
  const Vec3<F> f = ray.o - center;
  const F b = -dot(f, ray.d);
  const Vec3<F> l = f + (b * ray.inverse_square) * ray.d;
  const F discriminant = r2 - dot(l, l);
  MaskOf<F> hit = discriminant >= zero;
  if (!any(hit)) return {zero, hit};
  const F c = dot(f, f) - r2;
  const F root = sqrt(max(discriminant, zero) * dot(ray.d, ray.d));
  const F q = b + select(b < zero, -root, root);
  // q = 0 only where the ray starts at its closest approach on the sphere: t0 is then NaN or infinite, and no
  // hit.
  const F t0 = c / q, t1 = q * ray.inverse_square;
  const F near = min(t0, t1), far = max(t0, t1);
  const F t = select(near > zero, near, far);
  return {t, both(hit, t > zero, t < F(__builtin_inff()))};
}

/// The side of a cone or cylinder, both sides, open at the ends. With f the origin and everything split into
/// a part along the axis (z) and across it, |f + t d|^2 = (radius + slope (fz + t dz))^2 is quadratic in t.
template <class F> Meeting<F> meet_cone(const QueryRay<F>& ray, const PlacedCone& cone) {
  const F zero(0.f), slope(float(cone.slope)), radius(float(cone.radius)), height(float(cone.height));
  const Vec3<F> axis = spread<F>(cone.axis);
  const Vec3<F> f = ray.o - spread<F>(cone.base);
  const F fz = dot(f, axis), dz = dot(ray.d, axis);
  const Vec3<F> fp = f - fz * axis, dp = ray.d - dz * axis;
  const F A = dot(dp, dp) - slope * slope * (dz * dz);
  const F at_f = radius + slope * fz;
  const F B = slope * dz * at_f - dot(fp, dp);  // A t^2 - 2 B t + C = 0
  const F C = dot(fp, fp) - at_f * at_f;
  // The discriminant does not change when the origin slides along the ray: take it nearest to the middle of
  // the cone.
  const F s = -dot(f - F(0.5f) * height * axis, ray.d) / dot(ray.d, ray.d);
  const F gz = fz + s * dz;
  const Vec3<F> gp = fp + s * dp;
  const F at_g = radius + slope * gz;
  const F Bs = slope * dz * at_g - dot(gp, dp);
  const F Cs = dot(gp, gp) - at_g * at_g;
  const F discriminant = Bs * Bs - A * Cs;
  MaskOf<F> hit = discriminant >= zero;
  if (!any(hit)) return {zero, hit};
  const F root = sqrt(max(discriminant, zero));
  const F q = B + select(B < zero, -root, root);
  const F t0 = C / q, t1 = q / A;
  // The ends count in, and a little more, so that a cap and its side leave no gap.
  const F slack = F(8 * unit_roundoff) * (abs(fz) + height);
  const auto valid = [&](F t) {
    const F z = fz + t * dz;
    return both(t > zero, t < F(__builtin_inff()), z >= -slack, z <= height + slack);
  };
  const F near = select(t0 < t1, t0, t1), far = select(t0 < t1, t1, t0);
  const MaskOf<F> near_hit = valid(near), far_hit = valid(far);
  return {select(near_hit, near, far), both(hit, either(near_hit, far_hit))};
}

/// The plane through a point with a unit normal, both sides.
template <class F>
Meeting<F> meet_plane(const QueryRay<F>& ray, const Vec3<F>& point, const Vec3<F>& normal) {
  const Vec3<F> v = point - ray.o;
  const F height = dot(v, normal), slope = dot(normal, ray.d);
  // normal and v are off by u each, the dot product by 3u; as for the triangle.
  const F bound = F(8 * unit_roundoff) * (abs(v.x * normal.x) + abs(v.y * normal.y) + abs(v.z * normal.z));
  const F t = height / slope;
  return {t, both(abs(height) > bound, t > F(0.f), t < F(__builtin_inff()))};
}

template <class F>
Meeting<F> meet_disc(const QueryRay<F>& ray, const Vec3<F>& center, const Vec3<F>& normal, F radius) {
  Meeting<F> m = meet_plane(ray, center, normal);
  const Vec3<F> across = ray.o + m.t * ray.d - center;
  m.hit = both(m.hit, dot(across, across) <= radius * radius);
  return m;
}

/// The three vertices of a triangle.
inline const std::uint32_t* corners(const Geometry& g, std::int32_t triangle) {
  return reinterpret_cast<const std::uint32_t*>(g.triangles) + 3 * std::size_t(triangle);
}

/// Any primitive but an instance.
template <class F> Meeting<F> meet(const Geometry& g, std::int32_t primitive, const QueryRay<F>& ray) {
  switch (g.kind) {
    case PrimitiveKind::triangle: {
      const std::uint32_t* v = corners(g, primitive);
      return meet_triangle(ray, spread<F>(g.vertices[v[0]]), spread<F>(g.vertices[v[1]]),
                           spread<F>(g.vertices[v[2]]));
    }
    case PrimitiveKind::sphere: {
      const Sphere& s = g.spheres[primitive];
      return meet_sphere(ray, spread<F>(s.center), F(float(s.radius)));
    }
    case PrimitiveKind::cone:
      return meet_cone(ray, g.cones[primitive]);
    case PrimitiveKind::disc: {
      const Disc& d = g.discs[primitive];
      return meet_disc(ray, spread<F>(d.center), spread<F>(d.normal), F(float(d.radius)));
    }
    case PrimitiveKind::plane: {
      const Plane& p = g.planes[primitive];
      return meet_plane(ray, spread<F>(p.point), spread<F>(p.normal));
    }
    case PrimitiveKind::instance:
      break;
  }
  __builtin_unreachable();
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
