#pragma once
// GGX: the microfacets of a rough surface, by Trowbridge and Reitz (Average irregularity representation of a
// rough surface, 1975); Walter et al., Microfacet models for refraction through rough surfaces, EGSR 2007.
//
//   D(H)  = alpha^2 / (pi ((N.H)^2 (alpha^2 - 1) + 1)^2)
//   G1(V) = 2 (N.V) / (N.V + S(V)),  S(V) = sqrt(alpha^2 + (1 - alpha^2) (N.V)^2)
//   G2    = 2 (N.V) (N.L) / ((N.L) S(V) + (N.V) S(L))   on one side: shadowing and masking depend on height
//           (Heitz, Understanding the masking-shadowing function, JCGT 3(2), 2014)
//
// alpha = roughness^2 (Burley). Directions are drawn by visible normals, G1 D (V.H)+ / (N.V).

#include "scattering/directions.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// Surfaces that are smoother are perfectly so. The directions of queries are rounded to 2^-24: a lobe as
/// narrow as this cannot be told from a single direction.
inline constexpr double narrowest_alpha = 0x1p-20;

/// One lobe of microfacets, as V sees it.
template <class F> class Ggx {
 public:
  Vec3<F> N, V;
  F cosine;  ///< N.V >= 0
  F alpha, alpha2;
  MaskOf<F> perfect;
  F S;         ///< S(V)
  F over_sum;  ///< 1 / (N.V + S(V))

  Ggx() = default;
  /// alpha: 0 to 1. N.V must not be less than zero.
  Ggx(const Vec3<F>& normal, const Vec3<F>& view, const F& width, const F& slimmest) : N(normal), V(view) {
    cosine = min(max(dot(N, V), F(0)), F(1));
    perfect = slimmest < F(narrowest_alpha);
    alpha = max(width, F(narrowest_alpha));
    alpha2 = alpha * alpha;
    S = root(cosine);
    over_sum = F(1) / (cosine + S);
  }
  Ggx(const Vec3<F>& normal, const Vec3<F>& view, const F& width) : Ggx(normal, view, width, width) {}

  F root(const F& c) const { return sqrt(alpha2 + (F(1) - alpha2) * c * c); }

  /// D for a half-vector of any length but zero. The part of H along the surface is a difference of vectors,
  /// which keeps its digits where 1 - (N.H)^2 would lose them.
  F distribution(const Vec3<F>& H) const {
    const F up = dot(N, H);
    const Vec3<F> flat = H - up * N;
    const F square = dot(flat, flat), up2 = up * up, bound = alpha2 * up2 + square;
    const F length2 = square + up2;
    return F(one_over_pi) * alpha2 * (length2 * length2) / (bound * bound);
  }

  struct Reflected {
    F value;    ///< f (N.L) where all of the microfacet's light is reflected.
    F density;  ///< Of L, drawn by visible normals.
    F VH;       ///< V.H = L.H
  };
  /// L: above the surface, with `cosine_L` = N.L > 0.
  Reflected reflected(const Vec3<F>& L, const F& cosine_L) const {
    const Vec3<F> H = L + V;  // |H| = 2 V.H
    const F D = distribution(H);
    const F value = D * (F(0.5) * cosine_L) / (cosine_L * S + cosine * root(cosine_L));
    return {value, F(0.5) * D * over_sum, min(F(0.5) * length(H), F(1))};
  }

  /// A microfacet's normal as V sees them: density G1 D (V.H)+ / (N.V). Stretched, so that alpha were 1, they
  /// mirror V evenly into a cap of the sphere (Dupuy and Benyoub, Sampling visible GGX normals with spherical
  /// caps, HPG 2023).
  Vec3<F> visible_normal(const F& u, const F& v) const {
    const Axes<F> axes = axes_around(N);
    const Vec3<F> across{alpha * dot(axes.x, V), alpha * dot(axes.y, V), cosine};
    const Vec3<F> stretched = normalize(across);
    const F below = v * (F(1) + stretched.z);  // 1 - z of the point on the cap
    const F sine = sqrt(max(below * (F(2) - below), F(0)));
    const SinCos<F> turn = sincos_degrees(F(360) * u);
    const Vec3<F> H{alpha * (sine * turn.cos + stretched.x), alpha * (sine * turn.sin + stretched.y),
                    (F(1) - v) * (F(1) + stretched.z)};
    return to_world(axes, normalize(H));
  }
};

/// Schlick's (1 - cosine)^5 (An inexpensive BRDF model for physically-based rendering, 1994).
template <class F> F schlick_weight(const F& cosine) {
  const F x = F(1) - cosine, x2 = x * x;
  return x2 * x2 * x;
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
