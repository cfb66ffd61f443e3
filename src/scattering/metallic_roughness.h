#pragma once
// glTF 2.0's metallic-roughness material (appendix B) with KHR_materials_ior, _specular, _transmission and
// _clearcoat, made to keep its energy. With metallic m, transmission t, base colour b:
//
//   d = min(((ior - 1) / (ior + 1))^2 specular_color, 1) specular
//   F0 = (1 - m) d + m b,  F90 = (1 - m) specular + m
//
//   GGX reflection   (F0 + (F90 - F0) (1 - V.H)^5) D G2 / (4 (N.V) (N.L))
//   its further      m M (1 - E(V)) (1 - E(L)) / (pi (1 - <E>)),  M = <F>^2 <E> / (1 - <F> (1 - <E>))
//   bounces          (Kulla and Conty, Revisiting physically based shading at Imageworks, SIGGRAPH 2017
//                    course; <F> squared: Hill, A multi-faceted exploration, 2018); <F> = (1 + 20 b) / 21 is
//                    Schlick's average
//   diffuse          (1 - m) (1 - t) b (1 - Ed(V)) (1 - Ed(L)) / (pi (1 - <Ed>))
//                    (Kelemen and Szirmay-Kalos, A microfacet based coupled specular-matte BRDF model with
//                    importance sampling, Eurographics 2001)
//   transmission     (1 - m) t b of what is not reflected: the lobe (1 - F(V.H)) D G2 ... turned through the
//                    surface, and (1 - E(V)) (1 - E(L)) / (pi (1 - <E>)). Thin: nothing is bent.
//
// E is what GGX reflects of light from everywhere where F = 1, Ed where F is the dielectric's, with the
// largest channel of d, as glTF has it; <> their averages over the hemisphere. A non-metal's light that meets
// several facets goes on into what lies below. All this is reciprocal, and what is white reflects everything:
//
//   F0 (E - B) + F90 B + m M (1 - E) + (1 - m) (1 - Ed) = 1 where b = 1.
//
// The coat, a second GGX with F0 = 0.04 on top, reflects Ec(V) and leaves 1 - Ec(V) for all that is below, on
// the way in only, as KHR_materials_clearcoat has it: energy is kept, reciprocity is not.

#include "scattering/ggx.h"
#include "scattering/ggx_albedo.h"
#include "scattering/surface.h"

