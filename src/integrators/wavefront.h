#pragma once
// Rays in waves: what integrators that follow rays level by level have in common. A batch of samples throws
// its eye rays; the rays of a level are traced together; their hits are sorted into groups, one for each kind
// of primitive and of whatever the integrator tells apart; and what happens at a hit happens to a packet of
// hits of one group. Here are the stages that do not depend on what light does: from the film to the surface
// points with the numbers of their materials, and from a sample's colour back to the film.
//
// An integrator's kernel derives from Wavefront, and says what rays bring and which rays go on.

#include "accel/coordinates.h"
#include "accel/surface.h"
#include "integrators/frame.h"
#include "integrators/paint.h"
#include "math/directions.h"
#include "math/random.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// A task on its way through the stages.
struct Wavefront {
  // Queries run in float, shading in double: an error of R.V counts n times in (R.V)^n, so float could not
  // keep 1e-6 where n >= 32.
  static constexpr int lanes = native_float_lanes;
  using Query = Pack<float, lanes>;
  using F = Pack<double, lanes>;
  using C = Color<F>;
  using Truth = MaskOf<F>;

  /// Samples that are followed together: what they need fits the cache.
  static constexpr std::uint32_t batch_size = 1024;

  static constexpr int kinds = int(PrimitiveKind::instance);
  static constexpr int most_ways_to_shade = model_count;  ///< Which an integrator may tell apart.
  static constexpr int group_count = kinds * 2 * 2 * most_ways_to_shade;
  static constexpr std::uint8_t no_group = 255;
  static_assert(group_count < no_group);

  const Frame& frame;
  const PixelTask& task;
  Scratch& scratch;
  RayCounts& counts;

  int depth = 1;  ///< Of the rays at hand; the ray from the eye is 1.
  std::uint64_t first_of_batch = 0;

  int samples_per_pixel() const { return task.end_sample - task.first_sample; }
  std::uint64_t sample_count() const { return std::uint64_t(task.count) * samples_per_pixel(); }

  /// Which of the pattern's samples has a place in the frame's order.
  int sample_at(int place) const { return frame.order ? frame.order[place] : place; }

  void make_room() const {
    if (scratch.samples.capacity > 0) return;
    Scratch::grow(scratch.samples, batch_size);
    Scratch::grow(scratch.rays, batch_size);
    Scratch::grow(scratch.next_rays, batch_size);
  }

  /// Follows the task's samples, a batch at a time. `begin()` is called when the eye rays of a batch are
  /// made, `shade()` when the hits of a level are sorted, `end(first, count)` when a batch is done.
  template <class Begin, class Background, class Shade, class End>
  void follow_batches(int MaterialRecord::*way_to_shade, const Begin& begin, const Background& background,
                      const Shade& shade, const End& end) {
    for (std::uint64_t first = 0; first < sample_count(); first += batch_size) {
      const std::uint32_t count = size_of_batch(first);
      follow_batch(first, count, way_to_shade, begin, background, shade);
      end(first, count);
    }
  }
  std::uint32_t size_of_batch(std::uint64_t first) const {
    return std::uint32_t(min<std::uint64_t>(batch_size, sample_count() - first));
  }
  template <class Begin, class Background, class Shade>
  void follow_batch(std::uint64_t first, std::uint32_t count, int MaterialRecord::*way_to_shade,
                    const Begin& begin, const Background& background, const Shade& shade) {
    first_of_batch = first;
    throw_eye_rays(first, count);
    begin(count);
    for (depth = 1; scratch.rays.count > 0; ++depth) {
      trace(depth == 1);
      if (frame.fog.density > 0) pass_fog();
      sort_into_groups(way_to_shade, background);
      if (depth == 1) counts.eye_hits += hit_count();
      scratch.next_rays.count = 0;
      shade();
      RayQueue rays = scratch.rays;
      scratch.rays = scratch.next_rays;
      scratch.next_rays = rays;
    }
  }

  // ---- eye rays

  LAMBENT_FLATTEN void throw_eye_rays(std::uint64_t first, std::uint32_t count) {
    RayQueue& rays = scratch.rays;
    rays.count = count;
    const bool has_lens = frame.camera.lens_radius > 0;
    if (has_lens) choose_lens_points(first, count);
    place_in_picture(first, count);
    const CameraRecord& camera = frame.camera;
    const F half_width(0.5 * frame.width), half_height(0.5 * frame.height), per_unit(2.0 / frame.height);
    const Vec3<F> right = broadcast<F>(camera.right), up = broadcast<F>(camera.up),
                  forward = broadcast<F>(camera.forward), eye = broadcast<F>(camera.eye);
    for (std::uint32_t i = 0; i < count; i += lanes) {
      const F x = (F::load(&rays.ox[i]) - half_width) * per_unit,
              y = (half_height - F::load(&rays.oy[i])) * per_unit;
      const Vec3<F> aside = x * right + y * up;
      Vec3<F> o = eye + F(camera.spread_of_origins) * aside,
              d = forward + F(camera.spread_of_directions) * aside;
      if (has_lens) {
        const Vec3<F> off_centre = F::load(&rays.dx[i]) * right + F::load(&rays.dy[i]) * up;
        o = o + off_centre;
        d = F(camera.focus) * d - off_centre;
      }
      d = normalize(d);
      o.x.store(&rays.ox[i]), o.y.store(&rays.oy[i]), o.z.store(&rays.oz[i]);
      d.x.store(&rays.dx[i]), d.y.store(&rays.dy[i]), d.z.store(&rays.dz[i]);
      const Vec3<Query> q = number_cast<float>(o);
      q.x.store(&rays.qx[i]), q.y.store(&rays.qy[i]), q.z.store(&rays.qz[i]);
      F(0.0).store(&rays.R[i]);
      for (int c = 0; c < color_channels; ++c) {
        F(1.0).store(&rays.weight[c][i]);
        F(0.0).store(&scratch.samples.color[c][i]);
      }
    }
    counts.eye += count;
    if (frame.cones) begin_cones(count);
  }

