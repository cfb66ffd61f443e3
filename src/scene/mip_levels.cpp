#include "scene/mip_levels.h"

#include <algorithm>
#include <array>

#include "image/srgb.h"

namespace lambent {
namespace {

/// Which texels of the finer level an output texel covers along one side, and by how much.
struct Taps {
  int first = 0, count = 0;
  std::array<float, 3> weight{};
};

/// Of n texels become m = n / 2, each n / m wide. For odd n, texel i covers [i n / m, (i + 1) n / m): of the
/// texels 2 i, 2 i + 1, 2 i + 2 the shares (m - i) / n, m / n, (i + 1) / n of its own width.
Taps taps_of(int i, int n) {
  if (n == 1) return {0, 1, {1, 0, 0}};
  if (n % 2 == 0) return {2 * i, 2, {0.5f, 0.5f, 0}};
  const int m = n / 2;
  const double size = n;
  return {2 * i, 3, {float((m - i) / size), float(m / size), float((i + 1) / size)}};
}

/// One level from another. `Read` and `Write` turn a stored number of a channel into a linear one and back.
template <class Number, class Read, class Write>
void halve(std::vector<Number>& texels, const Texture::Level& from, const Texture::Level& to, int channels,
           const Read& read, const Write& write) {
  const std::size_t row = std::size_t(from.width) * std::size_t(channels);
  std::vector<Taps> across;
  for (int x = 0; x < to.width; ++x) across.push_back(taps_of(x, from.width));
  std::vector<float> sums(row);
  for (int y = 0; y < to.height; ++y) {
    const Taps down = taps_of(y, from.height);
    std::fill(sums.begin(), sums.end(), 0.0f);
    for (int t = 0; t < down.count; ++t) {
      const Number* in = &texels[from.first + std::size_t(down.first + t) * row];
      const float weight = down.weight[std::size_t(t)];
      for (std::size_t i = 0; i < row; i += std::size_t(channels))
        for (int c = 0; c < channels; ++c)
          sums[i + std::size_t(c)] += weight * read(in[i + std::size_t(c)], c);
    }
    Number* out = &texels[to.first + std::size_t(y) * std::size_t(to.width) * std::size_t(channels)];
    for (const Taps& taps : across) {
      const float* in = &sums[std::size_t(taps.first) * std::size_t(channels)];
      for (int c = 0; c < channels; ++c) {
        float sum = 0;
        for (int t = 0; t < taps.count; ++t) sum += taps.weight[std::size_t(t)] * in[t * channels + c];
        *out++ = write(sum, c);
      }
    }
  }
}

}  // namespace

void build_levels(Texture& texture) {
  texture.levels.resize(1);
  const std::size_t channels = std::size_t(texture.channels);
  Texture::Level level = texture.levels[0];
  std::size_t end = level.first + std::size_t(level.width) * std::size_t(level.height) * channels;
  while (level.width > 1 || level.height > 1) {
    level.width = std::max(level.width / 2, 1), level.height = std::max(level.height / 2, 1);
    level.first = end;
    end += std::size_t(level.width) * std::size_t(level.height) * channels;
    texture.levels.push_back(level);
  }
  const bool bytes = !texture.bytes.empty();
  if (bytes) texture.bytes.resize(end);
  else texture.floats.resize(end);

  // The channel of alpha, or one that there is not.
  const int alpha = texture.channels % 2 == 0 ? texture.channels - 1 : texture.channels;
  const std::vector<float>& linear = linear_from_srgb_table(8);
  const SrgbQuantizer& encoded = srgb_quantizer(8);
  const int first_data = texture.srgb ? alpha : 0;  // the channels from here on are numbers as they are
  for (std::size_t i = 1; i < texture.levels.size(); ++i) {
    const Texture::Level &from = texture.levels[i - 1], &to = texture.levels[i];
    if (bytes)
      halve(
          texture.bytes, from, to, texture.channels,
          [&](std::uint8_t n, int c) { return c < first_data ? linear[n] : float(n); },
          [&](float x, int c) { return std::uint8_t(c < first_data ? encoded(x) : int(x + 0.5f)); });
    else
      halve(
          texture.floats, from, to, texture.channels, [](float x, int) { return x; },
          [](float x, int) { return x; });
  }
}

}  // namespace lambent
