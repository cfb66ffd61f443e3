// The path tracer (Kajiya, The rendering equation, SIGGRAPH 1986):
//
//   L(P, V) = Le(P, V) + integral over the sphere of  f(P, L, V) L(P, L) |N.L| dL
//
// One path for each sample. Where it meets a surface, two things happen. One light is looked for, chosen by
// what it may bring, and adds f(L) |N.L| times what arrives of it; and one direction is chosen by the
// material, along which the path goes on, its colour counting f(L) |N.L| over the density of the choice. What
// shines is found in both ways, each weighed by how likely it was to find it (Veach, Robust Monte Carlo
// methods for light transport simulation, 1997: multiple importance sampling, power heuristic). Later rays
// may end by chance, those that go on counting the more for it (Russian roulette).
//
// Light counts as in the equation of equation.h: a point light of colour Il gives Il Kd (N.L)+ / r^2 on a
// surface that scatters alike in all directions, f = Kd / pi. So the radiant intensity of a point light is pi
// Il.
//
// Random numbers are a function of pixel, sample and dimension (math/random.h). Per sample the order of the
// sum is that of the path: at each surface what it sends out itself, then what it scatters of the light that
// was looked for.
//
// This file is compiled once for each instruction set.

#include "integrators/emitters.h"
#include "integrators/wavefront.h"
#include "math/random.h"
#include "scattering/scattering.h"

