#include "scene/mip_levels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "lambent/image.h"

namespace lambent {
namespace {

Texture bytes_of(int width, int height, int channels, const std::vector<std::uint8_t>& bytes, bool srgb) {
  Texture texture;
  texture.srgb = srgb;
  texture.channels = channels;
  texture.levels = {{width, height, 0}};
  texture.bytes = bytes;
  build_levels(texture);
  return texture;
}
Texture floats_of(int width, int height, int channels, const std::vector<float>& floats) {
  Texture texture;
  texture.channels = channels;
  texture.levels = {{width, height, 0}};
  texture.floats = floats;
  build_levels(texture);
  return texture;
}

TEST(MipLevels, HalveDownToOneTexel) {
  const Texture texture = bytes_of(13, 3, 2, std::vector<std::uint8_t>(13 * 3 * 2, 9), true);
  std::vector<std::pair<int, int>> sizes;
  std::size_t first = 0;
  for (const Texture::Level& level : texture.levels) {
    sizes.emplace_back(level.width, level.height);
    EXPECT_EQ(level.first, first);
    first += std::size_t(level.width * level.height * 2);
  }
  EXPECT_EQ(sizes, (std::vector<std::pair<int, int>>{{13, 3}, {6, 1}, {3, 1}, {1, 1}}));
  EXPECT_EQ(texture.bytes.size(), first);
}

TEST(MipLevels, AConstantImageStays) {
  for (const int value : {0, 1, 2, 77, 128, 254, 255})
    for (const bool srgb : {true, false}) {
      const Texture texture =
          bytes_of(23, 17, 3, std::vector<std::uint8_t>(23 * 17 * 3, std::uint8_t(value)), srgb);
      for (const std::uint8_t byte : texture.bytes) ASSERT_EQ(byte, value);
    }
}

TEST(MipLevels, MeansAreOfLight) {
  // A checkerboard of black and white is half the light: 0.5, encoded 188.
  const std::vector<std::uint8_t> board{0, 255, 255, 0};
  EXPECT_EQ(bytes_of(2, 2, 1, board, true).bytes.back(), 188);
  EXPECT_EQ(std::lround(255 * srgb_from_linear(0.5)), 188);
  // As data it is the mean of the numbers, 127.5 rounded up.
  EXPECT_EQ(bytes_of(2, 2, 1, board, false).bytes.back(), 128);
}

TEST(MipLevels, AlphaIsData) {
  const std::vector<std::uint8_t> board{0, 0, 255, 255, 255, 255, 0, 0};
  const Texture grey = bytes_of(2, 2, 2, board, true);
  EXPECT_EQ(grey.bytes[8], 188);
  EXPECT_EQ(grey.bytes[9], 128);
  const Texture colour = bytes_of(2, 1, 4, {0, 0, 0, 0, 255, 255, 255, 255}, true);
  EXPECT_EQ(colour.bytes[8], 188);
  EXPECT_EQ(colour.bytes[11], 128);
}

TEST(MipLevels, OddSizesKeepTheMean) {
  constexpr std::pair<int, int> sizes[] = {{5, 3}, {7, 1}, {1, 9}, {31, 17}};
  for (const auto& [width, height] : sizes) {
    std::vector<float> floats;
    for (int i = 0; i < width * height; ++i) floats.push_back(float((i * 7919) % 101));
    const double mean = std::accumulate(floats.begin(), floats.end(), 0.0) / double(floats.size());
    const Texture texture = floats_of(width, height, 1, floats);
    for (const Texture::Level& level : texture.levels) {
      const auto begin = texture.floats.begin() + std::ptrdiff_t(level.first);
      const int count = level.width * level.height;
      // Sums of floats: a few roundings of 2^-24 each.
      EXPECT_NEAR(std::accumulate(begin, begin + count, 0.0) / count, mean, 1e-5 * mean);
    }
  }
}

TEST(MipLevels, AnOddSideIsShared) {
  // 3 texels become 1: a third each. 5 become 2: each is 2.5 wide.
  EXPECT_FLOAT_EQ(floats_of(3, 1, 1, {3, 6, 12}).floats.back(), 7);
  const Texture texture = floats_of(5, 1, 1, {10, 20, 30, 40, 50});
  EXPECT_FLOAT_EQ(texture.floats[5], (10 + 20 + 15) / 2.5f);
  EXPECT_FLOAT_EQ(texture.floats[6], (15 + 40 + 50) / 2.5f);
}

}  // namespace
}  // namespace lambent
