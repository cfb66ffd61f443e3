#pragma once
// How much GGX reflects in all: of light from everywhere, seen from one direction, or from all on average.
//
// The numbers are our own, integrated and fitted by make_albedo_tables.cpp. With S = S(V) of ggx.h and
// s = sqrt(N.V / S), in which the dip at N.V near alpha looks alike for all alpha,
//
//   E = sum of E_ij s^i roughness^j,     B = E (1 - S h)^5,  h = sum of h_ij s^i roughness^j
//
// Glass loses T d, where d has the shape of what GGX loses,
//
//   d = z (1 - z^2) (0.21 + 0.35 z^8) + 0.06 alpha + 0.5 alpha^2 s,   z = s^2,
//
// and T is a table by z, the roughness and eta: E_glass = 1 - T d. From inside the table's steps lie close
// together at the critical angle.
//
// E is too much by 0 to 0.006, so that what makes up for the rest is too little: nothing is gained, and less
// than 1 % lost. So is E_glass, at any roughness, for indices from 1.04 to 3 (tests/scattering).

#include <type_traits>

#include "scattering/albedo_tables.h"
#include "scattering/ggx.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// Reflected shares of a lobe whose Fresnel factor is F0 + (F90 - F0) (1 - V.H)^5.
template <class F> struct GgxAlbedo {
  F all;      ///< E: with F = 1.
  F grazing;  ///< B: with F = (1 - V.H)^5.
  F with(const F& F0, const F& F90) const { return F0 * (all - grazing) + F90 * grazing; }
};

template <class F, int N> F polynomial(const double (&coefficients)[N], const F& x) {
  F sum(coefficients[N - 1]);
  for (int i = N - 2; i >= 0; --i) sum = sum * x + F(coefficients[i]);
  return sum;
}

/// The fits for one roughness, as polynomials of s.
template <class F> class GgxAlbedos {
  static constexpr int E_terms = std::extent_v<decltype(albedo_tables::E)>;
  static constexpr int h_terms = std::extent_v<decltype(albedo_tables::h)>;
  F E_[E_terms], h_[h_terms];
  F roughness_;

 public:
  GgxAlbedos() = default;
  explicit GgxAlbedos(const F& roughness) : roughness_(roughness) {
    for (int i = 0; i < E_terms; ++i) E_[i] = polynomial(albedo_tables::E[i], roughness);
    for (int i = 0; i < h_terms; ++i) h_[i] = polynomial(albedo_tables::h[i], roughness);
  }
  /// E of a direction with that cosine; root: S of the cosine. 1 where the surface is perfectly smooth.
  F all(const Ggx<F>& ggx, const F& cosine, const F& root) const {
    return select(ggx.perfect, F(1), all_by(sqrt(cosine / root)));
  }
  GgxAlbedo<F> operator()(const Ggx<F>& ggx, const F& cosine, const F& root) const {
    const F s = sqrt(cosine / root), E = all_by(s);
    F h = h_[h_terms - 1];
    for (int i = h_terms - 2; i >= 0; --i) h = h * s + h_[i];
    const F x = max(F(1) - root * h, F(0)), x2 = x * x;
    return {select(ggx.perfect, F(1), E), select(ggx.perfect, schlick_weight(cosine), E * (x2 * x2 * x))};
  }
  /// Averages over the hemisphere, weighted by the cosine.
  GgxAlbedo<F> average(const Ggx<F>& ggx) const {
    return {F(1) - average_lost(ggx),
            select(ggx.perfect, F(1.0 / 21), polynomial(albedo_tables::average_B, roughness_))};
  }
  /// 1 - <E>, with its digits where it is small.
  F average_lost(const Ggx<F>& ggx) const {
    return select(ggx.perfect, F(0), ggx.alpha2 * polynomial(albedo_tables::average_lost, roughness_));
  }

 private:
  F all_by(const F& s) const {
    F E = E_[E_terms - 1];
    for (int i = E_terms - 2; i >= 0; --i) E = E * s + E_[i];
    return min(E, F(1));
  }
};

