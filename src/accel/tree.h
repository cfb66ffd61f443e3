#pragma once
#include "accel/pages.h"
#include "accel/world.h"

namespace lambent {

/// A primitive and its box, in the builder's own layout.
struct alignas(32) BoxedPrimitive {
  Vec3<float> lower;
  std::int32_t geometry;
  Vec3<float> upper;
  std::int32_t primitive;
};

/// Appends a tree over `primitives` to world.nodes and world.refs; those of one geometry must stand together,
/// in their order. Building is Embree's work (rtcBuildBVH, in parallel); the queries are ours.
Bvh build_tree(Pages<BoxedPrimitive> primitives, TreeQuality quality, World& world);

}  // namespace lambent
