#include <gtest/gtest.h>

#include <cmath>

#include "lambent/diagnostics.h"
#include "lambent/image.h"

namespace lambent {
namespace {

TEST(CompareImages, EqualPicturesDoNotDiffer) {
  Image image{2, 1, {"R", "G", "B"}, {0, 0.5f, 1, NAN, INFINITY, -1}};
  const Difference difference = compare_images(image, image);
  EXPECT_EQ(difference.largest, 0);
  EXPECT_EQ(difference.differing_pixels, 0u);
  EXPECT_EQ(difference.channel, "");
  EXPECT_EQ(difference.picture.data, std::vector<float>(6));
}

TEST(CompareImages, MeasuresWhatDiffers) {
  const Image a{2, 2, {"R", "G", "B"}, {0, 0, 0, 1, 1, 1, 0.5f, 0.5f, 0.5f, 0, 0, 0}};
  Image b = a;
  b.pixel(0, 1)[1] = 0.25f;
  b.pixel(1, 1)[0] = 0.125f;
  b.pixel(0, 0)[2] = -0.0f;  // another bit, the same value
  const Difference difference = compare_images(a, b);
  EXPECT_EQ(difference.largest, 0.25);
  EXPECT_EQ(difference.x, 0);
  EXPECT_EQ(difference.y, 1);
  EXPECT_EQ(difference.channel, "G");
  EXPECT_DOUBLE_EQ(difference.mean, (0.25 + 0.125) / 12);
  EXPECT_DOUBLE_EQ(difference.root_mean_square, std::sqrt((0.25 * 0.25 + 0.125 * 0.125) / 12));
  EXPECT_EQ(difference.largest_relative, 1);  // 0.125 against nothing
  EXPECT_EQ(difference.differing_pixels, 3u);
  // srgb(0.125) = 0.3885728 is 99 of 255; srgb(0.5) is 188 and srgb(0.25) is 137.
  EXPECT_EQ(difference.largest_8_bit, 99);
  EXPECT_EQ(difference.picture.channels, a.channels);
  EXPECT_EQ(difference.picture.pixel(0, 1)[1], 0.25f);
  EXPECT_EQ(difference.picture.pixel(1, 1)[0], 0.125f);
  EXPECT_EQ(difference.picture.pixel(0, 0)[2], 0.0f);
}

TEST(CompareImages, ValuesNearZeroHaveNoRelativeDifference) {
  const Difference difference = compare_images({1, 1, {"Z"}, {1e-7f}}, {1, 1, {"Z"}, {2e-7f}});
  EXPECT_GT(difference.largest, 0);
  EXPECT_EQ(difference.largest_relative, 0);
}

TEST(CompareImages, DataBesideTheColoursIsNotShownInEightBits) {
  const Difference difference = compare_images({1, 1, {"Z"}, {0}}, {1, 1, {"Z"}, {1}});
  EXPECT_EQ(difference.largest, 1);
  EXPECT_EQ(difference.largest_8_bit, 0);
}

TEST(CompareImages, NanOnOneSideIsAnInfiniteDifference) {
  for (const float odd : {NAN, INFINITY, -INFINITY}) {
    const Difference difference = compare_images({1, 1, {"R"}, {odd}}, {1, 1, {"R"}, {0.5f}});
    EXPECT_EQ(difference.largest, INFINITY);
    EXPECT_EQ(difference.largest_relative, INFINITY);
    EXPECT_EQ(difference.mean, INFINITY);
    EXPECT_EQ(difference.differing_pixels, 1u);
  }
  EXPECT_EQ(compare_images({1, 1, {"R"}, {NAN}}, {1, 1, {"R"}, {NAN}}).largest, 0);
}

TEST(CompareImages, ChannelsAreMatchedByName) {
  const Difference difference = compare_images({1, 1, {"R", "G"}, {1, 2}}, {1, 1, {"G", "R"}, {2, 1}});
  EXPECT_EQ(difference.largest, 0);
  EXPECT_EQ(difference.differing_pixels, 0u);
}

TEST(CompareImages, RefusesWhatCannotBeCompared) {
  const auto message = [](const Image& a, const Image& b) -> std::string {
    try {
      compare_images(a, b);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(message({2, 1, {"R"}, {0, 0}}, {1, 2, {"R"}, {0, 0}}),
            "error: the pictures differ in size: 2 x 1 and 1 x 2 pixels");
  EXPECT_EQ(message({1, 1, {"R"}, {0}}, {1, 1, {"Z"}, {0}}),
            "error: the pictures have different channels: R and Z");
  EXPECT_EQ(message({1, 1, {"R"}, {0}}, {1, 1, {"R", "A"}, {0, 0}}),
            "error: the pictures have different channels: R and R, A");
}

}  // namespace
}  // namespace lambent