/// Directions for light that has met several facets, (N.L) (1 - E(L)): of a smooth surface it is found where
/// N.L is about alpha or less, 1 - E(L) being about as alpha^2 / (alpha^2 + (N.L)^2). So their density is
///
///   (N.L) / (pi log(1 + 1 / alpha^2) (alpha^2 + (N.L)^2)).
template <class F> class GgxBounces {
  F alpha2_, octaves_, factor_;

 public:
  GgxBounces() = default;
  explicit GgxBounces(const Ggx<F>& ggx) : alpha2_(ggx.alpha2) {
    octaves_ = log2(F(1) + F(1) / alpha2_);
    factor_ = F(one_over_pi / 0.69314718055994530942) / octaves_;
  }
  F density(const F& cosine) const { return factor_ * cosine / (alpha2_ + cosine * cosine); }
  F cosine(const F& v) const { return min(sqrt(alpha2_ * (exp2(v * octaves_) - F(1))), F(1)); }
};

/// Where on the table's first axis, 0 to 1, a direction stands, z = N.V / S(V). Outside the steps gather at
/// both ends. From inside the first seven tenths are what a smooth surface reflects totally, up to the
/// critical angle; they gather at both of its ends.
///   critical   z at the critical angle; 1 outside
template <class F> F place_of_glass(const F& z, const F& critical, const MaskOf<F>& inside) {
  const F one(1), two(2), half(0.5), below = select(inside, F(0.7), one);
  const F y = min(z / critical, one);
  const auto lower = y < half;
  const F root = sqrt(two * select(lower, y, one - y));
  const F place = select(lower, F(0.625) * root / (one + F(0.25) * root), one - half * root);
  const F above = (z - critical) / select(inside, one - critical, one);
  return select(both(inside, z >= critical), below + (one - below) * max(above, F(0)), below * place);
}

/// What rough glass reflects and refracts in all, seen from V. eta: 1/3 to 3; what is beyond is as at its
/// end.
template <class F> F glass_albedo(const Ggx<F>& ggx, const F& roughness, const F& eta) {
  constexpr int nx = std::extent_v<decltype(albedo_tables::glass), 1>,
                nr = std::extent_v<decltype(albedo_tables::glass), 2>,
                nt = std::extent_v<decltype(albedo_tables::glass), 3>;
  const float* const table = &albedo_tables::glass[0][0][0][0];
  const F one(1), t = (eta - one) / (eta + one), least(0.02);
  const auto inside = t < F(0);
  const F within = min(max(abs(t), least), F(0.5)), across = (within - least) * F(1 / 0.48);
  const F mu = F(2) * sqrt(within) / (one + within);  // of the critical angle: sqrt(1 - eta^2)
  const F critical = select(inside, mu / ggx.root(mu), one), z = ggx.cosine / ggx.S;
  F whole[3], rest[3];
  const auto split = [&](int axis, const F& at, int nodes) {
    const F x = at * F(nodes - 1), magic(0x1.8p52);
    whole[axis] = max(min((x - F(0.5) + magic) - magic, F(nodes - 2)), F(0));
    rest[axis] = x - whole[axis];
  };
  split(0, place_of_glass(z, critical, inside), nx), split(1, roughness, nr), split(2, sqrt(across), nt);
  const F cell = ((select(inside, F(nx), F(0)) + whole[0]) * F(nr) + whole[1]) * F(nt) + whole[2];
  double cells[lanes_of<F>];
  if constexpr (lanes_of<F> == 1) cells[0] = cell;
  else cell.store(cells);
  F T(0);
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    const F value =
        gather<F>([&](int lane) { return double(table[int(cells[lane]) + (i * nr + j) * nt + k]); });
    const F weight =
        (i ? rest[0] : one - rest[0]) * (j ? rest[1] : one - rest[1]) * (k ? rest[2] : one - rest[2]);
    T = T + weight * value;
  }
  // Below the table's first index it goes to nothing as the index goes to 1.
  T = T * min(abs(t) / least, one);
  const F z2 = z * z, z4 = z2 * z2;
  const F d =
      z * (one - z2) * (F(0.21) + F(0.35) * (z4 * z4)) + ggx.alpha * (F(0.06) + F(0.5) * ggx.alpha * sqrt(z));
  return select(ggx.perfect, one, one - max(T * d, F(0)));
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
