// Compiled once for each instruction set, as the renderer's kernels are.

#include "accel/traverse.h"
#include "math/pack.h"
#include "own_queries.h"

namespace lambent {
inline namespace LAMBENT_ISA {
namespace {

using QueryPack = Pack<float, native_float_lanes>;

template <class F> F load(const float* from) {
  if constexpr (lanes_of<F> == 1) return *from;
  else return F::load(from);
}
template <class F> void store(const F& value, float* to) {
  for (int k = 0; k < lanes_of<F>; ++k) to[k] = lane(value, k);
}

template <class F> QueryRay<F> ray_at(const bench::RayBlock& b, std::uint32_t i) {
  return {{load<F>(b.ox + i), load<F>(b.oy + i), load<F>(b.oz + i)},
          {load<F>(b.dx + i), load<F>(b.dy + i), load<F>(b.dz + i)}};
}

template <class F>
void all_closest(const WorldView& world, const bench::RayBlock* rays, std::uint32_t count, float* answers) {
  for (std::uint32_t i = 0; i < count; i += lanes_of<F>) {
    Closest<F> hit{F(__builtin_inff())};
    find_closest(world, ray_at<F>(rays[i / bench::block_size], i % bench::block_size), MaskOf<F>(true), hit);
    store(hit.t, answers + i);
  }
}

void closest(const WorldView& world, const bench::RayBlock* rays, std::uint32_t count, bool packets,
             float* answers) {
  if (packets) all_closest<QueryPack>(world, rays, count, answers);
  else all_closest<float>(world, rays, count, answers);
}

void occluded(const WorldView& world, const bench::RayBlock* rays, std::uint32_t count, float* answers) {
  for (std::uint32_t i = 0; i < count; i += native_float_lanes) {
    const bench::RayBlock& b = rays[i / bench::block_size];
    const auto t_far = QueryPack::load(b.t_far + i % bench::block_size);
    const auto blocked = find_occluded(world, ray_at<QueryPack>(b, i % bench::block_size),
                                       MaskOf<QueryPack>(true), t_far, true);
    store(select(blocked, QueryPack(-__builtin_inff()), t_far), answers + i);
  }
}

}  // namespace

extern const bench::OwnQueries bench_queries;
const bench::OwnQueries bench_queries{LAMBENT_ISA_NAME, closest, occluded};

}  // namespace LAMBENT_ISA
}  // namespace lambent
