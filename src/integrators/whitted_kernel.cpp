// The Whitted integrator (Whitted, An improved illumination model for shaded display, CACM 23(6), 1980):
//
//   colour of a ray = emission + I + reflect * (colour along the mirror ray) + transmit * (colour along the
//   refracted ray)
//
// with I the equation of equation.h. Rays of a tile are followed level by level: all eye rays, then all that
// these threw, and so on; a ray's colour is added to its sample with the product of the factors on its way.
// Per sample the order of the sum is fixed: level by level, rays in the order of those that threw them, the
// mirror ray before the refracted one.
//
// This file is compiled once for each instruction set.

#include "accel/surface.h"
#include "illumination/equation.h"
#include "integrators/frame.h"
#include "math/pack.h"

namespace lambent {
inline namespace LAMBENT_ISA {
namespace {

// Queries run in float, shading in double: an error of R.V counts n times in (R.V)^n, so float could not keep
// 1e-6 where n >= 32.
using QueryPack = Pack<float, native_float_lanes>;
using ShadePack = Pack<double, native_float_lanes / 2>;
constexpr int query_lanes = lanes_of<QueryPack>, shade_lanes = lanes_of<ShadePack>;

constexpr std::uint32_t batch_size = 2048;         // samples that are followed together
constexpr std::uint32_t light_entries = 1u << 18;  // hits * lights that are kept at a time

template <class T>
Vec3<double> at(const Column<T>& x, const Column<T>& y, const Column<T>& z, std::uint32_t i) {
  return {x[i], y[i], z[i]};
}
inline void put(const Vec3<double>& v, const Column<double>& x, const Column<double>& y,
                const Column<double>& z, std::uint32_t i) {
  x[i] = v.x, y[i] = v.y, z[i] = v.z;
}

inline void push_ray(RayQueue& rays, const Vec3<double>& o, const Vec3<double>& start, const Vec3<double>& d,
                     double R, const Rgb& weight, std::uint32_t sample) {
  if (rays.count == rays.capacity) Scratch::grow(rays, rays.capacity * 2 + batch_size);
  const std::uint32_t i = rays.count++;
  put(o, rays.ox, rays.oy, rays.oz, i);
  put(d, rays.dx, rays.dy, rays.dz, i);
  rays.qx[i] = float(start.x), rays.qy[i] = float(start.y), rays.qz[i] = float(start.z);
  rays.R[i] = R;
  for (int c = 0; c < color_channels; ++c) rays.weight[c][i] = weight[c];
  rays.sample[i] = sample;
}

/// One tile on its way through the stages.
struct TileWork {
  const Frame& frame;
  const Tile& tile;
  Scratch& scratch;
  RayCounts& counts;

  int width() const { return tile.x1 - tile.x0; }
  std::uint32_t pixel_count() const { return std::uint32_t(width()) * std::uint32_t(tile.y1 - tile.y0); }

  void run() {
    const std::uint64_t samples = std::uint64_t(pixel_count()) * frame.samples;
    start_pixels();
    for (std::uint64_t first = 0; first < samples; first += batch_size) {
      const auto count = std::uint32_t(min<std::uint64_t>(batch_size, samples - first));
      throw_eye_rays(first, count);
      for (int depth = 1; scratch.rays.count > 0; ++depth) {
        trace(depth == 1);
        scratch.next_rays.count = 0;
        for (std::uint32_t ray = 0; ray < scratch.rays.count;) {
          ray = gather_hits(ray);
          if (depth == 1) counts.eye_hits += scratch.hits.count;
          look_at_lights();
          shade();
          if (depth < frame.whitted.max_depth) follow();
        }
        RayQueue rays = scratch.rays;
        scratch.rays = scratch.next_rays;
        scratch.next_rays = rays;
      }
      add_to_pixels(first, count);
    }
    develop();
  }

  // ---- eye rays

  void start_pixels() {
    if (scratch.pixels.capacity < pixel_count()) Scratch::grow(scratch.pixels, pixel_count());
    if (scratch.samples.capacity < batch_size) Scratch::grow(scratch.samples, batch_size);
    for (auto& channel : scratch.pixels.color)
      for (std::uint32_t i = 0; i < pixel_count(); ++i) channel[i] = 0;
  }

  void throw_eye_rays(std::uint64_t first, std::uint32_t count) {
    for (auto& channel : scratch.samples.color)
      for (std::uint32_t i = 0; i < count; ++i) channel[i] = 0;
    scratch.rays.count = 0;
    const CameraRecord& camera = frame.camera;
    const double half_width = 0.5 * frame.width, half_height = 0.5 * frame.height;
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto pixel = std::uint32_t((first + i) / frame.samples);
      const Vec2<double>& point = frame.pattern[(first + i) % frame.samples];
      const double x = (tile.x0 + int(pixel % width()) + point.x - half_width) / half_height;
      const double y = (half_height - (tile.y0 + int(pixel / width()) + point.y)) / half_height;
      const Vec3<double> aside = x * camera.right + y * camera.up;
      const Vec3<double> o = camera.eye + camera.spread_of_origins * aside;
      push_ray(scratch.rays, o, o, normalize(camera.forward + camera.spread_of_directions * aside), 0,
               grey(1.0), i);
    }
    counts.eye += count;
  }

  // ---- where rays end

  /// Eye rays lie close together and go through the tree in packets; scattered ones do not, and go one by
  /// one.
  void trace(bool coherent) {
    RayQueue& rays = scratch.rays;
    std::uint32_t i = 0;
    if (coherent)
      for (; i + query_lanes <= rays.count; i += query_lanes) trace_at<QueryPack>(rays, i);
    for (; i < rays.count; ++i) trace_at<float>(rays, i);
  }

  template <class F> void trace_at(RayQueue& rays, std::uint32_t first) const {
    Vec3<F> o, d;
    for (int k = 0; k < lanes_of<F>; ++k) {
      const std::uint32_t i = first + k;
      set_lane(o.x, k, rays.qx[i]), set_lane(o.y, k, rays.qy[i]), set_lane(o.z, k, rays.qz[i]);
      set_lane(d.x, k, float(rays.dx[i])), set_lane(d.y, k, float(rays.dy[i])),
          set_lane(d.z, k, float(rays.dz[i]));
    }
    Closest<F> hit{F(__builtin_inff())};
    find_closest(frame.world, QueryRay<F>(o, d), MaskOf<F>(true), hit);
    for (int k = 0; k < lanes_of<F>; ++k) {
      const std::uint32_t i = first + k;
      rays.t[i] = lane(hit.t, k);
      rays.instance[i] = lane(hit.ids.instance, k);
      rays.geometry[i] = lane(hit.ids.geometry, k);
      rays.primitive[i] = lane(hit.ids.primitive, k);
    }
  }

  /// Collects hits from ray `first` on, as many as the lights' memory allows, and gives the others the
  /// background. Returns the first ray that it did not look at.
  std::uint32_t gather_hits(std::uint32_t first) {
    const RayQueue& rays = scratch.rays;
    HitQueue& hits = scratch.hits;
    const std::uint32_t room = max(64u, light_entries / std::uint32_t(max(1, frame.light_count)));
    const std::uint32_t last = min(rays.count, first + min(room, batch_size));
    if (hits.capacity < last - first) Scratch::grow(hits, last - first);
    hits.count = 0;
    for (std::uint32_t i = first; i < last; ++i) {
      if (rays.geometry[i] < 0) add(i, frame.background);
      else add_hit(hits, rays, i);
    }
    sort_by_model(hits);
    return last;
  }

  void add_hit(HitQueue& hits, const RayQueue& rays, std::uint32_t i) const {
    const Vec3<double> o = at(rays.ox, rays.oy, rays.oz, i), d = at(rays.dx, rays.dy, rays.dz, i);
    const SurfacePoint s =
        surface_at(frame.world, {rays.instance[i], rays.geometry[i], rays.primitive[i]}, o, d, rays.t[i]);
    const std::uint32_t h = hits.count++;
    const Vec3<double> V = -d;
    const bool outside = dot(s.Ng, V) >= 0;
    const double side = outside ? 1.0 : -1.0;
    const Vec3<double> G = side * s.Ng;
    put(s.P, hits.Px, hits.Py, hits.Pz, h);
    put(side * s.N, hits.Nx, hits.Ny, hits.Nz, h);
    put(V, hits.Vx, hits.Vy, hits.Vz, h);
    put(G, hits.Gx, hits.Gy, hits.Gz, h);
    // The lift is towards the outside of a convex surface; seen from inside, the point is where it is.
    put(s.P + (outside ? s.lift : Vec3<double>{}) + s.offset * G, hits.sx, hits.sy, hits.sz, h);
    put(s.P - s.offset * G, hits.bx, hits.by, hits.bz, h);
    hits.R[h] = rays.R[i] + s.t;
    hits.ray[h] = i;
    hits.material[h] = s.material;
    hits.outside[h] = outside;
  }

  void sort_by_model(HitQueue& hits) const {
    std::uint32_t next = 0;
    for (int model = 0; model < model_count; ++model)
      for (std::uint32_t h = 0; h < hits.count; ++h)
        if (frame.materials[hits.material[h]].model == model) hits.order[next++] = h;
  }

  // ---- lights and shadows

  /// Decides for each hit and light how much of the light passes. No shadow ray is thrown where the light is
  /// behind the surface (N.L <= 0) or dark in this direction.
  void look_at_lights() {
    const HitQueue& hits = scratch.hits;
    LightQueue& lights = scratch.lights;
    const std::uint32_t entries = hits.count * std::uint32_t(frame.light_count);
    if (lights.capacity < entries) Scratch::grow(lights, entries);
    for (int l = 0; l < frame.light_count; ++l) {
      ShadowPacket packet;
      for (std::uint32_t h = 0; h < hits.count; ++h) {
        const std::uint32_t entry = std::uint32_t(l) * hits.count + h;
        const auto light = sample_light<double>(l, at(hits.Px, hits.Py, hits.Pz, h));
        const bool lit = dot(at(hits.Nx, hits.Ny, hits.Nz, h), light.L) > 0 && !is_black(light.I);
        set_passes(entry, lit ? grey(1.0) : Rgb{});
        if (lit && frame.whitted.shadows) packet.add(h, entry, light.L, light.r, hits);
        if (packet.count == query_lanes) cast_shadows(packet);
      }
      cast_shadows(packet);
    }
  }

  template <class F> LightSample<F, Color<F>> sample_light(int l, const Vec3<F>& P) const {
    LightSample<F, Color<F>> result;
    with_light(frame.lights[l], [&](const auto& light) { result = sample(light, P, F(0.5), F(0.5)); });
    return result;
  }

  void set_passes(std::uint32_t entry, const Rgb& share) {
    for (int c = 0; c < color_channels; ++c) scratch.lights.passes[c][entry] = share[c];
  }

  /// Shadow rays that wait for company. The lanes beyond `count` are masked out.
  struct ShadowPacket {
    int count = 0;
    std::uint32_t entry[query_lanes];
    Vec3<QueryPack> o, d;
    QueryPack t_far;
    void add(std::uint32_t h, std::uint32_t e, const Vec3<double>& L, double r, const HitQueue& hits) {
      entry[count] = e;
      set_lane(o.x, count, float(hits.sx[h])), set_lane(o.y, count, float(hits.sy[h])),
          set_lane(o.z, count, float(hits.sz[h]));
      set_lane(d.x, count, float(L.x)), set_lane(d.y, count, float(L.y)), set_lane(d.z, count, float(L.z));
      set_lane(t_far, count, float(r));
      ++count;
    }
  };

  void cast_shadows(ShadowPacket& packet) {
    if (packet.count == 0) return;
    MaskOf<QueryPack> active(false);
    for (int k = 0; k < packet.count; ++k) set_lane(active, k, true);
    const bool all_opaque = !frame.any_transmits || !frame.whitted.colored_shadows;
    const auto blocked =
        find_occluded(frame.world, QueryRay<QueryPack>(packet.o, packet.d), active, packet.t_far, all_opaque);
    for (int k = 0; k < packet.count; ++k) {
      if (lane(blocked, k)) set_passes(packet.entry[k], Rgb{});
      else if (!all_opaque) set_passes(packet.entry[k], transmittance(packet, k));
    }
    counts.shadow += packet.count;
    packet.count = 0;
  }

  /// What transmitting surfaces leave of the light: the product of their `transmit`, straight on, in the
  /// order in which the ray meets them.
  Rgb transmittance(const ShadowPacket& packet, int k) const {
    QueryRay<float> ray({lane(packet.o.x, k), lane(packet.o.y, k), lane(packet.o.z, k)},
                        {lane(packet.d.x, k), lane(packet.d.y, k), lane(packet.d.z, k)});
    const Vec3<double> d = normalize(cast<double>(ray.d));
    double left = lane(packet.t_far, k);
    Rgb result = grey(1.0);
    for (;;) {
      Closest<float> hit{float(left)};
      find_closest(frame.world, ray, true, hit);
      if (hit.ids.geometry < 0) return result;
      const SurfacePoint s = surface_at(frame.world, hit.ids, cast<double>(ray.o), d, hit.t);
      result = result * frame.materials[s.material].transmit;
      if (is_black(result)) return result;
      const double side = dot(s.Ng, d) >= 0 ? 1.0 : -1.0;
      const Vec3<double> next = s.P + side * s.offset * s.Ng;
      left = left - max(s.t, 0.0);
      if (!(left > 0)) return result;
      ray.o = cast<float>(next);
    }
  }

  // ---- the equation

  void shade() {
    const HitQueue& hits = scratch.hits;
    for (std::uint32_t h = 0; h < hits.count; ++h) {
      const MaterialRecord& m = frame.materials[hits.material[h]];
      if (m.emits) add(hits.ray[h], m.emission);
    }
    for (std::uint32_t first = 0; first < hits.count;) {
      const int model = frame.materials[hits.material[hits.order[first]]].model;
      std::uint32_t last = first + 1;
      while (last < hits.count && last < first + shade_lanes &&
             frame.materials[hits.material[hits.order[last]]].model == model)
        ++last;
      with_model(ModelId(model),
                 [&]<class Model>() { shade_packet<Model>(frame.fading[model], first, int(last - first)); });
      first = last;
    }
  }

  /// Evaluates the equation for `count` hits of one model, one in each lane; lanes left over repeat the last.
  template <class Model> void shade_packet(const FadingRecord& fading, std::uint32_t first, int count) {
    using F = ShadePack;
    using C = Color<F>;
    const HitQueue& hits = scratch.hits;
    const LightQueue& lights = scratch.lights;
    std::uint32_t hit[shade_lanes];
    Surface<F, C> s;
    Vec3<F> P;
    F R;
    for (int k = 0; k < shade_lanes; ++k) {
      const std::uint32_t h = hit[k] = hits.order[first + min(k, count - 1)];
      set_lane(P.x, k, hits.Px[h]), set_lane(P.y, k, hits.Py[h]), set_lane(P.z, k, hits.Pz[h]);
      set_lane(s.N.x, k, hits.Nx[h]), set_lane(s.N.y, k, hits.Ny[h]), set_lane(s.N.z, k, hits.Nz[h]);
      set_lane(s.V.x, k, hits.Vx[h]), set_lane(s.V.y, k, hits.Vy[h]), set_lane(s.V.z, k, hits.Vz[h]);
      set_lane(R, k, hits.R[h]);
      const MaterialRecord& m = frame.materials[hits.material[h]];
      for (int c = 0; c < color_channels; ++c) {
        set_lane(s.ka[c], k, m.ambient[c]), set_lane(s.kd[c], k, m.diffuse[c]),
            set_lane(s.ks[c], k, m.specular[c]);
      }
      set_lane(s.n, k, m.shininess);
      for (int i = 0; i < max_model_parameters; ++i) set_lane(s.own[i], k, m.own[i]);
    }
    const F minimum(frame.minimum_distance);
    const auto arriving = [&](int l) {
      const auto light = sample_light(l, P);
      const F faded = attenuate(fading.attenuation, light.r, minimum);
      Arriving<F, C> result{light.L, {}};
      for (int c = 0; c < color_channels; ++c) {
        F passes;
        for (int k = 0; k < shade_lanes; ++k)
          set_lane(passes, k, lights.passes[c][std::size_t(l) * hits.count + hit[k]]);
        result.I[c] = passes * (faded * light.I[c]);
      }
      return result;
    };
    C Ia;
    for (int c = 0; c < color_channels; ++c)
      Ia[c] = F(frame.ambient[c]) * attenuate(fading.ambient, R, minimum);

    const C I = illuminate<Model>(s, Ia, frame.light_count, arriving);

    for (int k = 0; k < count; ++k) {
      Rgb color;
      for (int c = 0; c < color_channels; ++c) color[c] = lane(I[c], k);
      add(hits.ray[hit[k]], color);
    }
  }

  /// Adds a ray's colour to its sample.
  void add(std::uint32_t ray, const Rgb& color) {
    const std::uint32_t sample = scratch.rays.sample[ray];
    for (int c = 0; c < color_channels; ++c)
      scratch.samples.color[c][sample] += scratch.rays.weight[c][ray] * color[c];
  }

  // ---- mirror rays and refracted rays

  void follow() {
    const HitQueue& hits = scratch.hits;
    for (std::uint32_t h = 0; h < hits.count; ++h) {
      const MaterialRecord& m = frame.materials[hits.material[h]];
      if (m.reflects || m.transmits) follow(h, m);
    }
  }

  void follow(std::uint32_t h, const MaterialRecord& m) {
    const HitQueue& hits = scratch.hits;
    const std::uint32_t ray = hits.ray[h], sample = scratch.rays.sample[ray];
    const Vec3<double> P = at(hits.Px, hits.Py, hits.Pz, h), N = at(hits.Nx, hits.Ny, hits.Nz, h),
                       V = at(hits.Vx, hits.Vy, hits.Vz, h);
    const Vec3<double> G = at(hits.Gx, hits.Gy, hits.Gz, h);
    Rgb weight;
    for (int c = 0; c < color_channels; ++c) weight[c] = scratch.rays.weight[c][ray];
    const double R = hits.R[h];
    Rgb mirrored = m.reflect;

    Vec3<double> through{};
    bool refracted = false;
    if (m.transmits) {
      refracted = refract(V, N, G, hits.outside[h] ? 1 / m.ior : m.ior, through);
      if (!refracted) {  // total internal reflection: what cannot leave stays, and goes with the mirror ray
        mirrored = mirrored + m.transmit;
        ++counts.refraction;  // asked for, though there is none: so does Haines count in the SPD's tables
      }
    }
    const Rgb mirror_weight = weight * mirrored;
    if (!is_black(mirror_weight) || frame.whitted.trace_black_rays) {
      Vec3<double> mirror = reflect(V, N);
      if (!(dot(mirror, G) > 0))
        mirror = reflect(V, G);  // the shading normal leans too far: do not look into the surface
      push_ray(scratch.next_rays, P, at(hits.sx, hits.sy, hits.sz, h), normalize(mirror), R, mirror_weight,
               sample);
      ++counts.reflection;
    }
    const Rgb through_weight = weight * m.transmit;
    if (refracted && (!is_black(through_weight) || frame.whitted.trace_black_rays)) {
      push_ray(scratch.next_rays, P, at(hits.bx, hits.by, hits.bz, h), normalize(through), R, through_weight,
               sample);
      ++counts.refraction;
    }
  }

  /// Snell: sin(theta') = eta sin(theta), eta the index on V's side over that beyond. False where the light
  /// is reflected totally.
  static bool refract(const Vec3<double>& V, const Vec3<double>& N, const Vec3<double>& G, double eta,
                      Vec3<double>& through) {
    for (const Vec3<double>& n :
         {N, G}) {  // the geometric normal where the shading normal would bend the ray back out
      const double cosine = dot(n, V), k = 1 - eta * eta * (1 - cosine * cosine);
      if (k < 0) return false;
      through = (eta * cosine - sqrt(k)) * n - eta * V;
      if (dot(through, G) < 0) return true;
    }
    return false;
  }

  // ---- the film

  void add_to_pixels(std::uint64_t first, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto pixel = std::uint32_t((first + i) / frame.samples);
      for (int c = 0; c < color_channels; ++c) scratch.pixels.color[c][pixel] += scratch.samples.color[c][i];
    }
  }

  void develop() {
    for (std::uint32_t i = 0; i < pixel_count(); ++i) {
      const std::size_t x = tile.x0 + i % width(), y = tile.y0 + i / width();
      float* to = frame.film + (y * frame.film_width + x) * color_channels;
      for (int c = 0; c < color_channels; ++c) to[c] = float(scratch.pixels.color[c][i] / frame.samples);
    }
  }
};

void render_tile(const Frame& frame, const Tile& tile, Scratch& scratch, RayCounts& counts) {
  TileWork{frame, tile, scratch, counts}.run();
}

}  // namespace

extern const Kernel whitted_kernel;
const Kernel whitted_kernel{LAMBENT_ISA_NAME, render_tile};

}  // namespace LAMBENT_ISA
}  // namespace lambent
