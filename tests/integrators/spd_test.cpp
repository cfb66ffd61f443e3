// Haines' Standard Procedural Databases: the rays that a scene takes, counted against his table. The format's
// files come with no picture to agree with bit for bit; the number of rays of each kind is what the benchmark
// compares, and it notices any error in geometry, shadows, reflection or refraction.

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "lambent/lambent.h"
#include "peers/conformance.h"
#include "support.h"

namespace lambent {
namespace {

struct Row {
  const char* file;
  std::uint64_t eye_hits, reflection, refraction, shadow;
};
void PrintTo(const Row& row, std::ostream* out) { *out << row.file; }
// "All within about 10 %" is his rule for acceptance; 1 % is ours.
const Row table[] = {
    {"balls_s4_c.nff", 263169, 175095, 0, 954368},      {"gears_s4_c.nff", 245086, 304643, 207564, 2246955},
    {"mount_s6_c.nff", 173125, 354769, 354769, 412922}, {"rings_s7_c.nff", 263169, 315236, 0, 1085002},
    {"teapot_s12_c.nff", 161120, 225248, 0, 407656},    {"tetra_s6_c.nff", 49788, 0, 0, 46112},
    {"tree_s11_c.nff", 169836, 0, 0, 1097419},
};

class Spd : public testing::TestWithParam<Row> {};

TEST_P(Spd, CountsTheRaysOfHainesTable) {
  const auto data = test::data_dir();
  if (!data) {
    test::not_compared("Haines' SPD", GetParam().file, "the SPD files are not here");
    GTEST_SKIP() << "the SPD files are not here: set LAMBENT_DATA to the folder that holds nff/spd";
  }
  const Row& row = GetParam();
  const auto rays = render(load_scene(*data + "/nff/spd/" + row.file)).stats.rays;
  const auto within = [](std::uint64_t got, std::uint64_t want) {
    return std::fabs(double(got) - double(want)) <= 0.01 * double(want);
  };
  EXPECT_EQ(rays.eye, 513u * 513u);
  EXPECT_TRUE(within(rays.eye_hits, row.eye_hits)) << rays.eye_hits << " for " << row.eye_hits;
  EXPECT_TRUE(within(rays.reflection, row.reflection)) << rays.reflection << " for " << row.reflection;
  EXPECT_TRUE(within(rays.refraction, row.refraction)) << rays.refraction << " for " << row.refraction;
  EXPECT_TRUE(within(rays.shadow, row.shadow)) << rays.shadow << " for " << row.shadow;

  double largest = 0;
  const auto compare = [&](std::uint64_t got, std::uint64_t want) {
    if (want > 0) largest = std::fmax(largest, std::fabs(double(got) - double(want)) / double(want));
  };
  compare(rays.eye_hits, row.eye_hits), compare(rays.reflection, row.reflection);
  compare(rays.refraction, row.refraction), compare(rays.shadow, row.shadow);
  test::conform("Haines' SPD", std::string("rays by kind, relative, of ") + row.file,
                fmt::format("{} rays", rays.eye + rays.reflection + rays.refraction + rays.shadow), 0.01,
                largest);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Spd, testing::ValuesIn(table), [](const auto& info) {
  const std::string file = info.param.file;
  return file.substr(0, file.find('_'));
});

}  // namespace
}  // namespace lambent
