#pragma once
// Painted surfaces: what textures, the colours of vertices and opacity make of a material at one point. And
// the picture around the scene. One point at a time; the kernel packs them again.
//
// A ray sees a disc of a surface, not a point: `width` is its diameter across the ray, in scene units. Where
// it falls at a slant it sees an ellipse, 1 / cos longer. (Akenine-Moeller et al., Improved shader and
// texture level of detail using ray cones, JCGT 10(1), 2021.)

#include "accel/coordinates.h"
#include "illumination/fresnel.h"
#include "illumination/metallic_roughness.h"
#include "integrators/frame.h"
#include "integrators/texture_lookup.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// A material at one point.
struct Paint {
  Rgb ka, kd, ks, emission, reflect, transmit;
  double n, ior;
  double curvature;  ///< SurfaceCoordinates'.
  double lobe;       ///< How much wider mirror rays leave than they came, radians.
  bool gap;          ///< There is no surface here.
  Vec3<double> N;    ///< Tilted by normal and bump maps; on the outside.
  MetallicRoughnessOf<double, Rgb> rough;
  double opacity, occlusion;
};

namespace detail {

inline Footprint footprint_of(const Vec3<double>& G, const Vec3<double>& d, double width,
                              const Vec3<double>& du, const Vec3<double>& dv) {
  Vec3<double> across = cross(G, d);
  const double sine = length(across), cosine = max(abs(dot(G, d)), 1e-3);
  Vec3<double> ignored;
  if (sine > 1e-6) across = across / sine;
  else axes_across(G, across, ignored);
  const Vec3<double> minor = (0.5 * width) * across, major = (0.5 * width / cosine) * cross(across, G);
  return {{dot(du, major), dot(dv, major)}, {dot(du, minor), dot(dv, minor)}};
}

inline Footprint in_map(const TextureMap& map, const Footprint& f) {
  return {map_step(map, f.major), map_step(map, f.minor)};
}

/// Unit vectors T along growing u and B along growing v, as far as they go at right angles with N.
struct Tangents {
  Vec3<double> T, B;
};
inline Tangents tangents_at(const SurfaceCoordinates& at, int set, const Vec3<double>& N) {
  const auto upright = [&](const Vec3<double>& v) { return v - dot(v, N) * N; };
  Vec3<double> T = upright(at.tangent);
  double sign = at.bitangent_sign;
  if (!(dot(T, T) > 0)) {
    // P grows with u across the way that v grows.
    T = cross(at.dv[set], N);
    if (dot(T, at.du[set]) < 0) T = -T;
    sign = dot(cross(N, T), at.dv[set]) < 0 ? -1 : 1;
  }
  if (!(dot(T, T) > 0)) {
    Vec3<double> B;
    axes_across(N, T, B);
    return {T, B};
  }
  T = normalize(T);
  return {T, sign * cross(N, T)};
}

inline Vec3<double> tilted(const Vec3<double>& N, const Vec3<double>& by, const Vec3<double>& G) {
  if (!(dot(by, by) > 0)) return N;
  const Vec3<double> n = normalize(by);
  // Not below the surface itself.
  const double low = 0.01 - dot(n, G);
  return low > 0 ? normalize(n + low * G) : n;
}

}  // namespace detail

