#include "spectra/optical.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace lambent {
namespace {

struct Measured {
  double wavelength, n, k;
};
MetalConstants table(std::initializer_list<Measured> rows) {
  MetalConstants result;
  for (const Measured& row : rows) {
    result.n.wavelengths.push_back(row.wavelength), result.n.values.push_back(row.n);
    result.k.wavelengths.push_back(row.wavelength), result.k.values.push_back(row.k);
  }
  return result;
}

constexpr const char* noble =
    "Johnson and Christy, Optical constants of the noble metals, Phys. Rev. B 6, 1972";
constexpr const char* transition =
    "Johnson and Christy, Optical constants of transition metals, Phys. Rev. B 9, 1974";
constexpr const char* schott = "SCHOTT, optical glass catalogue, 2017";

}  // namespace

const std::vector<NamedMetal>& metals() {
  static const std::vector<NamedMetal> all{
      {"gold", noble,
       table({{354.2, 1.5, 1.866},
              {367.9, 1.48, 1.895},
              {381.5, 1.46, 1.933},
              {397.4, 1.47, 1.952},
              {413.3, 1.46, 1.958},
              {430.5, 1.45, 1.948},
              {450.9, 1.38, 1.914},
              {471.4, 1.31, 1.849},
              {495.9, 1.04, 1.833},
              {520.9, 0.62, 2.081},
              {548.6, 0.43, 2.455},
              {582.1, 0.29, 2.863},
              {616.8, 0.21, 3.272},
              {659.5, 0.14, 3.697},
              {704.5, 0.13, 4.103},
              {756, 0.14, 4.542},
              {821.1, 0.16, 5.083}})},
      {"silver", noble,
       table({{354.2, 0.1, 1.419},
              {367.9, 0.07, 1.657},
              {381.5, 0.05, 1.864},
              {397.4, 0.05, 2.07},
              {413.3, 0.05, 2.275},
              {430.5, 0.04, 2.462},
              {450.9, 0.04, 2.657},
              {471.4, 0.05, 2.869},
              {495.9, 0.05, 3.093},
              {520.9, 0.05, 3.324},
              {548.6, 0.06, 3.586},
              {582.1, 0.05, 3.858},
              {616.8, 0.06, 4.152},
              {659.5, 0.05, 4.483},
              {704.5, 0.04, 4.838},
              {756, 0.03, 5.242},
              {821.1, 0.04, 5.727}})},
      {"copper", noble,
       table({{354.2, 1.37, 1.916},
              {367.9, 1.36, 1.975},
              {381.5, 1.33, 2.045},
              {397.4, 1.32, 2.116},
              {413.3, 1.28, 2.207},
              {430.5, 1.25, 2.305},
              {450.9, 1.24, 2.397},
              {471.4, 1.25, 2.483},
              {495.9, 1.22, 2.564},
              {520.9, 1.18, 2.608},
              {548.6, 1.02, 2.577},
              {582.1, 0.7, 2.704},
              {616.8, 0.3, 3.205},
              {659.5, 0.22, 3.747},
              {704.5, 0.21, 4.205},
              {756, 0.24, 4.665},
              {821.1, 0.26, 5.18}})},
      {"aluminium",
       "Rakic, Algorithm for the determination of intrinsic optical constants of metal films: application to "
       "aluminum, Appl. Opt. 34, 1995",
       table({{326.28, 0.31474, 3.9165},
              {364.66, 0.39877, 4.3957},
              {413.28, 0.52135, 5.0008},
              {442.8, 0.6079, 5.3676},
              {476.87, 0.7278, 5.7781},
              {516.6, 0.8734, 6.2418},
              {563.57, 1.0728, 6.7839},
              {619.93, 1.366, 7.4052},
              {652.25, 1.5724, 7.7354},
              {688.81, 1.8301, 8.0601},
              {729.32, 2.1606, 8.3565},
              {774.91, 2.6154, 8.4914},
              {794.78, 2.7675, 8.3866}})},
      {"chromium", transition,
       table({{354, 1.84, 2.64},
              {368, 1.87, 2.69},
              {381, 1.92, 2.74},
              {397, 2, 2.83},
              {413, 2.08, 2.93},
              {431, 2.19, 3.04},
              {451, 2.33, 3.14},
              {471, 2.51, 3.24},
              {496, 2.75, 3.3},
              {521, 2.94, 3.33},
              {549, 3.18, 3.33},
              {582, 3.22, 3.3},
              {617, 3.17, 3.3},
              {659, 3.09, 3.34},
              {704, 3.05, 3.39},
              {756, 3.08, 3.42},
              {821, 3.2, 3.48}})},
      {"nickel", transition,
       table({{354, 1.74, 2.32},
              {368, 1.7, 2.4},
              {381, 1.72, 2.48},
              {397, 1.72, 2.57},
              {413, 1.7, 2.69},
              {431, 1.71, 2.82},
              {451, 1.73, 2.95},
              {471, 1.78, 3.09},
              {496, 1.82, 3.25},
              {521, 1.85, 3.42},
              {549, 1.92, 3.61},
              {582, 1.96, 3.8},
              {617, 1.99, 4.02},
              {659, 1.99, 4.26},
              {704, 2.06, 4.5},
              {756, 2.13, 4.73},
              {821, 2.26, 4.97}})},
      {"titanium", transition,
       table({{354, 1.82, 2.87},
              {368, 1.9, 2.9},
              {381, 1.99, 2.93},
              {397, 2.08, 2.95},
              {413, 2.14, 2.98},
              {431, 2.21, 3.01},
              {451, 2.27, 3.04},
              {471, 2.32, 3.1},
              {496, 2.36, 3.19},
              {521, 2.44, 3.3},
              {549, 2.54, 3.43},
              {582, 2.6, 3.58},
              {617, 2.67, 3.72},
              {659, 2.76, 3.84},
              {704, 2.86, 3.96},
              {756, 3, 4.01},
              {821, 3.21, 4.01}})},
  };
  return all;
}

