#pragma once
#include <vector>

#include "lambent/image.h"
#include "scene/scene.h"

namespace lambent {

/// What the rays bring: a colour for each pixel, row 0 on top. With Pattern::corners there is one row and one
/// column more than in the picture.
struct Film {
  int width = 0, height = 0;
  std::vector<float> colors;  ///< color_channels for each pixel.

  Film() = default;
  explicit Film(const ImageSettings& settings);
};

/// The picture that a film holds: the film itself, or, with Pattern::corners, the mean of each pixel's four
/// corners.
Image develop(Film film, const ImageSettings& settings);

}  // namespace lambent
