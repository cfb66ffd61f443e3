#include "film/adaptive.h"

#include <algorithm>
#include <cmath>

namespace lambent {

AdaptiveFilm::AdaptiveFilm(const Film& film, const ImageSettings& settings)
    : width_(film.width),
      height_(film.height),
      settings_(settings.adaptive.value_or(AdaptiveSamples{})),
      encoded_(settings.encoding == Encoding::srgb),
      pixels_(std::size_t(film.width) * film.height),
      columns_(film.layers ? std::size_t(film.layers->plan().columns()) : 0),
      layer_sums_(pixels_.size() * columns_),
      hits_(film.layers ? pixels_.size() : 0) {
  for (Pixel& pixel : pixels_) {
    std::fill_n(pixel.least, color_channels, std::numeric_limits<float>::infinity());
    std::fill_n(pixel.greatest, color_channels, -std::numeric_limits<float>::infinity());
  }
}

/// In steps of 8 bits. The square root stands for sRGB's curve: as steep or steeper where it is dark, and the
/// same on every machine.
double AdaptiveFilm::seen(float value) const {
  const double held = std::clamp(double(value), 0.0, 1.0);
  return 255 * (encoded_ ? std::sqrt(held) : held);
}

double AdaptiveFilm::height_of_edge(int x, int y) const {
  double height = 0;
  for (int c = 0; c < color_channels; ++c) {
    float least = std::numeric_limits<float>::infinity(), greatest = -least;
    for (int j = std::max(0, y - 1); j <= std::min(height_ - 1, y + 1); ++j)
      for (int i = std::max(0, x - 1); i <= std::min(width_ - 1, x + 1); ++i) {
        const Pixel& pixel = pixels_[std::size_t(j) * width_ + i];
        least = std::min(least, pixel.least[c]);
        greatest = std::max(greatest, pixel.greatest[c]);
      }
    height = std::max(height, seen(greatest) - seen(least));
  }
  return height;
}

bool AdaptiveFilm::needs_more(int x, int y) const {
  const double n = pixels_[std::size_t(y) * width_ + x].samples;
  return height_of_edge(x, y) > settings_.error * std::sqrt(n * std::sqrt(n));
}

void NoiseSum::add(const double* sum, double squares, int samples) {
  const double mean = luminance_of(Rgb{sum[0], sum[1], sum[2]}) / samples;
  const double spread = std::max(squares / samples - mean * mean, 0.0);
  variance += samples > 1 ? spread / (samples - 1) : std::numeric_limits<double>::infinity();
  luminance += mean;
  ++pixels;
}
void NoiseSum::add(const NoiseSum& more) {
  variance += more.variance, luminance += more.luminance, pixels += more.pixels;
}
double NoiseSum::noise() const {
  return luminance > 0 ? std::sqrt(variance * double(pixels)) / luminance : 0;
}

double AdaptiveFilm::noise() const {
  NoiseSum sum;
  for (const Pixel& pixel : pixels_) sum.add(pixel.sum, pixel.squares, pixel.samples);
  return sum.noise();
}

Rgb AdaptiveFilm::mean(std::size_t pixel) const {
  Rgb result;
  for (int c = 0; c < color_channels; ++c) result[c] = pixels_[pixel].sum[c] / samples(pixel);
  return result;
}

}  // namespace lambent
