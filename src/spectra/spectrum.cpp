#include "spectra/spectrum.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "math/functions.h"

namespace lambent {
namespace {

struct ObserverRow {
  double wavelength, x, y, z, d65;
};
constexpr ObserverRow observer[] = {
#include "spectra/observer.inc"
};
struct BasisRow {
  double wavelength, red, green;
};
constexpr BasisRow basis[] = {
#include "spectra/basis.inc"
};
constexpr std::size_t rows = std::size(observer);
static_assert(std::size(basis) == rows);
static_assert(observer[0].wavelength == shortest_wavelength);
static_assert(observer[rows - 1].wavelength == longest_wavelength);
static_assert(observer[1].wavelength - observer[0].wavelength == table_step);

/// Where a wavelength lies among the tables' rows: after row `row`, by `part` of the way to the next.
struct Between {
  std::size_t row;
  double part;
};
Between between_rows(double wavelength) {
  const double place =
      (std::clamp(wavelength, shortest_wavelength, longest_wavelength) - shortest_wavelength) / table_step;
  const std::size_t row = std::min(std::size_t(place), rows - 2);
  return {row, place - double(row)};
}

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix inverse(const Matrix& m) {
  Matrix result;
  const auto minor = [&](int r, int c) {
    const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
  };
  const double d = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) result[c][r] = minor(r, c) / d;
  return result;
}

/// From X, Y, Z to linear sRGB, by the primaries of IEC 61966-2-1 and this white.
Matrix rgb_from_xyz(const std::array<double, 3>& white) {
  constexpr double chromaticities[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
  Matrix primaries;
  for (int p = 0; p < 3; ++p) {
    const auto [x, y] = chromaticities[p];
    primaries[0][p] = x / y, primaries[1][p] = 1, primaries[2][p] = (1 - x - y) / y;
  }
  const Matrix shares_from_xyz = inverse(primaries);
  Matrix result = shares_from_xyz;
  for (int p = 0; p < 3; ++p) {
    const auto& row = shares_from_xyz[p];
    const double share = row[0] * white[0] + row[1] * white[1] + row[2] * white[2];
    for (double& entry : result[p]) entry /= share;
  }
  return result;
}

/// Of a light: Y, where D65's is 1.
template <class Power> double luminance_of(const Power& power) {
  double sum = 0, white = 0;
  for (const ObserverRow& row : observer) {
    sum += row.y * power(row.wavelength);
    white += row.y * row.d65;
  }
  return sum / white;
}

}  // namespace

double at(const Samples& samples, double wavelength) {
  const auto& x = samples.wavelengths;
  const auto after = std::size_t(std::upper_bound(x.begin(), x.end(), wavelength) - x.begin());
  if (after == 0) return samples.values.front();
  if (after == x.size()) return samples.values.back();
  const double part = (wavelength - x[after - 1]) / (x[after] - x[after - 1]);
  return samples.values[after - 1] + part * (samples.values[after] - samples.values[after - 1]);
}

double at(const Blackbody& body, double wavelength) {
  // c2 = h c / k of the SI's definitions, in nm K.
  constexpr double c2 = 1.438776877e7, log2_of_e = 1.4426950408889634;
  const double x = 560 / wavelength, x5 = x * x * x * x * x;
  return x5 / (exp2(log2_of_e * c2 / (wavelength * body.kelvin)) - 1);
}

RelativeLight::RelativeLight(LightSpectrum spectrum, double intensity) : spectrum_(std::move(spectrum)) {
  const double luminance = luminance_of([&](double nm) { return at(nm) * d65_at(nm); });
  scale_ = luminance > 0 ? intensity / luminance : 0;
}

double RelativeLight::at(double wavelength) const {
  const double power = std::visit([&](const auto& s) { return lambent::at(s, wavelength); }, spectrum_);
  return scale_ * power / d65_at(wavelength);
}

double at(const Spectrum& spectrum, double wavelength) {
  if (const auto* samples = std::get_if<Samples>(&spectrum)) return at(*samples, wavelength);
  return std::get<RelativeLight>(spectrum).at(wavelength);
}

Rgb rgb_of(const Spectrum& spectrum) {
  Rgb result = rgb_of([&](double wavelength) { return at(spectrum, wavelength); });
  for (double& channel : result.c) channel = std::max(channel, 0.0);
  return result;
}

double d65_at(double wavelength) {
  const auto [row, part] = between_rows(wavelength);
  return observer[row].d65 + part * (observer[row + 1].d65 - observer[row].d65);
}

Rgb basis_at(double wavelength) {
  const auto [row, part] = between_rows(wavelength);
  const BasisRow &a = basis[row], &b = basis[row + 1];
  const double red = a.red + part * (b.red - a.red), green = a.green + part * (b.green - a.green);
  return {{red, green, 1 - red - green}};
}

double upsample(const Rgb& color, double wavelength) {
  // As blue plus differences from it, so that grey stays what it is in every bit.
  const Rgb base = basis_at(wavelength);
  return color[2] + base[0] * (color[0] - color[2]) + base[1] * (color[1] - color[2]);
}

const std::vector<Rgb>& rgb_weights() {
  static const std::vector<Rgb> weights = [] {
    std::array<double, 3> white{};
    for (const ObserverRow& row : observer) {
      const double xyz[] = {row.x, row.y, row.z};
      for (int c = 0; c < 3; ++c) white[c] += row.d65 * xyz[c];
    }
    const Matrix m = rgb_from_xyz(white);
    std::vector<Rgb> result;
    for (const ObserverRow& row : observer) {
      Rgb& weight = result.emplace_back();
      for (int c = 0; c < 3; ++c) weight[c] = row.d65 * (m[c][0] * row.x + m[c][1] * row.y + m[c][2] * row.z);
    }
    return result;
  }();
  return weights;
}

WavelengthSet wavelength_set(std::vector<double> wavelengths) {
  WavelengthSet set{std::move(wavelengths), {}};
  const auto& x = set.wavelengths;
  set.weights.resize(x.size());
  double wavelength = shortest_wavelength;
  for (const Rgb& weight : rgb_weights()) {
    const auto after = std::size_t(std::upper_bound(x.begin(), x.end(), wavelength) - x.begin());
    if (after == 0) {
      set.weights.front() = set.weights.front() + weight;
    } else if (after == x.size()) {
      set.weights.back() = set.weights.back() + weight;
    } else {
      const double part = (wavelength - x[after - 1]) / (x[after] - x[after - 1]);
      set.weights[after - 1] = set.weights[after - 1] + (1 - part) * weight;
      set.weights[after] = set.weights[after] + part * weight;
    }
    wavelength += table_step;
  }
  return set;
}

std::vector<double> even_wavelengths(int count) {
  constexpr double from = 375, to = 735;
  std::vector<double> result;
  for (int i = 0; i < count; ++i) result.push_back(from + (2 * i + 1) * (to - from) / (2 * count));
  return result;
}

}  // namespace lambent
