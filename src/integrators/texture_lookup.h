#pragma once
// Looking a texture up, one point at a time: linear between texels and between levels of detail, with several
// taps along the longer side of a footprint that is not round.

#include "math/functions.h"
#include "math/vec.h"
#include "scene/texture.h"

namespace lambent {

/// A texture as kernels read it.
struct TextureRecord {
  const std::uint8_t* bytes;  ///< Or floats; the other is null.
  const float* floats;
  const float* decoded;  ///< What a byte means in a colour channel.
  const Texture::Level* levels;
  int level_count, channels;
};

inline namespace LAMBENT_ISA {

/// R, G, B, alpha.
struct Texel {
  double c[4];
};

/// What a ray sees of a surface, in texture coordinates: two half axes of an ellipse at a right angle in
/// space.
struct Footprint {
  Vec2<double> major{}, minor{};
};

namespace detail {

inline constexpr int most_taps = 16;

inline double floor_of(double x) { return __builtin_floor(x); }

/// Texel i of n, as the texture goes on beyond its ends.
inline int wrapped(double i, int n, Wrap wrap) {
  if (wrap == Wrap::clamp) return int(min(max(i, 0.0), double(n - 1)));
  const double period = wrap == Wrap::mirror ? 2.0 * n : double(n);
  double in = i - period * floor_of(i / period);
  if (in >= n) in = period - 1 - in;
  return int(min(max(in, 0.0), double(n - 1)));
}

inline Texel texel_at(const TextureRecord& texture, const Texture::Level& level, int x, int y) {
  const std::size_t i = level.first + (std::size_t(y) * std::size_t(level.width) + std::size_t(x)) *
                                          std::size_t(texture.channels);
  const bool grey = texture.channels < 3, alpha = texture.channels % 2 == 0;
  const int last = texture.channels - 1;
  Texel t;
  for (int c = 0; c < 3; ++c)
    t.c[c] = texture.bytes ? double(texture.decoded[texture.bytes[i + std::size_t(grey ? 0 : c)]])
                           : double(texture.floats[i + std::size_t(grey ? 0 : c)]);
  t.c[3] = !alpha          ? 1.0
           : texture.bytes ? texture.bytes[i + std::size_t(last)] / 255.0
                           : double(texture.floats[i + std::size_t(last)]);
  return t;
}

inline void add(Texel& sum, double weight, const Texel& t) {
  for (int c = 0; c < 4; ++c) sum.c[c] += weight * t.c[c];
}

inline Texel on_level(const TextureRecord& texture, int number, const Vec2<double>& uv,
                      const TextureMap& map) {
  const Texture::Level& level = texture.levels[number];
  const double x = uv.x * level.width, y = (1 - uv.y) * level.height;
  if (map.nearest)
    return texel_at(texture, level, wrapped(floor_of(x), level.width, map.wrap_u),
                    wrapped(floor_of(y), level.height, map.wrap_v));
  const double left = floor_of(x - 0.5), top = floor_of(y - 0.5), fx = x - 0.5 - left, fy = y - 0.5 - top;
  const int x0 = wrapped(left, level.width, map.wrap_u), x1 = wrapped(left + 1, level.width, map.wrap_u),
            y0 = wrapped(top, level.height, map.wrap_v), y1 = wrapped(top + 1, level.height, map.wrap_v);
  Texel sum{};
  add(sum, (1 - fx) * (1 - fy), texel_at(texture, level, x0, y0));
  add(sum, fx * (1 - fy), texel_at(texture, level, x1, y0));
  add(sum, (1 - fx) * fy, texel_at(texture, level, x0, y1));
  add(sum, fx * fy, texel_at(texture, level, x1, y1));
  return sum;
}

}  // namespace detail

/// The texture at uv, over the footprint (of which the size of a texel of the image itself is the least).
inline Texel look_up(const TextureRecord& texture, const Vec2<double>& uv, const Footprint& footprint,
                     const TextureMap& map) {
  const double width = texture.levels[0].width, height = texture.levels[0].height;
  const auto texels = [&](const Vec2<double>& axis) {
    const double x = axis.x * width, y = axis.y * height;
    return 2 * sqrt(x * x + y * y);
  };
  double longer = texels(footprint.major), shorter = texels(footprint.minor);
  Vec2<double> along = footprint.major;
  if (shorter > longer) {
    const double swap = longer;
    longer = shorter, shorter = swap, along = footprint.minor;
  }
  if (!(longer > 1)) return detail::on_level(texture, 0, uv, map);
  const double ratio = longer / max(shorter, 1.0);
  const int taps = ratio >= detail::most_taps ? detail::most_taps : int(ratio + 0.999);
  const double detail_level = min(log2(max(longer / taps, 1.0)), double(texture.level_count - 1));
  const int finer = map.nearest ? int(detail_level + 0.5) : int(detail_level);
  const double f = map.nearest ? 0.0 : detail_level - finer;
  Texel sum{};
  for (int tap = 0; tap < taps; ++tap) {
    const double at = (2 * tap + 1.0) / taps - 1;  // -1 to 1
    const Vec2<double> here{uv.x + at * along.x, uv.y + at * along.y};
    detail::add(sum, (1 - f) / taps, detail::on_level(texture, finer, here, map));
    if (f > 0) detail::add(sum, f / taps, detail::on_level(texture, finer + 1, here, map));
  }
  return sum;
}

/// Of a map: its own coordinates of a surface's.
inline Vec2<double> map_uv(const TextureMap& map, const Vec2<double>& uv) {
  const auto& m = map.matrix;
  return {m[0] * uv.x + m[1] * uv.y + m[2], m[3] * uv.x + m[4] * uv.y + m[5]};
}
inline Vec2<double> map_step(const TextureMap& map, const Vec2<double>& step) {
  const auto& m = map.matrix;
  return {m[0] * step.x + m[1] * step.y, m[3] * step.x + m[4] * step.y};
}

/// The number that a map takes of a texel, before gain and offset.
inline double number_of(const TextureMap& map, const Texel& t) {
  return map.channel < 0 ? 0.2126 * t.c[0] + 0.7152 * t.c[1] + 0.0722 * t.c[2] : t.c[int(map.channel)];
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
