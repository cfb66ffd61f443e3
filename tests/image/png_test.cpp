#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "image/damage.h"
#include "image/formats.h"
#include "image/png_session.h"
#include "image/srgb.h"
#include "lambent/image.h"

namespace lambent {
namespace {

std::string error_of(const Image& image, int bits = 8) {
  try {
    encode_png(image, {}, {bits, true}, "a.png");
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Png, HoldsLinearValuesWhereNoEncodingIsWanted) {
  const Image image{1, 1, {"R", "G", "B"}, {0.25f, 0.5f, 2.0f}};
  const Image read = decode_png(encode_png(image, {}, {8, false}, "a.png"), "a.png").image;
  const double want[] = {64 / 255.0, 128 / 255.0, 1};  // round(255 x), clamped
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(srgb_from_linear(read.data[c]), want[c], 1e-6);
}

TEST(Png, RoundsToTheNearestCodeAndClamps) {
  const Image image{
      2, 2, {"R", "G", "B"}, {0, 0.5f, 1, -1, 2, NAN, INFINITY, -INFINITY, 0.18f, 1e-9f, 0.9999f, 0.25f}};
  for (const int bits : {8, 16}) {
    const int maximum = (1 << bits) - 1;
    const Image read = decode_png(encode_png(image, {}, {bits, true}, "a.png"), "a.png").image;
    ASSERT_EQ(read.width, 2);
    ASSERT_EQ(read.height, 2);
    ASSERT_EQ(read.channels, image.channels);
    for (std::size_t i = 0; i < image.data.size(); ++i) {
      const int code = quantize(srgb_from_linear(double(image.data[i])), maximum);
      EXPECT_EQ(read.data[i], float(linear_from_srgb(double(code) / maximum)))
          << bits << " bits, value " << i;
    }
  }
}

TEST(Png, WritingWhatWasReadGivesTheSameBytes) {
  EXPECT_TRUE(rc::check([] {
    const int width = *rc::gen::inRange(1, 20), height = *rc::gen::inRange(1, 20),
              bits = *rc::gen::element(8, 16);
    Image image{width, height, {"R", "G", "B"}, {}};
    if (*rc::gen::arbitrary<bool>()) image.channels.push_back("A");
    image.data = *rc::gen::container<std::vector<float>>(
        std::size_t(width * height) * image.channels.size(),
        rc::gen::map(rc::gen::inRange(0, 1 << 24), [](int i) { return float(i) / float(1 << 24); }));
    const std::string bytes = encode_png(image, {{"key", "value"}}, {bits, true}, "a.png");
    const ReadImage read = decode_png(bytes, "a.png");
    RC_ASSERT(read.image.channels == image.channels);
    RC_ASSERT(encode_png(read.image, read.metadata, {bits, true}, "a.png") == bytes);
  }));
}

TEST(Png, AlphaIsNotEncodedAsAColour) {
  const Image image{1, 1, {"A", "B", "G", "R"}, {0.5f, 0.1f, 0.2f, 0.3f}};
  const Image read = decode_png(encode_png(image, {}, {16, true}, "a.png"), "a.png").image;
  ASSERT_EQ(read.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
  EXPECT_NEAR(read.data[0], 0.3, 2e-5);
  EXPECT_NEAR(read.data[1], 0.2, 2e-5);
  EXPECT_NEAR(read.data[2], 0.1, 2e-5);
  EXPECT_EQ(read.data[3], 32768 / 65535.0f);  // srgb(0.5) would be 48192
}

TEST(Png, TakesTheColoursOfALayeredPicture) {
  const Image image{1, 1, {"R", "Z", "G", "B", "diffuse.R"}, {1, 7, 0, 1, 5}};
  const Image read = decode_png(encode_png(image, {}, {8, true}, "a.png"), "a.png").image;
  EXPECT_EQ(read.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(read.data, (std::vector<float>{1, 0, 1}));
}

TEST(Png, ASingleChannelIsGrey) {
  const std::string bytes = encode_png({2, 1, {"Z"}, {0, 1}}, {}, {8, true}, "a.png");
  EXPECT_EQ(bytes[25], 0);  // IHDR's colour type: grey
  EXPECT_EQ(decode_png(bytes, "a.png").image.data, (std::vector<float>{0, 0, 0, 1, 1, 1}));
  const std::string with_alpha = encode_png({1, 1, {"A", "Y"}, {0, 1}}, {}, {8, true}, "a.png");
  EXPECT_EQ(with_alpha[25], 4);
  EXPECT_EQ(decode_png(with_alpha, "a.png").image.data, (std::vector<float>{1, 1, 1, 0}));
}

TEST(Png, SaysThatItIsSrgb) {
  EXPECT_NE(encode_png({1, 1, {"R", "G", "B"}, {0, 0, 0}}, {}, {8, true}, "a.png").find("sRGB"),
            std::string::npos);
}

TEST(Png, RefusesWhatItCannotHold) {
  EXPECT_EQ(
      error_of({1, 1, {"R", "Z", "light.R"}, {0, 0, 0}}),
      "a.png: error: a PNG needs the channels R, G and B, or a single one; the picture has R, Z, light.R\n"
      "    hint: EXR holds any channels: write to a name that ends in .exr");
  EXPECT_EQ(error_of({1, 1, {"R", "G", "B"}, {0, 0, 0}}, 12), "a.png: error: a PNG has 8 or 16 bits, not 12");
}

TEST(Png, MetadataComesBackAsItWas) {
  const Metadata metadata{{"Software", "Lambent"},
                          {"scene", "camera: {eye: [0, 1, 5]}\n\tsecond line"},
                          {"gr\xc3\xb6\xc3\x9f"
                           "e",
                           "\xe2\x88\xab L cos \xce\xb8"},  // in Latin-1: a keyword as it is
                          {"\xce\xb8", "not in Latin-1"},
                          {" two  spaces ", ""},
                          {"", "no key"},
                          {std::string(200, 'k'), "a long key"},
                          {"long", std::string(5000, 'v')}};
  const Image image{1, 1, {"R", "G", "B"}, {0, 0, 0}};
  Metadata expected = metadata;
  expected[5].first = "Comment";
  EXPECT_EQ(decode_png(encode_png(image, metadata, {8, true}, "a.png"), "a.png").metadata, expected);
}

TEST(Png, KeywordsKeepTheRules) {
  EXPECT_EQ(png_keyword("Title"), "Title");
  EXPECT_EQ(png_keyword("  a \n  b  "), "a ? b");
  EXPECT_EQ(png_keyword("\xce\xb8"), "?");
  EXPECT_EQ(png_keyword("\xc3\xa9\xc2\xa0"), "\xe9?");  // the no-break space is not allowed
  EXPECT_EQ(png_keyword(std::string(100, 'x')), std::string(79, 'x'));
  EXPECT_EQ(png_keyword(" "), "Comment");
  EXPECT_TRUE(rc::check([] {
    const std::string keyword = png_keyword(*rc::gen::arbitrary<std::string>());
    RC_ASSERT(keyword.size() >= 1 && keyword.size() <= 79);
    RC_ASSERT(keyword.front() != ' ' && keyword.back() != ' ');
    RC_ASSERT(keyword.find("  ") == std::string::npos);
    for (const char c : keyword) {
      const unsigned char byte = static_cast<unsigned char>(c);
      RC_ASSERT((byte >= 32 && byte <= 126) || byte >= 161);
    }
  }));
}

// Whatever bytes are damaged or missing: a picture or an InputError.
TEST(Png, DamageIsAnError) {
  Image image{16, 16, {"R", "G", "B"}, std::vector<float>(16 * 16 * 3, 0.5f)};
  test::expect_damage_is_an_error(encode_png(image, {{"key", "value"}}, {8, true}, "a.png"),
                                  [](std::string_view bytes) { return decode_png(bytes, "a.png"); });
}

TEST(Png, AHeaderAloneClaimsNoMemory) {
  const auto error = [](const std::string& ihdr, const std::string& crc) -> std::string {
    const std::string start("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR", 16),
        data("\0\0\0\0IDAT\x35\xaf\x06\x1e\0\0\0\0IEND\xae\x42\x60\x82", 24);
    try {
      decode_png(start + ihdr + crc + data, "a.png");
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  // 60000 x 20000 and 10000 x 10000 pixels of 16-bit RGBA in no bytes at all; the checksums are right.
  EXPECT_EQ(error(std::string("\0\0\xea\x60\0\0\x4e\x20\x10\x06\0\0\0", 13), "\x6c\xfe\x54\x10"),
            "a.png: error: the picture is too large: 60000 x 20000 pixels with 4 channels\n"
            "    hint: at most 2^30 values are read");
  EXPECT_EQ(error(std::string("\0\0\x27\x10\0\0\x27\x10\x10\x06\0\0\0", 13), "\xea\xde\xbe\x64"),
            "a.png: error: the file is damaged: 57 bytes cannot hold 10000 x 10000 pixels with 4 channels");
}

}  // namespace
}  // namespace lambent
