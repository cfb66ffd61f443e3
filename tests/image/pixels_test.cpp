#include "image/pixels.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstddef>
#include <cstdio>
// jpeglib.h wants the two above.
#include <jpeglib.h>
#include <png.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "image/damage.h"
#include "image/formats.h"
#include "lambent/diagnostics.h"
#include "lambent/image.h"
#include "support.h"

namespace lambent {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

std::string error_of(std::string_view bytes, const Limits& limits = {}) {
  try {
    read_pixels(bytes, "a.img", limits);
    return "";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().at(0).place.file, "a.img");
    EXPECT_FALSE(error.diagnostics().at(0).hint.empty()) << error.what();
    return error.what();
  }
}
void expect_error(std::string_view bytes, const std::string& part, const Limits& limits = {}) {
  const std::string error = error_of(bytes, limits);
  EXPECT_NE(error.find(part), std::string::npos) << error;
}

/// Bytes in hexadecimal, spaces between them as one likes.
std::string hex(std::string_view text) {
  std::string bytes, digits;
  for (const char c : text) {
    if (c != ' ') digits += c;
    if (digits.size() == 2) {
      bytes += char(std::stoi(digits, nullptr, 16));
      digits.clear();
    }
  }
  return bytes;
}
std::string le16(int value) { return {char(value & 255), char(value >> 8 & 255)}; }
std::string le32(std::uint32_t value) { return le16(int(value & 0xffff)) + le16(int(value >> 16)); }

// ---- PNG

