#include "scene/triangulate.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "math/functions.h"

namespace lambent {
namespace {

using Points = std::vector<Vec3<double>>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Vec3<double> normal_of(const Points& p, const std::array<std::uint32_t, 3>& t) {
  return cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
}

/// A triangulation of a simple polygon turns as the polygon does everywhere, and its areas sum to the
/// polygon's: then nothing is covered twice and nothing is left out.
void expect_covers(const Points& points, double tolerance = 1e-12) {
  const Triangles triangles = triangulate(points);
  ASSERT_EQ(triangles.size(), points.size() - 2);
  const Vec3<double> n = newell_normal(points);
  const double area = length(n);
  ASSERT_GT(area, 0);
  double sum = 0;
  for (const auto& t : triangles) {
    const double part = dot(normal_of(points, t), n) / area;
    EXPECT_GE(part, -tolerance * area);
    sum += part;
  }
  EXPECT_NEAR(sum, area, tolerance * area);
}

/// A polygon of n corners around the origin, each at a distance of its own: simple, and mostly concave.
Points star(const std::vector<int>& radii) {
  Points points;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const auto [s, c] = sincos_degrees(360.0 * double(i) / double(radii.size()));
    points.push_back({radii[i] * c, radii[i] * s, 0});
  }
  return points;
}

TEST(Triangulate, FewerThanThreePointsGiveNothing) {
  EXPECT_TRUE(triangulate(Points{}).empty());
  EXPECT_TRUE(triangulate(Points{{0, 0, 0}, {1, 0, 0}}).empty());
  EXPECT_EQ(newell_normal(Points{{0, 0, 0}, {1, 0, 0}}), (Vec3<double>{0, 0, 0}));
}

TEST(Triangulate, NewellNormalIsTwiceTheArea) {
  // A 2 x 3 rectangle in the plane x = 7, counter-clockwise seen from +x.
  EXPECT_EQ(newell_normal(Points{{7, 0, 0}, {7, 2, 0}, {7, 2, 3}, {7, 0, 3}}), (Vec3<double>{12, 0, 0}));
}

TEST(Triangulate, TriangleStays) {
  EXPECT_EQ(triangulate(Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), (Triangles{{0, 1, 2}}));
}

TEST(Triangulate, ConvexQuadIsCutFromItsFirstCorner) {
  EXPECT_EQ(triangulate(Points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}),
            (Triangles{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Triangulate, ArrowheadIsCutAtItsReflexCorner) {
  // Corner 3 points inwards: the diagonal 0-2 would lie outside.
  const Points arrow{{-1, -1, 0}, {2, 0, 0}, {-1, 1, 0}, {0, 0, 0}};
  EXPECT_EQ(triangulate(arrow), (Triangles{{0, 1, 3}, {1, 2, 3}}));
  // Turned by one, it is corner 2.
  const Points turned{arrow[1], arrow[2], arrow[3], arrow[0]};
  EXPECT_EQ(triangulate(turned), (Triangles{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Triangulate, CornerOnAStraightSideMakesNoEmptyTriangle) {
  // Corner 1 lies in the middle of the side from 0 to 2.
  const Points points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  for (const auto& t : triangulate(points)) EXPECT_GT(length(normal_of(points, t)), 0.5);
  // The same with more of them, and coordinates that are no sums of powers of two.
  const Points more{{0.1, 0.1, 0}, {0.2, 0.1, 0}, {0.3, 0.1, 0}, {0.4, 0.1, 0},
                    {0.3, 0.2, 0}, {0.2, 0.3, 0}, {0.1, 0.4, 0}, {0.1, 0.3, 0}};
  expect_covers(more);
  for (const auto& t : triangulate(more)) EXPECT_GT(length(normal_of(more, t)), 1e-3);
}

TEST(Triangulate, ConcavePolygonsInEveryPlane) {
  const std::vector<std::pair<double, double>> comb{{0, 0}, {7, 0}, {7, 3}, {6, 3}, {6, 1}, {5, 1},
                                                    {5, 3}, {4, 3}, {4, 1}, {3, 1}, {3, 3}, {2, 3},
                                                    {2, 1}, {1, 1}, {1, 3}, {0, 3}};
  for (int side : {1, -1}) {
    for (int axis = 0; axis < 3; ++axis) {
      Points points;
      for (const auto& [a, b] : comb) {
        const double u = side * a, w = 0.25 * a - 0.125 * b;  // w tilts the plane
        points.push_back(axis == 0   ? Vec3<double>{w, u, b}
                         : axis == 1 ? Vec3<double>{b, w, u}
                                     : Vec3<double>{u, b, w});
      }
      expect_covers(points);
    }
  }
}

TEST(Triangulate, PolygonWithABridgeToItsHole) {
  // A 4 x 4 square with a 2 x 2 hole, cut open from corner to corner; the ends of the cut stand twice in the
  // list.
  const Points points{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                      {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
  EXPECT_EQ(length(newell_normal(points)), 2 * 12);
  expect_covers(points);
  for (const auto& t : triangulate(points)) {
    const Vec3<double> middle = (points[t[0]] + points[t[1]] + points[t[2]]) / 3.0;
    EXPECT_FALSE(middle.x > 1 && middle.x < 3 && middle.y > 1 && middle.y < 3)
        << "a triangle lies in the hole";
  }
}

TEST(Triangulate, FarFromTheOrigin) {
  Points points = star({3, 1, 3, 1, 3, 1, 3, 1, 3, 1});
  for (auto& p : points) p = p + Vec3<double>{14678, -9605, 1e5};
  expect_covers(points, 1e-9);
}

TEST(Triangulate, CoversEveryStar) {
  EXPECT_TRUE(rc::check("the triangles of a star-shaped polygon cover it once", [] {
    const int n = *rc::gen::inRange(3, 60);
    const auto radii = *rc::gen::container<std::vector<int>>(std::size_t(n), rc::gen::inRange(1, 100));
    const Points points = star(radii);
    const Triangles triangles = triangulate(points);
    RC_ASSERT(triangles.size() == points.size() - 2);
    double sum = 0;
    for (const auto& t : triangles) {
      RC_ASSERT(normal_of(points, t).z > -1e-9);
      sum += normal_of(points, t).z;
    }
    RC_ASSERT(std::abs(sum - newell_normal(points).z) < 1e-9 * sum);
  }));
}

TEST(Triangulate, NeverFails) {
  EXPECT_TRUE(rc::check("any points give n - 2 triangles of points that exist", [] {
    // Few different coordinates, so that points coincide, sides overlap and cross.
    const int n = *rc::gen::inRange(3, 40);
    Points points;
    for (int i = 0; i < n; ++i)
      points.push_back({double(*rc::gen::inRange(0, 4)), double(*rc::gen::inRange(0, 4)),
                        double(*rc::gen::inRange(0, 2))});
    const Triangles triangles = triangulate(points);
    RC_ASSERT(triangles.size() == points.size() - 2);
    // Every side of the polygon is a side of just one triangle, diagonals of two: as many edges as such a net
    // must have.
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
    for (const auto& t : triangles) {
      RC_ASSERT(std::set<std::uint32_t>(t.begin(), t.end()).size() == 3u);
      for (int k = 0; k < 3; ++k) {
        RC_ASSERT(t[k] < points.size());
        ++sides[{t[k], t[(k + 1) % 3]}];
      }
    }
    for (std::uint32_t i = 0; i < points.size(); ++i)
      RC_ASSERT(sides[std::pair(i, std::uint32_t((i + 1) % points.size()))] == 1);
    for (const auto& [side, count] : sides) {
      if ((side.first + 1) % points.size() == side.second) continue;
      RC_ASSERT(count == 1);
      RC_ASSERT(sides.count({side.second, side.first}) == 1u);
    }
  }));
}

TEST(Triangulate, WithoutAreaItStillGivesTriangles) {
  EXPECT_EQ(triangulate(Points(6, Vec3<double>{1, 2, 3})).size(), 4u);
  const Points bow_tie{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(triangulate(bow_tie).size(), 2u);
  Points line;
  for (int i = 0; i < 1000; ++i) line.push_back({double(i), 0, 0});
  EXPECT_EQ(triangulate(line).size(), 998u);
}

TEST(Triangulate, ManyCornersInASpiral) {
  // A band along a spiral: ears open at its ends only.
  Points points;
  const int n = 5000;
  for (int side = 0; side < 2; ++side) {
    for (int k = 0; k < n; ++k) {
      const int i = side == 0 ? k : n - 1 - k;
      const double r = 1 + i * 0.001 - (side == 0 ? 0 : 0.01);
      const auto [s, c] = sincos_degrees(i * 0.36);
      points.push_back({r * c, r * s, 0});
    }
  }
  expect_covers(points, 1e-10);
}

}  // namespace
}  // namespace lambent
