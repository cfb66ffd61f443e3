#pragma once
// A picture of layers (docs/layers.md) under other lights and with other materials, without tracing a ray.

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "lambent/image.h"

namespace lambent {

/// Name and factor, linear R, G, B; none negative.
using LayerFactor = std::pair<std::string, std::array<double, 3>>;

struct Relighting {
  std::vector<LayerFactor> lights;  ///< By the light's name: on its colour.
  /// ambient, diffuse, specular, emission, background: on all that comes by this term. reflection,
  /// refraction: on all that comes this way.
  std::vector<LayerFactor> terms;
  /// "red.diffuse": on one term (ambient, diffuse, specular) of one material, where the eye sees it directly.
  std::vector<LayerFactor> materials;
};

struct Relit {
  Image image;  ///< R, G, B.
  /// With materials: pixels where one of them covers a part only. There the factor counts by that part, which
  /// is right where the other part is as bright.
  std::size_t mixed_pixels = 0;
  /// With materials: pixels that see something in a mirror or through glass, where materials keep their old
  /// factors.
  std::size_t mirroring_pixels = 0;
};

/// The sum of the layers, each times its factors. Throws InputError where the picture has no layers, or none
/// of the name.
Relit relight(const ReadImage& layers, const Relighting& relighting);

}  // namespace lambent
