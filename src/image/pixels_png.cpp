// PNG of every colour type and depth, as it is: a palette becomes colours, a transparent colour alpha.

#include <png.h>

#include "image/formats.h"
#include "image/pixel_formats.h"
#include "image/png_session.h"

namespace lambent {
namespace {

/// What decoding will give, with the session's header read. Throws InputError.
PixelSize open_png(PngSession& session, const PixelInput& input) {
  if (!png_chunks_fit(input.bytes)) throw damaged_image(input, "PNG", "the file ends too early");
  if (!session.read_header(input.bytes)) throw damaged_image(input, "PNG", session.error.text);
  png_structp png = session.png;
  png_infop info = session.info;
  PixelSize size;
  size.width = int(png_get_image_width(png, info));
  size.height = int(png_get_image_height(png, info));
  const int type = png_get_color_type(png, info);
  const bool alpha = (type & PNG_COLOR_MASK_ALPHA) != 0 || png_get_valid(png, info, PNG_INFO_tRNS) != 0;
  size.channels = ((type & PNG_COLOR_MASK_COLOR) != 0 ? 3 : 1) + (alpha ? 1 : 0);
  check_decoded(size, png_get_bit_depth(png, info) == 16 ? 4 : 1, input);
  return size;
}

PixelSize png_size(const PixelInput& input) {
  PngSession session(PngSession::Way::read);
  return open_png(session, input);
}

Pixels decode(const PixelInput& input) {
  PngSession session(PngSession::Way::read);
  const PixelSize size = open_png(session, input);
  png_structp png = session.png;
  png_infop info = session.info;
  const auto damaged = [&] { return damaged_image(input, "PNG", session.error.text); };
  if (!session.run([&] {
        png_set_expand(png);
        png_set_interlace_handling(png);
        png_read_update_info(png, info);
      }))
    throw damaged();
  const std::size_t row_bytes = png_get_rowbytes(png, info), height = std::size_t(size.height);
  const bool wide = png_get_bit_depth(png, info) == 16;
  const std::size_t row_values = std::size_t(size.width) * std::size_t(size.channels);
  if (png_get_channels(png, info) != size.channels || row_bytes != row_values * (wide ? 2 : 1))
    throw damaged_image(input, "PNG", "its header and its palette do not agree");

  Pixels pixels;
  pixels.width = size.width, pixels.height = size.height, pixels.channels = size.channels;
  pixels.bytes.resize(row_bytes * height);
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < height; ++y) rows.push_back(pixels.bytes.data() + y * row_bytes);
  if (!session.run([&] {
        png_read_image(png, rows.data());
        png_read_end(png, info);
      }))
    throw damaged();
  if (wide) {
    pixels.floats.reserve(row_values * height);
    for (std::size_t i = 0; i < pixels.bytes.size(); i += 2)
      pixels.floats.push_back(float(pixels.bytes[i] << 8 | pixels.bytes[i + 1]) / 65535.0f);
    pixels.bytes = {};
  }
  return pixels;
}

}  // namespace

const PixelFormat png_pixels{"PNG", is_png, png_size, decode};

}  // namespace lambent
