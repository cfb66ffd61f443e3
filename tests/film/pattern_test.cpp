#include "film/pattern.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "film/film.h"
#include "film/mean.h"

namespace lambent {
namespace {

TEST(Pattern, OneSampleIsTheCentre) {
  for (Filter filter : {Filter::box, Filter::tent}) {
    const auto points = sample_pattern(1, filter);
    ASSERT_EQ(points.size(), 1u);
    EXPECT_EQ(points[0].x, 0.5);
    EXPECT_EQ(points[0].y, 0.5);
  }
}

TEST(Pattern, EveryRowAndColumnHoldsOneSample) {
  for (int n : {2, 3, 4, 7, 16, 100}) {
    std::set<int> rows, columns;
    double x = 0, y = 0;
    for (const auto& point : sample_pattern(n, Filter::box)) {
      columns.insert(int(point.x * n));
      rows.insert(int(point.y * n));
      x += point.x, y += point.y;
    }
    EXPECT_EQ(int(rows.size()), n);
    EXPECT_EQ(int(columns.size()), n);
    EXPECT_NEAR(x / n, 0.5, 1e-12);  // balanced around the centre
    EXPECT_NEAR(y / n, 0.5, 1e-12);
  }
}

TEST(Pattern, EveryDyadicBoxHoldsOneSampleWhereTheCountIsAPowerOfTwo) {
  for (int bits = 1; bits <= 8; ++bits)
    for (int wide = 0; wide <= bits; ++wide) {
      const int columns = 1 << wide, rows = 1 << (bits - wide);
      std::set<int> boxes;
      for (const auto& point : sample_pattern(1 << bits, Filter::box))
        boxes.insert(int(point.y * rows) * columns + int(point.x * columns));
      EXPECT_EQ(int(boxes.size()), 1 << bits) << columns << " x " << rows;
    }
}

// Of an edge at x = c the left part of the pixel is seen. Over all shifts the share of the samples there has
// the mean c, and each is off by 1 / n at the most.
TEST(Pattern, OfAllShiftsTheMeanIsRightAtEdges) {
  constexpr int n = 8, shifts = 512;
  for (const double c : {0.01, 0.3, 0.77}) {
    double mean = 0;
    for (int i = 0; i < shifts; ++i) {
      const Vec2<double> shift{(i + 0.5) / shifts, 1 - (i + 0.5) / shifts};
      for (const auto& points :
           {sample_pattern(n, Filter::box, shift), progressive_pattern(n, n, Filter::box, shift)}) {
        double seen = 0;
        for (const auto& point : points) {
          ASSERT_TRUE(point.x >= 0 && point.x < 1 && point.y >= 0 && point.y < 1);
          seen += point.x < c ? 1.0 / n : 0;
        }
        EXPECT_LE(std::abs(seen - c), 1.0 / n + 1e-12);
        mean += seen / (2 * shifts);
      }
    }
    EXPECT_NEAR(mean, c, 1.0 / shifts);
  }
}

TEST(Pattern, EveryBeginningOfAProgressivePatternIsSpreadEvenly) {
  // The first 4^k points are a net: every dyadic box of that area holds one, moved by a whole or half cell.
  const int start = 4;
  const auto points = progressive_pattern(256, start, Filter::box);
  for (const int bits : {2, 4, 6, 8})
    for (int wide = 0; wide <= bits; ++wide) {
      const int columns = 1 << wide, rows = 1 << (bits - wide);
      std::set<int> boxes;
      const auto cell = [&](double a, int cells) {  // as if not moved
        const double back = a - 0.5 / start;
        return int((back < 0 ? back + 1 : back) * cells);
      };
      for (int i = 0; i < 1 << bits; ++i)
        boxes.insert(cell(points[i].y, rows) * columns + cell(points[i].x, columns));
      EXPECT_EQ(int(boxes.size()), 1 << bits) << columns << " x " << rows;
    }
  double x = 0, y = 0;
  for (int i = 0; i < start; ++i) x += points[i].x, y += points[i].y;
  EXPECT_EQ(x / start, 0.5);  // balanced around the centre
  EXPECT_EQ(y / start, 0.5);
}

TEST(Pattern, TentHasTheTentsVariance) {
  // The variance of the weight 1 - |x| on [-1, 1] is 1/6.
  double sum = 0;
  const auto points = sample_pattern(4096, Filter::tent);
  for (const auto& point : points) sum += (point.x - 0.5) * (point.x - 0.5);
  EXPECT_NEAR(sum / 4096, 1.0 / 6, 1e-3);
}

TEST(Film, IsBlackAtFirstHoweverManyThreadsAreBusyWithIt) {
  for (const auto& [width, height] : {std::pair{1, 1}, {63, 5}, {1237, 911}})
    for (const int threads : {1, 2, 3}) {
      ImageSettings settings;
      settings.width = width, settings.height = height;
      const Film film(settings, nullptr, threads);
      EXPECT_EQ(std::size_t(width) * std::size_t(height) * color_channels, film.values.size());
      EXPECT_TRUE(std::all_of(film.values.begin(), film.values.end(), [](float v) { return v == 0; }));
    }
}

TEST(Film, AMeanHasTheBitsOfTheQuotient) {
  std::mt19937 random(3);
  for (int samples = 1; samples <= 1024; ++samples) {
    const Mean<double> mean(samples);
    for (const double lowest : {-1074.0, -30.0}) {
      const double sum = std::exp2(std::uniform_real_distribution<double>(lowest, 10)(random));
      ASSERT_EQ(sum / samples, mean.of(sum)) << sum << ", " << samples << " samples";
    }
  }
}

TEST(Film, CornersAreAveraged) {
  ImageSettings settings;
  settings.width = 2, settings.height = 1, settings.pattern = Pattern::corners;
  Film film(settings);
  film.values.clear();
  for (float v : {0.f, 1.f, 4.f, 3.f, 0.f, 8.f})
    film.values.insert(film.values.end(), {v, 2 * v, 0});  // 3 x 2 corners
  const Image image = develop(film, settings);
  EXPECT_EQ(image.pixel(0, 0)[0], (0 + 1 + 3 + 0) / 4.f);
  EXPECT_EQ(image.pixel(1, 0)[0], (1 + 4 + 0 + 8) / 4.f);
  EXPECT_EQ(image.pixel(1, 0)[1], (2 + 8 + 0 + 16) / 4.f);
}

}  // namespace
}  // namespace lambent
