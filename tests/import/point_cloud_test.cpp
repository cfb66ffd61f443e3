#include "import/point_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lambent {
namespace {

std::vector<Vec3<float>> grid(int side, float step) {
  std::vector<Vec3<float>> points;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) points.push_back({step * float(x), step * float(y), 5});
  return points;
}

TEST(PointCloud, SpheresCloseAGrid) {
  EXPECT_EQ(point_radius(grid(100, 2)), 1.5);
  EXPECT_EQ(point_radius(grid(3, 4)), 3);
}

TEST(PointCloud, PointsAtRandomAreAboutAsFarApart) {
  std::mt19937 random(1);
  std::vector<Vec3<float>> points;
  for (int i = 0; i < 100000; ++i) points.push_back({float(random() % 65536), 0, float(random() % 65536)});
  const double per_area = 100000 / (65536.0 * 65536.0);
  // The fourth neighbour's median: pi r^2 density is the median of a gamma distribution of shape 4, 3.672.
  EXPECT_NEAR(point_radius(points) * std::sqrt(per_area), 0.75 * std::sqrt(3.672 / 3.14159265), 0.02);
}

TEST(PointCloud, OutliersAndCopiesMoveNothing) {
  std::vector<Vec3<float>> points = grid(100, 2);
  for (int i = 0; i < 100; ++i) points.push_back({1e9f * float(i + 1), -1e7f * float(i), 3});
  for (int i = 0; i < 5000; ++i) points.push_back(points[std::size_t(i)]);
  for (int i = 0; i < 5000; ++i) points.push_back(points[std::size_t(i)]);
  EXPECT_EQ(point_radius(points), 1.5);
}

TEST(PointCloud, FewPoints) {
  EXPECT_EQ(point_radius({{1, 2, 3}}), 1);
  EXPECT_EQ(point_radius({{1, 2, 3}, {1, 2, 3}}), 1);
  EXPECT_EQ(point_radius({{0, 0, 0}, {0, 4, 0}, {0, 5, 0}}), 0.75);
  EXPECT_EQ(point_radius({{0, 0, 0}, {0, 0, 1e-30f}}), positive.min);
}

TEST(PointCloud, ManyColorsShareMaterials) {
  std::mt19937 random(2);
  std::vector<std::array<float, 4>> colors;
  const auto number = [&] { return float(random() % 1000) / 999; };
  for (int i = 0; i < 20000; ++i) colors.push_back({number(), number(), number(), 1});
  std::vector<Vec3<float>> points(colors.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i].x = float(i);
  Model model;
  add_points(model, "cloud", points, colors);
  EXPECT_LE(model.materials.size(), 4096u);
  EXPECT_GT(model.materials.size(), 2000u);
  const auto& of = model.shapes.at(0).material_of_primitive;
  ASSERT_EQ(of.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int c = 0; c < 3; ++c)  // a sixteenth of the root at most
      ASSERT_NEAR(std::sqrt(model.materials.at(of[i]).diffuse[c]), std::sqrt(colors[i][std::size_t(c)]),
                  1.0 / 16);
}

TEST(PointCloud, FewColorsStayAsTheyAre) {
  std::vector<std::array<float, 4>> colors;
  for (int i = 0; i < 4096; ++i) colors.push_back({float(i) / 4096, 0.25f, 0, 1});
  std::vector<Vec3<float>> points(colors.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i].x = float(i);
  Model model;
  add_points(model, "cloud", points, colors);
  // 1024 steps of the root.
  EXPECT_GT(model.materials.size(), 900u);
  for (std::size_t i = 0; i < points.size(); ++i)
    ASSERT_NEAR(model.materials[model.shapes[0].material_of_primitive[i]].diffuse[0], colors[i][0], 0.002);
}

TEST(PointCloud, WithoutColorsOneMaterial) {
  Model model;
  add_points(model, "cloud", grid(10, 1), {});
  ASSERT_EQ(model.materials.size(), 1u);
  EXPECT_EQ(model.materials[0].diffuse, (Rgb{{0.7, 0.7, 0.7}}));
  EXPECT_TRUE(model.shapes.at(0).material_of_primitive.empty());
}

}  // namespace
}  // namespace lambent
