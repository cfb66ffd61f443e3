#pragma once
// The lecture's material in the rendering equation: Lambert's cosine, a lobe that keeps its energy, a perfect
// mirror, and perfect refraction.
//
//   phong         f = Kd / pi + Ks (n + 2) / (2 pi) ((R.L)+)^n,  R the mirror image of V
//                 (Lafortune and Willems, Using the modified Phong reflectance model for physically based
//                 rendering, 1994)
//   blinn_phong   f = Kd / pi + Ks (n + 2) (n + 4) / (8 pi (n + 2^(-n/2))) (N.H)^n
//
// Both factors make the lobe's albedo 1 for light along the normal: with theta the angle between L and N = V,
//
//   integral of cos^n(theta) cos(theta) over the hemisphere = 2 pi / (n + 2)
//   integral of cos^n(theta / 2) cos(theta)                 = 8 pi (n + 2^(-n/2)) / ((n + 2) (n + 4))
//
// At other angles it is less: the horizon cuts the lobe, and N.L (for blinn_phong about its square) makes it
// darker. Nothing makes up for that; both are reciprocal as they are, and gain nothing.
//
// Nothing shines brighter than it is lit: where Kd + Ks + reflect + transmit is more than 1 in any channel,
// all of them are divided by the largest sum, which keeps their hue.

#include "scattering/directions.h"
#include "scattering/surface.h"

namespace lambent {
inline namespace LAMBENT_ISA {

enum class LectureLobe : std::uint8_t { phong, blinn_phong };

template <LectureLobe lobe, class F, class C> class LectureScattering {
  using Truth = MaskOf<F>;
  static constexpr int channels = channels_of<C>;
  const ScatterSurface<F, C>& s_;
  C kd_, ks_, reflect_, transmit_;
  Vec3<F> R_;                                ///< V mirrored about N.
  F diffuse_, glossy_, mirror_, refracted_;  ///< Probabilities.
  F factor_, density_factor_;                ///< Of the lobe's power.
  Refracted<F> bent_;
  Truth has_lobe_;

 public:
  explicit LectureScattering(const ScatterSurface<F, C>& s) : s_(s) {
    const F excess = largest(s.kd + s.ks + s.reflect + s.transmit);
    const F scale = F(1) / max(excess, F(1));
    kd_ = scale * s.kd, ks_ = scale * s.ks, reflect_ = scale * s.reflect, transmit_ = scale * s.transmit;
    const Truth transmits = !is_black(transmit_);
    bent_.passes = Truth(false);
    if (any(transmits)) {
      bent_ = refract_direction(s.N, s.G, s.V, select(s.outside, s.ior, F(1) / s.ior));
      // Total reflection: what cannot leave goes with the mirrored light.
      reflect_ = select(bent_.passes, reflect_, reflect_ + transmit_);
      transmit_ = select(bent_.passes, transmit_, C{});
    }
    R_ = reflect(s.V, s.N);
    diffuse_ = mean(kd_), glossy_ = mean(ks_), mirror_ = mean(reflect_), refracted_ = mean(transmit_);
    const F sum = diffuse_ + glossy_ + mirror_ + refracted_;
    const F share = select(sum > F(0), F(1) / sum, F(0));
    diffuse_ = share * diffuse_, glossy_ = share * glossy_, mirror_ = share * mirror_,
    refracted_ = share * refracted_;
    has_lobe_ = glossy_ > F(0);
    density_factor_ = F(0.5 * one_over_pi) * (s.n + F(1));
    if constexpr (lobe == LectureLobe::phong) {
      factor_ = F(0.5 * one_over_pi) * (s.n + F(2));
    } else {
      factor_ = F(0.125 * one_over_pi) * (s.n + F(2)) * (s.n + F(4)) / (s.n + exp2(F(-0.5) * s.n));
    }
  }

  Evaluated<F, C> evaluate(const Vec3<F>& L) const {
    const F nl = dot(s_.N, L);
    const Truth above = both(nl > F(0), dot(s_.G, L) > F(0));
    const F cosine = select(above, nl, F(0));
    const F flat = F(one_over_pi) * cosine;
    Evaluated<F, C> out{flat * kd_, diffuse_ * flat};
    if (any(both(above, has_lobe_))) {
      F power, density;
      if constexpr (lobe == LectureLobe::phong) {
        power = pow(max(dot(R_, L), F(0)), s_.n);
        density = density_factor_ * power;
      } else {
        const Vec3<F> sum = L + s_.V;
        const F square = dot(sum, sum);
        const F over = select(square > F(0), F(1) / sqrt(square), F(0));
        power = pow(max(over * dot(s_.N, sum), F(0)), s_.n);
        density = density_factor_ * power * (F(0.5) * over);  // 1 / (4 V.H), V.H = |L + V| / 2
      }
      out.value = out.value + (factor_ * power * cosine) * ks_;
      out.density = out.density + select(above, glossy_ * density, F(0));
    }
    return out;
  }

  Scattered<F, C> scatter(const F& u, const F& v, const F& w) const {
    const Truth flat = w < diffuse_, wide = w < diffuse_ + glossy_,
                mirrored = both(!wide, w < diffuse_ + glossy_ + mirror_),
                refracted = both(!wide, !mirrored, refracted_ > F(0));
    const Truth shiny = both(wide, !flat);
    F cosine = lambert_cosine(v);
    if (any(shiny)) cosine = select(shiny, power_cosine(v, s_.n), cosine);
    Vec3<F> L;
    if constexpr (lobe == LectureLobe::phong) {
      L = direction_around(axes_around(select(shiny, R_, s_.N)), cosine, u);
    } else {
      const Vec3<F> around = direction_around(axes_around(s_.N), cosine, u);
      L = select(shiny, reflect(s_.V, around), around);
    }
    const Evaluated<F, C> here = evaluate(L);
    Scattered<F, C> out;
    const Truth leaves = both(wide, here.density > F(0));
    out.density = select(leaves, here.density, F(0));
    const F over = F(1) / select(leaves, here.density, select(mirrored, mirror_, refracted_));
    const C factor = select(mirrored, reflect_, transmit_);
    out.perfect = either(mirrored, refracted);
    out.through = refracted;
    out.weight = select(either(leaves, out.perfect), over * select(leaves, here.value, factor), C{});
    const Vec3<F> straight = mirror_direction(s_.N, s_.G, s_.V);
    out.L = select(mirrored, straight, L);
    if (any(refracted)) out.L = select(refracted, bent_.L, out.L);
    out.eta_scale = F(1);
    out.spread = select(wide, spread_of(out.density), F(0));
    return out;
  }

  C albedo() const { return kd_ + ks_ + reflect_ + transmit_; }
  Truth only_perfect() const { return !either(diffuse_ > F(0), has_lobe_); }
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
