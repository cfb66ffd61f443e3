#pragma once
// Lights with extent that stand in the world, as what is seen of them: one more object each, of one more
// material.

#include <vector>

#include "scene/scene.h"

namespace lambent {

struct StandingLight {
  std::uint32_t light;  ///< Index into Scene::lights.
  Shape shape;          ///< In the world.
  Material material;    ///< It sends out the light's radiance and nothing else.
  bool two_sided;       ///< Otherwise its inside is dark.
};

/// In the order of the lights. To all who number objects or materials, their objects come after the scene's
/// objects, and their materials after the scene's materials.
std::vector<StandingLight> standing_lights(const Scene& scene);

}  // namespace lambent
