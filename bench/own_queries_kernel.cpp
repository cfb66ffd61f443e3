// Compiled once for each instruction set, as the renderer's kernels are.

#include "accel/traverse.h"
#include "math/pack.h"
#include "own_queries.h"

namespace lambent {
inline namespace LAMBENT_ISA {
namespace {

using QueryPack = Pack<float, native_float_lanes>;

constexpr std::uint32_t lanes = native_float_lanes;

QueryRay<QueryPack> rays_at(const bench::RayBlock& b, std::uint32_t i) {
  return {{QueryPack::load(b.ox + i), QueryPack::load(b.oy + i), QueryPack::load(b.oz + i)},
          {QueryPack::load(b.dx + i), QueryPack::load(b.dy + i), QueryPack::load(b.dz + i)}};
}

/// Calls ask(rays, first, packets) for at most `together` packets at a time; `first` is the number of their
/// first ray.
template <class Ask>
void for_packets(const bench::RayBlock* rays, std::uint32_t count, std::uint32_t together, const Ask& ask) {
  const std::uint32_t packets = (count + lanes - 1) / lanes;
  for (std::uint32_t first = 0; first < packets; first += together) {
    QueryRay<QueryPack> asked[beam];
    const std::uint32_t size = min(together, packets - first);
    for (std::uint32_t i = 0; i < size; ++i) {
      const std::uint32_t ray = (first + i) * lanes;
      asked[i] = rays_at(rays[ray / bench::block_size], ray % bench::block_size);
    }
    ask(asked, first * lanes, int(size));
  }
}

void closest(const WorldView& world, const bench::RayBlock* rays, std::uint32_t count, bool together,
             float* answers) {
  for_packets(rays, count, together ? beam : 1,
              [&](const QueryRay<QueryPack>* asked, std::uint32_t first, int packets) {
                Closest<QueryPack> hits[beam];
                MaskOf<QueryPack> active[beam];
                for (int i = 0; i < packets; ++i)
                  hits[i] = {QueryPack(__builtin_inff())}, active[i] = MaskOf<QueryPack>(true);
                find_closest(world, asked, active, packets, hits);
                for (int i = 0; i < packets; ++i) hits[i].t.store(answers + first + std::uint32_t(i) * lanes);
              });
}

void occluded(const WorldView& world, const bench::RayBlock* rays, std::uint32_t count, float* answers) {
  for_packets(rays, count, beam, [&](const QueryRay<QueryPack>* asked, std::uint32_t first, int packets) {
    QueryPack t_far[beam];
    MaskOf<QueryPack> open[beam];
    for (int i = 0; i < packets; ++i) {
      const std::uint32_t ray = first + std::uint32_t(i) * lanes;
      t_far[i] = QueryPack::load(rays[ray / bench::block_size].t_far + ray % bench::block_size);
      open[i] = MaskOf<QueryPack>(true);
    }
    find_open(world, asked, t_far, packets, true, open);
    for (int i = 0; i < packets; ++i)
      select(open[i], t_far[i], QueryPack(-__builtin_inff()))
          .store(answers + first + std::uint32_t(i) * lanes);
  });
}

}  // namespace

extern const bench::OwnQueries bench_queries;
const bench::OwnQueries bench_queries{LAMBENT_ISA_NAME, closest, occluded};

}  // namespace LAMBENT_ISA
}  // namespace lambent
