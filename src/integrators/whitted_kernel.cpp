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

#include "illumination/equation.h"
#include "integrators/wavefront.h"

namespace lambent {
inline namespace LAMBENT_ISA {
namespace {

/// A task on its way through the stages. `Seen`: somebody wants to know more than the colours: layers, what
/// eye rays met, or every number (frame.h, Witness). All that is seen is made of the very numbers that the
/// picture is made of.
template <bool Seen> struct Work : Wavefront {
  void run() {
    begin();
    for (std::uint64_t first = 0; first < sample_count(); first += batch_size) {
      const std::uint32_t count = size_of_batch(first);
      follow_samples(first, count);
      add_to_pixels(first, count);
    }
  }

  void begin() {
    make_room();
    if (frame.light_point_count > 0 && !scratch.open.data) {
      Scratch::grow(scratch.open, std::uint32_t(frame.light_point_count) * beam);
      Scratch::grow(scratch.reaching, std::uint32_t(frame.light_point_count));
    }
    if constexpr (Seen) grow_layers();
    point_count = frame.light_point_count;
    for (int p = 0; p < point_count; ++p) scratch.reaching[p] = std::uint32_t(p);
  }

  /// A batch, until the colours of its samples are known.
  void follow_samples(std::uint64_t first, std::uint32_t count) {
    follow_batch(
        first, count, &MaterialRecord::model, [&](std::uint32_t n) { begin_batch(n); },
        [&](std::uint32_t i, std::uint32_t end) { see_background(i, end); },
        [&] {
          if (frame.lights_have_limits && hit_count() > 0) choose_lights();
          for_each_group([&](int group) { shade_group(group, depth < frame.whitted.max_depth); });
        });
  }

  void begin_batch(std::uint32_t count) {
    if constexpr (Seen) {
      clear_layers(count);
      for (std::uint32_t i = 0; i < count; ++i) {
        scratch.rays.way[i] = Way::direct;
        if (frame.witness) tell_ray(scratch.rays, i, no_ray, Way::direct, false, grey(1.0));
      }
    }
  }

  void see_background(std::uint32_t first, std::uint32_t end) {
    if (!Seen && !frame.environment.texture.levels) return add_background(first, end);
    for (std::uint32_t ray = first; ray < end; ++ray) {
      const Rgb background = background_of(ray);
      add(ray, background);
      if constexpr (Seen) note_background(ray, background);
    }
  }

  int point_count = 0;  ///< How many of scratch.reaching.

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
    point_count = 0;
    int last = -1;
    bool last_reaches = false;
    for (int p = 0; p < frame.light_point_count; ++p) {
      const int l = frame.light_points[p].light;
      if (l != last)
        last_reaches = with_light(frame.lights[l], [&](const auto& light) { return reaches(light, box); });
      last = l;
      if (last_reaches) scratch.reaching[point_count++] = std::uint32_t(p);
    }
  }

  /// A packet of hits and a point of a light: what the shadow rays have found out, for the equation.
  struct Lit {
    Vec3<F> L;
    F r;
    C I;
  };
  /// A block of hits under the points of lights; the first of these are kept.
  struct LitBlock : Block {
    static constexpr int most_kept = 4;
    Lit lit[most_kept][beam];
  };

  void shade_group(int group, bool follow_on) {
    for (std::uint32_t first = group_first[group]; first < group_first[group + 1];) {
      LitBlock block;
      fill(block, group, first);
      if constexpr (Seen) {
        if (depth == 1 && task.first_hits)
          for (int i = 0; i < block.count; ++i) note_first_hits(block.at[i], block.hits[i]);
      }
      for (int i = 0; i < point_count; ++i) {
        if (frame.light_points[scratch.reaching[i]].extended) look_at_light<true>(i, block);
        else look_at_light<false>(i, block);
      }
      for (int i = 0; i < block.count; ++i) {
        with_model(ModelId(way_to_shade_of(group)), [&]<class Model>() { shade<Model>(block, i); });
        if (follow_on) follow(block.at[i], block.hits[i]);
      }
    }
  }

  // ---- the equation

  template <class Model> LAMBENT_FLATTEN void shade(const LitBlock& block, int packet) {
    const Lanes& at = block.at[packet];
    const Hits& hits = block.hits[packet];
    Surface<F, C> s;
    s.N = hits.N;
    s.V = hits.V;
    s.ka = ambient_of(hits);
    s.kd = diffuse_of(hits);
    s.ks = specular_of(hits);
    // Where Ks is black no power is seen, and x^0 costs nothing.
    s.n = select(is_black(s.ks), F(0), shininess_of(hits));
    for (int i = 0; i < max_model_parameters; ++i)
      if (Model::info.parameters[i].name)
        s.own[i] = of_materials(hits, [&](const MaterialRecord& m) { return m.own[i]; });
    s.outside = select(hits.outside, F(1), F(-1));
    s.to_camera = -broadcast<F>(frame.camera.forward);
    if constexpr (Model::info.measured) {
      // From inside of glass the index of what lies beyond is that of air over its own.
      const Truth turned =
          both(Truth(!hits.outside), Truth(of_materials(hits, [](const MaterialRecord& m) {
                                             return m.boundary == Boundary::glass ? 1.0 : 0.0;
                                           }) > F(0)));
      const C eta = colors_of_materials(hits, [](const MaterialRecord& m) { return m.eta; });
      for (int c = 0; c < color_channels; ++c) s.eta[c] = select(turned, F(1) / eta[c], eta[c]);
      s.k = colors_of_materials(hits, [](const MaterialRecord& m) { return m.k; });
    }

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
        for (int number = 0; number < point_count; ++number)
          tell_light(number, packet, at, hits, fading.attenuation);
      }
    }
    const auto arriving = [&](int number) -> Arriving<F, C> {
      const LightPoint& point = frame.light_points[scratch.reaching[number]];
      const std::uint32_t open = scratch.open[std::size_t(number) * beam + packet];
      if (open == 0) return {hits.N, grey(F(0))};
      Lit found_again;
      const bool kept = number < LitBlock::most_kept;
      if (!kept) {
        const auto found = sample_point(point, hits.P);
        found_again = {found.L, found.r, found.I};
      }
      const Lit& light = kept ? block.lit[number][packet] : found_again;
      if constexpr (Model::info.unfaded_light) {
        const F faded = attenuate(fading.attenuation, light.r, minimum);
        const C Il = F(point.share) *
                     with_light(frame.lights[point.light], [](const auto& one) { return brightest<F>(one); });
        return {light.L, share_that_passes(open, hits, point) * (faded * light.I), Il,
                faded * share_of(light.I, Il)};
      }
      return {light.L, share_that_passes(open, hits, point) *
                           (attenuate(fading.attenuation, light.r, minimum) * light.I)};
    };
    const C emission = emission_of(hits);
    if constexpr (Seen) {
      see_term(at, LayerPlan::emission, Term::emission, -1, emission);
      const C I = illuminate<Model>(s, Ia, point_count, arriving, [&](Term term, int number, const C& color) {
        const int point = number < 0 ? -1 : int(scratch.reaching[number]);
        const int l = number < 0 ? -1 : frame.light_points[point].source;
        const int layer = term == Term::ambient   ? int(LayerPlan::ambient)
                          : term == Term::diffuse ? LayerPlan::diffuse(l)
                                                  : LayerPlan::specular(l);
        see_term(at, layer, term, point, color);
      });
      add(at, emission + I);
      if (frame.witness) tell_colors(at, emission + I);
    } else {
      add(at, emission + illuminate<Model>(s, Ia, point_count, arriving));
    }
  }

