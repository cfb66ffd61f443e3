#include "scenefile/textures.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

#include "image/pixels.h"
#include "import/text_file.h"
#include "lambent/image.h"
#include "scene/mip_levels.h"

namespace lambent {
namespace {

/// Two textures of one image are one.
using Key = std::tuple<std::string, const void*, bool>;
Key key_of(const Texture& texture) { return {texture.source.file, texture.source.bytes.get(), texture.srgb}; }

/// Diagnostics of reading an image, told at the place that names it.
std::vector<Diagnostic> told_where_named(const InputError& error, const ImageSource& source) {
  std::vector<Diagnostic> result;
  for (Diagnostic diagnostic : error.diagnostics()) {
    if (diagnostic.message.find(source.name) == std::string::npos)
      diagnostic.message = "image '" + source.name + "': " + diagnostic.message;
    diagnostic.place = source.place;
    diagnostic.excerpt.clear();
    result.push_back(std::move(diagnostic));
  }
  return result;
}

/// The bytes of an image file. A device or a pipe might never end.
std::string bytes_of(const std::string& path, const Limits& limits) {
  const auto refuse = [&](const std::string& message, const std::string& hint = {}) {
    Diagnostic diagnostic;
    diagnostic.place.file = path;
    diagnostic.message = message;
    diagnostic.hint = hint;
    throw InputError(diagnostic);
  };
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) refuse("'" + path + "' is no regular file");
  if (std::filesystem::file_size(path, error) > limits.file_bytes)
    refuse("'" + path + "' is larger than files may be", "--max-file-bytes sets the limit");
  return read_file(path);
}

/// `left`: how many pixels all textures together may still have.
void load(Texture& texture, const Limits& limits, std::uint64_t& left) {
  const ImageSource& source = texture.source;
  const std::string from_file = source.file.empty() ? std::string() : bytes_of(source.file, limits);
  const std::string_view bytes = source.file.empty() ? std::string_view(*source.bytes) : from_file;
  const PixelSize size = pixel_size(bytes, source.name, limits);
  const std::uint64_t count = std::uint64_t(size.width) * std::uint64_t(size.height);
  if (count > left) {
    Diagnostic diagnostic;
    diagnostic.message = "image '" + source.name +
                         "' is one too many: together the textures have more than " +
                         std::to_string(limits.pixels) + " pixels";
    diagnostic.hint = "--max-pixels sets the limit";
    throw InputError(diagnostic);
  }
  left -= count;
  Pixels pixels = read_pixels(bytes, source.name, limits);
  if (texture.srgb && !pixels.linear) {
    texture.decoded.resize(256);
    for (int i = 0; i < 256; ++i) texture.decoded[std::size_t(i)] = float(linear_from_srgb(i / 255.0));
    // 16 bits are linear from here on.
    const bool has_alpha = pixels.channels % 2 == 0;
    for (std::size_t i = 0; i < pixels.floats.size(); ++i)
      if (!has_alpha || i % std::size_t(pixels.channels) != std::size_t(pixels.channels - 1))
        pixels.floats[i] = float(linear_from_srgb(pixels.floats[i]));
  } else {
    texture.decoded.resize(256);
    for (int i = 0; i < 256; ++i) texture.decoded[std::size_t(i)] = float(i / 255.0);
  }
  // Infinities and NaN would spread over whole levels.
  for (float& value : pixels.floats) value = value == value ? std::clamp(value, 0.0f, 1e9f) : 0.0f;
  texture.channels = pixels.channels;
  texture.levels = {{pixels.width, pixels.height, 0}};
  texture.bytes = std::move(pixels.bytes);
  texture.floats = std::move(pixels.floats);
  build_levels(texture);
}

}  // namespace

void load_textures(Scene& scene, const Limits& limits) {
  std::vector<bool> used(scene.textures.size());
  if (scene.background_image) used[*scene.background_image] = true;
  for (const Material& material : scene.materials)
    for (const MaterialMap& one : material.maps) used[one.map.texture] = true;

  constexpr std::uint32_t none = ~0u;
  std::vector<Texture> loaded;
  std::vector<std::uint32_t> index(scene.textures.size(), none);
  std::map<Key, std::uint32_t> known;
  std::vector<Diagnostic> wrong;
  std::uint64_t left = limits.pixels;
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    if (!used[i]) continue;
    Texture& texture = scene.textures[i];
    const auto [found, is_new] = known.try_emplace(key_of(texture), std::uint32_t(loaded.size()));
    if (!is_new) {
      index[i] = found->second;
      continue;
    }
    try {
      if (texture.channels == 0) load(texture, limits, left);
      index[i] = std::uint32_t(loaded.size());
      loaded.push_back(std::move(texture));
    } catch (const InputError& error) {
      found->second = none;
      for (Diagnostic& diagnostic : told_where_named(error, texture.source)) {
        if (texture.source.required) {
          wrong.push_back(std::move(diagnostic));
          continue;
        }
        diagnostic.severity = Severity::warning;
        diagnostic.hint = "the surface does without it";
        scene.warnings.push_back(std::move(diagnostic));
      }
    }
  }
  if (!wrong.empty()) throw InputError(std::move(wrong));
  scene.textures = std::move(loaded);
  if (scene.background_image) scene.background_image = index[*scene.background_image];
  for (Material& material : scene.materials) {
    std::erase_if(material.maps, [&](const MaterialMap& one) { return index[one.map.texture] == none; });
    for (MaterialMap& one : material.maps) one.map.texture = index[one.map.texture];
  }
}

}  // namespace lambent
