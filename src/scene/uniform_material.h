#pragma once

#include "scene/scene.h"

namespace lambent {

/// The material as it is where nothing is painted on it: a metallic-roughness one in the lecture's numbers
/// (illumination/metallic_roughness.h), and what is not opaque of it in its colours and `transmit`. Its maps
/// are as they were; a mask too, as it is all there or not at all.
Material uniform_material(const Material& material);

}  // namespace lambent
