#include "scenefile/shapes.h"

#include <cmath>

#include "scene/triangulate.h"

namespace lambent {

Mesh rectangle(const Plane& plane, double width, double height) {
  const Vec3<double> n = normalize(plane.normal);
  const Vec3<double> horizontal = cross(Vec3<double>{0, 1, 0}, n);
  // Where the normal is vertical every direction of the plane is horizontal, and x is as good as any. The
  // limit only has to keep rounding errors from choosing the direction.
  const Vec3<double> u = length(horizontal) > 1e-9 ? normalize(horizontal) : Vec3<double>{1, 0, 0};
  const Vec3<double> a = (width / 2) * u, b = (height / 2) * cross(n, u);
  const Vec3<double>& p = plane.point;
  Mesh mesh;
  for (const Vec3<double>& corner : {p - a - b, p + a - b, p + a + b, p - a + b})
    mesh.vertices.push_back(cast<float>(corner));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Mesh box(const Vec3<double>& lower, const Vec3<double>& upper) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)  // bit 0 is x, bit 1 is y, bit 2 is z
    mesh.vertices.push_back(cast<float>(
        Vec3<double>{i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z}));
  mesh.triangles = {{0, 4, 6}, {0, 6, 2},   // -x
                    {1, 3, 7}, {1, 7, 5},   // +x
                    {0, 1, 5}, {0, 5, 4},   // -y
                    {2, 6, 7}, {2, 7, 3},   // +y
                    {0, 2, 3}, {0, 3, 1},   // -z
                    {4, 5, 7}, {4, 7, 6}};  // +z
  return mesh;
}

std::vector<Disc> caps(const Cone& cone) {
  std::vector<Disc> discs;
  if (cone.radius_from > 0) discs.push_back({cone.from, normalize(cone.from - cone.to), cone.radius_from});
  if (cone.radius_to > 0) discs.push_back({cone.to, normalize(cone.to - cone.from), cone.radius_to});
  return discs;
}

double unevenness(const std::vector<Vec3<double>>& corners) {
  Bounds box;
  for (const Vec3<double>& p : corners) box.add(p);
  const double extent = length(box.upper - box.lower);
  const Vec3<double> normal = newell_normal(corners);
  // Twice the area against the square of the extent: less than this is rounding.
  if (!(length(normal) > 1e-12 * extent * extent)) return -1;
  const Vec3<double> n = normalize(normal);
  double lowest = 1e300, highest = -1e300;
  for (const Vec3<double>& p : corners) {
    const double height = dot(n, p - corners[0]);
    lowest = min(lowest, height);
    highest = max(highest, height);
  }
  return (highest - lowest) / 2 / extent;
}

Mesh polygon(const std::vector<Vec3<double>>& corners) {
  Mesh mesh;
  for (const Vec3<double>& p : corners) mesh.vertices.push_back(cast<float>(p));
  mesh.triangles = triangulate(corners);
  return mesh;
}

}  // namespace lambent
