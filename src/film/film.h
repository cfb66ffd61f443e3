#pragma once
#include <vector>

#include "lambent/image.h"
#include "scene/scene.h"

namespace lambent {

/// The picture that a film holds: the film itself, or, with Pattern::corners, the mean of each pixel's four
/// corners.
///   film  film_width * film_height colours; with corners, one row and one column more than the picture
Image develop(const std::vector<float>& film, const ImageSettings& settings);

}  // namespace lambent
