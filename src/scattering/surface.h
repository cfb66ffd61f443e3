#pragma once
// The contract of scattering: what a surface point is made of, and what is asked of it.
//
// A kind of surface is handed one point and one direction, and answers how much light comes from there (BSDF
// times cosine), or is handed three numbers in [0, 1) and answers a direction. It knows no scene, no light,
// and no random number of its own. A kind is a class template over the number F (a double, or a packet of
// them) and the colour C = Color<F, channels>:
//
//   explicit Kind(const ScatterSurface<F, C>&)              what both questions need, once for each point
//   Evaluated<F, C> evaluate(const Vec3<F>& L) const
//   Scattered<F, C> scatter(F u, F v, F w) const
//   C albedo() const                                        for a denoiser
//   MaskOf<F> only_perfect() const
//
// Shading normals: N decides on the lobe; G decides what is above the surface and what is below. Light that
// the lobe would send to the wrong side of G is lost, for evaluate() and for scatter() alike.

#include <cstdint>

#include "illumination/metallic_roughness.h"
#include "math/color.h"
#include "math/pack.h"
#include "math/vec.h"

namespace lambent {

/// A packet's lanes share one.
enum class ScatterKind : std::uint8_t { lecture_phong, lecture_blinn, metallic_roughness, metal, glass };

/// Members that the kind does not name may have any value. Of packets, all are nothing until they are set.
template <class F, class C> struct ScatterSurface {
  Vec3<F> N;                        ///< Unit shading normal, on the side that V is on.
  Vec3<F> G;                        ///< Unit geometric normal, G.V >= 0.
  Vec3<F> V;                        ///< Unit vector from the point to where the ray came from.
  MaskOf<F> outside;                ///< Whether V is on the outside of the surface.
  C kd, ks;                         ///< Lecture: Lambert's albedo, and the lobe's along the normal.
  F n;                              ///< Lecture: the lobe's exponent, >= 0.
  C reflect, transmit;              ///< Lecture: factors of the mirrored and of the refracted ray.
  F ior;                            ///< Lecture and glass: index of refraction, inside over outside.
  MetallicRoughnessOf<F, C> rough;  ///< Metallic-roughness.
  F roughness;                      ///< Metal and glass: alpha = roughness^2; 0: perfectly smooth.
  C eta, k;                         ///< Metal: complex index of refraction, over that outside.
};

/// How much of what arrives along L leaves along V.
template <class F, class C> struct Evaluated {
  C value;    ///< f |N.L|; without what is perfect.
  F density;  ///< With which scatter() chooses L, per solid angle.
};

/// A direction chosen by scatter().
template <class F, class C> struct Scattered {
  Vec3<F> L;    ///< Unit vector away from the point.
  C weight;     ///< f |N.L| / density; of what is perfect the factor over the probability that it was chosen.
                ///< Black where nothing leaves: then L may be any direction.
  F density;    ///< Per solid angle, of everything that could have chosen L; 0 where perfect, or black.
  F eta_scale;  ///< Square of the index beyond over that on V's side where light was refracted and its
                ///< radiance with it, else 1: weight * eta_scale is a share of power, for Russian roulette.
  F spread;     ///< About how much wider the ray leaves, radians.
  MaskOf<F> perfect;  ///< Mirrored, refracted or let through without width.
  MaskOf<F> through;  ///< L is on the other side of the surface.
};

}  // namespace lambent