  LightSample<F, C> sample_point(const LightPoint& point, const Vec3<F>& P) const {
    return sample_point(point, P, [](const auto&) { return true; });
  }
  /// may_be(light): whether it can be of that kind at all; what cannot be makes no code.
  template <class MayBe>
  LightSample<F, C> sample_point(const LightPoint& point, const Vec3<F>& P, const MayBe& may_be) const {
    auto result = with_light(frame.lights[point.light], [&](const auto& light) {
      if (!may_be(light)) __builtin_unreachable();
      return sample(light, P, F(point.u), F(point.v));
    });
    if (point.share != 1) result.I = F(point.share) * result.I;
    return result;
  }

  /// From hits.front.
  static ShadowWay way_to(const LightSample<F, C>& light, const LightPoint& point, const Hits& hits) {
    if (point.extended) return shadow_way(hits.front, hits.P, light.L, light.clear);
    return {light.L, light.r};
  }

  /// Decides which hits of a block a light reaches. No shadow ray is thrown where the light is behind the
  /// surface (N.L <= 0) or dark in this direction.
  template <bool extended> LAMBENT_FLATTEN void look_at_light(int number, LitBlock& block) {
    const LightPoint& point = frame.light_points[scratch.reaching[number]];
    std::uint32_t* open_bits = &scratch.open[std::size_t(number) * beam];
    QueryRay<Query> rays[beam];
    Query t_far[beam];
    MaskOf<Query> open[beam];
    int packet[beam], asked = 0;
    for (int i = 0; i < block.count; ++i) {
      const Hits& hits = block.hits[i];
      const auto light =
          sample_point(point, hits.P, []<class Light>(const Light&) { return HasExtent<Light> == extended; });
      if (number < LitBlock::most_kept) {
        Lit& kept = block.lit[number][i];
        kept.L = light.L, kept.r = light.r, kept.I = light.I;
      }
      const Truth lit = both(block.at[i].active, dot(hits.N, light.L) > F(0), Truth(!is_black(light.I)));
      open_bits[i] = lane_bits(lit);
      if (open_bits[i] == 0 || !frame.whitted.shadows) continue;
      // Not by way_to(): that way, compilers copy what they could build where it stands.
      if constexpr (extended) {
        const ShadowWay way = shadow_way(hits.front, hits.P, light.L, light.clear);
        rays[asked] = query_rays(hits.front, way.d);
        t_far[asked] = number_cast<float>(way.length);
      } else {
        rays[asked] = query_rays(hits.front, light.L);
        t_far[asked] = number_cast<float>(light.r);
      }
      open[asked] = mask_cast<std::int32_t>(lit);
      counts.shadow += std::uint64_t(__builtin_popcount(open_bits[i]));
      if (frame.listener) tell(rays[asked], open_bits[i], t_far[asked]);
      packet[asked++] = i;
    }
    if (asked == 0) return;
    cast_shadows(rays, t_far, asked, open);
    for (int a = 0; a < asked; ++a) open_bits[packet[a]] = lane_bits(open[a]);
  }