/// The surface `ids` at P, seen along `d` over `width`, as it is given: a metallic-roughness material's
/// numbers are in `rough`, and `opacity` counts nowhere yet. N and G: the shading and the geometric normal,
/// outside.
inline Paint paint_as_given(const Frame& frame, const HitIds<std::int32_t>& ids, std::uint32_t material,
                            const Vec3<double>& P, const Vec3<double>& N, const Vec3<double>& G,
                            const Vec3<double>& d, double width) {
  const MaterialRecord& m = frame.unpainted[material];
  const SurfaceCoordinates at = coordinates_at(frame.world, ids, P);
  Paint out{m.ambient,  m.diffuse,   m.specular, m.emission,   m.reflect,
            m.transmit, m.shininess, m.ior,      at.curvature, 0,
            false,      N,           m.rough,    m.opacity,    1};
  if (!m.white || m.alpha == Alpha::mask) out.opacity *= at.color[3];
  MetallicRoughnessOf<double, Rgb>& rough = out.rough;
  const Rgb vertex_color = m.white ? grey(1.0) : Rgb{at.color[0], at.color[1], at.color[2]};
  if (m.is_rough) rough.base_color = rough.base_color * vertex_color;
  out.ka = out.ka * vertex_color, out.kd = out.kd * vertex_color;
  if (m.unlit) out.emission = out.emission * vertex_color;

  Footprint seen[2];
  for (int set = 0; set < 2; ++set) seen[set] = detail::footprint_of(G, d, width, at.du[set], at.dv[set]);
  for (int i = 0; i < m.map_count; ++i) {
    const MaterialMap& one = m.maps[i];
    const TextureMap& map = one.map;
    const TextureRecord& texture = frame.textures[map.texture];
    const Vec2<double> uv = map_uv(map, at.uv[map.uv_set]);
    const Footprint footprint = detail::in_map(map, seen[map.uv_set]);
    const Texel texel = look_up(texture, uv, footprint, map);
    const double number = map.offset + map.gain * number_of(map, texel);
    Rgb color;
    for (int c = 0; c < color_channels; ++c) color[c] = map.offset + map.gain * texel.c[c];
    switch (one.slot) {
      case MapSlot::ambient:
        out.ka = out.ka * color;
        break;
      case MapSlot::diffuse:
        out.kd = out.kd * color;
        break;
      case MapSlot::specular:
        out.ks = out.ks * color;
        break;
      case MapSlot::shininess:
        out.n *= number;
        break;
      case MapSlot::reflect:
        out.reflect = out.reflect * color;
        break;
      case MapSlot::transmit:
        out.transmit = out.transmit * color;
        break;
      case MapSlot::emission:
        out.emission = out.emission * color;
        break;
      case MapSlot::opacity:
        out.opacity *= number;
        break;
      case MapSlot::occlusion:
        out.occlusion *= 1 + map.strength * (number - 1);
        break;
      case MapSlot::normal: {
        const auto [T, B] = detail::tangents_at(at, map.uv_set, N);
        const double x = map.strength * (2 * texel.c[0] - 1), y = map.strength * (2 * texel.c[1] - 1),
                     z = max(2 * texel.c[2] - 1, 0.0);
        out.N = detail::tilted(N, x * T + y * B + z * N, G);
        break;
      }
      case MapSlot::bump: {
        // The slope between points half a footprint apart, or half a texel where that is more.
        const double step_u = max(0.5 / texture.levels[0].width,
                                  max(abs(footprint.major.x), abs(footprint.minor.x))),
                     step_v = max(0.5 / texture.levels[0].height,
                                  max(abs(footprint.major.y), abs(footprint.minor.y)));
        const auto height = [&](double u, double v) {
          return map.gain * number_of(map, look_up(texture, {u, v}, footprint, map));
        };
        const double by_u = (height(uv.x + step_u, uv.y) - height(uv.x - step_u, uv.y)) / (2 * step_u),
                     by_v = (height(uv.x, uv.y + step_v) - height(uv.x, uv.y - step_v)) / (2 * step_v);
        const auto& k = map.matrix;
        Vec3<double> slope =
            (by_u * k[0] + by_v * k[3]) * at.du[map.uv_set] + (by_u * k[1] + by_v * k[4]) * at.dv[map.uv_set];
        slope = slope - dot(slope, N) * N;
        out.N = detail::tilted(out.N, out.N - map.strength * slope, G);
        break;
      }
      case MapSlot::base_color:
        rough.base_color = rough.base_color * color;
        break;
      case MapSlot::metallic:
        rough.metallic *= number;
        break;
      case MapSlot::roughness:
        rough.roughness *= number;
        break;
      case MapSlot::specular_factor:
        rough.specular *= number;
        break;
      case MapSlot::specular_color:
        rough.specular_color = rough.specular_color * color;
        break;
      case MapSlot::transmission:
        rough.transmission *= number;
        break;
      case MapSlot::clearcoat:
        rough.clearcoat *= number;
        break;
      case MapSlot::clearcoat_roughness:
        rough.clearcoat_roughness *= number;
        break;
    }
  }
  if (m.alpha == Alpha::mask) out.gap = out.opacity < m.alpha_cutoff, out.opacity = 1;
  else out.opacity = min(max(out.opacity, 0.0), 1.0);
  return out;
}

