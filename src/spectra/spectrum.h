#pragma once
// Quantities against wavelength: what spectra are given by. Wavelengths are in nanometres.

#include <variant>
#include <vector>

#include "math/color.h"

namespace lambent {

/// The wavelengths that the program knows of; light beyond them is not seen.
inline constexpr double shortest_wavelength = 360, longest_wavelength = 780;

/// A quantity by its samples: straight lines between them, constant beyond them.
struct Samples {
  std::vector<double> wavelengths;  ///< Growing.
  std::vector<double> values;       ///< As many; one at least.
};
double at(const Samples& samples, double wavelength);

/// The light of a black body (Planck 1901).
struct Blackbody {
  double kelvin = 6500;
};
/// Its power per wavelength, of no particular unit.
double at(const Blackbody& body, double wavelength);

/// The light of a lamp: power per wavelength, of any unit.
using LightSpectrum = std::variant<Blackbody, Samples>;
/// The same relative to D65, and as bright as D65 to the eye (Y): what a lamp of this spectrum is where white
/// is 1.
class RelativeLight {
 public:
  /// `intensity`: a factor on it.
  explicit RelativeLight(LightSpectrum spectrum, double intensity = 1);
  double at(double wavelength) const;

 private:
  LightSpectrum spectrum_;
  double scale_ = 1;
};

/// What is said of a colour at every wavelength, as a factor on white: what a surface reflects, or light has
/// of D65's.
using Spectrum = std::variant<Samples, RelativeLight>;
double at(const Spectrum& spectrum, double wavelength);

/// The relative power of the CIE standard illuminant D65, 100 at 560 nm: white light.
double d65_at(double wavelength);

/// Linear sRGB as a spectrum: what a surface of this colour reflects, or light of this colour has of D65's.
/// The three that stand for red, green and blue add up to 1 at every wavelength, so that grey is the same
/// everywhere (Mallett and Yuksel, Spectral primary decomposition for rendering with sRGB reflectance, EGSR
/// 2019; make_basis.py).
Rgb basis_at(double wavelength);
double upsample(const Rgb& color, double wavelength);

/// Linear sRGB of a spectrum: `relative(wavelength)` is what it has of D65's light; 1 everywhere is white,
/// [1, 1, 1]. Saturated colours lie outside of sRGB and have negative channels.
template <class Relative> Rgb rgb_of(const Relative& relative);

/// What each sample of the tables (every 5 nm, first to last) adds to linear sRGB where all D65's light is
/// there. They add up to [1, 1, 1].
const std::vector<Rgb>& rgb_weights();
inline constexpr double table_step = 5;

template <class Relative> Rgb rgb_of(const Relative& relative) {
  Rgb sum{};
  double wavelength = shortest_wavelength;
  for (const Rgb& weight : rgb_weights()) {
    sum = sum + double(relative(wavelength)) * weight;
    wavelength += table_step;
  }
  return sum;
}

/// Wavelengths that a picture is made of, and what each adds to its linear sRGB. Between them a spectrum is
/// taken to run straight, and to stay as it is beyond the first and the last: so the weights add up to [1, 1,
/// 1], and what is white or grey is so with any wavelengths.
struct WavelengthSet {
  std::vector<double> wavelengths;  ///< Growing; one at least.
  std::vector<Rgb> weights;
};
WavelengthSet wavelength_set(std::vector<double> wavelengths);

/// Linear sRGB of a spectrum; what lies outside of sRGB goes to its border.
Rgb rgb_of(const Spectrum& spectrum);

/// The middles of `count` equal parts of 375 to 735 nm, beyond which the eye sees next to nothing: 12 are
/// 390, 420, ... 720 nm.
std::vector<double> even_wavelengths(int count);

}  // namespace lambent
