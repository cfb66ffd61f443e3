// OpenEXR for textures: of all its channels, the colours.

#include <algorithm>
#include <cmath>
#include <optional>

#include "image/formats.h"
#include "image/pixel_formats.h"

namespace lambent {
namespace {

/// Which of the channels are wanted: R, G, B or Y, then A. The picture itself comes before its layers; a
/// lone channel of any name is grey.
std::vector<std::size_t> wanted_channels(const std::vector<std::string>& channels, const PixelInput& input) {
  const auto find = [&](const std::string& name) -> std::optional<std::size_t> {
    const auto found = std::find(channels.begin(), channels.end(), name);
    if (found == channels.end()) return std::nullopt;
    return std::size_t(found - channels.begin());
  };
  if (channels.size() == 1) return {0};
  for (const std::string& channel : channels) {
    const std::string layer = channel.substr(0, channel.rfind('.') + 1);  // "" or "diffuse."
    const auto r = find(layer + "R"), g = find(layer + "G"), b = find(layer + "B"), y = find(layer + "Y"),
               a = find(layer + "A");
    std::vector<std::size_t> wanted;
    if (r && g && b) wanted = {*r, *g, *b};
    else if (y) wanted = {*y};
    else continue;
    if (a) wanted.push_back(*a);
    return wanted;
  }
  std::string names;
  for (const std::string& channel : channels) names += (names.empty() ? "" : ", ") + channel;
  throw picture_error(input.name, "the EXR has no colours: its channels are " + names,
                      "an image has R, G and B, or Y");
}

PixelSize exr_size(const PixelInput& input) {
  const PictureHead head = exr_head(input.bytes, input.name);
  PixelSize size;
  size.width = head.width, size.height = head.height;
  size.channels = int(wanted_channels(head.channels, input).size());
  PixelSize decoded = size;
  decoded.channels = int(head.channels.size());  // all are decoded before some are chosen
  check_decoded(decoded, 4, input);
  return size;
}

Pixels decode(const PixelInput& input) {
  const PixelSize size = exr_size(input);
  Image image = decode_exr(input.bytes, input.name).image;
  const std::vector<std::size_t> wanted = wanted_channels(image.channels, input);
  const std::size_t from = image.channels.size(), to = wanted.size();
  constexpr float largest = 65504;
  const auto tame = [](float value) {
    if (std::isnan(value)) return 0.0f;
    return std::isinf(value) ? std::copysign(largest, value) : value;
  };
  Pixels pixels;
  pixels.width = size.width, pixels.height = size.height, pixels.channels = size.channels;
  pixels.linear = true;
  pixels.floats = std::move(image.data);
  // In place: what is written lies before what is still to be read, but within one pixel.
  float values[4] = {};
  const std::size_t count = pixels.floats.size() / from;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < to; ++c) values[c] = tame(pixels.floats[i * from + wanted[c]]);
    std::copy(values, values + to, pixels.floats.begin() + std::ptrdiff_t(i * to));
  }
  pixels.floats.resize(count * to);
  return pixels;
}

}  // namespace

const PixelFormat exr_pixels{"OpenEXR", is_exr, exr_size, decode};

}  // namespace lambent
