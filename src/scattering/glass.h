#pragma once
// Glass: reflection and refraction by the exact Fresnel equations, at microfacets or, with roughness 0, at a
// perfectly smooth surface. With eta the index beyond over that on V's side, for radiance:
//
//   reflection   f = F(V.H) D G2 / (4 (N.V) (N.L)) / E(V)
//   refraction   f = (1 - F(V.H)) D G1(V) G1(L) |V.H| |L.H| / ((N.V) |N.L| (V.H + eta L.H)^2) / E(V)
//
// (Walter et al. 2007). E(V) is what of the light from everywhere, reflected and refracted, would leave along
// V without it: light that meets several facets leaves with the shape of that which meets one (Turquin,
// Practical multiple scattering compensation for microfacet models, 2019). So no energy is lost at any
// roughness. f E(V) is reciprocal, with the factor eta^2 for refraction; f itself is where the surface is
// smooth.
//
// Refraction spreads or gathers radiance by eta^2, which `eta_scale` says.

#include "scattering/fresnel.h"
#include "scattering/ggx.h"
#include "scattering/ggx_albedo.h"
#include "scattering/surface.h"

namespace lambent {
inline namespace LAMBENT_ISA {

template <class F, class C> class GlassScattering {
  using Truth = MaskOf<F>;
  static constexpr int channels = channels_of<C>;
  const ScatterSurface<F, C>& s_;
  F eta_;
  Ggx<F> ggx_;
  F over_E_;

 public:
  explicit GlassScattering(const ScatterSurface<F, C>& s) : s_(s) {
    eta_ = select(s.outside, s.ior, F(1) / s.ior);
    const F alpha = s.roughness * s.roughness;
    // The less it bends, the less it blurs; with eta = 1 nothing is there.
    ggx_ = Ggx<F>(facing_normal(s.N, s.G, s.V), s.V, alpha, alpha * min(abs(eta_ - F(1)), F(1)));
    over_E_ = F(1) / glass_albedo(ggx_.cosine, s.roughness, eta_);
  }

  Evaluated<F, C> evaluate(const Vec3<F>& L) const {
    const F nl = dot(ggx_.N, L), gl = dot(s_.G, L), cosine = abs(nl);
    const Truth above = both(nl > F(0), gl > F(0)), below = both(nl < F(0), gl < F(0));
    // The half-vector, of any length, on N's side.
    const Vec3<F> sum = select(above, L + s_.V, s_.V + eta_ * L);
    const Vec3<F> H = select(dot(ggx_.N, sum) < F(0), -sum, sum);
    const F over_length = F(1) / length(H);
    const F VH = over_length * dot(s_.V, H), LH = over_length * dot(L, H);
    const F D = ggx_.distribution(H), fresnel = fresnel_dielectric(min(max(VH, F(0)), F(1)), eta_);
    const F root = ggx_.root(cosine);
    // Reflection.
    const F mirrored = fresnel * D * (F(0.5) * cosine) / (cosine * ggx_.S + ggx_.cosine * root);
    const F mirrored_density = fresnel * F(0.5) * D * ggx_.over_sum;
    // Refraction. G1(V) / (N.V) = 2 / (N.V + S(V)), and G1(L) likewise.
    const F width = VH + eta_ * LH;
    const F bent = (F(1) - fresnel) * (F(2) * D * ggx_.over_sum) * (VH * abs(LH)) / (width * width);
    const F bent_value = bent * (F(2) * cosine / (cosine + root)), bent_density = bent * eta_ * eta_;
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
    const F VH = min(max(dot(s_.V, H), F(0)), F(1)), fresnel = fresnel_dielectric(VH, eta_);
    const Truth mirrored = w < fresnel;
    const F bend = F(1) / eta_;
    const F inside2 = F(1) - bend * bend * ((F(1) - VH) * (F(1) + VH));
    const Vec3<F> bent = (bend * VH - sqrt(max(inside2, F(0)))) * H - bend * s_.V;
    const Vec3<F> L = normalize(select(mirrored, F(2) * VH * H - s_.V, bent));
    const Evaluated<F, C> here = evaluate(L);
    const Truth leaves = both(here.density > F(0), select_truth(mirrored, dot(ggx_.N, L) > F(0)));
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
      out.weight = select(ggx_.perfect, grey<F, channels>(select(passes, bend * bend, F(1))), out.weight);
      out.through = either(passes, both(!ggx_.perfect, out.through));
    }
    out.eta_scale = select(out.through, eta_ * eta_, F(1));
    out.spread = select(ggx_.perfect, F(0), spread_of(out.density));
    return out;
  }

  C albedo() const { return grey<F, channels>(F(1)); }
  Truth only_perfect() const { return ggx_.perfect; }

 private:
  /// Whether `above` is as `mirrored` says.
  static Truth select_truth(const Truth& mirrored, const Truth& above) {
    return either(both(mirrored, above), both(!mirrored, !above));
  }
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
