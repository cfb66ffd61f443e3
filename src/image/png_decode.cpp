#include <png.h>

#include <new>

#include "image/formats.h"
#include "image/png_session.h"
#include "image/srgb.h"

namespace lambent {
namespace {

std::string utf8_from_latin1(const std::string& latin) {
  std::string text;
  for (const char c : latin) {
    const unsigned code = static_cast<unsigned char>(c);
    if (code < 0x80) text += c;
    else text += {char(0xc0 | code >> 6), char(0x80 | (code & 0x3f))};
  }
  return text;
}

Metadata metadata_of(const PngSession& session) {
  png_textp texts = nullptr;
  int count = 0;
  png_get_text(session.png, session.info, &texts, &count);
  Metadata metadata;
  for (int i = 0; i < count; ++i) {
    const png_text& text = texts[i];
    std::string key = utf8_from_latin1(text.key), value = text.text != nullptr ? text.text : "";
    const bool international = text.compression >= PNG_ITXT_COMPRESSION_NONE;
    if (!international) value = utf8_from_latin1(value);
    // encode_png keeps there the key that would not pass as a keyword. Others keep translations there, which
    // are no keys.
    if (international && text.lang_key != nullptr && *text.lang_key != '\0' &&
        png_keyword(text.lang_key) == text.key)
      key = text.lang_key;
    metadata.emplace_back(key, value);
  }
  return metadata;
}

}  // namespace

bool is_png(std::string_view bytes) { return bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n"; }

ReadImage decode_png(std::string_view bytes, const std::string& path) {
  if (!png_chunks_fit(bytes)) throw picture_error(path, "cannot read the PNG: the file ends too early");
  PngSession session(PngSession::Way::read);
  png_structp png = session.png;
  png_infop info = session.info;
  const auto damaged = [&] {
    return picture_error(path, std::string("cannot read the PNG: ") + session.error.text);
  };

  if (!session.read_header(bytes)) throw damaged();
  const png_uint_32 width = png_get_image_width(png, info), height = png_get_image_height(png, info);
  // Deflate makes of one byte 1032 at most, and those are 8256 pixels where a pixel is one bit.
  check_size(width, height, png_get_channels(png, info), bytes.size(), 8256, path);

  if (!session.run([&] {
        png_set_expand(png);
        png_set_gray_to_rgb(png);
        png_set_interlace_handling(png);
        png_read_update_info(png, info);
      }))
    throw damaged();
  const std::size_t channels = png_get_channels(png, info), row_bytes = png_get_rowbytes(png, info);
  const int bits = png_get_bit_depth(png, info);
  check_size(width, height, channels, bytes.size(), 4 * 8256, path);

  ReadImage result;
  std::vector<png_byte> encoded;
  std::vector<png_bytep> rows;
  try {
    encoded.resize(row_bytes * height);
    result.image.data.reserve(std::size_t(width) * height * channels);
    for (std::size_t y = 0; y < height; ++y) rows.push_back(&encoded[y * row_bytes]);
  } catch (const std::bad_alloc&) {
    throw picture_error(path, "the picture does not fit into memory");
  }
  if (!session.run([&] {
        png_read_image(png, rows.data());
        png_read_end(png, info);
      }))
    throw damaged();

  result.image.width = int(width);
  result.image.height = int(height);
  if (channels == 4) result.image.channels.push_back("A");
  const std::vector<float>& linear = linear_from_srgb_table(bits);
  const float maximum = float((1 << bits) - 1);
  for (const png_bytep row : rows) {
    const png_byte* in = row;
    for (std::size_t i = 0; i < width * channels; ++i) {
      std::size_t code = *in++;
      if (bits == 16) code = code << 8 | *in++;
      result.image.data.push_back(i % 4 == 3 && channels == 4 ? float(code) / maximum : linear[code]);
    }
  }
  result.metadata = metadata_of(session);
  return result;
}

}  // namespace lambent