  /// Where samples lie in the picture, in pixels from its upper left corner; kept where the rays' origins
  /// will be.
  void place_in_picture(std::uint64_t first, std::uint32_t count) const {
    RayQueue& rays = scratch.rays;
    for (std::uint32_t i = 0; i < count; ++i) rays.sample[i] = i;
    const Pixel* pixel = task.pixels + first / samples_per_pixel();
    if (samples_per_pixel() == 1) {
      const Vec2<double> at = frame.pattern[sample_at(task.first_sample)];
      for (std::uint32_t i = 0; i < count; ++i) rays.ox[i] = pixel[i].x + at.x;
      for (std::uint32_t i = 0; i < count; ++i) rays.oy[i] = pixel[i].y + at.y;
      return;
    }
    const int* order = frame.order;
    int sample = task.first_sample + int(first % samples_per_pixel());
    for (std::uint32_t i = 0; i < count; ++pixel, sample = task.first_sample) {
      const double x = pixel->x, y = pixel->y;
      const std::uint32_t end = min(i + std::uint32_t(task.end_sample - sample), count);
      for (; i < end; ++i, ++sample) {
        const Vec2<double>& at = frame.pattern[order ? order[sample] : sample];
        rays.ox[i] = x + at.x;
        rays.oy[i] = y + at.y;
      }
    }
  }

  /// Where rays go through the lens, in scene units from its centre; kept where their directions will be.
  /// Which point says nothing about where in its pixel the sample lies, nor about the neighbours' points.
  [[gnu::noinline]] void choose_lens_points(std::uint64_t first, std::uint32_t count) const {
    auto pixel = std::uint32_t(first / samples_per_pixel());
    int sample = task.first_sample + int(first % samples_per_pixel());
    for (std::uint32_t i = 0; i < count; ++i) {
      const Pixel& at_pixel = task.pixels[pixel];
      const Vec2<double> at = random_point(std::uint32_t(sample_at(sample)),
                                           hashed(seed_of_pixel(at_pixel.x, at_pixel.y) + lens_pair));
      const Vec2<double> point = on_disc(at.x, at.y);
      scratch.rays.dx[i] = frame.camera.lens_radius * point.x;
      scratch.rays.dy[i] = frame.camera.lens_radius * point.y;
      if (++sample == task.end_sample) sample = task.first_sample, ++pixel;
    }
  }

  /// How wide eye rays are: a pixel, or a sample's share of one. Off the picture's middle pixels cover less
  /// of the directions.
  void begin_cones(std::uint32_t count) const {
    RayQueue& rays = scratch.rays;
    const Vec3<double>& forward = frame.camera.forward;
    for (std::uint32_t i = 0; i < count; ++i) {
      const double cosine = rays.dx[i] * forward.x + rays.dy[i] * forward.y + rays.dz[i] * forward.z;
      rays.width[i] = frame.eye_width;
      rays.spread[i] = frame.eye_spread * cosine * cosine;
    }
  }

  // ---- where rays end

  /// Eye rays lie close together, so that many go through the tree as one; scattered ones go their own ways.
  void trace(bool coherent) {
    RayQueue& rays = scratch.rays;
    if (frame.listener) tell(rays, coherent ? RayKind::eye : RayKind::scattered);
    const int together = coherent ? beam : 1;
    for (std::uint32_t i = 0; i < rays.count; i += std::uint32_t(together * lanes))
      trace_packets(rays, i, together);
    if (frame.any_gaps)
      for (std::uint32_t i = 0; i < rays.count; ++i) pass_gaps(rays, i);
  }

  /// Takes a ray on through surfaces that are not there for it: the gaps of masks, and one-sided surfaces
  /// from inside.
  void pass_gaps(RayQueue& rays, std::uint32_t i) const {
    const Vec3<double> o{rays.ox[i], rays.oy[i], rays.oz[i]}, d{rays.dx[i], rays.dy[i], rays.dz[i]};
    QueryRay<float> ray({rays.qx[i], rays.qy[i], rays.qz[i]}, cast<float>(d));
    // Each turn leaves a surface behind; a ray that runs along one may find it again.
    for (int turns_left = 10000; rays.geometry[i] >= 0 && turns_left > 0; --turns_left) {
      const HitIds<std::int32_t> ids{rays.instance[i], rays.geometry[i], rays.primitive[i]};
      const std::uint32_t material = material_of(frame.world, ids.instance, ids.geometry, ids.primitive);
      if (!frame.materials[material].gaps) return;
      const SurfacePoint<double> s = surface_at(frame.world, ids, o, d, rays.t[i]);
      const double width = frame.cones ? rays.width[i] + rays.spread[i] * s.t : 0;
      if (!is_gap(frame, ids, material, s, d, width)) return;
      const double side = dot(s.Ng, d) >= 0 ? 1.0 : -1.0;
      ray.o = cast<float>(s.P + side * s.offset * s.Ng);
      Closest<float> hit{__builtin_inff()};
      find_closest(frame.world, ray, true, hit);
      rays.t[i] = float(s.t + hit.t);
      rays.instance[i] = hit.ids.instance;
      rays.geometry[i] = hit.ids.geometry;
      rays.primitive[i] = hit.ids.primitive;
    }
  }

