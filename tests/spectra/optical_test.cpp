#include "spectra/optical.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace lambent {
namespace {

const NamedGlass& glass(const std::string& name) {
  for (const NamedGlass& one : glasses())
    if (one.name == name) return one;
  throw std::out_of_range(name);
}
const NamedMetal& metal(const std::string& name) {
  for (const NamedMetal& one : metals())
    if (one.name == name) return one;
  throw std::out_of_range(name);
}

TEST(Glasses, HaveTheIndexAndTheAbbeNumberOfTheirDataSheets) {
  const struct {
    const char* name;
    double index, abbe;
  } sheets[] = {
      {"bk7", 1.51680, 64.17}, {"f2", 1.62004, 36.37}, {"sf11", 1.78472, 25.68}, {"silica", 1.45846, 67.82}};
  for (const auto& sheet : sheets) {
    EXPECT_NEAR(index_at(glass(sheet.name).index, line_d), sheet.index, 1e-5) << sheet.name;
    EXPECT_NEAR(abbe_of(glass(sheet.name).index), sheet.abbe, 0.01) << sheet.name;
  }
  EXPECT_NEAR(index_at(glass("water").index, line_d), 1.3334, 1e-4);
  EXPECT_NEAR(index_at(glass("diamond").index, line_d), 2.4175, 1e-3);
  EXPECT_NEAR(index_at(glass("sapphire").index, line_d), 1.7682, 1e-3);
}

TEST(Glasses, WaterAgreesWithHaleAndQuerry) {
  // Optical constants of water, Appl. Opt. 12, 1973, given to three places for 25 degrees
  for (const auto& [nm, n] : {std::pair{400.0, 1.339}, {500.0, 1.335}, {600.0, 1.332}, {700.0, 1.331}})
    EXPECT_NEAR(index_at(glass("water").index, nm), n, 5e-3) << nm;
}

TEST(Glasses, BendBlueMoreThanRed) {
  for (const NamedGlass& one : glasses())
    for (double nm = 380; nm < 780; nm += 10)
      EXPECT_GT(index_at(one.index, nm), index_at(one.index, nm + 10)) << one.name << " at " << nm;
}

TEST(Glasses, ByIndexAndAbbeNumberAreWhatTheySay) {
  const GlassIndex made = glass_of(1.6, 40);
  EXPECT_NEAR(index_at(made, line_d), 1.6, 1e-14);
  EXPECT_NEAR(abbe_of(made), 40, 1e-11);
}

TEST(Metals, HaveTheMeasuredValues) {
  // Johnson and Christy at 1.64 eV (756.0 nm) and 2.88 eV (430.5 nm)
  EXPECT_EQ(at(metal("gold").constants.n, 756), 0.14);
  EXPECT_EQ(at(metal("gold").constants.k, 756), 4.542);
  EXPECT_EQ(at(metal("silver").constants.n, 430.5), 0.04);
  EXPECT_EQ(at(metal("copper").constants.k, 430.5), 2.305);
}

TEST(Metals, OfThreeChannelsHaveTheirColour) {
  // The spectrum's colour where that is within what the metal reflects anywhere; gold's red is beyond.
  const auto reflected = [](const NamedMetal& one) {
    return rgb_of(
        [&](double nm) { return normal_reflectance(at(one.constants.n, nm), at(one.constants.k, nm)); });
  };
  for (const NamedMetal& one : metals()) {
    const RgbConstants rgb = rgb_constants(one.constants);
    const Rgb color = reflected(one);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(normal_reflectance(rgb.n[c], rgb.k[c]), std::min(color[c], 1.0),
                  std::string(one.name) == "gold" && c == 0 ? 0.03 : 1e-12)
          << one.name << ", channel " << c;
  }
  EXPECT_GT(reflected(metal("gold"))[0], 1);
}

}  // namespace
}  // namespace lambent
