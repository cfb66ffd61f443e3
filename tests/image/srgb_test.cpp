#include "image/srgb.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <bit>
#include <cmath>
#include <limits>

#include "lambent/image.h"

namespace lambent {
namespace {

TEST(Srgb, IsTheStandardsCurve) {
  // IEC 61966-2-1: 12.92 L up to 0.0031308, 1.055 L^(1/2.4) - 0.055 above.
  EXPECT_DOUBLE_EQ(srgb_from_linear(0.002), 12.92 * 0.002);
  EXPECT_NEAR(srgb_from_linear(0.5), 0.735356983052449, 1e-14);
  EXPECT_NEAR(srgb_from_linear(0.18), 1.055 * std::pow(0.18, 1 / 2.4) - 0.055, 1e-14);
  EXPECT_NEAR(linear_from_srgb(0.5), 0.214041140482233, 1e-14);
  EXPECT_DOUBLE_EQ(linear_from_srgb(0.02), 0.02 / 12.92);
  EXPECT_EQ(srgb_from_linear(0), 0);
  EXPECT_EQ(srgb_from_linear(1), 1);
  EXPECT_EQ(linear_from_srgb(1), 1);
}

TEST(Srgb, Clamps) {
  for (const double x : {-1.0, -0.0, std::nan(""), -HUGE_VAL}) {
    EXPECT_EQ(srgb_from_linear(x), 0);
    EXPECT_EQ(linear_from_srgb(x), 0);
  }
  for (const double x : {1.0000001, 7.0, HUGE_VAL}) {
    EXPECT_EQ(srgb_from_linear(x), 1);
    EXPECT_EQ(linear_from_srgb(x), 1);
  }
}

TEST(Srgb, OneCurveUndoesTheOther) {
  EXPECT_TRUE(rc::check([] {
    const double x = *rc::gen::inRange(0, 1 << 30) / double(1 << 30);
    // At the joint the two pieces of the standard leave a gap of 2e-8.
    RC_ASSERT(std::abs(linear_from_srgb(srgb_from_linear(x)) - x) < 1e-8);
  }));
}

TEST(Srgb, QuantizeRoundsToTheNearest) {
  EXPECT_EQ(quantize(0.4999 / 255, 255), 0);
  EXPECT_EQ(quantize(0.5001 / 255, 255), 1);
  EXPECT_EQ(quantize(254.5001 / 255, 255), 255);
  EXPECT_EQ(quantize(-3, 255), 0);
  EXPECT_EQ(quantize(std::nan(""), 255), 0);
  EXPECT_EQ(quantize(HUGE_VAL, 65535), 65535);
}

class SrgbQuantizerTest : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Bits, SrgbQuantizerTest, testing::Values(8, 16));

TEST_P(SrgbQuantizerTest, EveryCodeSurvivesDecodingAndEncoding) {
  const std::vector<float>& linear = linear_from_srgb_table(GetParam());
  ASSERT_EQ(linear.size(), std::size_t(1) << GetParam());
  for (std::size_t code = 0; code < linear.size(); ++code)
    ASSERT_EQ(srgb_quantizer(GetParam())(linear[code]), int(code));
}

// The table must be the formula, above all where one code ends and the next begins.
TEST_P(SrgbQuantizerTest, IsTheFormulaAtEveryStep) {
  const int maximum = (1 << GetParam()) - 1;
  const SrgbQuantizer& quantizer = srgb_quantizer(GetParam());
  for (int code = 1; code <= maximum; ++code) {
    const float x = float(linear_from_srgb((code - 0.5) / maximum));
    for (const float near : {std::nextafter(x, 0.0f), x, std::nextafter(x, 1.0f)})
      ASSERT_EQ(quantizer(near), quantize(srgb_from_linear(double(near)), maximum)) << near;
  }
}

TEST_P(SrgbQuantizerTest, IsTheFormulaForAnyFloat) {
  const int bits = GetParam();
  EXPECT_TRUE(rc::check([bits] {
    const float x = std::bit_cast<float>(*rc::gen::arbitrary<std::uint32_t>());
    RC_ASSERT(srgb_quantizer(bits)(x) == quantize(srgb_from_linear(double(x)), (1 << bits) - 1));
  }));
  // Most floats are far from [0, 1]: these are within.
  for (std::uint32_t pattern = 0; pattern <= std::bit_cast<std::uint32_t>(1.0f); pattern += 9973) {
    const float x = std::bit_cast<float>(pattern);
    ASSERT_EQ(srgb_quantizer(bits)(x), quantize(srgb_from_linear(double(x)), (1 << bits) - 1)) << x;
  }
}

}  // namespace
}  // namespace lambent
