#pragma once
// Glass: reflection and refraction by the exact Fresnel equations, at microfacets or, with roughness 0, at a
// perfectly smooth surface. With eta the index beyond over that on V's side, for radiance:
//
//   reflection   f = F(V.H) D G2 / (4 (N.V) (N.L)) / E(V)
//   refraction   f = (1 - F(V.H)) D min(G1(V), G1(L)) |V.H| |L.H| / ((N.V) |N.L| (V.H + eta L.H)^2) / E(V)
//
// (Walter et al. 2007). Two things differ from there, and leave less to make up for at great roughness: what
// is refracted is masked once, not twice, as it hardly changes its direction where eta is near 1 (Ashikhmin,
// Premoze and Shirley, A microfacet-based BRDF generator, 2000, of directions that lie together); and where a
// facet would refract light upwards, N.L > 0, it reflects it all.
//
// E(V) is how much of the light from everywhere, reflected and refracted, leaves along V by a single facet.
// Light that meets several facets leaves with the shape of that which meets one (Turquin, Practical multiple
// scattering compensation for microfacet models, 2019). So no energy is lost at any roughness. Reciprocal is
// f E(V), with the factor eta^2 for refraction, but for those facets that would refract upwards.
//
// Refraction spreads or gathers radiance by eta^2, which `eta_scale` says.

#include "illumination/fresnel.h"
#include "scattering/ggx.h"
#include "scattering/ggx_albedo.h"
#include "scattering/surface.h"

namespace lambent {
inline namespace LAMBENT_ISA {

template <class F, class C> class GlassScattering {
  using Truth = MaskOf<F>;
  static constexpr int channels = channels_of<C>;
  const ScatterSurface<F, C>& s_;
  F eta_, over_eta_;
  Ggx<F> ggx_;
  F over_E_;

 public:
  explicit GlassScattering(const ScatterSurface<F, C>& s) : s_(s) {
    eta_ = select(s.outside, s.ior, F(1) / s.ior);
    over_eta_ = F(1) / eta_;
    const F alpha = s.roughness * s.roughness;
    // The less it bends, the less it blurs; with eta = 1 nothing is there.
    ggx_ = Ggx<F>(facing_normal(s.N, s.G, s.V), s.V, alpha, alpha * min(abs(eta_ - F(1)), F(1)));
    over_E_ = F(1) / glass_albedo(ggx_, s.roughness, eta_);
  }

  Evaluated<F, C> evaluate(const Vec3<F>& L) const {
    const F nl = dot(ggx_.N, L), gl = dot(s_.G, L), cosine = abs(nl);
    const Truth above = both(nl > F(0), gl > F(0)), below = both(nl < F(0), gl < F(0));
    // The half-vector, of any length, on N's side.
    const Vec3<F> sum = select(above, L + s_.V, s_.V + eta_ * L);
    const Vec3<F> H = select(dot(ggx_.N, sum) < F(0), -sum, sum);
    const F over_length = F(1) / length(H);
    const F VH = over_length * dot(s_.V, H), LH = over_length * dot(L, H);
    const F D = ggx_.distribution(H), fresnel = facet(VH, over_length * dot(ggx_.N, H)).reflectance;
    const F root = ggx_.root(cosine);
    // Reflection.
    const F mirrored = fresnel * D * (F(0.5) * cosine) / (cosine * ggx_.S + ggx_.cosine * root);
    const F mirrored_density = fresnel * F(0.5) * D * ggx_.over_sum;
    // Refraction. G1(V) / (N.V) = 2 / (N.V + S(V)); shadowed: G1(L) / G1(V).
    const F width = VH + eta_ * LH;
    const F bent = (F(1) - fresnel) * (F(2) * D * ggx_.over_sum) * (VH * abs(LH)) / (width * width);
    const F shadowed = cosine * (ggx_.cosine + ggx_.S) / (ggx_.cosine * (cosine + root));
    const F bent_value = bent * min(shadowed, F(1)), bent_density = bent * eta_ * eta_;
    const Truth reflects = both(above, !ggx_.perfect);
    const Truth refracts = both(both(below, VH > F(0), LH < F(0)), !ggx_.perfect);
    const F value = over_E_ * select(reflects, mirrored, bent_value);
    const Truth sees = either(reflects, refracts);
    return {grey<F, channels>(select(sees, value, F(0))),
            select(sees, select(reflects, mirrored_density, bent_density), F(0))};
  }

  Scattered<F, C> scatter(const F& u, const F& v, const F& w) const {
    Vec3<F> H = ggx_.N;
    if (!all(ggx_.perfect)) H = select(ggx_.perfect, H, ggx_.visible_normal(u, v));
    const F VH = dot(s_.V, H);
    const Facet struck = facet(VH, dot(ggx_.N, H));
    const Truth mirrored = w < struck.reflectance;
    const Vec3<F> L =
        normalize(select(mirrored, F(2) * VH * H - s_.V, struck.along_H * H - over_eta_ * s_.V));
    const Evaluated<F, C> here = evaluate(L);
    const Truth leaves = both(here.density > F(0), agree(mirrored, dot(ggx_.N, L) > F(0)));
    Scattered<F, C> out;
    out.density = select(leaves, here.density, F(0));
    out.weight = select(leaves, (F(1) / select(leaves, here.density, F(1))) * here.value, C{});
    out.L = L;
    out.perfect = ggx_.perfect;
    out.through = !mirrored;
    if (any(ggx_.perfect)) {
      const Refracted<F> straight = refract_direction(s_.N, s_.G, s_.V, eta_);
      const Truth passes = both(ggx_.perfect, !mirrored, straight.passes);
      out.L = select(ggx_.perfect, select(passes, straight.L, mirror_direction(s_.N, s_.G, s_.V)), L);
      out.weight =
          select(ggx_.perfect, grey<F, channels>(select(passes, over_eta_ * over_eta_, F(1))), out.weight);
      out.through = either(passes, both(!ggx_.perfect, out.through));
    }
    out.eta_scale = select(out.through, eta_ * eta_, F(1));
    out.spread = select(ggx_.perfect, F(0), spread_of(out.density));
    return out;
  }

  C albedo() const { return grey<F, channels>(F(1)); }
  Truth only_perfect() const { return ggx_.perfect; }

 private:
  struct Facet {
    F reflectance;
    F along_H;  ///< What refracts is along_H H - V / eta.
  };
  /// What a facet does with light from V.
  Facet facet(const F& VH, const F& NH) const {
    const F cosine = min(max(VH, F(0)), F(1));
    const F k = F(1) - over_eta_ * over_eta_ * ((F(1) - cosine) * (F(1) + cosine));
    const F along_H = over_eta_ * cosine - sqrt(max(k, F(0)));
    const Truth upwards = along_H * NH >= over_eta_ * ggx_.cosine;
    const F fresnel = fresnel_dielectric(cosine, eta_);
    return {select(both(upwards, !ggx_.perfect), F(1), fresnel), along_H};
  }
  /// Where both are true or neither is.
  static Truth agree(const Truth& a, const Truth& b) { return either(both(a, b), both(!a, !b)); }
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