  [[gnu::noinline]] void cast_shadows(const QueryRay<Query>* rays, const Query* t_far, int count,
                                      MaskOf<Query>* open) const {
    find_open(frame.world, rays, t_far, count, all_opaque(), open);
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
      const auto sample =
          std::uint64_t(sample_at(task.first_sample + int(number % std::uint64_t(samples_per_pixel()))));
      const std::uint64_t hash = hashed(std::uint64_t(std::uint32_t(pixel.x)) << 32 | std::uint32_t(pixel.y));
      const double turn_u = double(hash >> 32) * 0x1p-32, turn_v = double(hash & 0xffffffff) * 0x1p-32;
      const Vec3<double> N = lane(hits.N, k), G = lane(hits.G, k);
      Vec3<double> a, b;
      axes_across(N, a, b);
      // From the surface itself, not from the smooth one that it stands for: lifted, a point near the floor
      // may lie below it.
      const Vec3<double> P = lane(hits.P, k), off = P - lane(hits.back, k);
      const Vec3<float> start = cast<float>(P + off);
      int open = 0;
      // One by one: of rays that go everywhere, and of which most are blocked near by, a packet takes longer.
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
  C share_that_passes(std::uint32_t open, const Hits& hits, const LightPoint& point) const {
    const C passes = grey(select(mask_of_bits<Truth>(open), F(1), F(0)));
    if (all_opaque() || !frame.whitted.shadows) return passes;
    return passes * transmittance(open, hits, point);
  }

  /// What transmitting surfaces leave of the light: the product of their `transmit`, straight on, in the
  /// order in which the ray meets them.
  [[gnu::noinline]] C transmittance(std::uint32_t open, const Hits& hits, const LightPoint& point) const {
    const ShadowWay way = way_to(sample_point(point, hits.P), point, hits);
    const QueryRay<Query> rays = query_rays(hits.front, way.d);
    const Query t_far = number_cast<float>(way.length);
    double left[color_channels][lanes] = {};
    for (; open; open &= open - 1) {
      const int k = __builtin_ctz(open);
      const Rgb one = what_passes(lane(rays, k), lane(t_far, k),
                                  [&](const auto&... surface) { return share_through(frame, surface...); });
      for (int c = 0; c < color_channels; ++c) left[c][k] = one[c];
    }
    C result;
    for (int c = 0; c < color_channels; ++c) result[c] = F::load(left[c]);
    return result;
  }
  // ---- mirror rays and refracted rays

  LAMBENT_FLATTEN void follow(const Lanes& at, const Hits& hits) {
    bool reflects = false, transmits = false, any_metal = false, any_glass = false;
    for (int k = 0; k < at.count; ++k) {
      const MaterialRecord& m = frame.materials[hits.material[k]];
      reflects |= m.reflects, transmits |= m.transmits;
      any_metal |= m.boundary == Boundary::metal, any_glass |= m.boundary == Boundary::glass;
    }
    if (!reflects && !transmits) return;

    C weight;
    for (int c = 0; c < color_channels; ++c) weight[c] = at.load(scratch.rays.weight[c]);
    C mirrored = reflect_of(hits);
    C through = transmit_of(hits);
    if (any_metal || any_glass) {
      const C w = fresnel_of(hits, any_metal, any_glass);
      mirrored = w * mirrored;
      if (any_glass) {
        const Truth glass = of_materials(hits, [](const MaterialRecord& m) {
                              return m.boundary == Boundary::glass ? 1.0 : 0.0;
                            }) > F(0);
        through = select(glass, (grey(F(1)) - w) * through, through);
      }
    }
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

  // ---- for those who look closer

  /// Tells of a summand, and adds it to its layer: `layer` counts from the first of the ray's way.
  void see_term(const Lanes& at, int layer, Term term, int point, const C& color) {
    if (frame.witness)
      for (int k = 0; k < at.count; ++k)
        frame.witness->term(frame.witness->self,
                            {scratch.rays.number[at.ray[k]], term, point, lane_color(color, k)});
    if (!task.layer_sums || all(is_black(color))) return;
    const RayQueue& rays = scratch.rays;
    if (depth == 1) return add(at, color, [&](int c) { return layer_column(layer, c); });
    for (int k = 0; k < at.count; ++k)
      add_to_layer(at.ray[k], frame.layers.first_of(rays.way[at.ray[k]]) + layer, lane_color(color, k));
  }
  void note_background(std::uint32_t ray, const Rgb& background) {
    if (task.layer_sums)
      add_to_layer(ray, frame.layers.first_of(scratch.rays.way[ray]) + LayerPlan::background, background);
    if (frame.witness) frame.witness->color(frame.witness->self, {scratch.rays.number[ray], background});
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
      const MaterialRecord& m = frame.materials[hits.material[k]];
      frame.witness->hit(frame.witness->self,
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
                          lane_color(Ia, k),
                          lane(open, k),
                          {lane_color(ambient_of(hits), k), lane_color(diffuse_of(hits), k),
                           lane_color(specular_of(hits), k), lane_color(emission_of(hits), k),
                           lane_color(reflect_of(hits), k), lane_color(transmit_of(hits), k),
                           lane(shininess_of(hits), k), lane(ior_of(hits), k), m.boundary, m.eta, m.k}});
    }
  }
  /// What `arriving` in shade() makes of a light, number by number.
  void tell_light(int number, int packet, const Lanes& at, const Hits& hits,
                  const Attenuation& attenuation) const {
    const auto p = int(scratch.reaching[number]);
    const LightPoint& point = frame.light_points[p];
    const std::uint32_t open = scratch.open[std::size_t(number) * beam + packet];
    const auto light = sample_point(point, hits.P);
    const ShadowWay way = way_to(light, point, hits);
    const QueryRay<Query> shadow = query_rays(hits.front, way.d);
    const Query t_far = number_cast<float>(way.length);
    const F faded = attenuate(attenuation, light.r, F(frame.minimum_distance));
    const C share = share_that_passes(open, hits, point), arriving = share * (faded * light.I);
    const std::uint32_t asked =
        lane_bits(both(Truth(dot(hits.N, light.L) > F(0)), Truth(!is_black(light.I))));
    for (int k = 0; k < at.count; ++k)
      frame.witness->light(
          frame.witness->self,
          {scratch.rays.number[at.ray[k]], p, bool(open >> k & 1), frame.whitted.shadows && (asked >> k & 1),
           lane(light.L, k), lane(light.r, k), lane_color(light.I, k), lane(faded, k), lane_color(share, k),
           lane_color(arriving, k), cast<double>(lane(shadow.d, k)), double(lane(t_far, k))});
  }
  void tell_colors(const Lanes& at, const C& color) const {
    for (int k = 0; k < at.count; ++k)
      frame.witness->color(frame.witness->self, {scratch.rays.number[at.ray[k]], lane_color(color, k)});
  }
};

