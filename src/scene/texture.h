#pragma once
// Images on surfaces: where an image comes from, how it is held, and how a material uses it.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lambent/diagnostics.h"
#include "math/color.h"
#include "math/vec.h"

namespace lambent {

/// An encoded image (PNG, JPEG, ...): a file, or bytes that stand inside a model file.
struct ImageSource {
  std::string name;  ///< For people: the file's path, or "image 2 of helmet.glb".
  std::string file;  ///< The path to open. Empty: it is in `bytes`.
  std::shared_ptr<const std::string> bytes;
  Place place;  ///< Where it is asked for; line 0 where the format has no lines.
  bool required =
      false;  ///< Whether nothing can stand in where it is missing or damaged; else there is a warning.
};

/// An image in levels of detail: the first is the image itself, each further one has half as many texels each
/// way, rounded down, the last is one texel. Readers of models set `source` and `srgb`; load_textures()
/// (scenefile/textures.h) does the rest, once for each image.
struct Texture {
  ImageSource source;
  /// Whether whole numbers in the file (8 or 16 bits) are sRGB-encoded colours; if not, they are data: n /
  /// 255. Alpha is data always, and formats of floating-point numbers are linear always.
  bool srgb = true;

  struct Level {
    int width = 0, height = 0;
    std::size_t first = 0;  ///< Index of the first texel's first number.
  };
  int channels = 0;                 ///< 1 grey, 2 grey and alpha, 3 R G B, 4 R G B alpha; 0: not loaded.
  std::vector<Level> levels;        ///< Row 0 is the image's top.
  std::vector<std::uint8_t> bytes;  ///< Texels as in the file (encoded, if `srgb`); or
  std::vector<float> floats;        ///< linear, where 8 bits do not hold them. One of the two is empty.
  std::vector<float> decoded;       ///< With `bytes`: what each of the 256 means in a colour channel, linear.
};

enum class Wrap : std::uint8_t { repeat, mirror, clamp };

/// How a surface reads a texture. Texture coordinates (u, v) = (0, 0) are the image's lower left corner, (1,
/// 1) its upper right one: readers of formats that have v run downwards turn it round (v -> 1 - v).
struct TextureMap {
  std::uint32_t texture = 0;  ///< Index into the model's, then the scene's textures.
  std::uint8_t uv_set = 0;    ///< Mesh::uvs, or 1: Mesh::uvs2.
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool nearest = false;  ///< The nearest texel as it is, not a mean of its neighbours.
  /// u' = m[0] u + m[1] v + m[2],  v' = m[3] u + m[4] v + m[5]
  std::array<double, 6> matrix{1, 0, 0, 0, 1, 0};
  /// Which of the texel's numbers, where one is wanted: 0 to 3 R, G, B, alpha; -1: the luminance (Rec. 709)
  /// of R, G, B. Grey images have R = G = B, images without alpha alpha = 1.
  std::int8_t channel = -1;
  double gain = 1, offset = 0;  ///< The value used: offset + gain * texel.
  /// Normal maps: factor on x and y. Bump maps: height of white above black, in scene units. Occlusion: how
  /// much of it counts, 0 to 1.
  double strength = 1;
};

/// What a texture changes: its value multiplies the material's own number (or colour), except for `normal`
/// and `bump`, which tilt N.
enum class MapSlot : std::uint8_t {
  ambient,
  diffuse,
  specular,
  shininess,
  reflect,
  transmit,
  emission,
  opacity,
  normal,      ///< Tangent space, (r, g, b) -> 2 (r, g, b) - 1; y up: along growing v.
  bump,        ///< Heights.
  occlusion,   ///< On the ambient term alone: 1 + strength (texel - 1).
  base_color,  ///< This one and the following: of Material::metallic_roughness.
  metallic,
  roughness,
  specular_factor,
  specular_color,
  transmission,
  clearcoat,
  clearcoat_roughness,
};

struct MaterialMap {
  MapSlot slot;
  TextureMap map;
};

}  // namespace lambent
