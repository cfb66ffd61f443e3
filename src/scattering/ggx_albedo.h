#pragma once
// How much GGX reflects in all: of light from everywhere, seen from one direction, or from all on average.

#include "scattering/ggx.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// Reflected shares of a lobe whose Fresnel factor is F0 + (F90 - F0) (1 - V.H)^5.
template <class F> struct GgxAlbedo {
  F all;      ///< E: with F = 1.
  F grazing;  ///< B: with F = (1 - V.H)^5.
  F with(const F& F0, const F& F90) const { return F0 * (all - grazing) + F90 * grazing; }
};

namespace ggx_fits {
inline constexpr double E_of_cosine[9][7] = {
    {1.00438811, -3.8103749e-05, 0.000179886929, 0.00430326913, -0.0228963488, 0.0354918243, -0.0171668962},
    {-0.788960164, -0.322906442, 0.119433928, -15.6333329, 92.2379676, -141.48289, 65.8876622},
    {13.8745977, 0.158591087, 85.1617436, -152.134547, -727.53589, 1613.47247, -839.72646},
    {-99.9464694, 47.7444526, -1323.73217, 4741.81482, -3039.15774, -3209.27343, 2907.37557},
    {365.159488, -322.077978, 6950.97529, -28138.1416, 35496.5273, -13002.2996, -1404.39061},
    {-748.892878, 842.730332, -16859.5883, 71409.9257, -104655.522, 59825.2948, -9739.77458},
    {871.498376, -1062.2914, 20824.4748, -90202.5294, 140078.262, -90185.4809, 19614.9771},
    {-537.66989, 645.915837, -12748.7635, 55936.1236, -88998.8038, 59976.1351, -14245.3137},
    {136.76207, -151.714913, 3069.54713, -13570.55, 21733.1888, -14858.138, 3635.63946}};
inline constexpr double h_of_cosine[6][6] = {
    {5.52507538, -26.9237742, 75.1628238, -115.964977, 90.1477782, -27.5001036},
    {-109.138351, 804.433137, -2270.88946, 3092.21362, -2042.92619, 526.401181},
    {509.78804, -3411.92991, 8450.04557, -9644.81676, 4991.19478, -894.045045},
    {-886.675508, 5246.45777, -10452.2005, 7485.28952, -24.1480559, -1367.70946},
    {669.361571, -3357.83885, 4228.0002, 2208.99425, -7140.28675, 3388.73872},
    {-187.869226, 746.351329, -36.1525092, -3007.82425, 4104.25766, -1616.67579}};
inline constexpr double average_E[8] = {0.999681967, 0.0217212037, -0.31110643, 2.20776135,
                                        -12.2233804, 20.6665499,   -15.4487382, 4.50090862};
inline constexpr double average_B[8] = {0.0484714904, -0.0626873366, 0.958389667, -6.45119204,
                                        17.0764071,   -22.227361,    14.3018745,  -3.6407429};
}  // namespace ggx_fits

template <class F, int N> F polynomial(const double (&coefficients)[N], const F& x) {
  F sum(coefficients[N - 1]);
  for (int i = N - 2; i >= 0; --i) sum = sum * x + F(coefficients[i]);
  return sum;
}

/// Of light from everywhere, seen from a direction with that cosine; root: ggx.root(cosine).
template <class F>
GgxAlbedo<F> ggx_albedo(const Ggx<F>& ggx, const F& cosine, const F& root, const F& roughness) {
  const F s = sqrt(cosine / root);
  F E(0), h(0);
  for (int i = 8; i >= 0; --i) E = E * s + polynomial(ggx_fits::E_of_cosine[i], roughness);
  for (int i = 5; i >= 0; --i) h = h * s + polynomial(ggx_fits::h_of_cosine[i], roughness);
  E = min(E, F(1));
  const F x = max(F(1) - root * h, F(0)), x2 = x * x;
  return {select(ggx.perfect, F(1), E), select(ggx.perfect, schlick_weight(cosine), E * (x2 * x2 * x))};
}
/// Averages over the hemisphere, weighted by the cosine.
template <class F> GgxAlbedo<F> ggx_average_albedo(const Ggx<F>& ggx, const F& roughness) {
  return {select(ggx.perfect, F(1), polynomial(ggx_fits::average_E, roughness)),
          select(ggx.perfect, F(1.0 / 21), polynomial(ggx_fits::average_B, roughness))};
}

/// What rough glass reflects and refracts in all.
template <class F> F glass_albedo(const F& cosine, const F& roughness, const F& eta) {
  (void)cosine, (void)roughness, (void)eta;
  return F(1);
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