  /// Lays the fog over what rays will bring: the fog's colour is added to their samples, and they count the
  /// less. Rays that were scattered by chance see no fog: theirs is the light that falls on a surface, which
  /// would come through no fog either where it was looked for.
  [[gnu::noinline]] void pass_fog() {
    constexpr double log2_e = 0x1.71547652b82fep+0;
    RayQueue& rays = scratch.rays;
    const FogRecord& fog = frame.fog;
    for (std::uint32_t i = 0; i < rays.count; ++i) {
      if (rays.density[i] > 0) continue;
      const double R = rays.R[i], way = max(R + rays.t[i] - fog.start, 0.0) - max(R - fog.start, 0.0);
      const double share = exp2(-log2_e * fog.density * way);
      const Rgb brings = (1 - share) * fog.color;
      add(i, brings);
      if (task.layer_sums)
        add_to_layer(i, frame.layers.first_of(rays.way[i]) + frame.layers.fog_layer(), brings);
      Rgb weight;
      for (int c = 0; c < color_channels; ++c) weight[c] = rays.weight[c][i] *= share;
      if (frame.witness)
        frame.witness->fog(frame.witness->self, {rays.number[i], way, share, brings, weight});
    }
  }

  /// So many packets from ray `first` on, together.
  void trace_packets(RayQueue& rays, std::uint32_t first, int together) const {
    QueryRay<Query> ray[beam];
    MaskOf<Query> active[beam];
    Closest<Query> hit[beam];
    int count = 0;
    for (std::uint32_t i = first; i < rays.count && count < together; i += lanes, ++count) {
      ray[count] = QueryRay<Query>(
          {Query::load(&rays.qx[i]), Query::load(&rays.qy[i]), Query::load(&rays.qz[i])},
          number_cast<float>(Vec3<F>{F::load(&rays.dx[i]), F::load(&rays.dy[i]), F::load(&rays.dz[i])}));
      active[count] = first_lanes<float>(rays.count - i);
      hit[count] = {Query(__builtin_inff())};
    }
    find_closest(frame.world, ray, active, count, hit);
    for (int k = 0; k < count; ++k) {
      const std::uint32_t i = first + std::uint32_t(k) * lanes;
      hit[k].t.store(&rays.t[i]);
      hit[k].ids.instance.store(&rays.instance[i]);
      hit[k].ids.geometry.store(&rays.geometry[i]);
      hit[k].ids.primitive.store(&rays.primitive[i]);
    }
  }

  template <class T> static MaskOf<Pack<T, lanes>> first_lanes(std::uint32_t count) {
    return Pack<T, lanes>(T(count)) > gather<Pack<T, lanes>>([](int k) { return T(k); });
  }

  void tell(const RayQueue& rays, RayKind kind) const {
    for (std::uint32_t i = 0; i < rays.count; ++i)
      frame.listener->asked(frame.listener->self,
                            {rays.qx[i], rays.qy[i], rays.qz[i], float(rays.dx[i]), float(rays.dy[i]),
                             float(rays.dz[i]), __builtin_inff(), kind});
  }

  std::uint32_t group_first[group_count + 1]{};  // in rays.order
  std::uint32_t hit_count() const { return group_first[group_count]; }

  /// Sorts the rays that hit something into groups; `background(first, end)` is called for each run of rays
  /// that did not.
  template <class Background>
  void sort_into_groups(int MaterialRecord::*way_to_shade, const Background& background) {
    // One's own, as the bytes that are written below could be those of another's pointers.
    const RayQueue rays = scratch.rays;
    std::uint32_t size[group_count] = {};
    // Neighbours often meet the same, so that groups come in runs.
    for (std::uint32_t i = 0, end = 0; i < rays.count; i = end) {
      const std::int32_t geometry = rays.geometry[i], instance = rays.instance[i];
      end = end_of_run<lanes>(i, rays.count, rays.geometry.data, rays.instance.data);
      if (geometry < 0) {
        for (std::uint32_t k = i; k < end; ++k) rays.group[k] = no_group;
        background(i, end);
        continue;
      }
      const auto material_at = [&](std::uint32_t ray) {
        return material_of(frame.world, instance, geometry, rays.primitive[ray]);
      };
      const bool one_material = frame.world.geometries[geometry].one_material;
      std::uint32_t material = material_at(i);
      for (std::uint32_t first = i, last = 0; first < end; first = last) {
        std::uint32_t next = material;
        last = one_material ? end : first + 1;
        while (last < end && (next = material_at(last)) == material) ++last;
        const auto group = std::uint8_t(group_of(geometry, instance >= 0, material, way_to_shade));
        for (std::uint32_t k = first; k < last; ++k) rays.material[k] = material;
        for (std::uint32_t k = first; k < last; ++k) rays.group[k] = group;
        size[group] += last - first;
        material = next;
      }
    }
    std::uint32_t next[group_count];
    group_first[0] = 0;
    for (int g = 0; g < group_count; ++g)
      next[g] = group_first[g], group_first[g + 1] = group_first[g] + size[g];
    for (std::uint32_t i = 0, end = 0; i < rays.count; i = end) {
      const std::uint8_t group = rays.group[i];
      for (end = i + 1; end < rays.count && rays.group[end] == group;) ++end;
      if (group == no_group) continue;
      std::uint32_t* order = &rays.order[next[group]];
      for (std::uint32_t k = 0; k < end - i; ++k) order[k] = i + k;
      next[group] += end - i;
    }
  }