/// The same in the lecture's numbers: metal and roughness as Ka, Kd, Ks, n, and what lies behind a surface
/// that is not opaque as part of `transmit`.
inline Paint paint(const Frame& frame, const HitIds<std::int32_t>& ids, std::uint32_t material,
                   const Vec3<double>& P, const Vec3<double>& N, const Vec3<double>& G, const Vec3<double>& d,
                   double width) {
  const MaterialRecord& m = frame.unpainted[material];
  Paint out = paint_as_given(frame, ids, material, P, N, G, d, width);
  if (m.is_rough) {
    const LectureMaterial<double, Rgb> lecture = lecture_material(out.rough);
    out.ka = lecture.ka, out.kd = lecture.kd, out.ks = lecture.ks;
    out.reflect = lecture.reflect, out.transmit = lecture.transmit, out.n = lecture.n;
    out.lobe = 2 * out.rough.roughness * out.rough.roughness;
  }
  out.ka = out.occlusion * out.ka;
  if (frame.pass)
    for (Rgb* color : {&out.ka, &out.kd, &out.ks, &out.emission, &out.reflect, &out.transmit})
      *color = in_pass(*frame.pass, *color);
  const double opacity = out.opacity;
  if (out.gap || opacity == 1) return out;
  for (Rgb* color : {&out.ka, &out.kd, &out.ks, &out.emission, &out.reflect, &out.transmit})
    *color = opacity * *color;
  out.transmit = out.transmit + grey(1 - opacity);
  return out;
}

/// Whether a ray along `d` goes on as if there were nothing, where it has met a surface of a material with
/// gaps.
inline bool is_gap(const Frame& frame, const HitIds<std::int32_t>& ids, std::uint32_t material,
                   const SurfacePoint<double>& s, const Vec3<double>& d, double width) {
  const MaterialRecord& m = frame.unpainted[material];
  if (m.one_sided && dot(s.Ng, d) > 0) return true;
  return m.alpha == Alpha::mask && paint(frame, ids, material, s.P, s.N, s.Ng, d, width).gap;
}

/// What a surface leaves of light that goes straight through it; black where it blocks.
inline Rgb share_through(const Frame& frame, const HitIds<std::int32_t>& ids, std::uint32_t material,
                         const SurfacePoint<double>& s, const Vec3<double>& d) {
  const MaterialRecord& m = frame.materials[material];
  Rgb share = m.transmit;
  if (m.painted || m.gaps || frame.world.geometries[ids.geometry].colors) {
    const Paint here = paint(frame, ids, material, s.P, s.N, s.Ng, d, 0);
    if (here.gap) return grey(1.0);
    share = here.transmit;
  }
  if (!frame.whitted.colored_shadows) return {};
  // Straight on, so that light meets the far side at the angle that it had outside.
  if (m.boundary == Boundary::glass)
    for (int c = 0; c < color_channels; ++c)
      share[c] *= 1 - fresnel_dielectric(min(abs(dot(s.Ng, d)), 1.0), m.eta[c]);
  return share;
}

/// Where the picture around the scene is seen along a direction. Its middle lies along -z, before its turn; u
/// grows to the right as seen from inside. `across`: the horizontal part of the direction.
inline Vec2<double> environment_uv(const EnvironmentRecord& e, const Vec3<double>& along, double& across) {
  const Vec3<double> d = e.z_up ? Vec3<double>{along.x, along.z, -along.y} : along;
  across = sqrt(d.x * d.x + d.z * d.z);
  return {0.5 + turns(d.x, -d.z) + e.turn, 0.5 + 2 * turns(d.y, across)};
}

/// What a ray sees that meets nothing; `spread`: the angle that it covers.
inline Rgb background_along(const Frame& frame, const Vec3<double>& along, double spread) {
  const EnvironmentRecord& e = frame.environment;
  if (!e.texture.levels) return frame.background;
  double across;
  const Vec2<double> uv = environment_uv(e, along, across);
  const double turn = 0.5 * spread * (0.5 / 3.141592653589793);
  const Footprint footprint{{min(turn / max(across, 1e-6), 0.5), 0}, {0, 2 * turn}};
  TextureMap map;
  map.wrap_v = Wrap::clamp;
  const Texel texel = look_up(e.texture, uv, footprint, map);
  Rgb color;
  for (int c = 0; c < color_channels; ++c) color[c] = frame.background[c] * texel.c[c];
  return frame.pass ? in_pass(*frame.pass, color) : color;
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
