// Pictures to and from files: which format, and what all formats have in common.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <new>

#include "image/file.h"
#include "image/formats.h"
#include "image/pixels.h"
#include "image/srgb.h"
#include "lambent/image.h"

namespace lambent {
namespace {

std::string lower_case_ending(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return ending;
}

/// "2 x 3 pixels with 1 channel".
std::string size_text(std::int64_t width, std::int64_t height, std::uint64_t channels) {
  return std::to_string(width) + " x " + std::to_string(height) + " pixels with " + std::to_string(channels) +
         (channels == 1 ? " channel" : " channels");
}

/// What every format asks of a picture.
void check_picture(const Image& image, const std::string& path) {
  if (image.width <= 0 || image.height <= 0 || image.channels.empty())
    throw picture_error(path, "a picture of " + size_text(image.width, image.height, image.channels.size()) +
                                  " cannot be written");
  const std::size_t samples = std::size_t(image.width) * std::size_t(image.height) * image.channels.size();
  if (image.data.size() != samples)
    throw picture_error(path, "the picture holds " + std::to_string(image.data.size()) + " values where " +
                                  std::to_string(samples) + " belong");
  std::vector<std::string> names = image.channels;
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end())
    throw picture_error(path, "the picture has two channels of the name '" + *twice + "'");
}

}  // namespace

InputError picture_error(const std::string& path, const std::string& message, const std::string& hint) {
  Diagnostic diagnostic;
  diagnostic.place.file = path;
  diagnostic.message = message;
  diagnostic.hint = hint;
  return InputError(diagnostic);
}

void check_size(std::uint64_t width, std::uint64_t height, std::uint64_t channels, std::uint64_t file_size,
                std::uint64_t samples_per_byte, const std::string& path) {
  const std::string size = size_text(std::int64_t(width), std::int64_t(height), channels);
  // Width, height and the number of channels stay below 2^32: the first two cannot overflow, and then nor can
  // all three.
  const std::uint64_t pixels = width * height;
  if (pixels > largest_sample_count || pixels * channels > largest_sample_count)
    throw picture_error(path, "the picture is too large: " + size, "at most 2^30 values are read");
  if (pixels * channels / samples_per_byte > file_size)
    throw picture_error(path,
                        "the file is damaged: " + std::to_string(file_size) + " bytes cannot hold " + size);
}

void write_image(const std::string& path, const Image& image, const Metadata& metadata,
                 const WriteOptions& options) {
  const std::string ending = lower_case_ending(path);
  if (ending != ".png" && ending != ".exr")
    throw picture_error(path,
                        ending.empty() ? "the name has no ending that says the picture's format"
                                       : "unknown picture format '" + ending + "'",
                        "the endings known are .png and .exr");
  check_picture(image, path);
  write_bytes(path, ending == ".png" ? encode_png(image, metadata, options, path)
                                     : encode_exr(image, metadata, path, options.threads));
}

namespace {

InputError beyond(const std::string& path, const std::string& what, std::uint64_t most,
                  const std::string& option) {
  return picture_error(path, what,
                       "at most " + std::to_string(most) + " are read; " + option + " sets another limit");
}

/// The picture, its pixels not yet seen: PNG and EXR have readers of their own here, which keep all channels
/// and texts, so their sizes are looked at before.
void check_pixels(std::int64_t width, std::int64_t height, const std::string& path, const Limits& limits) {
  if (std::uint64_t(width) * std::uint64_t(height) > limits.pixels)
    throw beyond(
        path,
        "the picture is too large: " + std::to_string(width) + " x " + std::to_string(height) + " pixels",
        limits.pixels, "--max-pixels");
}

/// Two sides as a PNG's header has them, the highest byte first, each below 2^32.
std::uint32_t png_side(std::string_view bytes, std::size_t at) {
  std::uint32_t side = 0;
  for (std::size_t i = at; i < at + 4 && i < bytes.size(); ++i)
    side = side << 8 | static_cast<unsigned char>(bytes[i]);
  return side;
}

/// R, G, B, and A where there is transparency, in linear light.
Image image_of(Pixels&& pixels) {
  Image image;
  image.width = pixels.width, image.height = pixels.height;
  const std::size_t from = std::size_t(pixels.channels);
  const bool grey = from < 3, alpha = from % 2 == 0;
  if (alpha) image.channels.push_back("A");
  const std::vector<float>& linear = linear_from_srgb_table(8);
  const std::size_t count = std::size_t(image.width) * std::size_t(image.height);
  image.data.reserve(count * image.channels.size());
  for (std::size_t i = 0; i < count * from; i += from) {
    const auto color = [&](std::size_t c) {
      if (!pixels.bytes.empty()) return linear[pixels.bytes[i + c]];
      const float value = pixels.floats[i + c];
      return pixels.linear ? value : float(linear_from_srgb(double(value)));
    };
    for (std::size_t c = 0; c < 3; ++c) image.data.push_back(color(grey ? 0 : c));
    if (alpha)
      image.data.push_back(!pixels.bytes.empty() ? float(pixels.bytes[i + from - 1]) / 255.0f
                                                 : pixels.floats[i + from - 1]);
  }
  return image;
}

}  // namespace

ReadImage read_image(const std::string& path, const Limits& limits) {
  std::error_code none;
  const auto size = std::filesystem::file_size(path, none);
  if (!none && size > limits.file_bytes)
    throw beyond(path, "the file is too large: " + std::to_string(size) + " bytes", limits.file_bytes,
                 "--max-file-bytes");
  const std::string bytes = read_bytes(path);
  ReadImage read;
  if (is_png(bytes)) {
    check_pixels(png_side(bytes, 16), png_side(bytes, 20), path, limits);
    read = decode_png(bytes, path);
    read.format = "PNG";
  } else if (is_exr(bytes)) {
    const PictureHead head = exr_head(bytes, path);
    check_pixels(head.width, head.height, path, limits);
    read = decode_exr(bytes, path);
    read.format = "OpenEXR";
  } else {
    read.format = pixel_size(bytes, path, limits).format;
    try {
      read.image = image_of(read_pixels(bytes, path, limits));
    } catch (const std::bad_alloc&) {
      throw picture_error(path, "the picture does not fit into memory");
    }
  }
  return read;
}

}  // namespace lambent