  int group_of(std::int32_t geometry, bool placed, std::uint32_t material,
               int MaterialRecord::*way_to_shade) const {
    const Geometry& g = frame.world.geometries[geometry];
    const MaterialRecord& m = frame.materials[material];
    const bool painted = m.painted || g.colors;
    return ((int(g.kind) * 2 + placed) * 2 + painted) * most_ways_to_shade + m.*way_to_shade;
  }
  static bool is_painted(int group) { return group / most_ways_to_shade % 2; }
  static int way_to_shade_of(int group) { return group % most_ways_to_shade; }

  /// Calls shade(group) for each group that has hits.
  template <class Shade> void for_each_group(const Shade& shade) {
    for (int group = 0; group < group_count; ++group)
      if (group_first[group] < group_first[group + 1]) shade(group);
  }

  Rgb background_of(std::uint32_t i) const {
    const RayQueue& rays = scratch.rays;
    if (!frame.environment.texture.levels) return frame.background;
    return background_along(frame, {rays.dx[i], rays.dy[i], rays.dz[i]}, rays.spread[i]);
  }

  /// Adds the colour of the background, the same everywhere, to the samples of rays.
  void add_background(std::uint32_t first, std::uint32_t end) {
    const RayQueue& rays = scratch.rays;
    for (int c = 0; c < color_channels; ++c) {
      double* color = scratch.samples.color[c].data;
      const double* weight = rays.weight[c].data;
      const double background = frame.background[c];
      if (depth == 1)  // each is its own sample's
        for (std::uint32_t i = first; i < end; ++i) color[i] += weight[i] * background;
      else
        for (std::uint32_t i = first; i < end; ++i) color[rays.sample[i]] += weight[i] * background;
    }
  }

  /// Adds a ray's colour to its sample.
  void add(std::uint32_t ray, const Rgb& color) {
    const std::uint32_t sample = scratch.rays.sample[ray];
    for (int c = 0; c < color_channels; ++c)
      scratch.samples.color[c][sample] += scratch.rays.weight[c][ray] * color[c];
  }

  // ---- hits, a packet at a time

  /// The rays of a packet whose hits are looked at together; lanes left over repeat the last.
  struct Lanes {
    std::uint32_t ray[lanes];
    int count;
    bool adjacent;  ///< They stand side by side in the queue.
    Truth active;

    F load(const Column<double>& column) const {
      if (adjacent) return F::load(&column[ray[0]]);
      return gather<F>([&](int k) { return column[ray[k]]; });
    }
    Vec3<F> load(const Column<double>& x, const Column<double>& y, const Column<double>& z) const {
      return {load(x), load(y), load(z)};
    }
  };

  /// The materials of a packet of hits on painted surfaces.
  struct Painted {
    C ka, kd, ks, emission, reflect, transmit;
    F n, ior;
    double curvature[lanes], lobe[lanes];
    // Of paths, which take a material as it is given:
    MetallicRoughnessOf<F, C> rough;
    F opacity;
  };

  /// A packet of hits: all that is known of them.
  struct Hits {
    Vec3<F> P, N, V;
    Vec3<F> G;            ///< Geometric normal; as N on V's side.
    F R;                  ///< Distance from the eye, over all bounces.
    F t;                  ///< The ray's length.
    Vec3<F> lifted;       ///< P, lifted to the smooth surface that it stands for.
    Vec3<F> front, back;  ///< Where rays start that leave on V's side, and those that go through.
    Truth outside;        ///< Whether V is on the outside.
    std::uint32_t material[lanes];
    bool one_material;
    const Painted* painted;  ///< Null, but for hits on painted surfaces.
  };

  /// Packets of hits that are looked at together, so that their shadow rays go through the tree together.
  struct Block {
    int count = 0;
    Lanes at[beam];
    Hits hits[beam];
    Painted painted[beam];
  };

  /// The next hits of a group, from `first` on, which is taken along.
  void fill(Block& block, int group, std::uint32_t& first) const {
    const std::uint32_t last = group_first[group + 1];
    for (; first < last && block.count < beam; first += lanes, ++block.count) {
      set_lanes(block.at[block.count], first, last);
      look(block.at[block.count], block.hits[block.count]);
      if (is_painted(group)) paint_hits(block, block.count);
    }
  }

  void set_lanes(Lanes& at, std::uint32_t first, std::uint32_t last) const {
    const std::uint32_t* order = &scratch.rays.order[first];
    at.count = int(min(last - first, std::uint32_t(lanes)));
    for (int k = 0; k < lanes; ++k) at.ray[k] = order[min(k, at.count - 1)];
    at.adjacent = at.count == lanes && at.ray[lanes - 1] - at.ray[0] == lanes - 1;
    at.active = first_lanes<double>(std::uint32_t(at.count));
  }

