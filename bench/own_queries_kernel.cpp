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

/// Calls ask(rays, first, packets) for beams of at most `size` packets (or numbers); `first` is the number of
/// a beam's first ray.
template <class F, class Ask>
void for_beams(const bench::RayBlock* rays, std::uint32_t count, std::uint32_t size, const Ask& ask) {
  constexpr std::uint32_t lanes = lanes_of<F>;
  const std::uint32_t packets = (count + lanes - 1) / lanes;
  for (std::uint32_t first = 0; first < packets; first += size) {
    QueryRay<F> beam_rays[max_packets];
    const std::uint32_t in_beam = min(size, packets - first);
    for (std::uint32_t i = 0; i < in_beam; ++i) {
      const std::uint32_t ray = (first + i) * lanes;
      beam_rays[i] = ray_at<F>(rays[ray / bench::block_size], ray % bench::block_size);
    }
    ask(beam_rays, first * lanes, int(in_beam));
  }
}

template <class F>
void all_closest(const WorldView& world, const bench::RayBlock* rays, std::uint32_t count, std::uint32_t size,
                 float* answers) {
  for_beams<F>(rays, count, size, [&](const QueryRay<F>* beam_rays, std::uint32_t first, int in_beam) {
    Closest<F> hits[max_packets];
    MaskOf<F> active[max_packets];
    for (int i = 0; i < in_beam; ++i) hits[i] = {F(__builtin_inff())}, active[i] = MaskOf<F>(true);
    find_closest(world, beam_rays, active, in_beam, hits);
    for (int i = 0; i < in_beam; ++i) store(hits[i].t, answers + first + std::uint32_t(i * lanes_of<F>));
  });
}

void closest(const WorldView& world, const bench::RayBlock* rays, std::uint32_t count, bool together,
             float* answers) {
  all_closest<QueryPack>(world, rays, count, together ? beam : 1, answers);
}

void occluded(const WorldView& world, const bench::RayBlock* rays, std::uint32_t count, float* answers) {
  for_beams<QueryPack>(
      rays, count, beam, [&](const QueryRay<QueryPack>* beam_rays, std::uint32_t first, int in_beam) {
        QueryPack t_far[max_packets];
        MaskOf<QueryPack> open[max_packets];
        for (int i = 0; i < in_beam; ++i) {
          const std::uint32_t ray = first + std::uint32_t(i * native_float_lanes);
          t_far[i] = QueryPack::load(rays[ray / bench::block_size].t_far + ray % bench::block_size);
          open[i] = MaskOf<QueryPack>(true);
        }
        find_open(world, beam_rays, t_far, in_beam, true, open);
        for (int i = 0; i < in_beam; ++i)
          store(select(open[i], t_far[i], QueryPack(-__builtin_inff())),
                answers + first + std::uint32_t(i * native_float_lanes));
      });
}

}  // namespace

extern const bench::OwnQueries bench_queries;
const bench::OwnQueries bench_queries{LAMBENT_ISA_NAME, closest, occluded};

}  // namespace LAMBENT_ISA
}  // namespace lambent
