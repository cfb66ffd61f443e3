#pragma once
// Our own queries without anything around them, for one instruction set.

#include <string>

#include "rays.h"

namespace lambent::bench {

struct OwnQueries {
  const char* isa;
  /// The distances of the nearest hits of `count` rays; packets together, as eye rays go, or each by itself.
  void (*closest)(const WorldView& world, const RayBlock* rays, std::uint32_t count, bool together,
                  float* answers);
  /// Whether something is in the way, with everything opaque.
  void (*occluded)(const WorldView& world, const RayBlock* rays, std::uint32_t count, float* answers);
};

/// The queries as the kernel called `isa` has them.
const OwnQueries& own_queries(const std::string& isa);

}  // namespace lambent::bench