  LAMBENT_FLATTEN void look(const Lanes& at, Hits& hits) const {
    const RayQueue& rays = scratch.rays;
    const Vec3<F> o = at.load(rays.ox, rays.oy, rays.oz), d = at.load(rays.dx, rays.dy, rays.dz);
    hits.painted = nullptr;
    std::int32_t apart[3][lanes];
    float t[lanes];
    HitIds<const std::int32_t*> ids{apart[0], apart[1], apart[2]};
    Query t_found;
    if (at.adjacent) {
      const std::uint32_t ray = at.ray[0];
      ids = {&rays.instance[ray], &rays.geometry[ray], &rays.primitive[ray]};
      std::memcpy(hits.material, &rays.material[ray], sizeof hits.material);
      t_found = Query::load(&rays.t[ray]);
    } else {
      for (int k = 0; k < lanes; ++k) {
        const std::uint32_t ray = at.ray[k];
        apart[0][k] = rays.instance[ray], apart[1][k] = rays.geometry[ray], apart[2][k] = rays.primitive[ray];
        hits.material[k] = rays.material[ray];
        t[k] = rays.t[ray];
      }
      t_found = Query::load(t);
    }
    hits.one_material = all_equal<lanes>(hits.material);
    const SurfacePoint<F> s = surface_at<F>(frame.world, ids, o, d, number_cast<double>(t_found));
    hits.P = s.P;
    hits.V = -d;
    hits.outside = dot(s.Ng, hits.V) >= F(0);
    const F side = select(hits.outside, F(1), F(-1));
    hits.N = side * s.N;
    hits.G = side * s.Ng;
    hits.lifted = s.P + s.lift;
    hits.front = hits.lifted + s.offset * hits.G;
    hits.back = s.P - s.offset * hits.G;
    hits.R = at.load(rays.R) + s.t;
    hits.t = s.t;
  }

  /// Looks the materials of painted surfaces up, lane by lane, and tilts N.
  [[gnu::noinline]] void paint_hits(Block& block, int packet) const {
    const RayQueue& rays = scratch.rays;
    const Lanes& at = block.at[packet];
    Hits& hits = block.hits[packet];
    const bool as_given = frame.tracing == Tracing::path;
    Paint paints[lanes];
    for (int k = 0; k < lanes; ++k) {
      if (k >= at.count) {
        paints[k] = paints[at.count - 1];
        continue;
      }
      const std::uint32_t ray = at.ray[k];
      const double side = lane_bits(hits.outside) >> k & 1 ? 1.0 : -1.0;
      const Vec3<double> d = -lane(hits.V, k);
      const double width = frame.cones ? rays.width[ray] + rays.spread[ray] * lane(hits.t, k) : 0;
      const HitIds<std::int32_t> ids{rays.instance[ray], rays.geometry[ray], rays.primitive[ray]};
      const Vec3<double> P = lane(hits.P, k), N = side * lane(hits.N, k), G = side * lane(hits.G, k);
      paints[k] = as_given ? paint_as_given(frame, ids, hits.material[k], P, N, G, d, width)
                           : paint(frame, ids, hits.material[k], P, N, G, d, width);
      paints[k].N = side * paints[k].N;
    }
    const auto color = [&](Rgb Paint::*member) {
      C result;
      for (int c = 0; c < color_channels; ++c)
        result[c] = gather<F>([&](int k) { return (paints[k].*member)[c]; });
      return result;
    };
    Painted& painted = block.painted[packet];
    if (as_given) {
      const auto number = [&](double MetallicRoughnessOf<double, Rgb>::*member) {
        return gather<F>([&](int k) { return paints[k].rough.*member; });
      };
      const auto rough_color = [&](Rgb MetallicRoughnessOf<double, Rgb>::*member) {
        C result;
        for (int c = 0; c < color_channels; ++c)
          result[c] = gather<F>([&](int k) { return (paints[k].rough.*member)[c]; });
        return result;
      };
      using Rough = MetallicRoughnessOf<double, Rgb>;
      painted.rough = {rough_color(&Rough::base_color),     number(&Rough::metallic),
                       number(&Rough::roughness),           number(&Rough::specular),
                       rough_color(&Rough::specular_color), number(&Rough::ior),
                       number(&Rough::transmission),        number(&Rough::clearcoat),
                       number(&Rough::clearcoat_roughness)};
      painted.opacity = gather<F>([&](int k) { return paints[k].opacity; });
    }
    painted.ka = color(&Paint::ka), painted.kd = color(&Paint::kd), painted.ks = color(&Paint::ks);
    painted.emission = color(&Paint::emission);
    painted.reflect = color(&Paint::reflect), painted.transmit = color(&Paint::transmit);
    painted.n = gather<F>([&](int k) { return paints[k].n; });
    painted.ior = gather<F>([&](int k) { return paints[k].ior; });
    for (int k = 0; k < lanes; ++k)
      painted.curvature[k] = paints[k].curvature, painted.lobe[k] = paints[k].lobe;
    hits.N = gather_points<F>([&](int k) -> const Vec3<double>& { return paints[k].N; });
    hits.painted = &painted;
  }

