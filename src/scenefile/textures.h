#pragma once

#include "lambent/limits.h"
#include "scene/scene.h"

namespace lambent {

/// Reads and decodes the images of the scene's textures, each once for all materials that use it, and makes
/// their levels of detail. What cannot be read leaves the material without that map, with a warning; but an
/// image that must be there (ImageSource::required) throws InputError.
void load_textures(Scene& scene, const Limits& limits);

}  // namespace lambent