/// A PNG of `type` with 8 or 16 bits, or fewer, whose rows are given as they stand in the file.
std::string png_of(int width, int height, int type, int bits, std::vector<Bytes> rows,
                   bool interlaced = false, const std::vector<png_color>& palette = {},
                   const Bytes& palette_alpha = {}, const png_color_16* transparent = nullptr) {
  std::string file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &file,
      [](png_structp p, png_bytep data, png_size_t size) {
        static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<char*>(data), size);
      },
      [](png_structp) {});
  png_set_IHDR(png, info, png_uint_32(width), png_uint_32(height), bits, type,
               interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (!palette.empty()) png_set_PLTE(png, info, palette.data(), int(palette.size()));
  if (!palette_alpha.empty())
    png_set_tRNS(png, info, palette_alpha.data(), int(palette_alpha.size()), nullptr);
  if (transparent != nullptr) png_set_tRNS(png, info, nullptr, 0, transparent);
  png_write_info(png, info);
  std::vector<png_bytep> pointers;
  for (Bytes& row : rows) pointers.push_back(row.data());
  png_write_image(png, pointers.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return file;
}

TEST(Pixels, PngOfEveryColourType) {
  const Pixels grey = read_pixels(png_of(2, 2, PNG_COLOR_TYPE_GRAY, 8, {{1, 2}, {3, 254}}), "a.png");
  EXPECT_EQ(grey.channels, 1);
  EXPECT_EQ(grey.bytes, (Bytes{1, 2, 3, 254}));
  const Pixels grey_alpha =
      read_pixels(png_of(1, 2, PNG_COLOR_TYPE_GRAY_ALPHA, 8, {{1, 2}, {3, 4}}), "a.png");
  EXPECT_EQ(grey_alpha.channels, 2);
  EXPECT_EQ(grey_alpha.bytes, (Bytes{1, 2, 3, 4}));
  const Pixels colour = read_pixels(png_of(2, 1, PNG_COLOR_TYPE_RGB, 8, {{1, 2, 3, 4, 5, 6}}), "a.png");
  EXPECT_EQ(colour.channels, 3);
  EXPECT_EQ(colour.bytes, (Bytes{1, 2, 3, 4, 5, 6}));
  const Pixels with_alpha = read_pixels(png_of(1, 1, PNG_COLOR_TYPE_RGBA, 8, {{1, 2, 3, 4}}), "a.png");
  EXPECT_EQ(with_alpha.channels, 4);
  EXPECT_EQ(with_alpha.bytes, (Bytes{1, 2, 3, 4}));
  EXPECT_TRUE(with_alpha.floats.empty());
}

TEST(Pixels, PngOfFewBits) {
  // Grey of b bits is n * 255 / (2^b - 1).
  EXPECT_EQ(read_pixels(png_of(8, 1, PNG_COLOR_TYPE_GRAY, 1, {{0xa0}}), "a.png").bytes,
            (Bytes{255, 0, 255, 0, 0, 0, 0, 0}));
  EXPECT_EQ(read_pixels(png_of(4, 1, PNG_COLOR_TYPE_GRAY, 2, {{0x1b}}), "a.png").bytes,
            (Bytes{0, 85, 170, 255}));
  EXPECT_EQ(read_pixels(png_of(2, 1, PNG_COLOR_TYPE_GRAY, 4, {{0x1f}}), "a.png").bytes, (Bytes{17, 255}));
}

TEST(Pixels, PngPalettesAndTransparentColours) {
  const std::vector<png_color> palette{{10, 20, 30}, {40, 50, 60}, {70, 80, 90}};
  const Pixels plain =
      read_pixels(png_of(4, 1, PNG_COLOR_TYPE_PALETTE, 2, {{0x24}}, false, palette), "a.png");
  EXPECT_EQ(plain.channels, 3);
  EXPECT_EQ(plain.bytes, (Bytes{10, 20, 30, 70, 80, 90, 40, 50, 60, 10, 20, 30}));
  const Pixels clear =
      read_pixels(png_of(2, 1, PNG_COLOR_TYPE_PALETTE, 8, {{2, 0}}, false, palette, {5, 6}), "a.png");
  EXPECT_EQ(clear.channels, 4);
  EXPECT_EQ(clear.bytes, (Bytes{70, 80, 90, 255, 10, 20, 30, 5}));
  png_color_16 key{};
  key.gray = 7;
  const Pixels keyed =
      read_pixels(png_of(2, 1, PNG_COLOR_TYPE_GRAY, 8, {{7, 8}}, false, {}, {}, &key), "a.png");
  EXPECT_EQ(keyed.channels, 2);
  EXPECT_EQ(keyed.bytes, (Bytes{7, 0, 8, 255}));
}

TEST(Pixels, SixteenBitsAreFloatsThatAreStillEncoded) {
  const Pixels pixels =
      read_pixels(png_of(2, 1, PNG_COLOR_TYPE_GRAY, 16, {{0x12, 0x34, 0xff, 0xff}}), "a.png");
  EXPECT_TRUE(pixels.bytes.empty());
  EXPECT_FALSE(pixels.linear);
  EXPECT_EQ(pixels.floats, (std::vector<float>{float(0x1234) / 65535.0f, 1}));
}

TEST(Pixels, InterlacedPngEqualsItsTwin) {
  std::vector<Bytes> rows;
  for (int y = 0; y < 9; ++y) {
    rows.emplace_back();
    for (int i = 0; i < 3 * 11; ++i) rows.back().push_back(std::uint8_t(y * 37 + i * 11));
  }
  EXPECT_EQ(read_pixels(png_of(11, 9, PNG_COLOR_TYPE_RGB, 8, rows, true), "a.png").bytes,
            read_pixels(png_of(11, 9, PNG_COLOR_TYPE_RGB, 8, rows, false), "a.png").bytes);
}

TEST(Pixels, OwnPngIsRead) {
  const Image image{1, 1, {"R", "G", "B"}, {0, 0.5f, 1}};
  const std::string bytes = encode_png(image, {}, {8, false}, "a.png");
  EXPECT_EQ(read_pixels(bytes, "a.png").bytes, (Bytes{0, 128, 255}));
  const PixelSize size = pixel_size(bytes, "a.png");
  EXPECT_EQ(size.format, "PNG");
  EXPECT_EQ(size.channels, 3);
}

// ---- JPEG

struct JpegWish {
  int components = 3;
  J_COLOR_SPACE from = JCS_RGB, to = JCS_YCbCr;
  bool progressive = false;
  bool adobe = true;
};
std::string jpeg_of(int width, int height, const std::vector<Bytes>& rows, const JpegWish& wish = {}) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = JDIMENSION(width), jpeg.image_height = JDIMENSION(height);
  jpeg.input_components = wish.components, jpeg.in_color_space = wish.from;
  jpeg_set_defaults(&jpeg);
  jpeg_set_colorspace(&jpeg, wish.to);
  jpeg_set_quality(&jpeg, 100, TRUE);
  jpeg.write_Adobe_marker = wish.adobe ? TRUE : FALSE;
  for (int c = 0; c < jpeg.num_components; ++c)
    jpeg.comp_info[c].h_samp_factor = jpeg.comp_info[c].v_samp_factor = 1;
  if (wish.progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  for (Bytes row : rows) {
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&jpeg, &pointer, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  const std::string file(reinterpret_cast<char*>(bytes), size);
  std::free(bytes);
  return file;
}
/// A plane of one colour, so that nothing is lost.
std::vector<Bytes> flat(int width, int height, const Bytes& pixel) {
  Bytes row;
  for (int x = 0; x < width; ++x) row.insert(row.end(), pixel.begin(), pixel.end());
  return std::vector<Bytes>(std::size_t(height), row);
}
void expect_flat(const Pixels& pixels, const Bytes& pixel) {
  ASSERT_EQ(std::size_t(pixels.channels), pixel.size());
  ASSERT_EQ(pixels.bytes.size(), std::size_t(pixels.width * pixels.height) * pixel.size());
  for (std::size_t i = 0; i < pixels.bytes.size(); ++i)
    ASSERT_NEAR(pixels.bytes[i], pixel[i % pixel.size()], 2) << i;  // JPEG rounds twice
}

TEST(Pixels, JpegOfEveryColourSpace) {
  expect_flat(read_pixels(jpeg_of(17, 9, flat(17, 9, {200, 100, 50})), "a.jpg"), {200, 100, 50});
  expect_flat(
      read_pixels(jpeg_of(17, 9, flat(17, 9, {99}), {1, JCS_GRAYSCALE, JCS_GRAYSCALE, false, true}), "a.jpg"),
      {99});
  expect_flat(
      read_pixels(jpeg_of(17, 9, flat(17, 9, {9, 8, 7}), {3, JCS_RGB, JCS_RGB, false, true}), "a.jpg"),
      {9, 8, 7});
  expect_flat(read_pixels(jpeg_of(20, 30, flat(20, 30, {200, 100, 50}), {3, JCS_RGB, JCS_YCbCr, true, true}),
                          "a.jpg"),
              {200, 100, 50});
}

TEST(Pixels, InksBecomeLights) {
  // Cyan 51, black 102 of 255: R = (1 - 0.2) (1 - 0.4) = 0.48; G = B = 0.6.
  const Bytes lights{122, 153, 153};
  const Bytes inks{51, 0, 0, 102}, inverted{204, 255, 255, 153};
  expect_flat(read_pixels(jpeg_of(8, 8, flat(8, 8, inks), {4, JCS_CMYK, JCS_CMYK, false, false}), "a.jpg"),
              lights);
  expect_flat(read_pixels(jpeg_of(8, 8, flat(8, 8, inverted), {4, JCS_CMYK, JCS_CMYK, false, true}), "a.jpg"),
              lights);
  expect_flat(read_pixels(jpeg_of(8, 8, flat(8, 8, inverted), {4, JCS_CMYK, JCS_YCCK, true, true}), "a.jpg"),
              lights);
}

TEST(Pixels, RowsAndColumnsOfAJpegStayInPlace) {
  std::vector<Bytes> rows = flat(32, 16, {0, 0, 0});
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 24; ++x) rows[0 + std::size_t(y)][std::size_t(x)] = 255;  // 8 x 8 at the top left
  const Pixels pixels = read_pixels(jpeg_of(32, 16, rows), "a.jpg");
  EXPECT_EQ(pixels.width, 32);
  EXPECT_EQ(pixels.height, 16);
  EXPECT_GT(pixels.bytes[0], 240);
  EXPECT_LT(pixels.bytes[3 * 31], 15);
  EXPECT_LT(pixels.bytes[3 * 32 * 15], 15);
}

TEST(Pixels, AJpegOfManyScansIsRefused) {
  // One scan of a progressive JPEG, repeated: it refines nothing and costs a pass over the image each time.
  const std::string jpeg = jpeg_of(64, 64, flat(64, 64, {99}), {1, JCS_GRAYSCALE, JCS_GRAYSCALE, true, true});
  const std::size_t last = jpeg.rfind("\xff\xda");
  std::string many = jpeg.substr(0, jpeg.size() - 2);
  for (int i = 0; i < 200; ++i) many += jpeg.substr(last, jpeg.size() - 2 - last);
  many += "\xff\xd9";
  expect_error(many, "it has more than 100 scans");
}

// ---- Radiance HDR

const std::string hdr_head = "#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1.0\n\n";

TEST(Pixels, HdrWithoutPacking) {
  const std::string bytes = hdr_head + "-Y 1 +X 2\n" + hex("80 40 00 81  ff 00 01 00");
  const Pixels pixels = read_pixels(bytes, "a.hdr");
  EXPECT_TRUE(pixels.linear);
  EXPECT_EQ(pixels.channels, 3);
  EXPECT_EQ(pixels.floats, (std::vector<float>{1, 0.5f, 0, 0, 0, 0}));  // 0x80 * 2^(129 - 136) = 1
  EXPECT_EQ(pixel_size(bytes, "a.hdr").format, "Radiance HDR");
}

TEST(Pixels, HdrInBothPackings) {
  // (1, 1, 1, n): the pixel before, n times more.
  const Pixels old =
      read_pixels(hdr_head + "-Y 1 +X 4\n" + hex("80 80 80 81 01 01 01 02 80 80 80 82"), "a.hdr");
  EXPECT_EQ(old.floats, (std::vector<float>{1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2}));
  // Each byte of 8 pixels apart: a run of 8; 8 as they are; a run of 4 and 4 as they are; a run of 8.
  const Pixels apart =
      read_pixels(hdr_head + "-Y 1 +X 8\n" +
                      hex("02 02 00 08  88 80  08 00 01 02 03 04 05 06 07  84 40 04 50 51 52 53  88 81"),
                  "a.hdr");
  ASSERT_EQ(apart.floats.size(), 24u);
  for (std::size_t x = 0; x < 8; ++x) {
    EXPECT_EQ(apart.floats[3 * x], 1);
    EXPECT_EQ(apart.floats[3 * x + 1], float(x) / 128);
    EXPECT_EQ(apart.floats[3 * x + 2], float(x < 4 ? 0x40 : 0x50 + x - 4) / 128);
  }
}

TEST(Pixels, HdrInEveryOrientation) {
  // Two columns and three rows; red is the number of the pixel in reading order, over 128.
  const auto red = [](const std::string& order, const std::string& numbers) {
    std::string bytes = hdr_head + order + "\n";
    for (const char c : numbers) bytes += {char(c - '0'), 0, 0, char(0x81)};
    std::string read;
    const Pixels pixels = read_pixels(bytes, "a.hdr");
    EXPECT_EQ(pixels.width, 2);
    EXPECT_EQ(pixels.height, 3);
    for (std::size_t i = 0; i < pixels.floats.size(); i += 3) read += char('0' + int(pixels.floats[i] * 128));
    return read;
  };
  EXPECT_EQ(red("-Y 3 +X 2", "123456"), "123456");
  EXPECT_EQ(red("-Y 3 -X 2", "214365"), "123456");
  EXPECT_EQ(red("+Y 3 +X 2", "563412"), "123456");
  EXPECT_EQ(red("+X 2 -Y 3", "135246"), "123456");
  EXPECT_EQ(red("-X 2 +Y 3", "642531"), "123456");
}

TEST(Pixels, BrokenHdr) {
  expect_error("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n", "values of another kind");
  expect_error(hdr_head + "-Y 1 -Y 1\n", "its resolution line is not like '-Y 512 +X 1024'");
  expect_error(hdr_head + "-Y 0 +X 1\n", "its resolution line");
  expect_error(hdr_head + "-Y 1 +X 9999999999\n", "its resolution line");
  expect_error(hdr_head + "-Y 1 +X 2\n" + hex("80 80 80 81 01 01 01 02"), "a run leads beyond its scan line");
  expect_error(hdr_head + "-Y 1 +X 2\n" + hex("01 01 01 01 01 01 01 02"), "a run leads beyond its scan line");
  expect_error(hdr_head + "-Y 1 +X 8\n" + hex("02 02 00 09"), "another length");
  expect_error(hdr_head + "-Y 1 +X 8\n" + hex("02 02 00 08 00"), "a run leads beyond its scan line");
  expect_error(hdr_head + "-Y 1 +X 2\n" + hex("80 80 80 81"), "the file ends too early");
}

// ---- OpenEXR

TEST(Pixels, ExrGivesItsColours) {
  const Image image{2, 1, {"A", "B", "G", "R", "Z"}, {0.5f, 3, 2, 1, 9, 1, -6, NAN, INFINITY, 9}};
  const std::string bytes = encode_exr(image, {}, "a.exr");
  const Pixels pixels = read_pixels(bytes, "a.exr");
  EXPECT_TRUE(pixels.linear);
  EXPECT_EQ(pixels.channels, 4);
  EXPECT_EQ(pixels.floats, (std::vector<float>{1, 2, 3, 0.5f, 65504, 0, -6, 1}));
  EXPECT_EQ(pixel_size(bytes, "a.exr").channels, 4);
}

TEST(Pixels, ExrOfGreyOrLayers) {
  const auto floats = [](const Image& image) {
    return read_pixels(encode_exr(image, {}, "a.exr"), "a.exr").floats;
  };
  EXPECT_EQ(floats({1, 1, {"Y"}, {0.25f}}), (std::vector<float>{0.25f}));
  EXPECT_EQ(floats({1, 1, {"height"}, {0.25f}}), (std::vector<float>{0.25f}));
  EXPECT_EQ(floats({1, 1, {"A", "Y"}, {0.5f, 0.25f}}), (std::vector<float>{0.25f, 0.5f}));
  EXPECT_EQ(floats({1, 1, {"x.B", "x.G", "x.R"}, {3, 2, 1}}), (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(floats({1, 1, {"B", "G", "R", "a.B", "a.G", "a.R"}, {3, 2, 1, 6, 5, 4}}),
            (std::vector<float>{1, 2, 3}));
  expect_error(encode_exr({1, 1, {"U", "V"}, {3, 2}}, {}, "a.exr"), "has no colours: its channels are U, V");
}

// ---- TGA

std::string tga_of(int palette_type, int kind, int palette_count, int palette_bits, int width, int height,
                   int bits, int descriptor, const std::string& rest) {
  return std::string{0, char(palette_type), char(kind)} + le16(0) + le16(palette_count) + char(palette_bits) +
         le16(0) + le16(0) + le16(width) + le16(height) + char(bits) + char(descriptor) + rest;
}

TEST(Pixels, TgaOfEveryKind) {
  const auto bytes = [](const std::string& file) { return read_pixels(file, "a.tga").bytes; };
  // From the top; the colours stand as B, G, R.
  EXPECT_EQ(bytes(tga_of(0, 2, 0, 0, 2, 1, 24, 0x20, hex("030201 060504"))), (Bytes{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(bytes(tga_of(0, 2, 0, 0, 1, 1, 32, 0x28, hex("03020107"))), (Bytes{1, 2, 3, 7}));
  EXPECT_EQ(bytes(tga_of(0, 2, 0, 0, 2, 1, 16, 0x20, hex("007c 1f00"))), (Bytes{255, 0, 0, 0, 0, 255}));
  EXPECT_EQ(bytes(tga_of(0, 2, 0, 0, 1, 1, 16, 0x21, hex("00fc"))), (Bytes{255, 0, 0, 255}));
  EXPECT_EQ(bytes(tga_of(0, 3, 0, 0, 2, 1, 8, 0x20, hex("0709"))), (Bytes{7, 9}));
  EXPECT_EQ(bytes(tga_of(0, 3, 0, 0, 1, 1, 16, 0x28, hex("0709"))), (Bytes{7, 9}));
  EXPECT_EQ(bytes(tga_of(1, 1, 2, 24, 2, 1, 8, 0x20, hex("030201 060504 01 00"))), (Bytes{4, 5, 6, 1, 2, 3}));
  // A run of three, then one as it is.
  EXPECT_EQ(bytes(tga_of(0, 10, 0, 0, 4, 1, 24, 0x20, hex("82 030201 00 060504"))),
            (Bytes{1, 2, 3, 1, 2, 3, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(bytes(tga_of(0, 11, 0, 0, 4, 1, 8, 0x20, hex("82 05 00 06"))), (Bytes{5, 5, 5, 6}));
  EXPECT_EQ(bytes(tga_of(1, 9, 2, 24, 3, 1, 8, 0x20, hex("030201 060504 82 01"))),
            (Bytes{4, 5, 6, 4, 5, 6, 4, 5, 6}));
}

TEST(Pixels, TgaFromAnyCorner) {
  const auto bytes = [](int descriptor) {
    return read_pixels(tga_of(0, 3, 0, 0, 2, 2, 8, descriptor, hex("01020304")), "a.tga").bytes;
  };
  EXPECT_EQ(bytes(0x20), (Bytes{1, 2, 3, 4}));
  EXPECT_EQ(bytes(0x00), (Bytes{3, 4, 1, 2}));
  EXPECT_EQ(bytes(0x30), (Bytes{2, 1, 4, 3}));
  EXPECT_EQ(bytes(0x10), (Bytes{4, 3, 2, 1}));
}

TEST(Pixels, AnAlphaThatIsZeroEverywhereIsNotMeant) {
  EXPECT_EQ(read_pixels(tga_of(0, 2, 0, 0, 1, 1, 32, 0x20, hex("03020100")), "a.tga").bytes,
            (Bytes{1, 2, 3, 255}));
}

TEST(Pixels, BrokenTga) {
  expect_error(tga_of(0, 2, 0, 0, 2, 1, 24, 0x20, hex("030201 0605")), "the file ends too early");
  expect_error(tga_of(0, 10, 0, 0, 2, 1, 24, 0x20, hex("82 030201")), "a run leads beyond the image");
  expect_error(tga_of(1, 1, 1, 24, 1, 1, 8, 0x20, hex("030201 01")), "the palette does not have");
  // What no TGA has is no TGA.
  for (const std::string& file :
       {tga_of(2, 1, 1, 24, 1, 1, 8, 0x20, hex("030201 00")),
        tga_of(0, 4, 0, 0, 1, 1, 24, 0x20, hex("030201")), tga_of(0, 2, 0, 0, 0, 1, 24, 0x20, ""),
        tga_of(0, 2, 0, 0, 1, 1, 17, 0x20, hex("030201")), tga_of(0, 2, 0, 0, 1, 1, 24, 0xe0, hex("030201"))})
    expect_error(file, "this is no image of a known format");
}

// ---- BMP

std::string bmp_of(int width, int height, int bits, int packing, const std::string& masks,
                   const std::string& palette, int colors, const std::string& pixels) {
  const std::uint32_t before = std::uint32_t(14 + 40 + masks.size() + palette.size());
  return "BM" + le32(before + std::uint32_t(pixels.size())) + le32(0) + le32(before) + le32(40) +
         le32(std::uint32_t(width)) + le32(std::uint32_t(height)) + le16(1) + le16(bits) +
         le32(std::uint32_t(packing)) + le32(0) + le32(0) + le32(0) + le32(std::uint32_t(colors)) + le32(0) +
         masks + palette + pixels;
}
const std::string two_colors = hex("03020100 06050400");

TEST(Pixels, BmpOfEveryDepth) {
  const auto bytes = [](const std::string& file) { return read_pixels(file, "a.bmp").bytes; };
  // From the bottom; rows are filled up to four bytes.
  EXPECT_EQ(bytes(bmp_of(1, 2, 24, 0, "", "", 0, hex("03020100 06050400"))), (Bytes{4, 5, 6, 1, 2, 3}));
  EXPECT_EQ(bytes(bmp_of(1, -2, 24, 0, "", "", 0, hex("03020100 06050400"))), (Bytes{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(bytes(bmp_of(1, 1, 32, 0, "", "", 0, hex("03020107"))), (Bytes{1, 2, 3}));
  EXPECT_EQ(bytes(bmp_of(2, 1, 16, 0, "", "", 0, hex("007c1f00"))), (Bytes{255, 0, 0, 0, 0, 255}));
  EXPECT_EQ(bytes(bmp_of(2, 1, 1, 0, "", two_colors, 2, hex("40000000"))), (Bytes{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(bytes(bmp_of(2, 1, 4, 0, "", two_colors, 2, hex("01000000"))), (Bytes{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(bytes(bmp_of(2, 1, 8, 0, "", two_colors, 2, hex("01000000"))), (Bytes{4, 5, 6, 1, 2, 3}));
  // 5, 6 and 5 bits; then 8 each with alpha.
  EXPECT_EQ(bytes(bmp_of(1, 1, 16, 3, hex("00f80000 e0070000 1f000000"), "", 0, hex("e0070000"))),
            (Bytes{0, 255, 0}));
  EXPECT_EQ(bytes(bmp_of(1, 1, 32, 6, hex("ff000000 00ff0000 0000ff00 000000ff"), "", 0, hex("01020304"))),
            (Bytes{1, 2, 3, 4}));
}

TEST(Pixels, BmpInRuns) {
  const auto bytes = [](int packing, int bits, const std::string& runs) {
    return read_pixels(bmp_of(3, 2, bits, packing, "", two_colors, 2, runs), "a.bmp").bytes;
  };
  const Bytes a{1, 2, 3}, b{4, 5, 6};
  const auto pixels = [&](const std::string& names) {
    Bytes all;
    for (const char c : names)
      all.insert(all.end(), c == 'a' ? a.begin() : b.begin(), c == 'a' ? a.end() : b.end());
    return all;
  };
  // The lower row: a run of three; the upper one: three as they are.
  EXPECT_EQ(bytes(1, 8, hex("03 01 00 00  00 03 01 00 01 00  00 01")), pixels("bab"
                                                                              "bbb"));
  EXPECT_EQ(bytes(2, 4, hex("03 10 00 00  00 03 10 10  00 01")), pixels("bab"
                                                                        "bab"));
  // One to the right and one up, then one pixel.
  EXPECT_EQ(bytes(1, 8, hex("00 02 01 01 01 01 00 01")), pixels("aba"
                                                                "aaa"));
}

TEST(Pixels, BrokenBmp) {
  expect_error(bmp_of(2, 1, 24, 0, "", "", 0, hex("030201")), "the file ends too early");
  expect_error(bmp_of(1, 1, 24, 4, "", "", 0, ""), "packed in a way that is not read: 4");
  expect_error(bmp_of(1, 1, 5, 0, "", "", 0, ""), "5 bits a pixel do not go with its packing");
  expect_error(bmp_of(0, 1, 24, 0, "", "", 0, ""), "it has no pixels");
  expect_error(bmp_of(2, 1, 8, 0, "", two_colors, 2, hex("05000000")), "the palette does not have");
  expect_error(bmp_of(2, 1, 8, 1, "", two_colors, 2, hex("0301 0001")), "a run leads beyond the image");
  expect_error(bmp_of(1, 1, 16, 3, hex("01010000 00000000 00000000"), "", 0, hex("0000")), "a mask has gaps");
}

// ---- all of them

/// A small image of each format.
std::vector<std::pair<std::string, std::string>> one_of_each() {
  std::vector<Bytes> rows;
  for (int y = 0; y < 10; ++y) {
    rows.emplace_back();
    for (int i = 0; i < 3 * 12; ++i) rows.back().push_back(std::uint8_t(y * 37 + i * 11));
  }
  Image image{12, 10, {"B", "G", "R"}, {}};
  for (int i = 0; i < 360; ++i) image.data.push_back(float(i) / 100);
  std::string hdr = hdr_head + "-Y 3 +X 8\n";
  for (int y = 0; y < 3; ++y)
    hdr += hex("02 02 00 08  88 80  08 00 01 02 03 04 05 06 07  84 40 04 50 51 52 53  88 81");
  return {{"PNG", png_of(12, 10, PNG_COLOR_TYPE_RGB, 8, rows)},
          {"JPEG", jpeg_of(12, 10, rows)},
          {"JPEG", jpeg_of(12, 10, rows, {3, JCS_RGB, JCS_YCbCr, true, true})},
          {"Radiance HDR", hdr},
          {"OpenEXR", encode_exr(image, {}, "a.exr")},
          {"BMP", bmp_of(3, 2, 8, 1, "", two_colors, 2, hex("03 01 00 00  00 03 01 00 01 00  00 01"))},
          {"TGA", tga_of(0, 10, 0, 0, 4, 1, 24, 0x20, hex("82 030201 00 060504"))}};
}

TEST(Pixels, DamageIsAnError) {
  for (const auto& [format, bytes] : one_of_each()) {
    SCOPED_TRACE(format);
    EXPECT_EQ(pixel_size(bytes, "a").format, format);
    test::expect_damage_is_an_error(bytes, [](std::string_view damaged) {
      const Pixels pixels = read_pixels(damaged, "a");
      const std::size_t count =
          std::size_t(pixels.width) * std::size_t(pixels.height) * std::size_t(pixels.channels);
      if (pixels.bytes.size() + pixels.floats.size() != count) throw std::logic_error("not whole");
    });
  }
}

TEST(Pixels, LimitsHold) {
  for (const auto& [format, bytes] : one_of_each()) {
    SCOPED_TRACE(format);
    Limits limits;
    limits.pixels = 3;
    expect_error(bytes, "the image is too large", limits);
    EXPECT_THROW(pixel_size(bytes, "a", limits), InputError);
    limits = {};
    limits.file_bytes = 10;
    expect_error(bytes, "the file is too large", limits);
  }
}

TEST(Pixels, FilesThatClaimTooMuchAreRefused) {
  // 16384 x 16384 with 8 bits, in a file of 60 bytes: the header is right, the rest is missing.
  const std::string hdr = hdr_head + "-Y 16384 +X 16384\n";
  expect_error(hdr, "the image is not plausible");
  expect_error(tga_of(0, 2, 0, 0, 16384, 16384, 24, 0x20, "abc"), "the image is not plausible");
  expect_error(bmp_of(16384, 16384, 24, 0, "", "", 0, "abc"), "the image is not plausible");
  std::string jpeg = jpeg_of(8, 8, flat(8, 8, {9, 9, 9}));
  const std::size_t frame = jpeg.find("\xff\xc0");
  jpeg.replace(frame + 5, 4, hex("4000 4000"));
  expect_error(jpeg, "the image is not plausible");
  // A true one: 16384 rows of one bit, all 0, deflated to a thousandth.
  const std::string png =
      png_of(16384, 16384, PNG_COLOR_TYPE_GRAY, 1, std::vector<Bytes>(16384, Bytes(2048)));
  ASSERT_LT(png.size(), 120000u);
  expect_error(png, "the image is not plausible");
}

TEST(Pixels, OtherFormatsAreNamed) {
  expect_error("GIF89a....", "images in the format GIF are not read");
  expect_error("RIFF1234WEBPVP8 ", "images in the format WebP are not read");
  expect_error(std::string("II*\0abc", 7), "images in the format TIFF are not read");
  expect_error("lambent: 1\n# no image, but longer than a header\n", "this is no image of a known format");
}

TEST(Pixels, AnEmptyFile) { EXPECT_THROW(read_pixels("", "a.png"), InputError); }

// ---- files of others

std::vector<std::string> files_in(const std::string& folder) {
  const auto data = test::data_dir();
  std::vector<std::string> files;
  std::error_code error;
  if (data)
    for (const auto& entry : fs::recursive_directory_iterator(*data + "/" + folder, error))
      if (entry.is_regular_file()) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}
#define SKIP_WITHOUT(files) \
  if ((files).empty()) GTEST_SKIP() << "The data of others is not here: set LAMBENT_DATA to its folder."

/// Whether it is read; if not, there was an error that names it.
bool is_read(const std::string& path) {
  const std::string bytes = test::read_text(path);
  try {
    const PixelSize size = pixel_size(bytes, path);
    const Pixels pixels = read_pixels(bytes, path);
    EXPECT_EQ(pixels.width, size.width) << path;
    EXPECT_EQ(pixels.height, size.height) << path;
    EXPECT_EQ(pixels.channels, size.channels) << path;
    EXPECT_EQ(pixels.bytes.size() + pixels.floats.size(),
              std::size_t(pixels.width) * std::size_t(pixels.height) * std::size_t(pixels.channels))
        << path;
    return true;
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().at(0).place.file, path);
    return false;
  }
}

TEST(PixelsCorpus, PngSuite) {
  const std::vector<std::string> files = files_in("png/pngsuite");
  SKIP_WITHOUT(files);
  for (const std::string& path : files) {
    if (fs::path(path).extension() != ".png") continue;
    const bool corrupt = fs::path(path).filename().string()[0] == 'x';
    EXPECT_EQ(is_read(path), !corrupt) << path;
  }
}

TEST(PixelsCorpus, DamagedFilesAreReadOrRefused) {
  std::vector<std::string> files = files_in("png/libpng-crashers");
  SKIP_WITHOUT(files);
  for (const std::string& path : files_in("exr/damaged")) files.push_back(path);
  for (const std::string& path : files) {
    const auto start = std::chrono::steady_clock::now();
    is_read(path);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20)) << path;
  }
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  EXPECT_LT(usage.ru_maxrss / 1024, 3000);
}

TEST(PixelsCorpus, ExrAndEnvironmentsAreRead) {
  std::vector<std::string> files = files_in("exr/openexr-images");
  SKIP_WITHOUT(files);
  for (const std::string& path : files_in("env"))
    if (const std::string end = fs::path(path).extension().string(); end == ".hdr" || end == ".exr")
      files.push_back(path);
  for (const std::string& path : files) EXPECT_TRUE(is_read(path)) << path;
}

TEST(PixelsCorpus, RealTexturesAreRead) {
  std::vector<std::string> files = files_in("gltf");
  SKIP_WITHOUT(files);
  for (const char* folder : {"nff", "obj"})
    for (const std::string& path : files_in(folder)) files.push_back(path);
  int count = 0;
  for (const std::string& path : files) {
    const std::string end = fs::path(path).extension().string();
    if (end != ".png" && end != ".jpg" && end != ".jpeg" && end != ".tga" && end != ".bmp") continue;
    EXPECT_TRUE(is_read(path)) << path;
    ++count;
  }
  EXPECT_GT(count, 20);
}

}  // namespace
}  // namespace lambent