namespace lambent {
inline namespace LAMBENT_ISA {
namespace {

/// `Seen`: somebody wants to know more than the colours, as in whitted_kernel.cpp.
template <bool Seen> struct Work : Wavefront {
  void run() {
    make_room();
    if constexpr (Seen) grow_layers();
    follow_batches(
        &MaterialRecord::scatter, [&](std::uint32_t count) { begin_batch(count); },
        [&](std::uint32_t i, std::uint32_t end) {
          for (; i < end; ++i) meet_background(i);
        },
        [&] { for_each_group([&](int group) { shade_group(group); }); },
        [&](std::uint64_t first, std::uint32_t count) { add_to_pixels(first, count); });
  }

  void begin_batch(std::uint32_t count) {
    auto pixel = std::uint32_t(first_of_batch / std::uint64_t(samples_per_pixel()));
    int sample = task.first_sample + int(first_of_batch % std::uint64_t(samples_per_pixel()));
    for (std::uint32_t i = 0; i < count; ++i) {
      scratch.rays.density[i] = 0;
      seeds[i] =
          hashed(seed_of_pixel(task.pixels[pixel].x, task.pixels[pixel].y) + std::uint64_t(frame.path.seed));
      numbers[i] = std::uint32_t(sample_at(sample));
      if (++sample == task.end_sample) sample = task.first_sample, ++pixel;
    }
    if constexpr (Seen) {
      clear_layers(count);
      if (frame.witness)
        for (std::uint32_t i = 0; i < count; ++i)
          tell_ray(scratch.rays, i, no_ray, Way::direct, grey(1.0), 1);
    }
  }

  void shade_group(int group) {
    for (std::uint32_t first = group_first[group]; first < group_first[group + 1];) {
      Block block;
      fill(block, group, first);
      for (int i = 0; i < block.count; ++i) {
        if constexpr (Seen) {
          if (depth == 1 && task.first_hits) note_first_hits(block.at[i], block.hits[i]);
        }
        shade(ScatterKind(way_to_shade_of(group)), block.at[i], block.hits[i]);
      }
    }
  }

  // ---- random numbers

  // Of each sample of the batch: what its random numbers begin with, and which of its pixel's it is.
  std::uint64_t seeds[batch_size]{};
  std::uint32_t numbers[batch_size]{};

  /// Of each vertex of a path: pairs of dimensions, each for its purpose.
  enum Pair : int { choices, light_point, direction, chances, pairs_per_vertex };

  /// A pair of random numbers for each lane.
  struct Draw {
    F x, y;
  };
  [[gnu::noinline]] Draw draw(const Lanes& at, Pair pair) const {
    std::uint32_t number[lanes];
    std::uint64_t seed[lanes];
    const auto dimension = std::uint64_t((depth - 1) * pairs_per_vertex + pair);
    for (int k = 0; k < lanes; ++k) {
      const std::uint32_t i = scratch.rays.sample[at.ray[k]];
      number[k] = numbers[i], seed[k] = hashed(seeds[i] + dimension);
    }
    const Vec2<F> points = random_points(number, seed);
    return {points.x, points.y};
  }

  // ---- what shines where a path gets to

  /// The weight of what was found with density `found` where the other way would have found it with `other`.
  template <class T> static T weight_against(const T& found, const T& other) {
    const T a = found * found, b = other * other;
    return a / (a + b);
  }

  Vec3<double> origin_of_light(std::uint32_t ray) const {
    const RayQueue& rays = scratch.rays;
    return {rays.from_x[ray], rays.from_y[ray], rays.from_z[ray]};
  }
  Vec3<double> normal_at_origin(std::uint32_t ray) const {
    const RayQueue& rays = scratch.rays;
    return {rays.from_nx[ray], rays.from_ny[ray], rays.from_nz[ray]};
  }
  Vec3<double> direction_of(std::uint32_t ray) const {
    const RayQueue& rays = scratch.rays;
    return {rays.dx[ray], rays.dy[ray], rays.dz[ray]};
  }

  [[gnu::noinline]] void meet_background(std::uint32_t ray) {
    const RayQueue& rays = scratch.rays;
    const double found = rays.density[ray];
    const Vec3<double> d = direction_of(ray);
    // What a light sample would bring is not blurred either.
    const Rgb sky = background_along(frame, d, found > 0 ? 0 : rays.spread[ray]);
    double searched = 0, weight = 1;
    if (found > 0) {
      searched = background_density(frame, origin_of_light(ray), normal_at_origin(ray), d);
      weight = weight_against(found, searched);
    }
    meet(ray, sky, searched, weight, background());
  }

  /// Light that a path has come upon by itself. `source`: which layer.
  void meet(std::uint32_t ray, const Rgb& radiance, double searched, double weight, int source) {
    Rgb brings = weight * radiance;
    if (is_black(brings)) return;
    if (depth > 2) brings = clamped(brings, ray);
    add(ray, brings);
    if constexpr (Seen) {
      if (frame.witness)
        frame.witness->find(frame.witness->self,
                            {scratch.rays.number[ray], source, radiance, searched, weight, brings});
      if (task.layer_sums)
        add_to_layer(ray,
                     depth == 1   ? (source == background() ? LayerPlan::background : LayerPlan::emission)
                     : depth == 2 ? LayerPlan::direct(source)
                                  : LayerPlan::indirect(source),
                     brings);
    }
  }

  int surfaces() const { return surfaces_source(frame.light_count); }
  int background() const { return background_source(frame.light_count); }

  /// As much of what a ray brings as the limit lets pass, with its hue.
  Rgb clamped(const Rgb& brings, std::uint32_t ray) const {
    if (!(frame.path.clamp > 0)) return brings;
    double most = 0;
    for (int c = 0; c < color_channels; ++c) most = max(most, scratch.rays.weight[c][ray] * brings[c]);
    return most > frame.path.clamp ? (frame.path.clamp / most) * brings : brings;
  }

  // ---- at a surface

  template <class Number> F given(const Hits& hits, const Number& number) const {
    if (hits.one_material) return F(number(frame.unpainted[hits.material[0]]));
    return gather<F>([&](int k) { return number(frame.unpainted[hits.material[k]]); });
  }
  template <class Colors> C given_color(const Hits& hits, const Colors& colors) const {
    C result;
    for (int c = 0; c < color_channels; ++c)
      result[c] = given(hits, [&](const MaterialRecord& m) { return colors(m)[c]; });
    return result;
  }

  template <ScatterKind kind> ScatterSurface<F, C> surface_of(const Hits& hits) const {
    ScatterSurface<F, C> s{};
    s.V = hits.V;
    s.G = hits.G;
    // A smooth normal may lean away from the eye.
    s.N = select(dot(hits.N, hits.V) > F(0), hits.N, hits.G);
    s.outside = hits.outside;
    const Painted* painted = hits.painted;
    if constexpr (kind == ScatterKind::lecture_phong || kind == ScatterKind::lecture_blinn) {
      s.kd = painted ? painted->kd : given_color(hits, [](const MaterialRecord& m) { return m.diffuse; });
      s.ks = painted ? painted->ks : given_color(hits, [](const MaterialRecord& m) { return m.specular; });
      s.n = painted ? painted->n : given(hits, [](const MaterialRecord& m) { return m.shininess; });
      s.reflect =
          painted ? painted->reflect : given_color(hits, [](const MaterialRecord& m) { return m.reflect; });
      s.transmit =
          painted ? painted->transmit : given_color(hits, [](const MaterialRecord& m) { return m.transmit; });
      s.ior = painted ? painted->ior : given(hits, [](const MaterialRecord& m) { return m.ior; });
    } else if constexpr (kind == ScatterKind::metallic_roughness) {
      if (painted) {
        s.rough = painted->rough;
      } else {
        using M = MaterialRecord;
        s.rough = {given_color(hits, [](const M& m) { return m.rough.base_color; }),
                   given(hits, [](const M& m) { return m.rough.metallic; }),
                   given(hits, [](const M& m) { return m.rough.roughness; }),
                   given(hits, [](const M& m) { return m.rough.specular; }),
                   given_color(hits, [](const M& m) { return m.rough.specular_color; }),
                   given(hits, [](const M& m) { return m.rough.ior; }),
                   given(hits, [](const M& m) { return m.rough.transmission; }),
                   given(hits, [](const M& m) { return m.rough.clearcoat; }),
                   given(hits, [](const M& m) { return m.rough.clearcoat_roughness; })};
      }
    } else {
      s.roughness = given(hits, [](const MaterialRecord& m) { return m.roughness; });
      s.ior = given(hits, [](const MaterialRecord& m) { return m.ior; });
      s.eta = given_color(hits, [](const MaterialRecord& m) { return m.eta; });
      s.k = given_color(hits, [](const MaterialRecord& m) { return m.k; });
    }
    return s;
  }

  void shade(ScatterKind kind, const Lanes& at, const Hits& hits) {
    switch (kind) {
      case ScatterKind::lecture_phong:
        return shade<ScatterKind::lecture_phong>(at, hits);
      case ScatterKind::lecture_blinn:
        return shade<ScatterKind::lecture_blinn>(at, hits);
      case ScatterKind::metallic_roughness:
        return shade<ScatterKind::metallic_roughness>(at, hits);
      case ScatterKind::metal:
        return shade<ScatterKind::metal>(at, hits);
      case ScatterKind::glass:
        return shade<ScatterKind::glass>(at, hits);
    }
    __builtin_unreachable();
  }

  template <ScatterKind kind> void shade(const Lanes& at, const Hits& hits) {
    const F opacity = hits.painted ? hits.painted->opacity : given(hits, [](const MaterialRecord& m) {
      return m.alpha == Alpha::mask ? 1.0 : m.opacity;
    });
    // Drawn where something is left to chance.
    const bool roulette = depth >= frame.path.roulette_depth && depth < frame.path.max_depth;
    Draw chance{F(0), F(0)};
    if (roulette || any(both(at.active, opacity < F(1)))) chance = draw(at, chances);
    const Truth solid = both(at.active, chance.y < opacity);
    const std::uint32_t passing = lane_bits(at.active) & ~lane_bits(solid);
    for (std::uint32_t left = passing; left; left &= left - 1) pass_on(at, hits, __builtin_ctz(left));
    if (!any(solid)) return;

    if constexpr (Seen) {
      if (frame.witness) tell_hits(at, hits, lane_bits(solid));
    }
    send_out(at, hits, lane_bits(solid));
    const Draw choice = draw(at, choices);
    const ScatterSurface<F, C> s = surface_of<kind>(hits);
    const Scattering<kind, F, C> scattering(s);
    // Light is looked for on the side that the normal shows; on both where the surface lets some through.
    Vec3<F> facing = s.N;
    const Vec3<F> nowhere{F(0), F(0), F(0)};
    if constexpr (kind == ScatterKind::glass) facing = nowhere;
    if constexpr (kind == ScatterKind::metallic_roughness)
      facing = select(s.rough.transmission > F(0), nowhere, s.N);
    look_for_light(at, hits, scattering, facing, solid, choice.x);
    if (depth < frame.path.max_depth) go_on(at, hits, scattering, facing, solid, choice.y, chance.x);
  }

  /// What surfaces send out themselves.
  [[gnu::noinline]] void send_out(const Lanes& at, const Hits& hits, std::uint32_t asked) {
    const C emission = hits.painted ? hits.painted->emission
                                    : given_color(hits, [](const MaterialRecord& m) { return m.emission; });
    asked &= ~lane_bits(Truth(is_black(emission)));
    const RayQueue& rays = scratch.rays;
    for (; asked; asked &= asked - 1) {
      const int k = __builtin_ctz(asked);
      const std::uint32_t ray = at.ray[k];
      const MaterialRecord& material = frame.materials[hits.material[k]];
      if (material.dark_inside && !(lane_bits(hits.outside) >> k & 1)) continue;
      double searched = 0, weight = 1;
      if (rays.density[ray] > 0) {
        searched = emitter_density(frame, origin_of_light(ray), normal_at_origin(ray),
                                   {rays.instance[ray], rays.geometry[ray], rays.primitive[ray]},
                                   lane(hits.P, k), lane(hits.G, k), direction_of(ray));
        weight = weight_against(rays.density[ray], searched);
      }
      meet(ray, lane_color(emission, k), searched, weight, material.light >= 0 ? material.light : surfaces());
    }
  }

  // ---- light that is looked for

  // One copy for all kinds of surfaces: a kernel takes long enough to compile.
  [[gnu::noinline]] EmitterSample light_at(const Vec3<double>& P, const Vec3<double>& N, double pick,
                                           double u, double v) const {
    return sample_emitters(frame, P, N, pick, u, v, depth < frame.path.max_depth);
  }

  /// A light that each lane of a packet looks for: as EmitterSample.
  struct Searched {
    Vec3<F> L;
    F r, clear;
    C brings;  ///< What f |N.L| is multiplied with.
    F density;
    int source[lanes];
  };

  /// One of all that shines.
  [[gnu::noinline]] Searched search_all(const Lanes& at, const Hits& hits, const Vec3<F>& facing,
                                        std::uint32_t asked, const F& pick) const {
    double L[3][lanes] = {}, brings[color_channels][lanes] = {}, density[lanes] = {}, clear[lanes] = {};
    double distance[lanes] = {};
    Searched out;
    const Draw point = draw(at, light_point);
    for (; asked; asked &= asked - 1) {
      const int k = __builtin_ctz(asked);
      const EmitterSample e =
          light_at(lane(hits.P, k), lane(facing, k), lane(pick, k), lane(point.x, k), lane(point.y, k));
      L[0][k] = e.L.x, L[1][k] = e.L.y, L[2][k] = e.L.z;
      for (int c = 0; c < color_channels; ++c) brings[c][k] = e.radiance_over_density[c];
      density[k] = e.density, clear[k] = e.clear, distance[k] = e.r, out.source[k] = e.light;
    }
    out.L = {F::load(L[0]), F::load(L[1]), F::load(L[2])};
    for (int c = 0; c < color_channels; ++c) out.brings[c] = F::load(brings[c]);
    out.r = F::load(distance), out.clear = F::load(clear), out.density = F::load(density);
    return out;
  }

  /// The light that is all that shines: its choice is certain, and a whole packet looks for it at once. Where
  /// it lights nothing search_all would not have asked: it is black there all the same.
  [[gnu::noinline]] Searched search_one(const Lanes& at, const Hits& hits, int number) const {
    const Draw point = draw(at, light_point);
    Searched out;
    for (int k = 0; k < lanes; ++k) out.source[k] = number;
    with_light(frame.lights[number], [&]<class Light>(const Light& light) {
      if constexpr (HasExtent<Light>) {
        const LightSample<F, C> s = sample(light, hits.P, point.x, point.y);
        const Truth black = is_black(s.I);
        out.L = s.L, out.r = s.r, out.clear = select(black, F(0), s.clear);
        out.brings = select(black, C{}, (F(pi) / (s.r * s.r)) * s.I);
        out.density = select(black, F(0), light.visible ? s.density : F(0));
      }
    });
    return out;
  }

  template <class Material>
  [[gnu::noinline]] void look_for_light(const Lanes& at, const Hits& hits, const Material& scattering,
                                        const Vec3<F>& facing, const Truth& solid, const F& pick) {
    const Truth asked = both(solid, Truth(!scattering.only_perfect()));
    if (!any(asked)) return;
    const int only = Seen ? -1 : frame.emitters->only_light;
    const Searched search =
        only >= 0 ? search_one(at, hits, only) : search_all(at, hits, facing, lane_bits(asked), pick);
    const Vec3<F>& to_light = search.L;
    const Evaluated<F, C> f = scattering.evaluate(to_light);
    C light;
    for (int c = 0; c < color_channels; ++c) light[c] = f.value[c] * search.brings[c];
    const F& found = search.density;
    // The path's last ray: nothing will find the light in the other way.
    const F weight =
        depth < frame.path.max_depth ? select(found > F(0), weight_against(found, f.density), F(1)) : F(1);
    light = weight * light;
    const Truth lit = both(asked, Truth(!is_black(light)));
    std::uint32_t open = 0;
    F share(1);
    if (any(lit)) {
      const Vec3<F> start = select(dot(to_light, hits.G) > F(0), hits.front, hits.back);
      const ShadowWay way = shadow_way(start, hits.P, to_light, search.clear);
      open = shadows(query_rays(start, way.d), number_cast<float>(way.length), lit, share);
      light = share * light;
    }
    for (std::uint32_t left = lane_bits(asked); left; left &= left - 1) {
      const int k = __builtin_ctz(left);
      const bool reached = open >> k & 1;
      if (!Seen && !reached) continue;
      Rgb one{};
      if (reached) {
        one = lane_color(light, k);
        if (depth > 1) one = clamped(one, at.ray[k]);
        add(at.ray[k], one);
      }
      if constexpr (Seen) {
        if (frame.witness)
          frame.witness->search(
              frame.witness->self,
              {scratch.rays.number[at.ray[k]], search.source[k], lane(to_light, k), lane(search.r, k),
               lane_color(search.brings, k), lane(found, k), lane_color(f.value, k), lane(f.density, k),
               lane(weight, k), bool(lane_bits(lit) >> k & 1), reached, lane(share, k), one});
        if (reached && task.layer_sums)
          add_to_layer(
              at.ray[k],
              depth == 1 ? LayerPlan::direct(search.source[k]) : LayerPlan::indirect(search.source[k]), one);
      }
    }
  }

  /// Which lanes the light reaches that was looked for. What is not wholly opaque leaves a part of it.
  [[gnu::noinline]] std::uint32_t shadows(const QueryRay<Query>& rays, const Query& t_far, const Truth& lit,
                                          F& share) {
    const std::uint32_t asked = lane_bits(lit);
    counts.shadow += std::uint64_t(__builtin_popcount(asked));
    if (frame.listener) tell(rays, asked, t_far);
    MaskOf<Query> open = mask_cast<std::int32_t>(lit);
    find_open(frame.world, &rays, &t_far, 1, !frame.any_transmits, &open);
    std::uint32_t bits = lane_bits(open);
    if (!frame.any_transmits) return bits;
    double left[lanes];
    for (int k = 0; k < lanes; ++k) left[k] = 1;
    for (std::uint32_t o = bits; o; o &= o - 1) {
      const int k = __builtin_ctz(o);
      left[k] = what_passes(lane(rays, k), lane(t_far, k), [&](const auto&... surface) {
        return grey(share_that_is_not_there(surface...));
      })[0];
      if (left[k] == 0) bits &= ~(1u << k);
    }
    share = F::load(left);
    return bits;
  }

  /// How much of a surface is not there, for light that goes straight on: gaps, and what is not opaque. What
  /// transmits may bend light, so the light behind it is left to the paths that go through.
  double share_that_is_not_there(const HitIds<std::int32_t>& ids, std::uint32_t material,
                                 const SurfacePoint<double>& surface, const Vec3<double>& d) const {
    const MaterialRecord& m = frame.unpainted[material];
    if (!m.painted && !m.gaps && !frame.world.geometries[ids.geometry].colors) return 1 - m.opacity;
    const Paint here = paint_as_given(frame, ids, material, surface.P, surface.N, surface.Ng, d, 0);
    return here.gap ? 1 : 1 - here.opacity;
  }

  // ---- where paths go on

  /// Leaves a surface behind that is not there for this path.
  [[gnu::noinline]] void pass_on(const Lanes& at, const Hits& hits, int k) {
    if (depth >= frame.path.max_depth) return;
    const RayQueue& rays = scratch.rays;
    const std::uint32_t ray = at.ray[k];
    RayQueue& to = scratch.next_rays;
    const std::uint32_t i = make_ray();
    const Vec3<double> P = lane(hits.P, k), start = lane(hits.back, k), d = direction_of(ray);
    set_ray(to, i, P, cast<float>(start), d);
    to.R[i] = lane(hits.R, k);
    for (int c = 0; c < color_channels; ++c) to.weight[c][i] = rays.weight[c][ray];
    to.sample[i] = rays.sample[ray];
    to.density[i] = rays.density[ray];
    if constexpr (Seen) {
      if (frame.witness) {
        tell_hits(at, hits, 1u << k);
        tell_ray(to, i, rays.number[ray], Way::refraction, grey(1.0), 1);
      }
    }
    to.from_x[i] = rays.from_x[ray], to.from_y[i] = rays.from_y[ray], to.from_z[i] = rays.from_z[ray];
    to.from_nx[i] = rays.from_nx[ray], to.from_ny[i] = rays.from_ny[ray], to.from_nz[i] = rays.from_nz[ray];
    if (frame.cones) {
      to.width[i] = rays.width[ray] + rays.spread[ray] * lane(hits.t, k);
      to.spread[i] = rays.spread[ray];
    }
  }

  std::uint32_t make_ray() {
    RayQueue& rays = scratch.next_rays;
    if (rays.count == rays.capacity) Scratch::grow(rays, rays.capacity * 2 + batch_size);
    return rays.count++;
  }
  static void set_ray(RayQueue& rays, std::uint32_t i, const Vec3<double>& o, const Vec3<float>& start,
                      const Vec3<double>& d) {
    rays.ox[i] = o.x, rays.oy[i] = o.y, rays.oz[i] = o.z;
    rays.dx[i] = d.x, rays.dy[i] = d.y, rays.dz[i] = d.z;
    rays.qx[i] = start.x, rays.qy[i] = start.y, rays.qz[i] = start.z;
  }

  template <class Material>
  [[gnu::noinline]] void go_on(const Lanes& at, const Hits& hits, const Material& scattering,
                               const Vec3<F>& facing, const Truth& solid, const F& which, const F& chance) {
    const Draw uv = draw(at, direction);
    const Scattered<F, C> next = scattering.scatter(uv.x, uv.y, which);
    C weight;
    for (int c = 0; c < color_channels; ++c) weight[c] = at.load(scratch.rays.weight[c]) * next.weight[c];
    Truth alive = both(solid, Truth(!is_black(weight)));
    F survival(1);
    if (depth >= frame.path.roulette_depth) {
      F most = weight[0];
      for (int c = 1; c < color_channels; ++c) most = max(most, weight[c]);
      survival = min(most, F(1));
      alive = both(alive, chance < survival);
      weight = (F(1) / select(alive, survival, F(1))) * weight;
    }
    std::uint32_t going = lane_bits(alive);
    if (!going) return;
    counts.reflection += std::uint64_t(__builtin_popcount(going & ~lane_bits(next.through)));
    counts.refraction += std::uint64_t(__builtin_popcount(going & lane_bits(next.through)));
    const Leaving leaving(select(next.through, hits.P, hits.lifted),
                          select(next.through, hits.back, hits.front), next.L, weight);
    const std::uint32_t perfect = lane_bits(next.perfect);
    for (; going; going &= going - 1) {
      const int k = __builtin_ctz(going);
      const std::uint32_t i = make_ray(), ray = at.ray[k];
      RayQueue& to = scratch.next_rays;
      set_ray(to, i, {leaving.o[0][k], leaving.o[1][k], leaving.o[2][k]},
              {leaving.q[0][k], leaving.q[1][k], leaving.q[2][k]},
              {leaving.d[0][k], leaving.d[1][k], leaving.d[2][k]});
      to.R[i] = lane(hits.R, k);
      for (int c = 0; c < color_channels; ++c) to.weight[c][i] = leaving.weight[c][k];
      to.sample[i] = scratch.rays.sample[ray];
      to.density[i] = perfect >> k & 1 ? 0 : lane(next.density, k);
      if constexpr (Seen) {
        if (frame.witness)
          tell_ray(to, i, scratch.rays.number[ray],
                   lane_bits(next.through) >> k & 1 ? Way::refraction : Way::reflection,
                   lane_color(next.weight, k), lane(survival, k));
      }
      const Vec3<double> P = lane(hits.P, k), N = lane(facing, k);
      to.from_x[i] = P.x, to.from_y[i] = P.y, to.from_z[i] = P.z;
      to.from_nx[i] = N.x, to.from_ny[i] = N.y, to.from_nz[i] = N.z;
      if (frame.cones) {
        widen(to, i, ray, hits, k, perfect >> k & 1);
        to.spread[i] += lane(next.spread, k);
      }
    }
  }

  // ---- for those who look closer

  void tell_ray(RayQueue& rays, std::uint32_t i, std::uint32_t parent, Way way, const Rgb& factor,
                double survival) {
    rays.number[i] = next_number++;
    const std::uint64_t sample = first_of_batch + rays.sample[i];
    SeenRay seen{rays.number[i],
                 parent,
                 way,
                 false,
                 std::uint32_t(sample / std::uint64_t(samples_per_pixel())),
                 task.first_sample + int(sample % std::uint64_t(samples_per_pixel())),
                 {rays.ox[i], rays.oy[i], rays.oz[i]},
                 {rays.dx[i], rays.dy[i], rays.dz[i]},
                 factor,
                 {},
                 rays.density[i],
                 survival};
    for (int c = 0; c < color_channels; ++c) seen.weight[c] = rays.weight[c][i];
    frame.witness->ray(frame.witness->self, seen);
  }
  void tell_hits(const Lanes& at, const Hits& hits, std::uint32_t which) const {
    const RayQueue& rays = scratch.rays;
    for (; which; which &= which - 1) {
      const int k = __builtin_ctz(which);
      const std::uint32_t ray = at.ray[k];
      frame.witness->hit(
          frame.witness->self,
          {rays.number[ray],
           rays.instance[ray],
           rays.geometry[ray],
           rays.primitive[ray],
           hits.material[k],
           lane(hits.P, k),
           lane(hits.N, k),
           lane(hits.G, k),
           lane(hits.V, k),
           lane(hits.front, k),
           lane(hits.t, k),
           lane(hits.R, k),
           bool(lane_bits(hits.outside) >> k & 1),
           {},
           1,
           {lane_color(ambient_of(hits), k), lane_color(diffuse_of(hits), k),
            lane_color(specular_of(hits), k), lane_color(emission_of(hits), k),
            lane_color(reflect_of(hits), k), lane_color(transmit_of(hits), k), lane(shininess_of(hits), k),
            lane(ior_of(hits), k), frame.materials[hits.material[k]].boundary,
            frame.materials[hits.material[k]].eta, frame.materials[hits.material[k]].k}});
    }
  }
};

}  // namespace

RenderPixels render_path;
void render_path(const Frame& frame, const PixelTask& task, Scratch& scratch, RayCounts& counts) {
  if (frame.witness || task.layer_sums || task.first_hits) {
    Work<true> work{{frame, task, scratch, counts}};
    work.run();
  } else {
    Work<false> work{{frame, task, scratch, counts}};
    work.run();
  }
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
