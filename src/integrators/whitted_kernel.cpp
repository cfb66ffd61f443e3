// The Whitted integrator (Whitted, An improved illumination model for shaded display, CACM 23(6), 1980):
//
//   colour of a ray = emission + I + reflect * (colour along the mirror ray) + transmit * (colour along the
//   refracted ray)
//
// with I the equation of equation.h. Rays are followed level by level: all eye rays of a batch of samples,
// then all that these threw, and so on; a ray's colour is added to its sample with the product of the factors
// on its way. On each level the rays that hit something are sorted into groups, one for each kind of
// primitive and illumination model, and what happens at a hit happens to a packet of hits of one group, from
// the surface point to the rays that leave it.
//
// Per sample the order of the sum is fixed: level by level; rays that hit nothing first, then group by group;
// within a group in the order in which the rays were thrown, the mirror ray before the refracted one.
//
// This file is compiled once for each instruction set.

#include "accel/coordinates.h"
#include "accel/surface.h"
#include "illumination/equation.h"
#include "integrators/frame.h"
#include "integrators/paint.h"

namespace lambent {
inline namespace LAMBENT_ISA {
namespace {

// Queries run in float, shading in double: an error of R.V counts n times in (R.V)^n, so float could not keep
// 1e-6 where n >= 32.
constexpr int lanes = native_float_lanes;
using Query = Pack<float, lanes>;
using F = Pack<double, lanes>;
using C = Color<F>;
using Truth = MaskOf<F>;

// All that is done to a packet of hits in one piece of code, so that it stays in registers.
#define LAMBENT_FLATTEN __attribute__((flatten))

constexpr std::uint32_t batch_size =
    1024;  // samples that are followed together: what they need fits the cache

constexpr int kinds = int(PrimitiveKind::instance);
constexpr int group_count = kinds * 2 * 2 * model_count;
constexpr std::uint8_t no_group = 255;
static_assert(group_count < no_group);

/// A task on its way through the stages. `Seen`: somebody wants to know more than the colours: layers, what
/// eye rays met, or every number (frame.h, Witness). All that is seen is made of the very numbers that the
/// picture is made of.
template <bool Seen> struct Work {
  const Frame& frame;
  const PixelTask& task;
  Scratch& scratch;
  RayCounts& counts;

  void run() {
    if (scratch.samples.capacity == 0) {
      Scratch::grow(scratch.samples, batch_size);
      Scratch::grow(scratch.rays, batch_size);
      Scratch::grow(scratch.next_rays, batch_size);
      Scratch::grow(scratch.open, std::uint32_t(frame.light_count) * beam);
      Scratch::grow(scratch.reaching, std::uint32_t(frame.light_count));
    }
    if constexpr (Seen) grow_layers();
    light_count = frame.light_count;
    for (int l = 0; l < light_count; ++l) scratch.reaching[l] = std::uint32_t(l);
    const std::uint64_t samples = std::uint64_t(task.count) * samples_per_pixel();
    for (std::uint64_t first = 0; first < samples; first += batch_size) {
      const auto count = std::uint32_t(min<std::uint64_t>(batch_size, samples - first));
      first_of_batch = first;
      throw_eye_rays(first, count);
      for (depth = 1; scratch.rays.count > 0; ++depth) {
        trace(depth == 1);
        sort_into_groups();
        if (frame.lights_have_limits && hit_count() > 0) choose_lights();
        if (depth == 1) counts.eye_hits += hit_count();
        scratch.next_rays.count = 0;
        for (int group = 0; group < group_count; ++group)
          if (group_first[group] < group_first[group + 1])
            shade_group(group, depth < frame.whitted.max_depth);
        RayQueue rays = scratch.rays;
        scratch.rays = scratch.next_rays;
        scratch.next_rays = rays;
      }
      add_to_pixels(first, count);
    }
  }

  int depth = 1;  ///< Of the rays at hand; the ray from the eye is 1.
  std::uint64_t first_of_batch = 0;

  int samples_per_pixel() const { return task.end_sample - task.first_sample; }

  // ---- eye rays

  LAMBENT_FLATTEN void throw_eye_rays(std::uint64_t first, std::uint32_t count) {
    RayQueue& rays = scratch.rays;
    rays.count = count;
    auto pixel = std::uint32_t(first / samples_per_pixel());
    int sample = task.first_sample + int(first % samples_per_pixel());
    for (std::uint32_t i = 0; i < count; ++i) {  // where they go through the picture; made rays of below
      rays.ox[i] = task.pixels[pixel].x + frame.pattern[sample].x;
      rays.oy[i] = task.pixels[pixel].y + frame.pattern[sample].y;
      rays.sample[i] = i;
      if (++sample == task.end_sample) sample = task.first_sample, ++pixel;
    }
    const CameraRecord& camera = frame.camera;
    const F half_width(0.5 * frame.width), half_height(0.5 * frame.height), per_unit(2.0 / frame.height);
    const Vec3<F> right = broadcast<F>(camera.right), up = broadcast<F>(camera.up),
                  forward = broadcast<F>(camera.forward), eye = broadcast<F>(camera.eye);
    for (std::uint32_t i = 0; i < count; i += lanes) {
      const F x = (F::load(&rays.ox[i]) - half_width) * per_unit,
              y = (half_height - F::load(&rays.oy[i])) * per_unit;
      const Vec3<F> aside = x * right + y * up;
      const Vec3<F> o = eye + F(camera.spread_of_origins) * aside,
                    d = normalize(forward + F(camera.spread_of_directions) * aside);
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
    if constexpr (Seen) {
      clear_layers(count);
      for (std::uint32_t i = 0; i < count; ++i) {
        rays.way[i] = Way::direct;
        if (!frame.witness) continue;
        tell_ray(rays, i, no_ray, Way::direct, false, grey(1.0));
      }
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

  /// Eye rays lie close together and go through the tree in packets; scattered ones do not, and go one by
  /// one.
  void trace(bool coherent) {
    RayQueue& rays = scratch.rays;
    if (frame.listener) tell(rays, coherent ? RayKind::eye : RayKind::scattered);
    if (coherent)
      for (std::uint32_t i = 0; i < rays.count; i += beam * lanes) trace_packets(rays, i);
    else
      for (std::uint32_t i = 0; i < rays.count; ++i) trace_one(rays, i);
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

  /// `beam` packets from ray `first` on, together.
  void trace_packets(RayQueue& rays, std::uint32_t first) const {
    QueryRay<Query> ray[beam];
    MaskOf<Query> active[beam];
    Closest<Query> hit[beam];
    int count = 0;
    for (std::uint32_t i = first; i < rays.count && count < beam; i += lanes, ++count) {
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

  void trace_one(RayQueue& rays, std::uint32_t i) const {
    const QueryRay<float> ray({rays.qx[i], rays.qy[i], rays.qz[i]},
                              {float(rays.dx[i]), float(rays.dy[i]), float(rays.dz[i])});
    Closest<float> hit{__builtin_inff()};
    find_closest(frame.world, ray, true, hit);
    rays.t[i] = hit.t;
    rays.instance[i] = hit.ids.instance;
    rays.geometry[i] = hit.ids.geometry;
    rays.primitive[i] = hit.ids.primitive;
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

  void sort_into_groups() {
    RayQueue& rays = scratch.rays;
    std::uint32_t size[group_count] = {};
    for (std::uint32_t i = 0; i < rays.count; ++i) {
      if (rays.geometry[i] < 0) {
        rays.group[i] = no_group;
        const Rgb background = background_of(i);
        add(i, background);
        if constexpr (Seen) add_background(i, background);
        continue;
      }
      rays.material[i] = material_of(frame.world, rays.instance[i], rays.geometry[i], rays.primitive[i]);
      const Geometry& geometry = frame.world.geometries[rays.geometry[i]];
      const MaterialRecord& material = frame.materials[rays.material[i]];
      const bool painted = material.painted || geometry.colors;
      const int group =
          ((int(geometry.kind) * 2 + (rays.instance[i] >= 0)) * 2 + painted) * model_count + material.model;
      rays.group[i] = std::uint8_t(group);
      ++size[group];
    }
    group_first[0] = 0;
    for (int g = 0; g < group_count; ++g) group_first[g + 1] = group_first[g] + size[g];
    std::uint32_t next[group_count];
    for (int g = 0; g < group_count; ++g) next[g] = group_first[g];
    for (std::uint32_t i = 0; i < rays.count; ++i)
      if (rays.group[i] != no_group) rays.order[next[rays.group[i]]++] = i;
  }

  Rgb background_of(std::uint32_t i) const {
    const RayQueue& rays = scratch.rays;
    if (!frame.environment.texture.levels) return frame.background;
    return background_along(frame, {rays.dx[i], rays.dy[i], rays.dz[i]}, rays.spread[i]);
  }

  /// Adds a ray's colour to its sample.
  void add(std::uint32_t ray, const Rgb& color) {
    const std::uint32_t sample = scratch.rays.sample[ray];
    for (int c = 0; c < color_channels; ++c)
      scratch.samples.color[c][sample] += scratch.rays.weight[c][ray] * color[c];
  }

  int light_count = 0;  ///< How many of scratch.reaching.

  /// Lights that cannot reach any of the hits at hand (spots that shine elsewhere, lights too far away) are
  /// left out for all of them at once: nothing would arrive of them.
  void choose_lights() {
    const RayQueue& rays = scratch.rays;
    float lower[3], upper[3];
    const float infinity = __builtin_inff();
    for (int a = 0; a < 3; ++a) lower[a] = infinity, upper[a] = -infinity;
    for (std::uint32_t i = 0; i < hit_count(); ++i) {
      const std::uint32_t ray = rays.order[i];
      const float t = rays.t[ray],
                  at[3] = {float(rays.ox[ray] + t * rays.dx[ray]), float(rays.oy[ray] + t * rays.dy[ray]),
                           float(rays.oz[ray] + t * rays.dz[ray])};
      for (int a = 0; a < 3; ++a) lower[a] = min(lower[a], at[a]), upper[a] = max(upper[a], at[a]);
    }
    // Some more than the queries' rounding: the surface points are found anew in double.
    float size = 0;
    for (int a = 0; a < 3; ++a) size = max(size, max(abs(lower[a]), abs(upper[a])));
    const double margin = 1e-4 * size;
    const Reach box{{lower[0] - margin, lower[1] - margin, lower[2] - margin},
                    {upper[0] + margin, upper[1] + margin, upper[2] + margin}};
    light_count = 0;
    for (int l = 0; l < frame.light_count; ++l)
      if (with_light(frame.lights[l], [&](const auto& light) { return reaches(light, box); }))
        scratch.reaching[light_count++] = std::uint32_t(l);
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
    const Painted* painted = nullptr;  ///< Of hits on painted surfaces.
  };

  /// Packets of hits whose shadow rays go through the tree together.
  struct Block {
    int count = 0;
    Lanes at[beam];
    Hits hits[beam];
    Painted painted[beam];
  };

  void shade_group(int group, bool follow_on) {
    const std::uint32_t last = group_first[group + 1];
    for (std::uint32_t first = group_first[group]; first < last;) {
      Block block;
      for (; first < last && block.count < beam; first += lanes, ++block.count) {
        block.at[block.count] = lanes_from(first, last);
        block.hits[block.count] = look(block.at[block.count]);
        if (group / model_count % 2) paint_hits(block, block.count);
        if constexpr (Seen) {
          if (depth == 1 && task.first_hits) note_first_hits(block.at[block.count], block.hits[block.count]);
        }
      }
      for (int i = 0; i < light_count; ++i) look_at_light(i, block);
      for (int i = 0; i < block.count; ++i) {
        with_model(ModelId(group % model_count), [&]<class Model>() { shade<Model>(block, i); });
        if (follow_on) follow(block.at[i], block.hits[i]);
      }
    }
  }

  Lanes lanes_from(std::uint32_t first, std::uint32_t last) const {
    const std::uint32_t* order = &scratch.rays.order[first];
    Lanes at;
    at.count = int(min(last - first, std::uint32_t(lanes)));
    for (int k = 0; k < lanes; ++k) at.ray[k] = order[min(k, at.count - 1)];
    at.adjacent = at.count == lanes && at.ray[lanes - 1] - at.ray[0] == lanes - 1;
    at.active = first_lanes<double>(std::uint32_t(at.count));
    return at;
  }

  LAMBENT_FLATTEN Hits look(const Lanes& at) const {
    const RayQueue& rays = scratch.rays;
    const Vec3<F> o = at.load(rays.ox, rays.oy, rays.oz), d = at.load(rays.dx, rays.dy, rays.dz);
    std::int32_t instance[lanes], geometry[lanes], primitive[lanes];
    Hits hits;
    hits.one_material = true;
    for (int k = 0; k < lanes; ++k) {
      instance[k] = rays.instance[at.ray[k]], geometry[k] = rays.geometry[at.ray[k]],
      primitive[k] = rays.primitive[at.ray[k]];
      hits.material[k] = rays.material[at.ray[k]];
      hits.one_material &= hits.material[k] == hits.material[0];
    }
    const F t_found = gather<F>([&](int k) { return double(rays.t[at.ray[k]]); });
    const SurfacePoint<F> s = surface_at<F>(frame.world, {instance, geometry, primitive}, o, d, t_found);
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
    return hits;
  }

  /// Looks the materials of painted surfaces up, lane by lane, and tilts N.
  [[gnu::noinline]] void paint_hits(Block& block, int packet) const {
    const RayQueue& rays = scratch.rays;
    const Lanes& at = block.at[packet];
    Hits& hits = block.hits[packet];
    Paint paints[lanes];
    for (int k = 0; k < lanes; ++k) {
      if (k >= at.count) {
        paints[k] = paints[at.count - 1];
        continue;
      }
      const std::uint32_t ray = at.ray[k];
      const double side = lane_bits(hits.outside) >> k & 1 ? 1.0 : -1.0;
      const Vec3<double> d = -lane_vector(hits.V, k);
      const double width = frame.cones ? rays.width[ray] + rays.spread[ray] * lane(hits.t, k) : 0;
      paints[k] = paint(frame, {rays.instance[ray], rays.geometry[ray], rays.primitive[ray]},
                        hits.material[k], lane_vector(hits.P, k), side * lane_vector(hits.N, k),
                        side * lane_vector(hits.G, k), d, width);
      paints[k].N = side * paints[k].N;
    }
    const auto color = [&](Rgb Paint::*member) {
      C result;
      for (int c = 0; c < color_channels; ++c)
        result[c] = gather<F>([&](int k) { return (paints[k].*member)[c]; });
      return result;
    };
    Painted& painted = block.painted[packet];
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
    return hits.painted ? hits.painted->emission
                        : colors_of_materials(hits, [](const MaterialRecord& m) { return m.emission; });
  }
  C reflect_of(const Hits& hits) const {
    return hits.painted ? hits.painted->reflect
                        : colors_of_materials(hits, [](const MaterialRecord& m) { return m.reflect; });
  }
  C transmit_of(const Hits& hits) const {
    return hits.painted ? hits.painted->transmit
                        : colors_of_materials(hits, [](const MaterialRecord& m) { return m.transmit; });
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

  // ---- the equation

  template <class Model> LAMBENT_FLATTEN void shade(const Block& block, int packet) {
    const Lanes& at = block.at[packet];
    const Hits& hits = block.hits[packet];
    Surface<F, C> s;
    s.N = hits.N;
    s.V = hits.V;
    s.ka = ambient_of(hits);
    s.kd = diffuse_of(hits);
    s.ks = specular_of(hits);
    s.n = shininess_of(hits);
    for (int i = 0; i < max_model_parameters; ++i)
      if (Model::info.parameters[i].name)
        s.own[i] = of_materials(hits, [&](const MaterialRecord& m) { return m.own[i]; });
    s.outside = select(hits.outside, F(1), F(-1));
    s.to_camera = -broadcast<F>(frame.camera.forward);

    const FadingRecord& fading = frame.fading[int(id_of<Model>)];
    const F minimum(frame.minimum_distance);
    C Ia;
    for (int c = 0; c < color_channels; ++c)
      Ia[c] = F(frame.ambient[c]) * attenuate(fading.ambient, hits.R, minimum);
    const F open = frame.occlusion.rays > 0 ? open_share(at, hits) : F(1);
    if (frame.occlusion.rays > 0) Ia = Ia * open;

    if constexpr (Seen) {
      if (frame.witness) {
        tell_hits(at, hits, Ia, open);
        for (int number = 0; number < light_count; ++number)
          tell_light(number, packet, at, hits, fading.attenuation);
      }
    }
    const auto arriving = [&](int number) -> Arriving<F, C> {
      const auto l = int(scratch.reaching[number]);
      const std::uint32_t open = scratch.open[std::size_t(number) * beam + packet];
      if (open == 0) return {hits.N, grey(F(0))};
      const auto light = sample_light(l, hits.P);
      if constexpr (Model::info.unfaded_light) {
        const F faded = attenuate(fading.attenuation, light.r, minimum);
        const C Il = with_light(frame.lights[l], [](const auto& one) { return brightest<F>(one); });
        return {light.L, share_that_passes(open, hits, light) * (faded * light.I), Il,
                faded * share_of(light.I, Il)};
      }
      return {light.L, share_that_passes(open, hits, light) *
                           (attenuate(fading.attenuation, light.r, minimum) * light.I)};
    };
    const C emission = emission_of(hits);
    if constexpr (Seen) {
      see_term(at, LayerPlan::emission, Term::emission, -1, emission);
      const C I = illuminate<Model>(s, Ia, light_count, arriving, [&](Term term, int number, const C& color) {
        const int l = number < 0 ? -1 : int(scratch.reaching[number]);
        const int layer = term == Term::ambient   ? int(LayerPlan::ambient)
                          : term == Term::diffuse ? LayerPlan::diffuse(l)
                                                  : LayerPlan::specular(l);
        see_term(at, layer, term, l, color);
      });
      add(at, emission + I);
      if (frame.witness) tell_colors(at, emission + I);
    } else {
      add(at, emission + illuminate<Model>(s, Ia, light_count, arriving));
    }
  }

  LightSample<F, C> sample_light(int l, const Vec3<F>& P) const {
    return with_light(frame.lights[l], [&](const auto& light) { return sample(light, P, F(0.5), F(0.5)); });
  }

  /// Decides which hits of a block a light reaches. No shadow ray is thrown where the light is behind the
  /// surface (N.L <= 0) or dark in this direction.
  LAMBENT_FLATTEN void look_at_light(int number, const Block& block) {
    const auto l = int(scratch.reaching[number]);
    std::uint32_t* open_bits = &scratch.open[std::size_t(number) * beam];
    QueryRay<Query> rays[beam];
    Query t_far[beam];
    MaskOf<Query> open[beam];
    int packet[beam], asked = 0;
    for (int i = 0; i < block.count; ++i) {
      const Hits& hits = block.hits[i];
      const auto light = sample_light(l, hits.P);
      const Truth lit = both(block.at[i].active, dot(hits.N, light.L) > F(0), Truth(!is_black(light.I)));
      open_bits[i] = lane_bits(lit);
      if (open_bits[i] == 0 || !frame.whitted.shadows) continue;
      rays[asked] = shadow_ray(hits, light.L);
      t_far[asked] = number_cast<float>(light.r);
      open[asked] = mask_cast<std::int32_t>(lit);
      counts.shadow += std::uint64_t(__builtin_popcount(open_bits[i]));
      if (frame.listener) tell(rays[asked], open_bits[i], t_far[asked]);
      packet[asked++] = i;
    }
    if (asked == 0) return;
    cast_shadows(rays, t_far, asked, open);
    for (int a = 0; a < asked; ++a) open_bits[packet[a]] = lane_bits(open[a]);
  }

  static QueryRay<Query> shadow_ray(const Hits& hits, const Vec3<F>& L) {
    return {number_cast<float>(hits.front), number_cast<float>(L)};
  }

  bool all_opaque() const {
    return !frame.any_transmits || (!frame.whitted.colored_shadows && !frame.any_masks);
  }

  [[gnu::noinline]] void cast_shadows(const QueryRay<Query>* rays, const Query* t_far, int count,
                                      MaskOf<Query>* open) const {
    if (depth == 1) return find_open(frame.world, rays, t_far, count, all_opaque(), open);
    // What scattered rays have found lies anywhere: packet by packet where the shadow rays still go together,
    // and one by one where they do not.
    const float extent = frame.world.bvhs[0].extent;
    for (int i = 0; i < count; ++i) {
      if (PacketBeam::suits(rays + i, t_far + i, 1, extent)) {
        find_open(frame.world, rays + i, t_far + i, 1, all_opaque(), open + i);
        continue;
      }
      for (std::uint32_t asked = lane_bits(open[i]); asked; asked &= asked - 1) {
        const int k = __builtin_ctz(asked);
        if (find_occluded(frame.world, lane(rays[i], k), true, lane(t_far[i], k), all_opaque()))
          set_lane(open[i], k, false);
      }
    }
  }

  /// The share of the sky above the hits that nothing hides. Directions are those of Roberts' R2 sequence
  /// (2018), by Malley's method as dense as their cosine with N, turned in each pixel by a hash of its place.
  [[gnu::noinline]] F open_share(const Lanes& at, const Hits& hits) {
    const RayQueue& rays = scratch.rays;
    const AmbientOcclusion& occlusion = frame.occlusion;
    double share[lanes] = {};
    for (int k = 0; k < at.count; ++k) {
      const std::uint64_t number = first_of_batch + rays.sample[at.ray[k]];
      const Pixel& pixel = task.pixels[number / std::uint64_t(samples_per_pixel())];
      const std::uint64_t sample =
          std::uint64_t(task.first_sample) + number % std::uint64_t(samples_per_pixel());
      const std::uint64_t hash = hashed(std::uint64_t(std::uint32_t(pixel.x)) << 32 | std::uint32_t(pixel.y));
      const double turn_u = double(hash >> 32) * 0x1p-32, turn_v = double(hash & 0xffffffff) * 0x1p-32;
      const Vec3<double> N = lane_vector(hits.N, k), G = lane_vector(hits.G, k);
      Vec3<double> a, b;
      axes_across(N, a, b);
      // From the surface itself, not from the smooth one that it stands for: lifted, a point near the floor
      // may lie below it.
      const Vec3<double> P = lane_vector(hits.P, k), off = P - lane_vector(hits.back, k);
      const Vec3<float> start = cast<float>(P + off);
      int open = 0;
      for (int j = 0; j < occlusion.rays; ++j) {
        const double i = double(sample) * occlusion.rays + j;
        double u = turn_u + i * 0.7548776662466927, v = turn_v + i * 0.5698402909980532;
        u -= __builtin_floor(u), v -= __builtin_floor(v);
        const auto [sine, cosine] = sincos_degrees(360 * v);
        const double radius = sqrt(u);
        Vec3<double> d = (radius * cosine) * a + (radius * sine) * b + sqrt(1 - u) * N;
        // A smooth normal may lean so far that some directions lie below the surface itself.
        if (const double below = dot(d, G); below < 0) d = d - 2 * below * G;
        const QueryRay<float> ray(start, cast<float>(d));
        const auto t_far = float(occlusion.distance);
        if (frame.listener)
          frame.listener->asked(frame.listener->self, {ray.o.x, ray.o.y, ray.o.z, ray.d.x, ray.d.y, ray.d.z,
                                                       t_far, RayKind::shadow});
        open += !find_occluded(frame.world, ray, true, t_far, !frame.any_transmits);
      }
      counts.ambient += std::uint64_t(occlusion.rays);
      share[k] = double(open) / occlusion.rays;
    }
    return F::load(share);
  }

  /// How much of a light arrives at the lanes that it reaches: all, or what transmitting surfaces leave of
  /// it.
  C share_that_passes(std::uint32_t open, const Hits& hits, const LightSample<F, C>& light) const {
    const C passes = grey(gather<F>([&](int k) { return open >> k & 1 ? 1.0 : 0.0; }));
    if (all_opaque() || !frame.whitted.shadows) return passes;
    return passes * transmittance(open, hits, light);
  }

  void tell(const QueryRay<Query>& rays, std::uint32_t asked, const Query& t_far) const {
    for (; asked; asked &= asked - 1) {
      const int k = __builtin_ctz(asked);
      const QueryRay<float> ray = lane(rays, k);
      frame.listener->asked(frame.listener->self, {ray.o.x, ray.o.y, ray.o.z, ray.d.x, ray.d.y, ray.d.z,
                                                   lane(t_far, k), RayKind::shadow});
    }
  }

  /// What transmitting surfaces leave of the light: the product of their `transmit`, straight on, in the
  /// order in which the ray meets them.
  [[gnu::noinline]] C transmittance(std::uint32_t open, const Hits& hits,
                                    const LightSample<F, C>& light) const {
    const QueryRay<Query> rays = shadow_ray(hits, light.L);
    double left[color_channels][lanes] = {};
    for (; open; open &= open - 1) {
      const int k = __builtin_ctz(open);
      const Rgb one = transmittance(lane(rays, k), float(lane(light.r, k)));
      for (int c = 0; c < color_channels; ++c) left[c][k] = one[c];
    }
    C result;
    for (int c = 0; c < color_channels; ++c) result[c] = F::load(left[c]);
    return result;
  }
  Rgb transmittance(QueryRay<float> ray, float t_far) const {
    const Vec3<double> d = normalize(cast<double>(ray.d));
    double left = t_far;
    Rgb result = grey(1.0);
    for (;;) {
      Closest<float> hit{float(left)};
      find_closest(frame.world, ray, true, hit);
      if (hit.ids.geometry < 0) return result;
      const SurfacePoint<double> s = surface_at(frame.world, hit.ids, cast<double>(ray.o), d, hit.t);
      result = result *
               share_through(frame, hit.ids,
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

  // ---- mirror rays and refracted rays

  LAMBENT_FLATTEN void follow(const Lanes& at, const Hits& hits) {
    bool reflects = false, transmits = false;
    for (int k = 0; k < at.count; ++k) {
      const MaterialRecord& m = frame.materials[hits.material[k]];
      reflects |= m.reflects, transmits |= m.transmits;
    }
    if (!reflects && !transmits) return;

    C weight;
    for (int c = 0; c < color_channels; ++c) weight[c] = at.load(scratch.rays.weight[c]);
    C mirrored = reflect_of(hits);
    const C through = transmit_of(hits);
    // Rays are asked for where the material does either.
    const Truth concerned = both(at.active, Truth(of_materials(hits, [](const MaterialRecord& m) {
                                                    return m.reflects || m.transmits ? 1.0 : 0.0;
                                                  }) > F(0)));
    Refraction bent{};
    Truth refracted(false), total(false);
    if (transmits) {
      const F ior = ior_of(hits);
      bent = refract(hits, select(hits.outside, F(1) / ior, ior));
      const Truth asked = both(concerned, Truth(!is_black(through)));
      refracted = both(asked, bent.passes);
      // Total internal reflection: what cannot leave stays, and goes with the mirror ray. It counts as asked
      // for, though there is no ray: so does Haines count in the SPD's tables.
      total = both(asked, Truth(!bent.passes));
      mirrored = select(total, mirrored + through, mirrored);
      counts.refraction += std::uint64_t(__builtin_popcount(lane_bits(total)));
    }

    Vec3<F> mirror = reflect(hits.V, hits.N);
    // Where the shading normal leans too far: do not look into the surface.
    mirror = select(dot(mirror, hits.G) > F(0), mirror, reflect(hits.V, hits.G));
    const bool black_too = frame.whitted.trace_black_rays;
    const C mirror_weight = weight * mirrored, through_weight = weight * through;
    const Truth mirrors = black_too ? concerned : both(concerned, Truth(!is_black(mirror_weight)));
    const Truth passes = black_too ? refracted : both(refracted, Truth(!is_black(through_weight)));
    // From the lifted point in double too: the surface that the query finds from there may lie beside the one
    // that the ray would meet from P.
    const Leaving mirror_rays(hits.lifted, hits.front, normalize(mirror), mirror_weight),
        through_rays(hits.P, hits.back, select(passes, normalize(bent.d), mirror), through_weight);
    const std::uint32_t mirror_bits = lane_bits(mirrors), through_bits = lane_bits(passes);
    counts.reflection += std::uint64_t(__builtin_popcount(mirror_bits));
    counts.refraction += std::uint64_t(__builtin_popcount(through_bits));

    double R[lanes];
    hits.R.store(R);
    const auto push = [&](const Leaving& leaving, int k) {
      RayQueue& rays = scratch.next_rays;
      if (rays.count == rays.capacity) Scratch::grow(rays, rays.capacity * 2 + batch_size);
      const std::uint32_t i = rays.count++;
      rays.ox[i] = leaving.o[0][k], rays.oy[i] = leaving.o[1][k], rays.oz[i] = leaving.o[2][k];
      rays.dx[i] = leaving.d[0][k], rays.dy[i] = leaving.d[1][k], rays.dz[i] = leaving.d[2][k];
      rays.qx[i] = leaving.q[0][k], rays.qy[i] = leaving.q[1][k], rays.qz[i] = leaving.q[2][k];
      rays.R[i] = R[k];
      for (int c = 0; c < color_channels; ++c) rays.weight[c][i] = leaving.weight[c][k];
      rays.sample[i] = scratch.rays.sample[at.ray[k]];
      if (frame.cones) widen(rays, i, at.ray[k], hits, k, &leaving == &mirror_rays);
      if constexpr (Seen) {
        const Way way = &leaving == &mirror_rays ? Way::reflection : Way::refraction;
        const Way so_far = scratch.rays.way[at.ray[k]];
        rays.way[i] = so_far == Way::direct ? way : so_far;
        if (frame.witness) {
          const C& factor = way == Way::reflection ? mirrored : through;
          tell_ray(rays, i, scratch.rays.number[at.ray[k]], way,
                   way == Way::reflection && (lane_bits(total) >> k & 1), lane_color(factor, k));
        }
      }
    };
    for (int k = 0; k < at.count; ++k) {
      if (mirror_bits >> k & 1) push(mirror_rays, k);
      if (through_bits >> k & 1) push(through_rays, k);
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
                            lane_vector(hits.P, k))
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

  // ---- for those who look closer

  std::uint32_t next_number = 0;  ///< Of the rays.

  double* layer_column(int layer, int channel) const {
    return &scratch.layers[std::size_t(layer * color_channels + channel) * layer_stride];
  }
  // So that the columns do not all fall into the same lines of the cache.
  static constexpr std::size_t layer_stride = batch_size + 8 * lanes;

  void grow_layers() {
    if (!task.layer_sums) return;
    const auto columns = std::uint32_t(frame.layers.count() * color_channels);
    if (scratch.layer_columns >= columns) return;
    Scratch::grow(scratch.layers, std::uint32_t(columns * layer_stride));
    scratch.layer_columns = columns;
  }
  void clear_layers(std::uint32_t count) {
    if (task.first_hits)
      for (std::uint32_t i = 0; i < count; ++i) task.first_hits[first_of_batch + i] = {};
    if (!task.layer_sums) return;
    for (int layer = 0; layer < frame.layers.count(); ++layer)
      for (int c = 0; c < color_channels; ++c) {
        double* column = layer_column(layer, c);
        for (std::uint32_t i = 0; i < count; ++i) column[i] = 0;
      }
  }

  /// Tells of a summand, and adds it to its layer: `layer` counts from the first of the ray's way.
  void see_term(const Lanes& at, int layer, Term term, int light, const C& color) {
    if (frame.witness)
      for (int k = 0; k < at.count; ++k)
        frame.witness->term(frame.witness->self,
                            {scratch.rays.number[at.ray[k]], term, light, lane_color(color, k)});
    if (!task.layer_sums || all(is_black(color))) return;
    const RayQueue& rays = scratch.rays;
    if (depth == 1) return add(at, color, [&](int c) { return layer_column(layer, c); });
    for (int k = 0; k < at.count; ++k)
      add_to_layer(at.ray[k], frame.layers.first_of(rays.way[at.ray[k]]) + layer, lane_color(color, k));
  }
  void add_to_layer(std::uint32_t ray, int layer, const Rgb& color) {
    const std::uint32_t sample = scratch.rays.sample[ray];
    for (int c = 0; c < color_channels; ++c)
      layer_column(layer, c)[sample] += scratch.rays.weight[c][ray] * color[c];
  }
  void add_background(std::uint32_t ray, const Rgb& background) {
    if (task.layer_sums)
      add_to_layer(ray, frame.layers.first_of(scratch.rays.way[ray]) + LayerPlan::background, background);
    if (frame.witness) frame.witness->color(frame.witness->self, {scratch.rays.number[ray], background});
  }

  static Rgb lane_color(const C& color, int k) {
    Rgb result;
    for (int c = 0; c < color_channels; ++c) result[c] = lane(color[c], k);
    return result;
  }
  static Vec3<double> lane_vector(const Vec3<F>& v, int k) {
    return {lane(v.x, k), lane(v.y, k), lane(v.z, k)};
  }

  /// Numbers ray i of the queue, and tells of it.
  void tell_ray(RayQueue& rays, std::uint32_t i, std::uint32_t parent, Way way, bool total,
                const Rgb& factor) {
    rays.number[i] = next_number++;
    const std::uint64_t sample = first_of_batch + rays.sample[i];
    SeenRay seen{rays.number[i],
                 parent,
                 way,
                 total,
                 std::uint32_t(sample / samples_per_pixel()),
                 task.first_sample + int(sample % samples_per_pixel()),
                 {rays.ox[i], rays.oy[i], rays.oz[i]},
                 {rays.dx[i], rays.dy[i], rays.dz[i]},
                 factor,
                 {}};
    for (int c = 0; c < color_channels; ++c) seen.weight[c] = rays.weight[c][i];
    frame.witness->ray(frame.witness->self, seen);
  }
  void tell_hits(const Lanes& at, const Hits& hits, const C& Ia, const F& open) const {
    const RayQueue& rays = scratch.rays;
    for (int k = 0; k < at.count; ++k) {
      const std::uint32_t ray = at.ray[k];
      frame.witness->hit(frame.witness->self,
                         {rays.number[ray],
                          rays.instance[ray],
                          rays.geometry[ray],
                          rays.primitive[ray],
                          hits.material[k],
                          lane_vector(hits.P, k),
                          lane_vector(hits.N, k),
                          lane_vector(hits.G, k),
                          lane_vector(hits.V, k),
                          lane_vector(hits.front, k),
                          lane(hits.t, k),
                          lane(hits.R, k),
                          bool(lane_bits(hits.outside) >> k & 1),
                          lane_color(Ia, k),
                          lane(open, k),
                          {lane_color(ambient_of(hits), k), lane_color(diffuse_of(hits), k),
                           lane_color(specular_of(hits), k), lane_color(emission_of(hits), k),
                           lane_color(reflect_of(hits), k), lane_color(transmit_of(hits), k),
                           lane(shininess_of(hits), k), lane(ior_of(hits), k)}});
    }
  }
  /// What `arriving` in shade() makes of a light, number by number.
  void tell_light(int number, int packet, const Lanes& at, const Hits& hits,
                  const Attenuation& attenuation) const {
    const auto l = int(scratch.reaching[number]);
    const std::uint32_t open = scratch.open[std::size_t(number) * beam + packet];
    const auto light = sample_light(l, hits.P);
    const F faded = attenuate(attenuation, light.r, F(frame.minimum_distance));
    const C share = share_that_passes(open, hits, light), arriving = share * (faded * light.I);
    const std::uint32_t asked =
        lane_bits(both(Truth(dot(hits.N, light.L) > F(0)), Truth(!is_black(light.I))));
    for (int k = 0; k < at.count; ++k)
      frame.witness->light(
          frame.witness->self,
          {scratch.rays.number[at.ray[k]], l, bool(open >> k & 1), frame.whitted.shadows && (asked >> k & 1),
           lane_vector(light.L, k), lane(light.r, k), lane_color(light.I, k), lane(faded, k),
           lane_color(share, k), lane_color(arriving, k)});
  }
  void tell_colors(const Lanes& at, const C& color) const {
    for (int k = 0; k < at.count; ++k)
      frame.witness->color(frame.witness->self, {scratch.rays.number[at.ray[k]], lane_color(color, k)});
  }

  void add_layers_to_pixel(std::uint32_t pixel, std::uint32_t sample) const {
    const int columns = frame.layers.count() * color_channels;
    double* sums = task.layer_sums + std::size_t(pixel) * std::size_t(columns);
    for (int c = 0; c < columns; ++c) sums[c] += scratch.layers[std::size_t(c) * layer_stride + sample];
  }

  void note_first_hits(const Lanes& at, const Hits& hits) const {
    const RayQueue& rays = scratch.rays;
    const C albedo = diffuse_of(hits);
    for (int k = 0; k < at.count; ++k) {
      const std::uint32_t ray = at.ray[k];
      FirstHit& first = task.first_hits[first_of_batch + rays.sample[ray]];
      first.object =
          std::int32_t(object_of(frame.world, rays.instance[ray], rays.geometry[ray], rays.primitive[ray]));
      first.material = std::int32_t(hits.material[k]);
      first.primitive = rays.primitive[ray];
      first.R = float(lane(hits.R, k));
      const Vec3<double> P = lane_vector(hits.P, k), N = lane_vector(hits.N, k);
      const Geometry& geometry = frame.world.geometries[rays.geometry[ray]];
      Vec2<double> uv{};
      if (geometry.uvs)
        uv = coordinates_at(frame.world, {rays.instance[ray], rays.geometry[ray], rays.primitive[ray]}, P)
                 .uv[0];
      first.P[0] = float(P.x), first.P[1] = float(P.y), first.P[2] = float(P.z);
      first.N[0] = float(N.x), first.N[1] = float(N.y), first.N[2] = float(N.z);
      first.uv[0] = float(uv.x), first.uv[1] = float(uv.y);
      for (int c = 0; c < color_channels; ++c) first.albedo[c] = float(lane(albedo[c], k));
    }
  }

  // ---- the film

  void add_to_pixels(std::uint64_t first, std::uint32_t count) {
    auto pixel = std::uint32_t(first / samples_per_pixel());
    int left = samples_per_pixel() - int(first % samples_per_pixel());
    for (std::uint32_t i = 0; i < count; ++i) {
      for (int c = 0; c < color_channels; ++c)
        task.sums[std::size_t(pixel) * color_channels + c] += scratch.samples.color[c][i];
      if constexpr (Seen) {
        if (task.layer_sums) add_layers_to_pixel(pixel, i);
      }
      if (task.least_and_greatest) {
        float* least = task.least_and_greatest + std::size_t(pixel) * 2 * color_channels;
        float* greatest = least + color_channels;
        for (int c = 0; c < color_channels; ++c) {
          const auto value = float(scratch.samples.color[c][i]);
          least[c] = min(least[c], value), greatest[c] = max(greatest[c], value);
        }
      }
      if (--left == 0) left = samples_per_pixel(), ++pixel;
    }
  }
};

void render(const Frame& frame, const PixelTask& task, Scratch& scratch, RayCounts& counts) {
  if (frame.witness || task.layer_sums || task.first_hits) {
    Work<true> work{frame, task, scratch, counts};
    work.run();
  } else {
    Work<false> work{frame, task, scratch, counts};
    work.run();
  }
}

}  // namespace

extern const Kernel whitted_kernel;
const Kernel whitted_kernel{LAMBENT_ISA_NAME, render};

}  // namespace LAMBENT_ISA
}  // namespace lambent
