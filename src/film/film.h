#pragma once
#include <vector>

#include "film/layer_book.h"
#include "lambent/image.h"
#include "scene/scene.h"

namespace lambent {

/// What the rays bring: a colour for each pixel, row 0 on top, and the layers' channels where there are
/// layers. With Pattern::corners there is one row and one column more than in the picture.
struct Film {
  int width = 0, height = 0;
  const LayerBook* layers = nullptr;  ///< Null: colours alone.
  int channels = color_channels;      ///< Of each pixel.
  std::vector<float> values;

  Film() = default;
  explicit Film(const ImageSettings& settings, const LayerBook* layers = nullptr);
  float* pixel(int x, int y) {
    return &values[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * std::size_t(channels)];
  }
};

/// The picture that a film holds: the film itself, or, with Pattern::corners, the mean of each pixel's four
/// corners.
Image develop(Film film, const ImageSettings& settings);

}  // namespace lambent
