#pragma once
// Looking a texture up, one point at a time: linear between texels and between levels of detail, with several
// taps along the longer side of a footprint that is not round.

#include <type_traits>

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

/// Calls f(read), where read(i) is the texel of which number i is the first: made for each format there is,
/// as what a texel needs is a few loads and no question.
template <class Function> Texel with_format(const TextureRecord& texture, const Function& f) {
  const auto of = [&]<int channels>(std::integral_constant<int, channels>) {
    constexpr bool grey = channels < 3, alpha = channels % 2 == 0;
    constexpr std::size_t g = grey ? 0 : 1, b = grey ? 0 : 2, last = channels - 1;
    if (const std::uint8_t* const bytes = texture.bytes) {
      const float* const decoded = texture.decoded;
      return f([=](std::size_t i) {
        return Texel{{double(decoded[bytes[i]]), double(decoded[bytes[i + g]]), double(decoded[bytes[i + b]]),
                      alpha ? bytes[i + last] / 255.0 : 1.0}};
      });
    }
    const float* const floats = texture.floats;
    return f([=](std::size_t i) {
      return Texel{{double(floats[i]), double(floats[i + g]), double(floats[i + b]),
                    alpha ? double(floats[i + last]) : 1.0}};
    });
  };
  switch (texture.channels) {
    case 1:
      return of(std::integral_constant<int, 1>());
    case 2:
      return of(std::integral_constant<int, 2>());
    case 3:
      return of(std::integral_constant<int, 3>());
    default:
      return of(std::integral_constant<int, 4>());
  }
}

inline std::size_t first_number(const TextureRecord& texture, const Texture::Level& level, int x, int y) {
  return level.first +
         (std::size_t(y) * std::size_t(level.width) + std::size_t(x)) * std::size_t(texture.channels);
}
inline Texel texel_at(const TextureRecord& texture, const Texture::Level& level, int x, int y) {
  return with_format(texture, [&](const auto& read) { return read(first_number(texture, level, x, y)); });
}

inline void add(Texel& sum, double weight, const Texel& t) {
  for (int c = 0; c < 4; ++c) sum.c[c] += weight * t.c[c];
}

/// Texels i and i + 1.
struct Neighbours {
  int first, second;
};
inline Neighbours wrapped_pair(double i, int n, Wrap wrap) {
  if (i >= 0 && i + 1 < n) return {int(i), int(i) + 1};
  const int first = wrapped(i, n, wrap);
  if (wrap == Wrap::repeat) return {first, first + 1 < n ? first + 1 : 0};
  return {first, wrapped(i + 1, n, wrap)};
}

template <class Read>
inline Texel on_level(const TextureRecord& texture, int number, const Vec2<double>& uv, const TextureMap& map,
                      const Read& read) {
  const Texture::Level& level = texture.levels[number];
  const double x = uv.x * level.width, y = (1 - uv.y) * level.height;
  const auto at = [&](int i, int j) { return read(first_number(texture, level, i, j)); };
  if (map.nearest)
    return at(wrapped(floor_of(x), level.width, map.wrap_u), wrapped(floor_of(y), level.height, map.wrap_v));
  const double left = floor_of(x - 0.5), top = floor_of(y - 0.5), fx = x - 0.5 - left, fy = y - 0.5 - top;
  const Neighbours column = wrapped_pair(left, level.width, map.wrap_u),
                   row = wrapped_pair(top, level.height, map.wrap_v);
  Texel sum{};
  add(sum, (1 - fx) * (1 - fy), at(column.first, row.first));
  add(sum, fx * (1 - fy), at(column.second, row.first));
  add(sum, (1 - fx) * fy, at(column.first, row.second));
  add(sum, fx * fy, at(column.second, row.second));
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
  if (!(longer > 1))
    return detail::with_format(texture,
                               [&](const auto& read) { return detail::on_level(texture, 0, uv, map, read); });
  const double ratio = longer / max(shorter, 1.0);
  const int taps = ratio >= detail::most_taps ? detail::most_taps : int(ratio + 0.999);
  const double detail_level = min(log2(max(longer / taps, 1.0)), double(texture.level_count - 1));
  const int finer = map.nearest ? int(detail_level + 0.5) : int(detail_level);
  const double f = map.nearest ? 0.0 : detail_level - finer, of_finer = (1 - f) / taps, of_coarser = f / taps;
  return detail::with_format(texture, [&](const auto& read) {
    Texel sum{};
    for (int tap = 0; tap < taps; ++tap) {
      const double at = (2 * tap + 1.0) / taps - 1;  // -1 to 1
      const Vec2<double> here{uv.x + at * along.x, uv.y + at * along.y};
      detail::add(sum, of_finer, detail::on_level(texture, finer, here, map, read));
      if (f > 0) detail::add(sum, of_coarser, detail::on_level(texture, finer + 1, here, map, read));
    }
    return sum;
  });
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
