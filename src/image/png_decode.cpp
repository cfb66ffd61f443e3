#include <png.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "image/formats.h"
#include "image/png_session.h"
#include "image/srgb.h"

namespace lambent {
namespace {

/// The bytes of the file that libpng has not asked for yet.
struct Source {
  const char* next;
  std::size_t left;
};

void take(png_structp png, png_bytep data, png_size_t size) {
  Source* source = static_cast<Source*>(png_get_io_ptr(png));
  if (size > source->left) png_error(png, "the file ends too early");
  std::memcpy(data, source->next, size);
  source->next += size;
  source->left -= size;
}

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

/// Whether every chunk ends within the file. libpng believes the lengths that the chunks claim, and would set
/// up a gigabyte for a text in a file of 57 bytes.
bool chunks_fit(std::string_view bytes) {
  constexpr std::size_t signature = 8, around = 12;  // length, name and checksum, 4 bytes each
  for (std::size_t at = signature; at < bytes.size();) {
    if (bytes.size() - at < around) return false;
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<unsigned char>(bytes[at + i]);
    if (length > bytes.size() - at - around) return false;
    if (bytes.substr(at + 4, 4) == "IEND") return true;  // what follows is no part of the picture
    at += around + length;
  }
  return false;
}

}  // namespace

bool is_png(std::string_view bytes) { return bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n"; }

ReadImage decode_png(std::string_view bytes, const std::string& path) {
  if (!chunks_fit(bytes)) throw picture_error(path, "cannot read the PNG: the file ends too early");
  PngSession session(PngSession::Way::read);
  png_structp png = session.png;
  png_infop info = session.info;
  const auto damaged = [&] {
    return picture_error(path, std::string("cannot read the PNG: ") + session.error.text);
  };

  Source source{bytes.data(), bytes.size()};
  // Unpacked, a text may be larger than the file.
  constexpr std::size_t smallest_limit = std::size_t(1) << 24;
  const std::size_t largest_chunk = std::max(bytes.size(), smallest_limit);
  if (!session.run([&] {
        png_set_read_fn(png, &source, take);
        png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
        png_set_chunk_malloc_max(png, largest_chunk);
        png_read_info(png, info);
      }))
    throw damaged();
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
