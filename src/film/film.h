#pragma once
#include <vector>

#include "film/layer_book.h"
#include "lambent/image.h"
#include "scene/scene.h"

namespace lambent {

/// What guides a denoiser through a pixel: the surfaces that its samples met first.
struct GuideSums {
  double albedo[3] = {}, normal[3] = {};  ///< Sums; what meets nothing adds 0.
  std::uint32_t samples = 0;
  void add(const FirstHit* hits, std::size_t count);
};

/// What the rays bring: a colour for each pixel, row 0 on top, and the layers' channels where there are
/// layers. With Pattern::corners there is one row and one column more than in the picture.
struct Film {
  int width = 0, height = 0;
  const LayerBook* layers = nullptr;  ///< Null: colours alone.
  int channels = color_channels;      ///< Of each pixel.
  std::vector<float> values;
  std::vector<GuideSums> guides;  ///< Of each pixel, or empty: not asked for.

  Film() = default;
  /// `threads`: how many may be busy with its memory.
  explicit Film(const ImageSettings& settings, const LayerBook* layers = nullptr, int threads = 1);
  std::size_t index(int x, int y) const { return std::size_t(y) * std::size_t(width) + std::size_t(x); }
  /// Whether what eye rays meet first is noted.
  bool wants_hits() const { return layers || !guides.empty(); }
  float* pixel(int x, int y) { return &values[index(x, y) * std::size_t(channels)]; }
};

/// The picture that a film holds: the film itself, or, with Pattern::corners, the mean of each pixel's four
/// corners.
Image develop(Film film, const ImageSettings& settings);

/// Of a film that has guides: their means, as the channels albedo.R, .G, .B and N.X, .Y, .Z.
Image develop_guides(const Film& film, const ImageSettings& settings);

}  // namespace lambent
