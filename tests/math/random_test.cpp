#include "math/random.h"

#include <gtest/gtest.h>

#include <set>

namespace lambent {
namespace {

// A (0, 2)-sequence: of 2^k points that begin at a multiple of 2^k, every box 2^-a by 2^-(k - a) holds one.
TEST(RandomPoints, HaveOneInEveryDyadicBoxOfTheirNumber) {
  for (const std::uint64_t seed : {0u, 1u, 77u, 123456789u})
    for (const std::uint32_t begin : {0u, 64u, 1024u})
      for (int a = 0; a <= 6; ++a) {
        std::set<std::pair<int, int>> boxes;
        for (std::uint32_t i = begin; i < begin + 64; ++i) {
          const Vec2<double> p = random_point(i, hashed(seed));
          ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
          boxes.insert({int(p.x * (1 << a)), int(p.y * (1 << (6 - a)))});
        }
        EXPECT_EQ(boxes.size(), 64u) << "boxes 2^-" << a << " wide, seed " << seed << ", from " << begin;
      }
}

TEST(RandomPoints, OfPacketsHaveTheBitsOfSingleOnes) {
  constexpr int lanes = native_float_lanes;
  for (std::uint64_t round = 0; round < 100; ++round) {
    std::uint32_t index[lanes];
    std::uint64_t seed[lanes];
    for (int k = 0; k < lanes; ++k) {
      seed[k] = hashed(round * lanes + std::uint64_t(k));
      index[k] = std::uint32_t(hashed(seed[k]) >> (round % 32));
    }
    const Vec2<Pack<double, lanes>> points = random_points(index, seed);
    for (int k = 0; k < lanes; ++k) {
      const Vec2<double> one = random_point(index[k], seed[k]);
      EXPECT_EQ(lane(points.x, k), one.x);
      EXPECT_EQ(lane(points.y, k), one.y);
    }
  }
}

// Points of two seeds have nothing to do with each other: the covariance of their coordinates is that of
// independent numbers, 0, with a standard deviation of 1 / (12 sqrt n).
TEST(RandomPoints, OfDifferentSeedsAreIndependent) {
  constexpr int n = 4096;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    double sum[4] = {};
    for (std::uint32_t i = 0; i < n; ++i) {
      const Vec2<double> p = random_point(i, hashed(seed)), q = random_point(i, hashed(seed + 100));
      sum[0] += (p.x - 0.5) * (q.x - 0.5), sum[1] += (p.x - 0.5) * (q.y - 0.5);
      sum[2] += (p.y - 0.5) * (q.x - 0.5), sum[3] += (p.y - 0.5) * (q.y - 0.5);
    }
    for (const double one : sum) EXPECT_LT(std::abs(one / n), 5 / (12 * std::sqrt(double(n)))) << seed;
  }
}

// The mean of x over all seeds at one index is 1/2, its variance 1/12: each point is uniform by itself.
TEST(RandomPoints, AreUniformOverTheSeeds) {
  constexpr int n = 20000;
  double mean_x = 0, mean_y = 0, square = 0;
  for (std::uint64_t seed = 0; seed < n; ++seed) {
    const Vec2<double> p = random_point(3, hashed(seed));
    mean_x += p.x / n, mean_y += p.y / n, square += (p.x - 0.5) * (p.x - 0.5) / n;
  }
  EXPECT_NEAR(mean_x, 0.5, 5 / std::sqrt(12.0 * n));
  EXPECT_NEAR(mean_y, 0.5, 5 / std::sqrt(12.0 * n));
  EXPECT_NEAR(square, 1.0 / 12, 0.002);
}

}  // namespace
}  // namespace lambent
