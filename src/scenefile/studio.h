#pragma once

#include "scene/texture.h"

namespace lambent {

/// The picture around a model that is shown by itself, for what mirrors: a dark room, lighter above, with
/// three soft lamps where the lights of autoscene.cpp stand around a camera that looks along -z. It has its
/// levels.
Texture studio_texture();

}  // namespace lambent
