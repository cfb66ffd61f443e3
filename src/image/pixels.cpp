#include "image/pixels.h"

#include <new>

#include "image/formats.h"
#include "image/pixel_formats.h"

namespace lambent {
namespace {

// TGA has no signature, so it is asked last.
constexpr const PixelFormat* formats[] = {&png_pixels, &jpeg_pixels, &hdr_pixels,
                                          &exr_pixels, &bmp_pixels,  &tga_pixels};

/// A format that is not read but known by its bytes; or nothing.
const char* foreign_format(std::string_view bytes) {
  const auto at = [&](std::size_t position, std::string_view text) {
    return bytes.size() >= position && bytes.substr(position, text.size()) == text;
  };
  if (at(0, "GIF8")) return "GIF";
  if (at(0, "RIFF") && at(8, "WEBP")) return "WebP";
  if (at(0, std::string_view("II*\0", 4)) || at(0, std::string_view("MM\0*", 4))) return "TIFF";
  if (at(0, "DDS ")) return "DDS";
  if (at(1, "KTX ")) return "KTX";
  if (at(0, "8BPS")) return "Photoshop";
  if (at(4, "ftypavif")) return "AVIF";
  if (at(4, "ftyphei") || at(4, "ftypmif1")) return "HEIF";
  if (at(0, "\xff\x4f\xff\x51") || at(4, "jP  ")) return "JPEG 2000";
  if (at(0, "<svg") || at(0, "<?xml")) return "SVG";
  return nullptr;
}

const PixelFormat& format_of(const PixelInput& input) {
  const std::string_view bytes = input.bytes;
  if (bytes.size() > input.limits.file_bytes)
    throw picture_error(input.name, "the file is too large: " + std::to_string(bytes.size()) + " bytes",
                        "at most " + std::to_string(input.limits.file_bytes) +
                            " bytes are read; --max-file-bytes sets another limit");
  if (bytes.empty()) throw picture_error(input.name, "the file is empty");
  for (const PixelFormat* format : formats)
    if (format->recognises(bytes)) return *format;
  const char* known = "PNG, JPEG, Radiance HDR, OpenEXR, TGA and BMP are read";
  const char* foreign = foreign_format(bytes);
  if (foreign != nullptr)
    throw picture_error(input.name, std::string("images in the format ") + foreign + " are not read",
                        std::string("convert it to PNG: ") + known);
  throw picture_error(input.name, "this is no image of a known format", known);
}

}  // namespace

Pixels read_pixels(std::string_view bytes, const std::string& name, const Limits& limits) {
  const PixelInput input{bytes, name, limits};
  try {
    return format_of(input).decode(input);
  } catch (const std::bad_alloc&) {
    throw picture_error(name, "the image does not fit into memory");
  }
}

PixelSize pixel_size(std::string_view bytes, const std::string& name, const Limits& limits) {
  const PixelInput input{bytes, name, limits};
  const PixelFormat& format = format_of(input);
  PixelSize size = format.size(input);
  size.format = format.name;
  return size;
}

void check_decoded(const PixelSize& size, int bytes_per_value, const PixelInput& input) {
  const std::string text = std::to_string(size.width) + " x " + std::to_string(size.height) + " pixels";
  if (size.width <= 0 || size.height <= 0)
    throw picture_error(input.name, "the image has no pixels: it is " + text);
  // Widths and heights stay below 2^31, and the rest below 2^5: nothing overflows before the first check.
  const std::uint64_t pixels = std::uint64_t(size.width) * std::uint64_t(size.height);
  if (pixels > input.limits.pixels)
    throw picture_error(input.name, "the image is too large: " + text,
                        "at most " + std::to_string(input.limits.pixels) +
                            " pixels are read; make it smaller, or set another limit with --max-pixels");
  constexpr std::uint64_t harmless = std::uint64_t{64} << 20, plausible = 2000;
  const std::uint64_t values = std::uint64_t(size.channels) * std::uint64_t(bytes_per_value);
  if (pixels > ~std::uint64_t{0} / values || pixels * values > harmless) {
    if (pixels / plausible > input.bytes.size() / values)
      throw picture_error(input.name,
                          "the image is not plausible: a file of " + std::to_string(input.bytes.size()) +
                              " bytes claims " + text,
                          "if it is meant so, make it smaller: it can hold little but a plain area");
  }
}

InputError damaged_image(const PixelInput& input, const char* format, const std::string& why) {
  return picture_error(input.name, std::string("cannot read the ") + format + ": " + why,
                       "the file is damaged: copy or export the image again");
}

}  // namespace lambent
