#pragma once
// A metal by its measured index of refraction: GGX with the exact Fresnel equations, and the light that meets
// several facets:
//
//   f = F(V.H) D G2 / (4 (N.V) (N.L)) + M (1 - E(V)) (1 - E(L)) / (pi (1 - <E>)),
//   M = <F>^2 <E> / (1 - <F> (1 - <E>))     (Kulla and Conty 2017, with <F> squared: metallic_roughness.h)
//
// <F> is Schlick's average (1 + 20 F(1)) / 21 with the exact reflection along the normal. Reciprocal, and
// where F = 1 all light is reflected. With roughness 0 a perfect mirror.

#include "illumination/fresnel.h"
#include "scattering/ggx.h"
#include "scattering/ggx_albedo.h"
#include "scattering/surface.h"

namespace lambent {
inline namespace LAMBENT_ISA {

template <class F, class C> class MetalScattering {
  using Truth = MaskOf<F>;
  static constexpr int channels = channels_of<C>;
  const ScatterSurface<F, C>& s_;
  Ggx<F> ggx_;
  GgxAlbedos<F> albedos_;
  GgxAlbedo<F> E_;
  GgxBounces<F> further_;
  C bounces_;           ///< M / (pi (1 - <E>))
  F facets_, bounced_;  ///< Probabilities.

  C fresnel(const F& cosine) const {
    C out;
    for (int c = 0; c < channels; ++c) out[c] = fresnel_conductor(cosine, s_.eta[c], s_.k[c]);
    return out;
  }

 public:
  explicit MetalScattering(const ScatterSurface<F, C>& s) : s_(s) {
    ggx_ = Ggx<F>(facing_normal(s.N, s.G, s.V), s.V, s.roughness * s.roughness);
    albedos_ = GgxAlbedos<F>(s.roughness);
    E_ = albedos_(ggx_, ggx_.cosine, ggx_.S);
    further_ = GgxBounces<F>(ggx_);
    const F lost = albedos_.average_lost(ggx_);
    const F under = select(ggx_.perfect, F(0), F(one_over_pi) / lost);
    C reflected;
    for (int c = 0; c < channels; ++c) {
      const F F0 = fresnel_conductor_at_normal(s.eta[c], s.k[c]), schlick = F(1.0 / 21) * (F(1) + F(20) * F0);
      bounces_[c] = schlick * schlick * (F(1) - lost) / (F(1) - schlick * lost);
      reflected[c] = E_.with(F0, F(1));
    }
    const F first = mean(reflected), further = mean(bounces_) * (F(1) - E_.all);
    bounces_ = under * bounces_;
    const F over = F(1) / (first + further);
    facets_ = over * first, bounced_ = over * further;
  }

  Evaluated<F, C> evaluate(const Vec3<F>& L) const {
    const F nl = dot(ggx_.N, L);
    const Truth above = both(nl > F(0), dot(s_.G, L) > F(0), !ggx_.perfect);
    const F cosine = max(nl, F(0));
    const auto facet = ggx_.reflected(L, cosine);
    const F E = albedos_.all(ggx_, cosine, ggx_.root(cosine));
    const C value = facet.value * fresnel(facet.VH) + (cosine * (F(1) - E_.all) * (F(1) - E)) * bounces_;
    const F density = facets_ * facet.density + bounced_ * further_.density(cosine);
    return {select(above, value, C{}), select(above, density, F(0))};
  }

  Scattered<F, C> scatter(const F& u, const F& v, const F& w) const {
    const Truth facets = w < facets_;
    Vec3<F> L = reflect(s_.V, ggx_.visible_normal(u, v));
    if (!all(facets)) L = select(facets, L, direction_around(axes_around(ggx_.N), further_.cosine(v), u));
    const Evaluated<F, C> here = evaluate(L);
    const Truth leaves = here.density > F(0);
    Scattered<F, C> out;
    out.density = here.density;
    const F over = F(1) / select(leaves, here.density, F(1));
    out.perfect = ggx_.perfect;
    out.weight = over * here.value;
    out.L = L;
    if (any(ggx_.perfect)) {
      out.weight = select(ggx_.perfect, fresnel(ggx_.cosine), out.weight);
      out.L = select(ggx_.perfect, mirror_direction(s_.N, s_.G, s_.V), L);
    }
    out.through = Truth(false);
    out.eta_scale = F(1);
    out.spread = select(ggx_.perfect, F(0), spread_of(out.density));
    return out;
  }

  C albedo() const { return fresnel(ggx_.cosine); }
  Truth only_perfect() const { return ggx_.perfect; }
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
