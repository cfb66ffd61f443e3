#pragma once
#include <limits>

#include "film/film.h"

namespace lambent {

/// What the samples of each pixel have brought so far, for samples that are taken where the picture needs
/// them.
class AdaptiveFilm {
 public:
  AdaptiveFilm(const Film& film, const ImageSettings& settings);

  /// Of a pixel: the sum of its samples' colours; the least of each channel, then the greatest; how many
  /// samples.
  struct Pixel {
    double sum[color_channels] = {};
    float least[color_channels], greatest[color_channels];
    int samples = 0;
  };
  Pixel& at(int x, int y) { return pixels_[index(x, y)]; }
  std::size_t index(int x, int y) const { return std::size_t(y) * std::size_t(width_) + std::size_t(x); }
  /// Where the film has layers: the sums of a pixel's, and what its samples met.
  double* layer_sums(std::size_t pixel) { return &layer_sums_[pixel * columns_]; }
  const double* layer_sums(std::size_t pixel) const { return &layer_sums_[pixel * columns_]; }
  PixelHits& hits(std::size_t pixel) { return hits_[pixel]; }

  /// Whether n samples of this pixel, which it has, may be off by more than the settings' error: an edge of
  /// height D is known to about D / n^(3/4) by n well-spread samples, and D is looked for in the pixel
  /// and its neighbours, since an edge may fall between its own samples.
  bool needs_more(int x, int y) const;

  /// The means.
  void develop(Film& film) const;

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
