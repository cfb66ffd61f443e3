#pragma once
// Where nodes stand: their own transforms, or what animations make of them at a time.

#include "import/gltf_accessors.h"
#include "math/transform.h"

namespace lambent::gltf {

struct Pose {
  std::vector<Transform> world_from_node;
  /// How much of each morph target a node's mesh has; empty: what the mesh itself says.
  std::vector<std::vector<double>> weights;
};

/// The file's static pose, or with `time` that of its animations at so many seconds: of all of them, but for
/// those that move what an earlier one moves already; a warning names them. Before its first key and after
/// its last one a channel holds still.
Pose make_pose(const Json& root, Buffers& buffers, std::optional<double> time, Remarks& remarks);

/// What keys must fulfil: times that grow, rotations of unit length.
void check_animations(const Json& root, Buffers& buffers, Remarks& remarks);

}  // namespace lambent::gltf
