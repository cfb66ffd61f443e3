#pragma once
#include <vector>

#include "integrators/light_tree.h"
#include "scene/scene.h"

namespace lambent {

/// Where some lights are, where they shine, and how much. Angles in turns.
struct LightBounds {
  Bounds box;
  Vec3<double> axis{0, 0, 1};  ///< Of unit length.
  double spread = 0.5;         ///< The lights face there within this angle,
  double reach = 0.25;         ///< and shine up to that one from where they face.
  double intensity = 0;        ///< As LightNode's.
  bool two_sided = false;
  std::int32_t emitter = -1;  ///< Of one light.
};
/// Bounds of both.
LightBounds both_bounds(const LightBounds& a, const LightBounds& b);
LightNode light_node(const LightBounds& bounds);

/// Where a light stands in its tree; `path` as in pick_probability.
struct LightPath {
  std::int32_t emitter;
  std::uint64_t path;
};

/// Appends a tree over the lights (one at least), whose root comes first; for each light its path is
/// appended. The tree depends on nothing but the lights and their order.
void build_light_tree(std::vector<LightBounds> lights, std::vector<LightNode>& nodes,
                      std::vector<LightPath>& paths);

}  // namespace lambent
