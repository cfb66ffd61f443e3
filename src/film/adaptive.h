#pragma once
#include <algorithm>
#include <limits>

#include "film/film.h"

namespace lambent {

/// Noise of a picture, gathered pixel by pixel.
struct NoiseSum {
  double variance = 0, luminance = 0;
  std::uint64_t pixels = 0;
  /// A pixel's samples: the sum of their colours, and that of the squares of their luminance.
  void add(const double* sum, double squares, int samples);
  void add(const NoiseSum& more);
  /// The standard deviation of a pixel from what endlessly many samples would give, root mean square over the
  /// pixels, as a share of the mean luminance. As if samples were independent; well-spread ones do better, so
  /// this is an upper estimate. 0 of a black picture; infinite where a pixel has one sample.
  double noise() const;
};

/// What the samples of each pixel have brought so far, for samples that are taken in several goes: where the
/// picture needs them, or until its noise is low.
class AdaptiveFilm {
 public:
  AdaptiveFilm(const Film& film, const ImageSettings& settings);

  /// Of a pixel: the sum of its samples' colours; where noise is measured, that of the squares of their
  /// luminance; the least of each channel, then the greatest; how many samples.
  struct Pixel {
    double sum[color_channels] = {};
    double squares = 0;
    float least[color_channels], greatest[color_channels];
    int samples = 0;
  };
  Pixel& at(int x, int y) { return pixels_[index(x, y)]; }
  std::size_t index(int x, int y) const { return std::size_t(y) * std::size_t(width_) + std::size_t(x); }
  /// Where the film has layers: the sums of a pixel's, and what its samples met.
  double* layer_sums(std::size_t pixel) { return &layer_sums_[pixel * columns_]; }
  const double* layer_sums(std::size_t pixel) const { return &layer_sums_[pixel * columns_]; }
  PixelHits& hits(std::size_t pixel) { return hits_[pixel]; }
  const PixelHits& hits(std::size_t pixel) const { return hits_[pixel]; }

  /// Whether n samples of this pixel, which it has, may be off by more than the settings' error: an edge of
  /// height D is known to about D / n^(3/4) by n well-spread samples, and D is looked for in the pixel
  /// and its neighbours, since an edge may fall between its own samples.
  bool needs_more(int x, int y) const;

  /// As noise_of.
  double noise() const;

  /// The mean of a pixel's samples; black where it has none yet.
  Rgb mean(std::size_t pixel) const;
  /// How many samples it counts, 1 at least.
  int samples(std::size_t pixel) const { return std::max(1, pixels_[pixel].samples); }

 private:
  double height_of_edge(int x, int y) const;
  double seen(float value) const;

  int width_, height_;
  AdaptiveSamples settings_;
  bool encoded_;
  std::vector<Pixel> pixels_;
  std::size_t columns_;  ///< Of layers.
  std::vector<double> layer_sums_;
  std::vector<PixelHits> hits_;
};

}  // namespace lambent
