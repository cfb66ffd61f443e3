#pragma once
#include <functional>
#include <vector>

#include "accel/world.h"

namespace lambent {

/// A primitive and its box, as the builder wants it.
struct BoxedPrimitive {
  PrimitiveRef ref;
  Vec3<float> lower, upper;
};

/// Appends a tree over `primitives` (which it may reorder) to nodes and refs. Building is Embree's work
/// (rtcBuildBVH, in parallel, surface area heuristic); the queries are ours.
Bvh build_tree(std::vector<BoxedPrimitive> primitives, std::vector<BvhNode>& nodes,
               std::vector<PrimitiveRef>& refs);

}  // namespace lambent