  // The numbers of the hits' materials.
  C ambient_of(const Hits& hits) const {
    return hits.painted ? hits.painted->ka
                        : colors_of_materials(hits, [](const MaterialRecord& m) { return m.ambient; });
  }
  C diffuse_of(const Hits& hits) const {
    return hits.painted ? hits.painted->kd
                        : colors_of_materials(hits, [](const MaterialRecord& m) { return m.diffuse; });
  }
  C specular_of(const Hits& hits) const {
    return hits.painted ? hits.painted->ks
                        : colors_of_materials(hits, [](const MaterialRecord& m) { return m.specular; });
  }
  F shininess_of(const Hits& hits) const {
    return hits.painted ? hits.painted->n
                        : of_materials(hits, [](const MaterialRecord& m) { return m.shininess; });
  }
  C emission_of(const Hits& hits) const {
    if (hits.painted) return hits.painted->emission;
    const C emission = colors_of_materials(hits, [](const MaterialRecord& m) { return m.emission; });
    if (!frame.any_dark_inside) return emission;
    const Truth bright =
        of_materials(hits, [](const MaterialRecord& m) { return m.dark_inside ? 0.0 : 1.0; }) > F(0);
    return select(either(hits.outside, bright), emission, grey(F(0)));
  }
  C reflect_of(const Hits& hits) const {
    return hits.painted ? hits.painted->reflect
                        : colors_of_materials(hits, [](const MaterialRecord& m) { return m.reflect; });
  }
  C transmit_of(const Hits& hits) const {
    return hits.painted ? hits.painted->transmit
                        : colors_of_materials(hits, [](const MaterialRecord& m) { return m.transmit; });
  }
  /// How much of the light that comes along V is reflected, where Fresnel's equations say so; elsewhere 1.
  C fresnel_of(const Hits& hits, bool any_metal, bool any_glass) const {
    const F cosine = min(max(dot(hits.N, hits.V), F(0)), F(1));
    const auto is = [&](Boundary boundary) {
      return Truth(of_materials(hits, [boundary](const MaterialRecord& m) {
                     return m.boundary == boundary ? 1.0 : 0.0;
                   }) > F(0));
    };
    const C eta = colors_of_materials(hits, [](const MaterialRecord& m) { return m.eta; });
    C w = grey(F(1));
    if (any_metal) {
      const C k = colors_of_materials(hits, [](const MaterialRecord& m) { return m.k; });
      const Truth metal = is(Boundary::metal);
      for (int c = 0; c < color_channels; ++c)
        w[c] = select(metal, fresnel_conductor(cosine, eta[c], k[c]), w[c]);
    }
    if (any_glass) {
      const Truth glass = is(Boundary::glass);
      for (int c = 0; c < color_channels; ++c)
        w[c] = select(glass, fresnel_dielectric(cosine, select(hits.outside, eta[c], F(1) / eta[c])), w[c]);
    }
    return w;
  }
  F ior_of(const Hits& hits) const {
    return hits.painted ? hits.painted->ior
                        : of_materials(hits, [](const MaterialRecord& m) { return m.ior; });
  }

  /// A number of the hits' materials.
  template <class Number> F of_materials(const Hits& hits, const Number& number) const {
    if (hits.one_material) return F(number(frame.materials[hits.material[0]]));
    return gather<F>([&](int k) { return number(frame.materials[hits.material[k]]); });
  }
  template <class Colors> C colors_of_materials(const Hits& hits, const Colors& colors) const {
    C result;
    for (int c = 0; c < color_channels; ++c)
      result[c] = of_materials(hits, [&](const MaterialRecord& m) { return colors(m)[c]; });
    return result;
  }

  /// The way of a shadow ray, which must be clear as far as `length`.
  struct ShadowWay {
    Vec3<F> d;
    F length;
  };
  /// From `start`, off the surface, to the end of the way that must be clear, P + clear L. Rays start beside
  /// P: along L one that is lifted would go that much too far, into a light with extent.
  static ShadowWay shadow_way(const Vec3<F>& start, const Vec3<F>& P, const Vec3<F>& L, const F& clear) {
    const Truth finite = clear < F(__builtin_inf());
    const Vec3<F> way = P + select(finite, clear, F(0)) * L - start;
    const F r = length(way);
    return {select(both(finite, r > F(0)), (F(1) / r) * way, L), select(finite, r, clear)};
  }
  static QueryRay<Query> query_rays(const Vec3<F>& start, const Vec3<F>& d) {
    return {number_cast<float>(start), number_cast<float>(d)};
  }

  bool all_opaque() const {
    return !frame.any_transmits || (!frame.whitted.colored_shadows && !frame.any_masks);
  }

  void tell(const QueryRay<Query>& rays, std::uint32_t asked, const Query& t_far) const {
    for (; asked; asked &= asked - 1) {
      const int k = __builtin_ctz(asked);
      const QueryRay<float> ray = lane(rays, k);
      frame.listener->asked(frame.listener->self, {ray.o.x, ray.o.y, ray.o.z, ray.d.x, ray.d.y, ray.d.z,
                                                   lane(t_far, k), RayKind::shadow});
    }
  }

  /// What surfaces leave of light along a ray: the product of share(ids, material, surface point, direction),
  /// straight on, in the order in which the ray meets them.
  template <class Share> Rgb what_passes(QueryRay<float> ray, float t_far, const Share& share) const {
    const Vec3<double> d = normalize(cast<double>(ray.d));
    double left = t_far;
    Rgb result = grey(1.0);
    for (;;) {
      Closest<float> hit{float(left)};
      find_closest(frame.world, ray, true, hit);
      if (hit.ids.geometry < 0) return result;
      const SurfacePoint<double> s = surface_at(frame.world, hit.ids, cast<double>(ray.o), d, hit.t);
      result = result * share(hit.ids,
                              material_of(frame.world, hit.ids.instance, hit.ids.geometry, hit.ids.primitive),
                              s, d);
      if (is_black(result)) return result;
      const double side = dot(s.Ng, d) >= 0 ? 1.0 : -1.0;
      left = left - max(s.t, 0.0);
      if (!(left > 0)) return result;
      ray.o = cast<float>(s.P + side * s.offset * s.Ng);
    }
  }

