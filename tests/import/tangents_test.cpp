#include "import/tangents.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lambent {
namespace {

/// Two triangles that share the edge x = 0; u grows away from it on both sides where `mirrored`.
Mesh strip(bool mirrored) {
  Mesh mesh;
  mesh.vertices = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.uvs = {{mirrored ? 1.f : -1.f, 0}, {0, 0}, {0, 1}, {1, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
  return mesh;
}

using Tangent = std::array<float, 4>;

TEST(Tangents, AlongGrowingU) {
  Mesh mesh = strip(false);
  make_tangents(mesh, 0);
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.tangents, (std::vector<Tangent>(4, Tangent{1, 0, 0, 1})));
}

TEST(Tangents, VerticesAreDoubledWhereTheImageIsMirrored) {
  Mesh mesh = strip(true);
  mesh.colors.assign(4, {1, 2, 3, 1});
  make_tangents(mesh, 0);
  ASSERT_EQ(mesh.vertices.size(), 6u);
  EXPECT_EQ(mesh.colors.size(), 6u);
  EXPECT_EQ(mesh.uvs.size(), 6u);
  EXPECT_EQ(mesh.normals.size(), 6u);
  for (const std::uint32_t v : mesh.triangles[0]) EXPECT_EQ(mesh.tangents[v], (Tangent{-1, 0, 0, -1}));
  for (const std::uint32_t v : mesh.triangles[1]) EXPECT_EQ(mesh.tangents[v], (Tangent{1, 0, 0, 1}));
  // Where they were doubled, they still are in the same place.
  EXPECT_EQ(mesh.vertices[mesh.triangles[1][0]], (Vec3<float>{0, 0, 0}));
}

TEST(Tangents, AreWeightedByAngleAndAcrossTheNormal) {
  // Two faces meet at the origin at right angles: one in the plane z = 0, u along x, with an angle of 90
  // degrees; one in the plane x = 0, u along z, with 45 degrees. The normal there is slanted.
  Mesh mesh;
  const float h = std::sqrt(0.5f);
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 1}, {0, 0, 1}};
  mesh.normals = {{-h, 0, h}, {0, 0, 1}, {0, 0, 1}, {-1, 0, 0}, {-1, 0, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, -1}, {1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
  make_tangents(mesh, 0);
  for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
    const auto [x, y, z, w] = mesh.tangents[i];
    const auto& n = mesh.normals[i];
    EXPECT_NEAR(x * x + y * y + z * z, 1, 1e-6);
    EXPECT_NEAR(x * n.x + y * n.y + z * n.z, 0, 1e-6);
  }
  EXPECT_NEAR(mesh.tangents[0][0], h, 1e-6);
  EXPECT_NEAR(mesh.tangents[0][2], h, 1e-6);
}

TEST(Tangents, VerticesThatAreAlikeCountAsOne) {
  // The same two triangles, each with vertices of its own, the second one slanted in u.
  Mesh shared = strip(false);
  shared.uvs[3] = {1, 0.5f};
  Mesh apart = shared;
  apart.vertices.push_back(shared.vertices[1]), apart.vertices.push_back(shared.vertices[2]);
  apart.normals.assign(6, {0, 0, 1});
  apart.uvs.push_back(shared.uvs[1]), apart.uvs.push_back(shared.uvs[2]);
  apart.triangles[1] = {4, 3, 5};
  make_tangents(shared, 0);
  make_tangents(apart, 0);
  for (int corner = 0; corner < 3; ++corner)
    EXPECT_EQ(shared.tangents[shared.triangles[1][std::size_t(corner)]],
              apart.tangents[apart.triangles[1][std::size_t(corner)]]);
}

TEST(Tangents, WithoutExtentInTheImageAnyDirectionWillDo) {
  Mesh mesh = strip(false);
  mesh.uvs.assign(4, {0.5f, 0.5f});
  make_tangents(mesh, 0);
  for (const Tangent& t : mesh.tangents) {
    EXPECT_NEAR(t[0] * t[0] + t[1] * t[1], 1, 1e-6);
    EXPECT_EQ(t[2], 0);
    EXPECT_EQ(t[3], 1);
  }
}

TEST(Tangents, OfTheSecondSet) {
  Mesh mesh = strip(false);
  mesh.uvs2 = {{0, 0}, {0, 1}, {-1, 1}, {0, 2}};  // u along -y
  make_tangents(mesh, 1);
  EXPECT_NEAR(mesh.tangents[1][1], -1, 1e-6);
}

}  // namespace
}  // namespace lambent
