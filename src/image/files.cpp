// Pictures to and from files: which format, and what all formats have in common.

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include "image/file.h"
#include "image/formats.h"
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
                                     : encode_exr(image, metadata, path));
}

ReadImage read_image(const std::string& path) {
  const std::string bytes = read_bytes(path);
  if (is_png(bytes)) return decode_png(bytes, path);
  if (is_exr(bytes)) return decode_exr(bytes, path);
  throw picture_error(path,
                      bytes.empty() ? "the file is empty" : "the file is neither a PNG nor an EXR picture");
}

}  // namespace lambent