const std::vector<NamedGlass>& glasses() {
  const auto square = [](double x) { return x * x; };
  static const std::vector<NamedGlass> all{
      {"bk7", "crown glass, N-BK7", schott,
       Sellmeier{{1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}}},
      {"f2", "flint glass, F2", schott,
       Sellmeier{{1.34533359, 0.209073176, 0.937357162}, {0.00997743871, 0.0470450767, 111.886764}}},
      {"sf11", "dense flint glass, N-SF11", schott,
       Sellmeier{{1.73759695, 0.313747346, 1.89878101}, {0.013188707, 0.0623068142, 155.23629}}},
      {"silica", "fused silica",
       "Malitson, Interspecimen comparison of the refractive index of fused silica, J. Opt. Soc. Am. 55, "
       "1965",
       Sellmeier{{0.6961663, 0.4079426, 0.8974794},
                 {square(0.0684043), square(0.1162414), square(9.896161)}}},
      {"diamond", "diamond", "Peter, Z. Phys. 15, 1923",
       Sellmeier{{0.3306, 4.3356}, {square(0.1750), square(0.1060)}}},
      {"sapphire", "sapphire, the ordinary ray",
       "Malitson and Dodge, Refractive index and birefringence of synthetic sapphire, J. Opt. Soc. Am. 62, "
       "1972",
       Sellmeier{{1.4313493, 0.65054713, 5.3414021},
                 {square(0.0726631), square(0.1193242), square(18.028251)}}},
      {"water", "water of 20 degrees C",
       "Daimon and Masumura, Measurement of the refractive index of distilled water, Appl. Opt. 46, 2007",
       Sellmeier{{0.5684027565, 0.1726177391, 0.02086189578, 0.1130748688},
                 {0.005101829712, 0.01821153936, 0.02620722293, 10.69792721}}},
  };
  return all;
}

double index_at(const GlassIndex& glass, double wavelength) {
  const double l = wavelength * 1e-3, l2 = l * l;
  if (const auto* cauchy = std::get_if<Cauchy>(&glass)) return cauchy->a + cauchy->b / l2;
  if (const auto* samples = std::get_if<Samples>(&glass)) return at(*samples, wavelength);
  const auto& sellmeier = std::get<Sellmeier>(glass);
  double square = 1;
  for (std::size_t i = 0; i < sellmeier.b.size(); ++i) square += sellmeier.b[i] * l2 / (l2 - sellmeier.c[i]);
  return std::sqrt(square);
}

Cauchy glass_of(double index_d, double abbe) {
  const auto inverse_square = [](double line) { return 1e6 / (line * line); };
  const double b = (index_d - 1) / (abbe * (inverse_square(line_F) - inverse_square(line_C)));
  return {index_d - b * inverse_square(line_d), b};
}

double abbe_of(const GlassIndex& glass) {
  return (index_at(glass, line_d) - 1) / (index_at(glass, line_F) - index_at(glass, line_C));
}

double normal_reflectance(double n, double k) {
  return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
}

RgbConstants rgb_constants(const MetalConstants& metal) {
  const auto reflectance = [&](double nm) { return normal_reflectance(at(metal.n, nm), at(metal.k, nm)); };
  const Rgb color = rgb_of(reflectance);
  Rgb n{}, sums{};
  double best = 0, wavelength = shortest_wavelength;
  for (const Rgb& weight : rgb_weights()) {
    best = std::max(best, reflectance(wavelength));
    for (int c = 0; c < 3; ++c) {
      const double seen = std::max(weight[c], 0.0);
      n[c] += seen * at(metal.n, wavelength);
      sums[c] += seen;
    }
    wavelength += table_step;
  }
  RgbConstants result{};
  for (int c = 0; c < 3; ++c) {
    const double r = std::clamp(color[c], 0.0, best), mean = n[c] / sums[c];
    const double square = (r * (mean + 1) * (mean + 1) - (mean - 1) * (mean - 1)) / (1 - r);
    result.n[c] = mean;
    result.k[c] = std::sqrt(std::max(square, 0.0));
  }
  return result;
}

}  // namespace lambent