  /// Adds the colours of a packet's rays to their samples.
  void add(const Lanes& at, const C& color) {
    add(at, color, [&](int c) { return scratch.samples.color[c].data; });
  }
  template <class Columns> void add(const Lanes& at, const C& color, const Columns& columns) {
    const RayQueue& rays = scratch.rays;
    const std::uint32_t* sample = &rays.sample[at.ray[0]];
    bool samples_adjacent = at.adjacent;
    if (at.adjacent)
      for (int k = 1; k < lanes; ++k) samples_adjacent &= sample[k] == sample[0] + std::uint32_t(k);
    for (int c = 0; c < color_channels; ++c) {
      double* const to = columns(c);
      const F weighted = at.load(rays.weight[c]) * color[c];
      if (samples_adjacent) {
        (F::load(&to[sample[0]]) + weighted).store(&to[sample[0]]);
      } else {
        double values[lanes];
        weighted.store(values);
        for (int k = 0; k < at.count; ++k) to[rays.sample[at.ray[k]]] += values[k];
      }
    }
  }

  /// How wide ray i of the queue is that leaves hit k: a mirror that is curved spreads it, and so does a
  /// rough one. What goes through goes on as it was.
  void widen(RayQueue& rays, std::uint32_t i, std::uint32_t parent, const Hits& hits, int k,
             bool mirrored) const {
    const RayQueue& before = scratch.rays;
    const double width = before.width[parent] + before.spread[parent] * lane(hits.t, k);
    rays.width[i] = width;
    rays.spread[i] = before.spread[parent];
    if (!mirrored) return;
    const auto curvature_there = [&] {
      return coordinates_at(frame.world,
                            {before.instance[parent], before.geometry[parent], before.primitive[parent]},
                            lane(hits.P, k))
          .curvature;
    };
    const double curvature = hits.painted ? hits.painted->curvature[k] : curvature_there();
    rays.spread[i] += 2 * curvature * width +
                      (hits.painted ? hits.painted->lobe[k] : frame.materials[hits.material[k]].lobe);
  }

  /// Rays of a packet that leave their hits, laid out to be taken one by one.
  struct Leaving {
    double o[3][lanes], d[3][lanes], weight[color_channels][lanes];
    float q[3][lanes];
    Leaving(const Vec3<F>& origin, const Vec3<F>& start, const Vec3<F>& direction, const C& of_color) {
      origin.x.store(o[0]), origin.y.store(o[1]), origin.z.store(o[2]);
      direction.x.store(d[0]), direction.y.store(d[1]), direction.z.store(d[2]);
      const Vec3<Query> query = number_cast<float>(start);
      query.x.store(q[0]), query.y.store(q[1]), query.z.store(q[2]);
      for (int c = 0; c < color_channels; ++c) of_color[c].store(weight[c]);
    }
  };

  struct Refraction {
    Vec3<F> d;
    Truth passes;  ///< False where the light is reflected totally.
  };

  /// Snell: sin(theta') = eta sin(theta), eta the index on V's side over that beyond. About the shading
  /// normal, or about the geometric one where the shading normal would bend the ray back out.
  static Refraction refract(const Hits& hits, const F& eta) {
    const auto about = [&](const Vec3<F>& n, Truth& possible) {
      const F cosine = dot(n, hits.V), k = F(1) - eta * eta * (F(1) - cosine * cosine);
      possible = k >= F(0);
      return (eta * cosine - sqrt(max(k, F(0)))) * n - eta * hits.V;
    };
    Truth by_N, by_G;
    const Vec3<F> d = about(hits.N, by_N), d_G = about(hits.G, by_G);
    const Truth through_N = both(by_N, dot(d, hits.G) < F(0));
    const Truth through_G = both(by_N, by_G, dot(d_G, hits.G) < F(0));
    return {select(through_N, d, d_G), either(through_N, through_G)};
  }

  static Rgb lane_color(const C& color, int k) {
    Rgb result;
    for (int c = 0; c < color_channels; ++c) result[c] = lane(color[c], k);
    return result;
  }

  // ---- for those who look closer

  std::uint32_t next_number = 0;  ///< Of the rays.

  double* layer_column(int layer, int channel) const {
    return &scratch.layers[std::size_t(layer * color_channels + channel) * layer_stride];
  }
  // So that the columns do not all fall into the same lines of the cache.
  static constexpr std::size_t layer_stride = batch_size + 8 * lanes;

  void grow_layers() {
    if (!task.layer_sums) return;
    const auto columns = std::uint32_t(frame.layers.columns());
    if (scratch.layer_columns >= columns) return;
    Scratch::grow(scratch.layers, std::uint32_t(columns * layer_stride));
    scratch.layer_columns = columns;
  }
  void clear_layers(std::uint32_t count) {
    if (task.first_hits && (!frame.pass || frame.pass->first == 0))
      for (std::uint32_t i = 0; i < count; ++i) task.first_hits[first_of_batch + i] = {};
    if (!task.layer_sums) return;
    for (int layer = 0; layer < frame.layers.count(); ++layer)
      for (int c = 0; c < color_channels; ++c) {
        double* column = layer_column(layer, c);
        for (std::uint32_t i = 0; i < count; ++i) column[i] = 0;
      }
  }

