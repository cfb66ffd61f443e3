#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lambent/diagnostics.h"
#include "lambent/sheet.h"

namespace lambent {
namespace {

/// Ottosson's Oklab of a linear sRGB colour: the inverse of what the colour map is made by.
struct Oklab {
  double L, a, b;
};
Oklab oklab_from_linear(const std::array<float, 3>& color) {
  const double r = double(color[0]), g = double(color[1]), b = double(color[2]);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

TEST(DivergingColor, IsItsFormula) {
  constexpr double degree = 3.14159265358979 / 180;
  for (int i = -100; i <= 100; ++i) {
    const double t = i / 100.0, size = std::abs(t), hue = (t < 0 ? 250 : 40) * degree;
    const Oklab lab = oklab_from_linear(diverging_color(t));
    // 1e-4: Ottosson's two matrices invert each other to six digits.
    EXPECT_NEAR(lab.L, 0.25 + 0.45 * size, 1e-4) << t;
    EXPECT_NEAR(lab.a, 0.15 * size * std::cos(hue), 1e-4) << t;
    EXPECT_NEAR(lab.b, 0.15 * size * std::sin(hue), 1e-4) << t;
  }
}

TEST(DivergingColor, IsNeutralAtZeroMonotoneAndSymmetric) {
  const std::array<float, 3> zero = diverging_color(0);
  EXPECT_NEAR(zero[0], zero[1], 1e-6);
  EXPECT_NEAR(zero[0], zero[2], 1e-6);
  double last_lightness = 0, last_yellow = -1;
  for (int i = -1000; i <= 1000; ++i) {
    const double t = i / 1000.0;
    const Oklab lab = oklab_from_linear(diverging_color(t));
    EXPECT_NEAR(lab.L, oklab_from_linear(diverging_color(-t)).L, 1e-4) << t;
    EXPECT_GT(lab.b, last_yellow) << "from blue to yellow without a turn, at " << t;
    last_yellow = lab.b;
    EXPECT_TRUE(i < 1 || lab.L > last_lightness) << t;
    last_lightness = lab.L;
  }
}

TEST(DivergingColor, EveryColourIsOneThatAScreenCanShow) {
  for (int i = -1000; i <= 1000; ++i)
    for (const float channel : diverging_color(i / 1000.0)) {
      EXPECT_GE(channel, 0);
      EXPECT_LE(channel, 1);
    }
}

TEST(DivergingColor, EndsAtItsEnds) {
  for (const double t : {1.0001, 7.0, double(INFINITY)}) {
    EXPECT_EQ(diverging_color(t), diverging_color(1));
    EXPECT_EQ(diverging_color(-t), diverging_color(-1));
  }
  EXPECT_EQ(diverging_color(NAN), diverging_color(1));
}

TEST(SignedDifference, OfColoursIsThatOfTheirLuminance) {
  const Image a{2, 2, {"R", "G", "B"}, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0.5f, 0.5f, 0.5f}};
  const Image b{2, 2, {"R", "G", "B"}, {0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1}};
  const SignedDifference difference = signed_difference(a, b);
  EXPECT_EQ(difference.values.channels, std::vector<std::string>{"Y"});
  EXPECT_EQ(difference.values.data, (std::vector<float>{0.2126f, 0.7152f, 0.0722f, -0.5f}));
  EXPECT_DOUBLE_EQ(difference.largest, 0.7152);
  EXPECT_EQ(difference.x, 1);
  EXPECT_EQ(difference.y, 0);
  EXPECT_DOUBLE_EQ(difference.mean, 0.125);            // (1 - 0.5) / 4
  EXPECT_DOUBLE_EQ(difference.mean_magnitude, 0.375);  // (1 + 0.5) / 4
}

TEST(SignedDifference, TheOtherWayRoundHasTheOtherSign) {
  const Image a{2, 1, {"R", "G", "B"}, {0.1f, 0.9f, 0.3f, 2, 3, 4}};
  const Image b{2, 1, {"B", "R", "G"}, {0.2f, 0.4f, 0.5f, 1, 0, 1}};
  const SignedDifference ab = signed_difference(a, b), ba = signed_difference(b, a);
  EXPECT_EQ(ab.largest, -ba.largest);
  EXPECT_EQ(ab.mean, -ba.mean);
  EXPECT_EQ(ab.mean_magnitude, ba.mean_magnitude);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(ab.values.data[i], -ba.values.data[i]);
  // 0.2126 * 2 + 0.7152 * 2 + 0.0722 * 3, channels by their names; far above 1, and not clamped.
  EXPECT_NEAR(ab.largest, 2.0722, 1e-12);
}

TEST(SignedDifference, TheLargestIsTheFarthestFromZeroWithItsSign) {
  const SignedDifference difference =
      signed_difference({3, 1, {"Y"}, {0.25f, 0, 0}}, {3, 1, {"Y"}, {0, 0.5f, 0.5f}});
  EXPECT_EQ(difference.largest, -0.5);
  EXPECT_EQ(difference.x, 1) << "of equal ones the first";
  EXPECT_EQ(difference.values.data, (std::vector<float>{0.25f, -0.5f, -0.5f}));
}

TEST(SignedDifference, EqualPicturesHaveNone) {
  const Image odd{2, 1, {"R", "G", "B"}, {NAN, 0, 1, INFINITY, 1, 1}};
  const SignedDifference difference = signed_difference(odd, odd);
  EXPECT_EQ(difference.largest, 0);
  EXPECT_EQ(difference.mean_magnitude, 0);
  EXPECT_EQ(difference.values.data, std::vector<float>(2));
  EXPECT_EQ(signed_difference({1, 1, {"Y"}, {NAN}}, {1, 1, {"Y"}, {1}}).largest, INFINITY);
}

TEST(SignedDifference, RefusesPicturesOfTwoSizes) {
  try {
    signed_difference({2, 1, {"Y"}, {0, 0}}, {1, 2, {"Y"}, {0, 0}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "error: the pictures differ in size: 2 x 1 and 1 x 2 pixels");
  }
}

TEST(ColorBarLimit, IsARoundNumberNotBelow) {
  const double expected[][2] = {{1, 1},          {1.01, 1.5},  {0.16, 0.2},   {-0.29, 0.3},
                                {4.2, 5},        {6.9, 7},     {7.1, 10},     {99, 100},
                                {0.00031, 5e-4}, {1500, 1500}, {1.2e6, 1.5e6}};
  for (const auto& [largest, limit] : expected)
    EXPECT_NEAR(color_bar_limit(largest), limit, 1e-9 * limit) << largest;
  for (double largest = 1e-9; largest < 1e9; largest *= 1.37) {
    EXPECT_GE(color_bar_limit(largest), largest * (1 - 1e-12));
    EXPECT_LE(color_bar_limit(largest), 1.67 * largest);  // the widest step is from 3 to 5
  }
  for (const double none : {0.0, double(INFINITY), double(NAN)}) EXPECT_EQ(color_bar_limit(none), 1);
}

TEST(DifferencePicture, IsTheColourMapOfEveryValuesRoot) {
  const Image values{5, 1, {"Y"}, {-2, 0, 0.5f, -0.125f, 7}};
  const Image picture = difference_picture(values, 2), plain = difference_picture(values, 2, false);
  ASSERT_EQ(picture.width, 5);
  const double t[] = {-1, 0, 0.5, -0.25, 1};
  for (int x = 0; x < 5; ++x)
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(picture.pixel(x, 0)[c], diverging_color(t[x])[std::size_t(c)]);
      EXPECT_EQ(plain.pixel(x, 0)[c], float(srgb_from_linear(double(picture.pixel(x, 0)[c]))));
    }
  EXPECT_THROW(difference_picture(values, 0), InputError);
  EXPECT_THROW(difference_picture(values, NAN), InputError);
  EXPECT_THROW(difference_picture({1, 1, {"R", "G", "B"}, {0, 0, 0}}, 1), InputError);
}

}  // namespace
}  // namespace lambent
