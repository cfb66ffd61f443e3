#pragma once
// The queries of one picture, as they were asked, in the layout that packets want: blocks of 16 rays as
// structures of arrays, so that a packet of any width up to 16 is a contiguous load.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "integrators/frame.h"

namespace lambent::bench {

inline constexpr int block_size = 16;

struct alignas(64) RayBlock {
  float ox[block_size], oy[block_size], oz[block_size];
  float dx[block_size], dy[block_size], dz[block_size];
  float t_far[block_size];
};

/// Consecutive rays of one kind. The last block is filled up with copies of its last ray.
struct RayList {
  std::vector<RayBlock> blocks;
  std::uint32_t count = 0;
  std::uint64_t first_answer = 0;  ///< Where the distance of the first block's first ray goes.

  void add(const AskedRay& ray) {
    const std::uint32_t lane = count++ % block_size;
    if (lane == 0) blocks.emplace_back();
    RayBlock& b = blocks.back();
    for (std::uint32_t i = lane; i < block_size; ++i) {
      b.ox[i] = ray.ox, b.oy[i] = ray.oy, b.oz[i] = ray.oz;
      b.dx[i] = ray.dx, b.dy[i] = ray.dy, b.dz[i] = ray.dz;
      b.t_far[i] = ray.t_far;
    }
  }
};

/// The rays of one tile: what a thread takes at a time.
struct TileRays {
  RayList eye, scattered, shadow;
};

/// What a query stores for a ray: the distance of the hit; infinity where there is none. For shadow rays:
/// -infinity where something is in the way, otherwise the way to the light; so does Embree.
using Answers = std::vector<float>;

struct RecordedRays {
  std::vector<TileRays> tiles;
  std::uint64_t eye = 0, scattered = 0, shadow = 0;
  std::uint64_t answers = 0;  ///< Places for distances, those of the last blocks' spare lanes included.

  std::uint64_t total() const { return eye + scattered + shadow; }
};

}  // namespace lambent::bench