namespace lambent {
inline namespace LAMBENT_ISA {

template <class F, class C> class MetallicRoughnessScattering {
  using Truth = MaskOf<F>;
  static constexpr int channels = channels_of<C>;
  const ScatterSurface<F, C>& s_;
  Ggx<F> base_, coat_;
  GgxAlbedos<F> albedos_;
  GgxAlbedo<F> E_;
  GgxBounces<F> further_;
  C F0_, F90_less_F0_;
  C bounces_;  ///< m M / (pi (1 - <E>)), what is to be multiplied by (1 - E(V)) (1 - E(L)).
  C matte_;    ///< (1 - m) (1 - t) b / (pi (1 - <Ed>))
  C tint_;     ///< (1 - m) t b
  F d_, d90_;  ///< Of the dielectric, the largest channel.
  F under_;    ///< 1 / (pi (1 - <E>))
  F below_;    ///< What the coat leaves.
  F coating_;  ///< clearcoat
  // Probabilities: of the coat's facets; of the base's, of the matte, and of further bounces; of the base's
  // facets and of further bounces, turned through the surface.
  F p_coat_, p_base_, p_flat_, p_bounced_, p_through_, p_bounced_through_;
  Truth any_coat_, any_through_;

  F dielectric_albedo(const GgxAlbedo<F>& E) const { return E.with(d_, d90_); }

 public:
  explicit MetallicRoughnessScattering(const ScatterSurface<F, C>& s) : s_(s) {
    const auto& m = s.rough;
    const F one(1), zero(0);
    const Vec3<F> N = facing_normal(s.N, s.G, s.V);
    base_ = Ggx<F>(N, s.V, m.roughness * m.roughness);
    albedos_ = GgxAlbedos<F>(m.roughness);
    E_ = albedos_(base_, base_.cosine, base_.S);
    further_ = GgxBounces<F>(base_);
    const GgxAlbedo<F> average = albedos_.average(base_);
    const F average_lost = albedos_.average_lost(base_);

    const F ratio = (m.ior - one) / (m.ior + one), dielectric = ratio * ratio;
    const F nonmetal = one - m.metallic;
    d90_ = m.specular, d_ = zero;
    const F F90 = nonmetal * m.specular + m.metallic;
    under_ = select(base_.perfect, zero, F(one_over_pi) / average_lost);
    C metal_bounces, reflected;
    for (int c = 0; c < channels; ++c) {
      const F d = min(dielectric * m.specular_color[c], one) * m.specular;
      d_ = max(d_, d);
      F0_[c] = nonmetal * d + m.metallic * m.base_color[c];
      F90_less_F0_[c] = F90 - F0_[c];
      reflected[c] = E_.with(F0_[c], F90);
      const F schlick = F(1.0 / 21) * (one + F(20) * m.base_color[c]);
      metal_bounces[c] = m.metallic * schlick * schlick * average.all / (one - schlick * average_lost);
    }
    bounces_ = under_ * metal_bounces;
    const F Ed = dielectric_albedo(E_), lost = one - E_.all;
    const F matte = nonmetal * (one - m.transmission);
    const F remains = one - dielectric_albedo(average);
    matte_ = (matte * select(remains > zero, F(one_over_pi) / remains, zero)) * m.base_color;
    tint_ = (nonmetal * m.transmission) * m.base_color;

    p_coat_ = zero, below_ = one;
    coating_ = m.clearcoat;
    any_coat_ = coating_ > zero;
    if (any(any_coat_)) {
      coat_ = Ggx<F>(N, s.V, m.clearcoat_roughness * m.clearcoat_roughness);
      const GgxAlbedo<F> E = GgxAlbedos<F>(m.clearcoat_roughness)(coat_, coat_.cosine, coat_.S);
      p_coat_ = coating_ * E.with(F(coat_F0), one);
      below_ = one - p_coat_;
    }
    const F base_mean = mean(m.base_color), through = nonmetal * m.transmission * base_mean;
    any_through_ = through > zero;
    p_base_ = below_ * mean(reflected);
    p_flat_ = below_ * (matte * base_mean * (one - Ed));
    p_bounced_ = below_ * (mean(metal_bounces) * lost);
    p_through_ = below_ * (through * (E_.all - Ed));
    p_bounced_through_ = below_ * (through * lost);
    const F sum = p_coat_ + p_base_ + p_flat_ + p_bounced_ + p_through_ + p_bounced_through_;
    const F share = select(sum > zero, one / sum, zero);
    p_coat_ = share * p_coat_, p_base_ = share * p_base_, p_flat_ = share * p_flat_,
    p_bounced_ = share * p_bounced_;
    p_through_ = share * p_through_, p_bounced_through_ = share * p_bounced_through_;
  }

  static constexpr double coat_F0 = 0.04;

  Evaluated<F, C> evaluate(const Vec3<F>& L) const {
    const Vec3<F>& N = base_.N;
    const F nl = dot(N, L), cosine = abs(nl), gl = dot(s_.G, L);
    const Truth above = both(nl > F(0), gl > F(0)), below = both(nl < F(0), gl < F(0));
    // Light from below is light from above, turned through the surface.
    const Vec3<F> upper = select(nl < F(0), L - F(2) * nl * N, L);
    const auto facet = base_.reflected(upper, cosine);
    const GgxAlbedo<F> E = albedos_(base_, cosine, base_.root(cosine));
    const F lost = (F(1) - E_.all) * (F(1) - E.all), schlick = schlick_weight(facet.VH);
    const F value = select(base_.perfect, F(0), facet.value),
            density = select(base_.perfect, F(0), facet.density);
    const F matte = (F(1) - dielectric_albedo(E_)) * (F(1) - dielectric_albedo(E));
    const F flat = F(one_over_pi) * cosine, bounced = further_.density(cosine);
    Evaluated<F, C> out;
    for (int c = 0; c < channels; ++c)
      out.value[c] =
          (F0_[c] + F90_less_F0_[c] * schlick) * value + cosine * (matte * matte_[c] + lost * bounces_[c]);
    out.density = p_base_ * density + p_flat_ * flat + p_bounced_ * bounced;
    if (any(any_through_)) {
      const F passed = (F(1) - (d_ + (d90_ - d_) * schlick)) * value + cosine * (lost * under_);
      out.value = select(below, passed * tint_, out.value);
      out.density = select(below, p_through_ * density + p_bounced_through_ * bounced, out.density);
    }
    const Truth sees = either(above, both(below, any_through_));
    out.value = select(sees, below_ * out.value, C{});
    out.density = select(sees, out.density, F(0));
    if (any(any_coat_)) {
      const auto coat = coat_.reflected(upper, cosine);
      const Truth adds = both(above, any_coat_, !coat_.perfect);
      const F fresnel = F(coat_F0) + F(1 - coat_F0) * schlick_weight(coat.VH);
      const F more = select(adds, coating_ * fresnel * coat.value, F(0));
      for (int c = 0; c < channels; ++c) out.value[c] = out.value[c] + more;
      out.density = out.density + select(adds, p_coat_ * coat.density, F(0));
    }
    return out;
  }

  Scattered<F, C> scatter(const F& u, const F& v, const F& w) const {
    const Vec3<F>& N = base_.N;
    F edge = p_coat_;
    const Truth coat = w < edge;
    edge = edge + p_base_;
    const Truth base = both(w < edge, !coat);
    edge = edge + p_flat_;
    const Truth flat = both(w < edge, !coat, !base);
    edge = edge + p_bounced_;
    const Truth bounced = both(w < edge, !coat, !base, !flat);
    const Truth upwards = either(either(coat, base), either(flat, bounced));
    edge = edge + p_through_;
    const Truth through = both(w < edge, !upwards);
    const Truth bounced_through = both(!upwards, !through, p_bounced_through_ > F(0));
    const Truth downwards = either(through, bounced_through);

    Vec3<F> L = N;
    const Truth several = either(bounced, bounced_through);
    if (any(either(flat, several))) {
      F cosine = lambert_cosine(v);
      if (any(several)) cosine = select(several, further_.cosine(v), cosine);
      L = direction_around(axes_around(N), cosine, u);
    }
    const Truth facets = either(base, through);
    if (any(facets)) L = select(facets, reflect(s_.V, base_.visible_normal(u, v)), L);
    if (any(coat)) L = select(coat, reflect(s_.V, coat_.visible_normal(u, v)), L);
    // Where the lobe reaches below the horizon, nothing leaves; so it must not be turned up again.
    const Truth above = dot(N, L) > F(0);
    L = select(downwards, L - F(2) * dot(N, L) * N, L);
    const Evaluated<F, C> here = evaluate(L);

    Truth perfect = both(facets, base_.perfect);
    if (any(coat)) perfect = either(perfect, both(coat, coat_.perfect));
    const Vec3<F> straight = select(through, -s_.V, mirror_direction(s_.N, s_.G, s_.V));
    const F schlick = schlick_weight(base_.cosine);
    C factor;
    for (int c = 0; c < channels; ++c) {
      const F mirrored = F0_[c] + F90_less_F0_[c] * schlick;
      const F passed = tint_[c] * (F(1) - (d_ + (d90_ - d_) * schlick));
      factor[c] =
          select(coat, F(coat_F0) + F(1 - coat_F0) * schlick, below_ * select(through, passed, mirrored));
      factor[c] = select(coat, coating_ * factor[c], factor[c]);
    }
    Scattered<F, C> out;
    const Truth leaves = both(!perfect, above, here.density > F(0), either(upwards, downwards));
    out.density = select(leaves, here.density, F(0));
    const F chance = select(coat, p_coat_, select(through, p_through_, p_base_));
    const F over = F(1) / select(leaves, here.density, chance);
    out.weight = select(either(leaves, perfect), over * select(perfect, factor, here.value), C{});
    out.L = select(perfect, straight, L);
    out.perfect = perfect;
    out.through = downwards;
    out.eta_scale = F(1);
    out.spread = select(perfect, F(0), spread_of(out.density));
    return out;
  }

  C albedo() const {
    C out;
    for (int c = 0; c < channels; ++c) {
      const F matte = (F(1) - dielectric_albedo(E_)) * (F(1) - s_.rough.metallic) * s_.rough.base_color[c];
      const F bounced = select(base_.perfect, F(0), bounces_[c] / under_ * (F(1) - E_.all));
      const F base = E_.with(F0_[c], F0_[c] + F90_less_F0_[c]) + bounced + matte;
      out[c] = min((F(1) - below_) + below_ * base, F(1));
    }
    return out;
  }
  Truth only_perfect() const {
    const Truth coat_too = any(any_coat_) ? either(!any_coat_, coat_.perfect) : Truth(true);
    return both(base_.perfect, coat_too, !(p_flat_ > F(0)));
  }
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
