// Texture coordinates of surfaces, and that they grow as they say.

#include "accel/coordinates.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lambent/lambent.h"

namespace lambent {
namespace {

using V = Vec3<double>;

struct Small {
  explicit Small(const std::string& objects)
      : scene(parse_scene(std::string("lambent: 1\ncamera: {eye: [0, 0, 9], target: [0, 0, 0]}\nobjects:\n") +
                          objects)),
        world(build_world(*scene)) {}
  /// What a ray meets, and where.
  std::pair<HitIds<std::int32_t>, SurfacePoint<double>> meet(const V& o, const V& towards) const {
    const V d = normalize(towards - o);
    Closest<float> hit{__builtin_inff()};
    const WorldView view = world.view();
    find_closest(view, QueryRay<float>(cast<float>(o), cast<float>(d)), true, hit);
    EXPECT_GE(hit.ids.geometry, 0);
    return {hit.ids, surface_at(view, hit.ids, o, d, hit.t)};
  }
  ScenePtr scene;
  World world;
};

/// The growth of u and v is what two neighbouring points of the surface say.
void expect_growth(const Small& small, const V& o, const V& towards) {
  const WorldView view = small.world.view();
  const auto [ids, s] = small.meet(o, towards);
  const SurfaceCoordinates at = coordinates_at(view, ids, s.P);
  V a, b;
  axes_across(s.Ng, a, b);
  for (const V& step : {a, b}) {
    const auto [other_ids, other] = small.meet(o, s.P + 1e-3 * step);
    const SurfaceCoordinates there = coordinates_at(view, other_ids, other.P);
    const V way = other.P - s.P;
    for (int set = 0; set < 2; ++set) {
      EXPECT_NEAR(there.uv[set].x - at.uv[set].x, dot(at.du[set], way), 2e-5);
      EXPECT_NEAR(there.uv[set].y - at.uv[set].y, dot(at.dv[set], way), 2e-5);
    }
  }
}

TEST(Coordinates, OfASphereAreLongitudeAndLatitude) {
  const Small small("  - {sphere: {center: [0, 0, 0], radius: 2}}\n");
  const WorldView view = small.world.view();
  const auto uv = [&](const V& from) {
    const auto [ids, s] = small.meet(5.0 * from, {});
    return coordinates_at(view, ids, s.P).uv[0];
  };
  EXPECT_NEAR(uv({0, 0, 1}).x, 0, 1e-12);
  EXPECT_NEAR(uv({0, 0, 1}).y, 0.5, 1e-12);
  EXPECT_NEAR(uv({1, 0, 0}).x, 0.25, 1e-12);
  EXPECT_NEAR(uv({0, 0, -1}).x, 0.5, 1e-12);
  EXPECT_NEAR(uv({0, 1, 0}).y, 1, 1e-7);
  EXPECT_NEAR(uv({0, -1, 0}).y, 0, 1e-7);
  EXPECT_NEAR(uv({1, 1, 0}).y, 0.75, 1e-12);
  expect_growth(small, {3, 2, 4}, {0.2, 0.3, 0});
}

TEST(Coordinates, OfAFloorAreXAndMinusZ) {
  const Small small("  - {plane: {point: [1, 0, 0], normal: [0, 1, 0]}}\n");
  const auto [ids, s] = small.meet({3, 5, -2}, {3, 0, -2});
  const SurfaceCoordinates at = coordinates_at(small.world.view(), ids, s.P);
  EXPECT_NEAR(at.uv[0].x, 2, 1e-12);
  EXPECT_NEAR(at.uv[0].y, 2, 1e-12);
  expect_growth(small, {3, 5, -2}, {2, 0, 1});
}

TEST(Coordinates, OfCylindersAndDiscs) {
  const Small cylinder("  - {cylinder: {from: [0, -1, 0], to: [0, 3, 0], radius: 0.5}}\n");
  expect_growth(cylinder, {2, 1, 3}, {0, 1.2, 0});
  const Small disc("  - {disc: {center: [0, 1, 0], normal: [1, 1, 0], radius: 2}}\n");
  expect_growth(disc, {4, 5, 1}, {0, 1, 0.3});
}

TEST(Coordinates, OfMeshesLieBetweenThoseOfTheCornersWhereverItIsPlaced) {
  const std::string mesh =
      "mesh: {vertices: [[0, 0, 0], [2, 0, 0], [0, 3, 0]], triangles: [[0, 1, 2]], uvs: [[0.1, 0.2], [0.7, "
      "0.1], "
      "[0.3, 0.9]]}";
  const std::string place =
      ", transform: [{scale: [1, 2, 0.5]}, {rotate: {axis: [1, 2, 3], degrees: 40}}]}\n";
  // Once in the world's own tree, and as an instance (a file's shape shown twice would be one).
  const Small once("  - {" + mesh + place);
  const Transform t = once.scene->objects[0].world_from_object;
  const V inside = transform_point(t, {0.5, 0.75, 0}), N = normalize(cross(t.x, t.y));
  const auto [ids, s] = once.meet(inside + 3.0 * N, inside);
  const SurfaceCoordinates at = coordinates_at(once.world.view(), ids, s.P);
  // Barycentric: 0.5, 0.25, 0.25
  EXPECT_NEAR(at.uv[0].x, 0.5 * 0.1 + 0.25 * 0.7 + 0.25 * 0.3, 1e-6);
  EXPECT_NEAR(at.uv[0].y, 0.5 * 0.2 + 0.25 * 0.1 + 0.25 * 0.9, 1e-6);
  expect_growth(once, inside + 3.0 * N, inside);
}

TEST(Turns, AreTheAngleOfAPoint) {
  for (int i = 0; i < 3600; ++i) {
    const double angle = (i - 1799.5) / 3600 * 2 * M_PI, length = 0.001 + i;
    EXPECT_NEAR(turns(length * std::sin(angle), length * std::cos(angle)), angle / (2 * M_PI), 1e-14);
  }
  EXPECT_EQ(turns(0, 0), 0);
  EXPECT_EQ(turns(1, 0), 0.25);
  EXPECT_EQ(turns(-1, 0), -0.25);
  EXPECT_EQ(turns(0, -1), 0.5);
}

}  // namespace
}  // namespace lambent
