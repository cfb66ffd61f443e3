#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <bit>
#include <cmath>

#include "image/damage.h"
#include "image/formats.h"
#include "lambent/image.h"

namespace lambent {
namespace {

std::string error_of(const Image& image, const Metadata& metadata) {
  try {
    encode_exr(image, metadata, "a.exr");
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

std::vector<std::uint32_t> bits_of(const std::vector<float>& values) {
  std::vector<std::uint32_t> bits;
  for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
  return bits;
}

TEST(Exr, EveryBitOfEveryFloatComesBack) {
  EXPECT_TRUE(rc::check([] {
    Image image{*rc::gen::inRange(1, 40), *rc::gen::inRange(1, 40), {"R", "G", "B"}, {}};
    const std::size_t samples = std::size_t(image.width * image.height) * 3;
    for (std::size_t i = 0; i < samples; ++i)
      image.data.push_back(std::bit_cast<float>(*rc::gen::arbitrary<std::uint32_t>()));
    const Image read = decode_exr(encode_exr(image, {}, "a.exr"), "a.exr").image;
    RC_ASSERT(read.width == image.width);
    RC_ASSERT(read.height == image.height);
    RC_ASSERT(read.channels == image.channels);
    RC_ASSERT(bits_of(read.data) == bits_of(image.data));
  }));
}

TEST(Exr, SpecialValuesComeBack) {
  const Image image{3, 1, {"R", "G", "B"}, {NAN, INFINITY, -INFINITY, -0.0f, 1e-45f, 3e38f, -2, 1e6f, 0.1f}};
  EXPECT_EQ(bits_of(decode_exr(encode_exr(image, {}, "a.exr"), "a.exr").image.data), bits_of(image.data));
}

TEST(Exr, LayersComeBackInTheirOrder) {
  // Two pixels; written in an order of no meaning, read layer by layer, R, G, B, A first.
  const Image image{
      2,
      1,
      {"light.key.diffuse.B", "Z", "A", "light.key.diffuse.R", "B", "G", "light.key.diffuse.G", "R"},
      {1, 2, 3, 4, 5, 6, 7, 8, 11, 12, 13, 14, 15, 16, 17, 18}};
  const Image read = decode_exr(encode_exr(image, {}, "a.exr"), "a.exr").image;
  EXPECT_EQ(read.channels, (std::vector<std::string>{"R", "G", "B", "A", "Z", "light.key.diffuse.R",
                                                     "light.key.diffuse.G", "light.key.diffuse.B"}));
  EXPECT_EQ(read.data, (std::vector<float>{8, 6, 5, 3, 2, 4, 7, 1, 18, 16, 15, 13, 12, 14, 17, 11}));
  const Difference difference = compare_images(image, read);
  EXPECT_EQ(difference.differing_pixels, 0u);
}

TEST(Exr, MetadataComesBackAsItWas) {
  const Metadata metadata{{"Software", "Lambent"},
                          {"a long name, longer than thirty-one bytes", "\xe2\x88\xab L"},
                          {"empty", ""}};
  EXPECT_EQ(decode_exr(encode_exr({1, 1, {"R"}, {1}}, metadata, "a.exr"), "a.exr").metadata, metadata);
}

TEST(Exr, TheSamePictureIsTheSameBytes) {
  const Image image{64, 64, {"R", "G", "B"}, std::vector<float>(64 * 64 * 3, 0.25f)};
  const std::string bytes = encode_exr(image, {{"b", "2"}, {"a", "1"}}, "first.exr");
  EXPECT_EQ(bytes, encode_exr(image, {{"a", "1"}, {"b", "2"}}, "second.exr"));
  for (const char* changing : {"capDate", "utcOffset", "owner", "first.exr"})
    EXPECT_EQ(bytes.find(changing), std::string::npos) << changing;
}

TEST(Exr, AnyNumberOfThreadsWritesTheSameBytes) {
  Image image{97, 331, {"B", "G", "R", "Z"}, {}};
  for (int i = 0; i < 97 * 331 * 4; ++i) image.data.push_back(std::sin(0.01f * float(i)));
  const std::string bytes = encode_exr(image, {}, "a.exr", 1);
  for (const int threads : {2, 3, 8, 0}) EXPECT_EQ(encode_exr(image, {}, "a.exr", threads), bytes) << threads;
}

TEST(Exr, RefusesNamesThatTheFormatCannotHold) {
  const Image image{1, 1, {"R"}, {1}};
  EXPECT_EQ(error_of(image, {{"", "x"}}), "a.exr: error: a metadata key has 1 to 255 bytes in EXR, not ''");
  EXPECT_EQ(error_of(image, {{"dataWindow", "x"}}),
            "a.exr: error: the metadata key 'dataWindow' is reserved by EXR");
  EXPECT_EQ(error_of({1, 1, {""}, {1}}, {}),
            "a.exr: error: a channel's name has 1 to 255 bytes in EXR, not ''");
  EXPECT_EQ(error_of({1, 1, {std::string(256, 'c')}, {1}}, {}),
            "a.exr: error: a channel's name has 1 to 255 bytes in EXR, not '" + std::string(256, 'c') + "'");
}

TEST(Exr, DamageIsAnError) {
  const Image image{16, 16, {"R", "G", "B"}, std::vector<float>(16 * 16 * 3, 0.5f)};
  test::expect_damage_is_an_error(encode_exr(image, {{"key", "value"}}, "a.exr"),
                                  [](std::string_view bytes) { return decode_exr(bytes, "a.exr"); });
}

TEST(Exr, AHeaderAloneClaimsNoMemory) {
  const std::string good = encode_exr({16, 16, {"R"}, std::vector<float>(256)}, {}, "a.exr");
  const std::string window("dataWindow\0box2i\0\x10\0\0\0", 21);
  const std::size_t x_max = good.find(window) + window.size() + 8;
  const auto error_with_width = [&](const std::string& little_endian) -> std::string {
    std::string bytes = good;
    bytes.replace(x_max, 4, little_endian);
    try {
      decode_exr(bytes, "a.exr");
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(error_with_width(std::string("\xff\xff\x3f\0", 4)),
            "a.exr: error: the file is damaged: " + std::to_string(good.size()) +
                " bytes cannot hold 4194304 x 16 pixels with 1 channel");
  EXPECT_EQ(error_with_width("\xff\xff\xff\x0f"),
            "a.exr: error: the picture is too large: 268435456 x 16 pixels with 1 channel\n"
            "    hint: at most 2^30 values are read");
  EXPECT_EQ(error_with_width(std::string("\x0f\0\0\0", 4)), "");  // the window as it was
}

TEST(Exr, ErrorsDoNotRepeatTheFilesName) {
  const std::string good = encode_exr({16, 16, {"R"}, std::vector<float>(256)}, {}, "a.exr");
  try {
    decode_exr(std::string_view(good).substr(0, good.size() - 1), "a.exr");
    FAIL() << "read a file without its end";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "a.exr: error: cannot read the EXR: the file ends too early");
  }
}

}  // namespace
}  // namespace lambent
