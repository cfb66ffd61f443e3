// Which samples see which moment.

#include "film/shutter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "film/pattern.h"

namespace lambent {
namespace {

TEST(Shutter, DealsEachSampleOnceAndTimeByTheirNumber) {
  for (const int samples : {1, 2, 7, 16, 17, 64, 100, 256})
    for (const int slices : {1, 2, 12, 16, 300}) {
      const Shutter shutter = open_shutter(samples, slices);
      ASSERT_EQ(std::size_t(std::min(samples, slices)), shutter.slices.size());
      EXPECT_EQ(std::size_t(samples), std::set<int>(shutter.order.begin(), shutter.order.end()).size());
      int next = 0;
      double mean = 0;
      for (const Slice& slice : shutter.slices) {
        EXPECT_EQ(next, slice.first);
        EXPECT_LE(std::abs((slice.end - slice.first) - samples / double(shutter.slices.size())), 1);
        // In the middle of what its samples stand for.
        EXPECT_DOUBLE_EQ((slice.first + slice.end) / (2.0 * samples), slice.time);
        mean += slice.time * (slice.end - slice.first) / samples;
        next = slice.end;
      }
      EXPECT_EQ(samples, next);
      EXPECT_NEAR(0.5, mean, 1e-12);
    }
}

// A slice's samples are spread over the pixel by themselves: of 256 samples in 16 slices each slice has 16,
// one in each column and each row of sixteen, and the places say nothing about the time.
TEST(Shutter, ASlicesSamplesAreSpreadOverThePixel) {
  const Shutter shutter = open_shutter(256, 16);
  const std::vector<Vec2<double>> pattern = progressive_pattern(256, 256, Filter::box);
  double covariance = 0;
  for (const Slice& slice : shutter.slices) {
    std::set<int> columns;
    for (int i = slice.first; i < slice.end; ++i) {
      const Vec2<double>& at = pattern[std::size_t(shutter.order[std::size_t(i)])];
      columns.insert(int(at.x * 16));
      covariance += (at.x - 0.5) * (slice.time - 0.5) / 256;
    }
    EXPECT_EQ(16u, columns.size());
  }
  EXPECT_NEAR(0, covariance, 0.001);
}

}  // namespace
}  // namespace lambent