/// A picture of wavelengths: each batch of samples goes once through every pass. What the passes bring is
/// added up in linear sRGB, sample by sample, so that from there on it is a picture as any other.
template <bool Seen> struct Passes : Wavefront {
  void run() {
    make_room();
    grow_layers();
    grow_totals();
    for (std::uint64_t first = 0; first < sample_count(); first += batch_size) {
      const std::uint32_t count = size_of_batch(first);
      for (int column = 0; column < total_columns(); ++column)
        for (std::uint32_t i = 0; i < count; ++i) total(column)[i] = 0;
      for (int p = 0; p < frame.pass_count; ++p) {
        Work<Seen> work{{*frame.passes[p].frame, task, scratch, counts}};
        work.begin();
        work.follow_samples(first, count);
        add_pass(frame.passes[p], count);
      }
      for (int c = 0; c < color_channels; ++c) take(total(c), scratch.samples.color[c].data, count);
      for (int c = color_channels; c < total_columns(); ++c)
        take(total(c), &scratch.layers[std::size_t(c - color_channels) * layer_stride], count);
      add_to_pixels(first, count);
    }
  }

 private:
  int total_columns() const { return color_channels + (task.layer_sums ? frame.layers.columns() : 0); }
  double* total(int column) const { return &scratch.totals[std::size_t(column) * layer_stride]; }
  static void take(const double* from, double* to, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) to[i] = from[i];
  }

  void grow_totals() const {
    const auto columns = std::uint32_t(total_columns());
    if (scratch.total_columns >= columns) return;
    Scratch::grow(scratch.totals, std::uint32_t(columns * layer_stride));
    scratch.total_columns = columns;
  }

  /// What the columns of one color bring to those of a total; the same as from_pass().
  static void add(const Pass& pass, const double* const channels[color_channels], double* const totals[],
                  std::uint32_t count) {
    for (int c = 0; c < color_channels; ++c)
      for (std::uint32_t i = 0; i < count; ++i) {
        double sum = channels[0][i] * pass.weights[0][c];
        for (int k = 1; k < pass.count; ++k) sum = sum + channels[k][i] * pass.weights[k][c];
        totals[c][i] += sum;
      }
  }

  void add_pass(const Pass& pass, std::uint32_t count) const {
    const double* channels[color_channels];
    double* totals[color_channels];
    for (int c = 0; c < color_channels; ++c)
      channels[c] = scratch.samples.color[c].data, totals[c] = total(c);
    add(pass, channels, totals, count);
    if (!task.layer_sums) return;
    const int wavelengths = color_channels + frame.layers.count() * color_channels;
    for (int k = 0; k < pass.count; ++k) take(channels[k], total(wavelengths + pass.first + k), count);
    for (int layer = 0; layer < frame.layers.count(); ++layer) {
      for (int c = 0; c < color_channels; ++c)
        channels[c] = layer_column(layer, c), totals[c] = total(color_channels * (layer + 1) + c);
      add(pass, channels, totals, count);
    }
  }
};

template <template <bool> class Job>
void render_seen_or_not(const Frame& frame, const PixelTask& task, Scratch& scratch, RayCounts& counts) {
  if (frame.witness || task.layer_sums || task.first_hits) {
    Job<true> job{{frame, task, scratch, counts}};
    job.run();
  } else {
    Job<false> job{{frame, task, scratch, counts}};
    job.run();
  }
}

}  // namespace

RenderPixels render_whitted;
void render_whitted(const Frame& frame, const PixelTask& task, Scratch& scratch, RayCounts& counts) {
  if (frame.pass_count > 0) render_seen_or_not<Passes>(frame, task, scratch, counts);
  else render_seen_or_not<Work>(frame, task, scratch, counts);
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
