#include "spectra/spectrum.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace lambent {
namespace {

Rgb seen_through(const WavelengthSet& set, const auto& relative) {
  Rgb sum{};
  for (std::size_t i = 0; i < set.wavelengths.size(); ++i)
    sum = sum + double(relative(set.wavelengths[i])) * set.weights[i];
  return sum;
}
void expect_near(const Rgb& a, const Rgb& b, double tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << "channel " << c;
}

TEST(Spectrum, WhiteIsWhite) {
  expect_near(rgb_of([](double) { return 1; }), {{1, 1, 1}}, 1e-14);
}

TEST(Spectrum, D65HasTheChromaticityThatTheStandardSays) {
  // (x, y) = (0.3127, 0.3290). In linear sRGB, whose white it is, equal energy is a little red:
  // E / D65 -> xyz = (1, 1, 1) by the standard matrix: 3.2404542 - 1.5371385 - 0.4985314 = 1.2047844, ...
  const Rgb equal_energy = rgb_of([](double nm) { return 1 / d65_at(nm); });
  const double y = 0.2126 * equal_energy[0] + 0.7152 * equal_energy[1] + 0.0722 * equal_energy[2];
  expect_near((1 / y) * equal_energy, {{1.2048, 0.9483, 0.9089}}, 1e-3);
}

TEST(Spectrum, BasisIsAReflectanceAndAddsUpToOne) {
  for (double nm = 350; nm <= 800; nm += 0.5) {
    const Rgb basis = basis_at(nm);
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(basis[c], -1e-7) << nm;
      EXPECT_LE(basis[c], 1) << nm;
    }
    EXPECT_NEAR(basis[0] + basis[1] + basis[2], 1, 1e-15) << nm;
  }
}

TEST(Spectrum, BasisLooksLikeThePrimariesInD65) {
  for (int p = 0; p < 3; ++p) {
    Rgb primary{};
    primary[p] = 1;
    expect_near(rgb_of([&](double nm) { return upsample(primary, nm); }), primary, 1e-6);
  }
}

RC_GTEST_PROP(Spectrum, GreyIsTheSameAtEveryWavelengthInEveryBit, ()) {
  const double grey = *rc::gen::inRange(0, 100000) / 1000.0, nm = *rc::gen::inRange(3000, 9000) / 10.0;
  RC_ASSERT(upsample({{grey, grey, grey}}, nm) == grey);
}

RC_GTEST_PROP(Spectrum, ColoursComeBackFromTheirSpectra, ()) {
  Rgb color;
  for (int c = 0; c < 3; ++c) color[c] = *rc::gen::inRange(0, 1001) / 1000.0;
  const Rgb back = rgb_of([&](double nm) { return upsample(color, nm); });
  for (int c = 0; c < 3; ++c) RC_ASSERT(std::abs(back[c] - color[c]) < 1e-6);
}

RC_GTEST_PROP(Spectrum, WhiteIsWhiteWithAnyWavelengths, ()) {
  std::vector<double> wavelengths;
  double nm = 360;
  for (int i = *rc::gen::inRange(1, 20); i > 0 && nm < 775; --i)
    wavelengths.push_back(nm += *rc::gen::inRange(1, 400) / 10.0);
  const Rgb white = seen_through(wavelength_set(wavelengths), [](double) { return 1; });
  for (int c = 0; c < 3; ++c) RC_ASSERT(std::abs(white[c] - 1) < 1e-13);
}

TEST(WavelengthSet, StraightSpectraNeedNoMoreThanTheirCorners) {
  // 0.2 at 400 nm, 0.9 at 600 nm, straight between them and constant beyond: two wavelengths say it all.
  const Samples straight{{400, 600}, {0.2, 0.9}};
  const auto relative = [&](double nm) { return at(straight, nm); };
  expect_near(seen_through(wavelength_set({400, 600}), relative), rgb_of(relative), 1e-14);
}

TEST(WavelengthSet, ATableOfTheTablesOwnWavelengthsIsExact) {
  std::vector<double> all;
  for (double nm = shortest_wavelength; nm <= longest_wavelength; nm += table_step) all.push_back(nm);
  const auto red = [](double nm) { return upsample({{0.8, 0.1, 0.05}}, nm); };
  expect_near(seen_through(wavelength_set(all), red), rgb_of(red), 1e-14);
}

TEST(WavelengthSet, TwelveShowColoursWithinThreeHundredths) {
  for (int p = 0; p < 3; ++p) {
    Rgb primary{};
    primary[p] = 1;
    const auto relative = [&](double nm) { return upsample(primary, nm); };
    expect_near(seen_through(wavelength_set(even_wavelengths(12)), relative), primary, 0.035);
    expect_near(seen_through(wavelength_set(even_wavelengths(36)), relative), primary, 0.005);
  }
}

TEST(WavelengthSet, TwelveLieThirtyNanometresApart) {
  const auto twelve = even_wavelengths(12);
  ASSERT_EQ(twelve.size(), 12u);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(twelve[std::size_t(i)], 390 + 30 * i);
}

TEST(Samples, RunStraightAndStayAtTheEnds) {
  const Samples samples{{400, 500, 700}, {1, 3, 2}};
  EXPECT_EQ(at(samples, 350), 1);
  EXPECT_EQ(at(samples, 400), 1);
  EXPECT_EQ(at(samples, 450), 2);
  EXPECT_EQ(at(samples, 500), 3);
  EXPECT_EQ(at(samples, 600), 2.5);
  EXPECT_EQ(at(samples, 900), 2);
}

TEST(Blackbody, FollowsPlanck) {
  // M(l1) / M(l2) = (l2 / l1)^5 (e^(c2 / (l2 T)) - 1) / (e^(c2 / (l1 T)) - 1), c2 = 1.438776877e7 nm K
  const double c2 = 1.438776877e7;
  for (const double T : {1500.0, 2856.0, 5000.0, 20000.0}) {
    const double expected =
        std::pow(700.0 / 450, 5) * std::expm1(c2 / (700 * T)) / std::expm1(c2 / (450 * T));
    EXPECT_NEAR(at(Blackbody{T}, 450) / at(Blackbody{T}, 700), expected, 1e-12 * expected) << T;
  }
}

TEST(RelativeLight, IsAsBrightAsWhite) {
  const auto luminance = [](const LightSpectrum& spectrum) {
    const RelativeLight light(spectrum);
    const Rgb rgb = rgb_of([&](double nm) { return light.at(nm); });
    return 0.2126390 * rgb[0] + 0.7151687 * rgb[1] + 0.0721923 * rgb[2];  // the second row of the standard
  };
  EXPECT_NEAR(luminance(Blackbody{1000}), 1, 2e-4);
  EXPECT_NEAR(luminance(Blackbody{2856}), 1, 2e-4);
  EXPECT_NEAR(luminance(Blackbody{15000}), 1, 2e-4);
  EXPECT_NEAR(luminance(Samples{{500, 560, 600}, {0, 7, 0}}), 1, 2e-4);
}

TEST(RelativeLight, OfIlluminantAHasItsChromaticity) {
  // A is a black body of 2856 K; (x, y) = (0.4476, 0.4074). Linear sRGB by the standard matrix of
  // XYZ = (x / y, 1, (1 - x - y) / y) = (1.0987, 1, 0.3559).
  const RelativeLight a{Blackbody{2856}};
  expect_near(rgb_of([&](double nm) { return a.at(nm); }), {{1.8456, 0.8259, 0.2334}}, 2e-3);
}

}  // namespace
}  // namespace lambent
