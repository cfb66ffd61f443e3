#pragma once
// Optical constants: what Fresnel's equations ask of a metal or a glass. Measured values, with their sources.

#include <array>
#include <string_view>
#include <variant>
#include <vector>

#include "spectra/spectrum.h"

namespace lambent {

/// The complex index of refraction n + i k of a metal.
struct MetalConstants {
  Samples n, k;
};

/// n^2 = 1 + sum b l^2 / (l^2 - c), l the wavelength in micrometres (Sellmeier 1871). Terms that are not
/// there are 0.
struct Sellmeier {
  std::array<double, 4> b{}, c{};
};
/// n = a + b / l^2, l in micrometres (Cauchy 1836).
struct Cauchy {
  double a = 1.5, b = 0;
};
/// The index of refraction of something clear.
using GlassIndex = std::variant<Cauchy, Sellmeier, Samples>;
double index_at(const GlassIndex& glass, double wavelength);

/// Fraunhofer's lines, by which glasses are told apart.
inline constexpr double line_d = 587.5618, line_F = 486.1327, line_C = 656.2725;
/// A glass by its index at d and its Abbe number (n_d - 1) / (n_F - n_C).
Cauchy glass_of(double index_d, double abbe);
double abbe_of(const GlassIndex& glass);

struct NamedMetal {
  const char* name;
  const char* source;
  MetalConstants constants;
};
struct NamedGlass {
  const char* name;
  const char* title;
  const char* source;
  GlassIndex index;
};
const std::vector<NamedMetal>& metals();
const std::vector<NamedGlass>& glasses();

/// n and k of red, green and blue, for pictures whose colours are no more than that. n is the mean over what
/// the channel sees; k is what gives the metal the colour that its spectrum has at normal incidence in D65's
/// light. Where that lies outside of sRGB, as gold's does, no channel reflects more than the metal does at
/// its best wavelength.
struct RgbConstants {
  Rgb n, k;
};
RgbConstants rgb_constants(const MetalConstants& metal);

/// What a metal reflects at normal incidence: ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2).
double normal_reflectance(double n, double k);

}  // namespace lambent