  void add_to_layer(std::uint32_t ray, int layer, const Rgb& color) {
    const std::uint32_t sample = scratch.rays.sample[ray];
    for (int c = 0; c < color_channels; ++c)
      layer_column(layer, c)[sample] += scratch.rays.weight[c][ray] * color[c];
  }

  void note_first_hits(const Lanes& at, const Hits& hits) const {
    const RayQueue& rays = scratch.rays;
    // Laid out once, to be taken one by one.
    double P[3][lanes], N[3][lanes], albedo[color_channels][lanes], R[lanes];
    hits.P.x.store(P[0]), hits.P.y.store(P[1]), hits.P.z.store(P[2]);
    hits.N.x.store(N[0]), hits.N.y.store(N[1]), hits.N.z.store(N[2]);
    hits.R.store(R);
    const C diffuse = diffuse_of(hits);
    for (int c = 0; c < color_channels; ++c) diffuse[c].store(albedo[c]);
    for (int k = 0; k < at.count; ++k) {
      const std::uint32_t ray = at.ray[k];
      FirstHit& first = task.first_hits[first_of_batch + rays.sample[ray]];
      first.object =
          std::int32_t(object_of(frame.world, rays.instance[ray], rays.geometry[ray], rays.primitive[ray]));
      first.material = std::int32_t(hits.material[k]);
      first.primitive = rays.primitive[ray];
      first.R = float(R[k]);
      const Geometry& geometry = frame.world.geometries[rays.geometry[ray]];
      Vec2<double> uv{};
      if (geometry.uvs)
        uv = coordinates_at(frame.world, {rays.instance[ray], rays.geometry[ray], rays.primitive[ray]},
                            {P[0][k], P[1][k], P[2][k]})
                 .uv[0];
      for (int a = 0; a < 3; ++a) first.P[a] = float(P[a][k]), first.N[a] = float(N[a][k]);
      first.uv[0] = float(uv.x), first.uv[1] = float(uv.y);
      Rgb kd{albedo[0][k], albedo[1][k], albedo[2][k]};
      if (frame.pass) kd = from_pass(*frame.pass, kd);
      for (int c = 0; c < color_channels; ++c)  // passes add up
        first.albedo[c] = float(frame.pass ? first.albedo[c] + kd[c] : kd[c]);
    }
  }

  // ---- the film

  void add_to_pixels(std::uint64_t first, std::uint32_t count) {
    if (task.layer_sums) add_layers_to_pixels(first, count);
    auto pixel = std::uint32_t(first / samples_per_pixel());
    if (samples_per_pixel() == 1 && !task.squares && !task.least_and_greatest) {
      double* sums = &task.sums[std::size_t(pixel) * color_channels];
      for (std::uint32_t i = 0; i < count; ++i)
        for (int c = 0; c < color_channels; ++c) sums[i * color_channels + c] += scratch.samples.color[c][i];
      return;
    }
    int left = samples_per_pixel() - int(first % samples_per_pixel());
    for (std::uint32_t i = 0; i < count; ++pixel, left = samples_per_pixel()) {
      const std::uint32_t end = min(i + std::uint32_t(left), count);
      double* sums = &task.sums[std::size_t(pixel) * color_channels];
      double sum[color_channels];
      for (int c = 0; c < color_channels; ++c) sum[c] = sums[c];
      for (std::uint32_t k = i; k < end; ++k)  // one channel need not wait for another
        for (int c = 0; c < color_channels; ++c) sum[c] += scratch.samples.color[c][k];
      for (int c = 0; c < color_channels; ++c) sums[c] = sum[c];
      if (task.squares) add_squares(pixel, i, end);
      if (task.least_and_greatest) widen_range(pixel, i, end);
      i = end;
    }
  }
  void add_layers_to_pixels(std::uint64_t first, std::uint32_t count) const {
    for (int c = 0; c < frame.layers.columns(); ++c) {
      const double* from = &scratch.layers[std::size_t(c) * layer_stride];
      double* sum = task.layer_sums + std::size_t(c) * task.layer_sums_stride + first / samples_per_pixel();
      if (samples_per_pixel() == 1) {
        for (std::uint32_t i = 0; i < count; ++i) sum[i] += from[i];
        continue;
      }
      int left = samples_per_pixel() - int(first % samples_per_pixel());
      for (std::uint32_t i = 0; i < count; ++i, --left) {
        if (left == 0) ++sum, left = samples_per_pixel();
        *sum += from[i];
      }
    }
  }
  void add_squares(std::uint32_t pixel, std::uint32_t first, std::uint32_t end) const {
    const auto& color = scratch.samples.color;
    for (std::uint32_t i = first; i < end; ++i) {
      const double luminance = luminance_of(Rgb{color[0][i], color[1][i], color[2][i]});
      task.squares[pixel] += luminance * luminance;
    }
  }
  void widen_range(std::uint32_t pixel, std::uint32_t first, std::uint32_t end) const {
    float* least = task.least_and_greatest + std::size_t(pixel) * 2 * color_channels;
    float* greatest = least + color_channels;
    for (std::uint32_t i = first; i < end; ++i)
      for (int c = 0; c < color_channels; ++c) {
        const auto value = float(scratch.samples.color[c][i]);
        least[c] = min(least[c], value), greatest[c] = max(greatest[c], value);
      }
  }
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
