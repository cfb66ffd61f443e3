#pragma once
// Where a surface point lies on its surface, for whoever paints it: texture coordinates, how they grow,
// colours and tangents of vertices. One point at a time.
//
//   triangles   the mesh's own, between those of the corners; where it has none, as planes, from the origin
//   spheres     u once round the y axis, from +z by way of +x; v from the south pole to the north pole
//   cylinders   u once round, v along the axis, in scene units
//   planes      u and v along two axes in the plane, in scene units, (0, 0) at `point`; for a floor x and -z
//   discs       likewise from the centre
//
// Where there is no placing of its own left of an object (spheres, ...), the axes are the world's.

#include "accel/surface.h"

namespace lambent {
inline namespace LAMBENT_ISA {

struct SurfaceCoordinates {
  Vec2<double> uv[2];         ///< The mesh's two sets; elsewhere both the same.
  Vec3<double> du[2], dv[2];  ///< How u and v grow in the world: along the surface, by scene unit.
  Vec3<double> tangent{};     ///< The corners' own, between them; zero where there is none.
  double bitangent_sign = 1;
  double color[4] = {1, 1, 1, 1};  ///< Of the vertices.
  double curvature = 0;            ///< About how much N turns, radians by scene unit.
};

/// Two unit vectors across `n`, so that (a, b, n) is right-handed; for n = y they are x and -z.
inline void axes_across(const Vec3<double>& n, Vec3<double>& a, Vec3<double>& b) {
  a = abs(n.y) > 0.999999 ? Vec3<double>{1, 0, 0} : Vec3<double>{n.z, 0, -n.x};
  a = normalize(a - dot(a, n) * n);
  b = cross(n, a);
}

namespace detail {

inline void on_plane(const Vec3<double>& origin, const Vec3<double>& normal, const Vec3<double>& at,
                     SurfaceCoordinates& c) {
  axes_across(normal, c.du[0], c.dv[0]);
  c.uv[0] = {dot(at - origin, c.du[0]), dot(at - origin, c.dv[0])};
}

inline void on_triangle(const Geometry& g, std::int32_t primitive, const Vec3<double>& at,
                        SurfaceCoordinates& c) {
  const auto& corner = g.triangles[primitive];
  const Vec3<double> p0 = cast<double>(g.vertices[corner[0]]), e1 = cast<double>(g.vertices[corner[1]]) - p0,
                     e2 = cast<double>(g.vertices[corner[2]]) - p0, n = cross(e1, e2), q = at - p0;
  const double nn = dot(n, n);
  double b[3] = {1, 0, 0};
  Vec3<double> grow1{}, grow2{};  // of b[1] and b[2]
  if (nn > 0) {
    grow1 = cross(e2, n) / nn, grow2 = cross(n, e1) / nn;
    b[1] = dot(q, grow1), b[2] = dot(q, grow2), b[0] = 1 - b[1] - b[2];
  }
  int set = 0;
  for (const Vec2<float>* uvs : {g.uvs, g.uvs2}) {
    if (uvs) {
      const Vec2<float>&t0 = uvs[corner[0]], &t1 = uvs[corner[1]], &t2 = uvs[corner[2]];
      c.uv[set] = {b[0] * t0.x + b[1] * t1.x + b[2] * t2.x, b[0] * t0.y + b[1] * t1.y + b[2] * t2.y};
      c.du[set] = (double(t1.x) - t0.x) * grow1 + (double(t2.x) - t0.x) * grow2;
      c.dv[set] = (double(t1.y) - t0.y) * grow1 + (double(t2.y) - t0.y) * grow2;
    }
    ++set;
  }
  if (!g.uvs && nn > 0) on_plane({}, n / sqrt(nn), at, c);
  if (!g.uvs2) c.uv[1] = c.uv[0], c.du[1] = c.du[0], c.dv[1] = c.dv[0];
  if (g.colors)
    for (int i = 0; i < 4; ++i)
      c.color[i] =
          b[0] * g.colors[corner[0]][i] + b[1] * g.colors[corner[1]][i] + b[2] * g.colors[corner[2]][i];
  if (g.tangents) {
    c.bitangent_sign = g.tangents[corner[0]][3] < 0 ? -1 : 1;
    for (int i = 0; i < 3; ++i) {
      const auto& t = g.tangents[corner[i]];
      c.tangent = c.tangent + b[i] * Vec3<double>{t[0], t[1], t[2]};
    }
  }
  if (g.normals) {
    const Vec3<double> n0 = cast<double>(g.normals[corner[0]]);
    const auto turned = [&](int i, const Vec3<double>& edge) {
      const Vec3<double> by = cast<double>(g.normals[corner[i]]) - n0;
      const double square = dot(edge, edge);
      return square > 0 ? sqrt(dot(by, by) / square) : 0.0;
    };
    c.curvature = max(turned(1, e1), turned(2, e2));
  }
}

inline void on_sphere(const Sphere& sphere, const Vec3<double>& at, SurfaceCoordinates& c) {
  const Vec3<double> n = normalize(at - sphere.center);
  const double across = sqrt(n.x * n.x + n.z * n.z), circle = 2 * 3.141592653589793 * sphere.radius;
  c.curvature = 1 / sphere.radius;
  double round = turns(n.x, n.z);
  if (round < 0) round += 1;
  c.uv[0] = {round, 0.5 + 2 * turns(n.y, across)};
  if (!(across > 1e-9)) return;
  const Vec3<double> east{n.z / across, 0, -n.x / across}, north = cross(n, east);
  c.du[0] = (1 / (circle * across)) * east;
  c.dv[0] = (2 / circle) * north;
}

inline void on_cone(const PlacedCone& cone, const Vec3<double>& at, SurfaceCoordinates& c) {
  Vec3<double> a, b;
  axes_across(cone.axis, a, b);
  const Vec3<double> q = at - cone.base;
  const double x = dot(q, a), y = dot(q, b), z = dot(q, cone.axis), radius = sqrt(x * x + y * y);
  double round = turns(y, x);
  if (round < 0) round += 1;
  c.uv[0] = {round, z};
  c.dv[0] = cone.axis;
  if (!(radius > 0)) return;
  c.curvature = 1 / radius;
  c.du[0] = (1 / (2 * 3.141592653589793 * radius * radius)) * (x * b - y * a);
}

}  // namespace detail

/// Of the point P of a primitive.
inline SurfaceCoordinates coordinates_at(const WorldView& world, const HitIds<std::int32_t>& ids,
                                         const Vec3<double>& P) {
  SurfaceCoordinates c;
  const Geometry& g = world.geometries[ids.geometry];
  const Instance* instance = ids.instance >= 0 ? &world.instances[ids.instance] : nullptr;
  const Vec3<double> at = instance ? transform_point(instance->object_from_world, P) : P;
  switch (g.kind) {
    case PrimitiveKind::triangle:
      detail::on_triangle(g, ids.primitive, at, c);
      break;
    case PrimitiveKind::sphere:
      detail::on_sphere(g.spheres[ids.primitive], at, c);
      break;
    case PrimitiveKind::cone:
      detail::on_cone(g.cones[ids.primitive], at, c);
      break;
    case PrimitiveKind::disc:
      detail::on_plane(g.discs[ids.primitive].center, g.discs[ids.primitive].normal, at, c);
      break;
    case PrimitiveKind::plane:
      detail::on_plane(g.planes[ids.primitive].point, g.planes[ids.primitive].normal, at, c);
      break;
    case PrimitiveKind::instance:
      break;
  }
  if (g.kind != PrimitiveKind::triangle) c.uv[1] = c.uv[0], c.du[1] = c.du[0], c.dv[1] = c.dv[0];
  if (instance) {
    for (int set = 0; set < 2; ++set) {
      c.du[set] = transform_normal(instance->object_from_world, c.du[set]);
      c.dv[set] = transform_normal(instance->object_from_world, c.dv[set]);
    }
    c.tangent = transform_vector(instance->world_from_object, c.tangent);
    if (determinant(instance->world_from_object) < 0) c.bitangent_sign = -c.bitangent_sign;
    c.curvature *= length(transform_vector(instance->object_from_world, Vec3<double>{1, 0, 0}));
  }
  return c;
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
