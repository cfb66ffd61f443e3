#include "import/creased_normals.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lambent {
namespace {

/// A strip of two rectangles, 1 by `width` and 1 by 1, that meet along the y axis at `degrees`.
Mesh fold(double degrees, float width = 1) {
  const double angle = degrees * 3.14159265358979323846 / 180;
  const float x = float(std::cos(angle)), z = float(std::sin(angle));
  Mesh mesh;
  mesh.vertices = {{-width, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-width, 1, 0}, {x, 0, z}, {x, 1, z}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  return mesh;
}

TEST(CreasedNormals, AFoldIsSmoothUpToTheCrease) {
  Mesh smooth = fold(39), creased = fold(41);
  add_creased_normals(smooth, 40);
  add_creased_normals(creased, 40);
  EXPECT_TRUE(creased.normals.empty());  // two planes: nothing is curved
  EXPECT_EQ(creased.vertices.size(), 6u);
  ASSERT_EQ(smooth.normals.size(), 6u);
  EXPECT_EQ(smooth.vertices.size(), 6u);
  EXPECT_EQ(smooth.normals[0], (Vec3<float>{0, 0, 1}));
  // On the fold, halfway: one triangle of each side ends at one of its vertices, two at the other, all of
  // area 1/2.
  const double n1[2] = {-std::sin(39 * 0.017453292519943295), std::cos(39 * 0.017453292519943295)};
  for (const int vertex : {1, 2}) {
    const double left = vertex == 1 ? 1 : 2, right = vertex == 1 ? 2 : 1;
    const double x = right * n1[0], z = left + right * n1[1], size = std::sqrt(x * x + z * z);
    EXPECT_NEAR(smooth.normals[std::size_t(vertex)].x, x / size, 1e-6);
    EXPECT_NEAR(smooth.normals[std::size_t(vertex)].z, z / size, 1e-6);
  }
}

TEST(CreasedNormals, LargeFacesStayFlat) {
  Mesh mesh = fold(30, 1000);
  add_creased_normals(mesh, 40);
  ASSERT_EQ(mesh.normals.size(), 6u);
  EXPECT_GT(mesh.normals[1].z, 0.999f);
}

TEST(CreasedNormals, EdgesSplitVerticesWithAllTheyHave) {
  // A third rectangle, upright on the far edge of a gentle fold.
  Mesh mesh = fold(10);
  const Vec3<float> a = mesh.vertices[4], b = mesh.vertices[5];
  mesh.vertices.push_back({a.x, a.y, a.z + 1});
  mesh.vertices.push_back({b.x, b.y, b.z + 1});
  mesh.triangles.push_back({4, 6, 7});
  mesh.triangles.push_back({4, 7, 5});
  for (int i = 0; i < 8; ++i) {
    mesh.uvs.push_back({float(i), 0});
    mesh.colors.push_back({float(i), 0, 0, 1});
  }
  add_creased_normals(mesh, 40);
  ASSERT_EQ(mesh.vertices.size(), 10u);
  ASSERT_EQ(mesh.normals.size(), 10u);
  EXPECT_EQ(mesh.vertices[8], a);
  EXPECT_EQ(mesh.vertices[9], b);
  EXPECT_EQ(mesh.uvs[8].x, 4.f);
  EXPECT_EQ(mesh.colors[9][0], 5.f);
  EXPECT_EQ(mesh.triangles[4], (std::array<std::uint32_t, 3>{8, 6, 7}));
  EXPECT_EQ(mesh.triangles[2], (std::array<std::uint32_t, 3>{1, 4, 5}));
  EXPECT_NEAR(mesh.normals[8].x, -1, 1e-6);
}

TEST(CreasedNormals, VerticesAtOnePlaceAreOne) {
  Mesh seamed = fold(20), whole = fold(20);
  seamed.vertices.push_back({-0.0f, 0, 0});
  seamed.vertices.push_back({0, 1, 0});
  seamed.triangles[2] = {6, 4, 5};
  seamed.triangles[3] = {6, 5, 7};
  add_creased_normals(seamed, 40);
  add_creased_normals(whole, 40);
  ASSERT_EQ(seamed.normals.size(), 8u);
  EXPECT_EQ(seamed.normals[1], whole.normals[1]);
  EXPECT_EQ(seamed.normals[6], whole.normals[1]);
  EXPECT_EQ(seamed.normals[7], whole.normals[2]);
}

TEST(CreasedNormals, FacesWoundAgainstEachOtherDoNotMix) {
  Mesh mesh = fold(10);
  std::swap(mesh.triangles[2][0], mesh.triangles[2][1]);
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  add_creased_normals(mesh, 40);
  EXPECT_TRUE(mesh.normals.empty());
}

TEST(CreasedNormals, ManyFacesAroundOnePoint) {
  // A fan of a hundred thousand: linear, not quadratic.
  Mesh mesh;
  mesh.vertices = {{0, 0, 1}};
  const int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double a = i * 6.283185307179586 / n;
    mesh.vertices.push_back({float(std::cos(a)), float(std::sin(a)), 0});
    mesh.triangles.push_back({0, std::uint32_t(i + 1), std::uint32_t((i + 1) % n + 1)});
  }
  add_creased_normals(mesh, 40);
  ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
  EXPECT_NEAR(mesh.normals[0].z, 1, 1e-3);
  EXPECT_NEAR(mesh.normals[1].z, std::sqrt(0.5), 1e-3);
}

}  // namespace
}  // namespace lambent
