// Bounds and validation of scenes.

#include "scene/scene.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

namespace lambent::test {
namespace {

using Point = Vec3<double>;

double distance(const Point& a, const Point& b) { return length(a - b); }

Transform any_transform() {
  const auto number = [] { return *rc::gen::inRange(-30, 31) / 10.0; };
  const auto vector = [&] { return Point{number(), number(), number()}; };
  return {vector(), vector(), vector(), vector()};
}

/// The largest coordinate along each world axis that any of `points` has.
template <class Points> void expect_tight(const Bounds& box, const Points& points, double tolerance) {
  Bounds seen;
  for (const Point& p : points) seen.add(p);
  RC_ASSERT(distance(box.lower, seen.lower) < tolerance);
  RC_ASSERT(distance(box.upper, seen.upper) < tolerance);
  RC_ASSERT(box.lower.x <= seen.lower.x + 1e-12 && box.upper.x >= seen.upper.x - 1e-12);
  RC_ASSERT(box.lower.y <= seen.lower.y + 1e-12 && box.upper.y >= seen.upper.y - 1e-12);
  RC_ASSERT(box.lower.z <= seen.lower.z + 1e-12 && box.upper.z >= seen.upper.z - 1e-12);
}

/// Points all over the unit sphere; `n` in each direction.
std::vector<Point> sphere_points(int n) {
  std::vector<Point> points;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const auto [s, c] = sincos_degrees(180.0 * i / n);
      const auto [sj, cj] = sincos_degrees(180.0 * j / n);
      points.push_back({s * cj, c, s * sj});
    }
  return points;
}

TEST(Bounds, OfATransformedSphereAreTight) {
  const std::vector<Point> unit = sphere_points(60);
  EXPECT_TRUE(rc::check([&] {
    const Transform t = any_transform();
    const Sphere sphere{{1, -2, 0.5}, 1.5};
    std::vector<Point> points;
    for (const Point& p : unit) points.push_back(transform_point(t, sphere.center + sphere.radius * p));
    expect_tight(bounds(Shape{"", std::vector<Sphere>{sphere}, {}}, t), points, 0.05);
  }));
}

TEST(Bounds, OfATransformedDiscAreTight) {
  EXPECT_TRUE(rc::check([&] {
    const Transform t = any_transform();
    const Disc disc{{1, 0, 2}, {0, 3, 0}, 2};
    std::vector<Point> points;
    for (int i = 0; i < 360; ++i) {
      const auto [s, c] = sincos_degrees(double(i));
      points.push_back(transform_point(t, {1 + 2 * c, 0, 2 + 2 * s}));
    }
    expect_tight(bounds(Shape{"", std::vector<Disc>{disc}, {}}, t), points, 0.01);
  }));
}

TEST(Bounds, OfAConeAreThoseOfItsEnds) {
  const Bounds box = bounds(Shape{"", std::vector<Cone>{{{0, 0, 0}, {0, 2, 0}, 1, 0.25}}, {}});
  EXPECT_LT(distance(box.lower, {-1, 0, -1}), 1e-12);
  EXPECT_LT(distance(box.upper, {1, 2, 1}), 1e-12);
}

TEST(Bounds, LeaveInfinitePlanesOut) {
  Scene scene;
  scene.materials.emplace_back();
  scene.shapes.push_back({"plane", std::vector<Plane>{{}}, {}});
  scene.objects.push_back({"floor", {}, 0, {0}, {}});
  EXPECT_TRUE(bounds(scene).empty());
  scene.shapes.push_back({"sphere", std::vector<Sphere>{{}}, {}});
  scene.objects.push_back({"ball", {}, 1, {0}, translation({5, 0, 0})});
  EXPECT_EQ(bounds(scene).lower, (Point{4, -1, -1}));
  EXPECT_EQ(bounds(scene).upper, (Point{6, 1, 1}));
}

TEST(PrimitiveCount, CountsWhatRaysMeet) {
  Mesh mesh;
  mesh.vertices.resize(4);
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(primitive_count({"", mesh, {}}), 2u);
  EXPECT_EQ(primitive_count({"", std::vector<Disc>(5), {}}), 5u);
}

/// One triangle, shown once; all is well with it.
Scene small_scene() {
  Scene scene;
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  scene.materials.emplace_back();
  scene.shapes.push_back({"mesh", mesh, {0}});
  scene.objects.push_back({"thing", {"f.yaml", 3, 5}, 0, {0}, {}});
  return scene;
}

std::string fault(const Scene& scene) {
  const std::vector<Diagnostic> found = validate(scene);
  if (found.empty()) return "";
  EXPECT_EQ(found[0].place.line, 3);
  return found[0].message;
}

TEST(Validate, FindsWhatPointsNowhere) {
  EXPECT_EQ(fault(small_scene()), "");
  Scene scene = small_scene();
  scene.objects[0].shape = 1;
  EXPECT_EQ(fault(scene), "'thing' shows shape 1, but there are only 1");
  scene = small_scene();
  scene.objects[0].materials = {4};
  EXPECT_EQ(fault(scene), "'thing' has material 4, but there are only 1");
  scene = small_scene();
  scene.objects[0].materials.clear();
  EXPECT_EQ(fault(scene), "'thing' has no material");
  scene = small_scene();
  scene.shapes[0].material_of_primitive = {1};
  EXPECT_EQ(fault(scene), "'thing' has a primitive with its material 1, but only 1 materials");
  scene = small_scene();
  scene.shapes[0].material_of_primitive = {0, 0};
  EXPECT_EQ(fault(scene), "'thing' has 1 primitives, but materials for 2");
  scene = small_scene();
  std::get<Mesh>(scene.shapes[0].primitives).triangles[0][2] = 3;
  EXPECT_EQ(fault(scene), "'thing' has a triangle with vertex 3, but only 3 vertices");
  scene = small_scene();
  std::get<Mesh>(scene.shapes[0].primitives).normals.resize(2);
  EXPECT_EQ(fault(scene), "'thing' has 3 vertices, but 2 normals");
}

TEST(Validate, FindsWhatIsOutOfReach) {
  const std::string far = "'thing' reaches beyond 1e10 scene units from the origin";
  Scene scene = small_scene();
  scene.objects[0].world_from_object = scaling({1e10, 1, 1});
  EXPECT_EQ(fault(scene), "");
  scene.objects[0].world_from_object = scaling({2e10, 1, 1});
  EXPECT_EQ(fault(scene), far);
  scene.objects[0].world_from_object = scaling({std::nan(""), 1, 1});
  EXPECT_EQ(fault(scene), far);
  scene = small_scene();
  scene.shapes[0] = {"plane", std::vector<Plane>{{{0, 1e9, 0}, {0, 1, 0}}}, {}};
  scene.objects[0].world_from_object = scaling({100, 100, 100});
  EXPECT_EQ(fault(scene), far);
}

}  // namespace
}  // namespace lambent::test
