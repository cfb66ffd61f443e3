#include <gtest/gtest.h>

#include <cmath>

#include "illumination/models.h"

namespace lambent {
namespace {

/// N and L at `degrees` from each other, V where L is mirrored: the middle of the highlight.
Surface<double, Rgb> surface(double degrees, const Rgb& eta, const Rgb& k) {
  const double a = degrees * M_PI / 180;
  Surface<double, Rgb> s{{0, 1, 0}, {-std::sin(a), std::cos(a), 0}, {}, {}, {{1, 0.5, 1}}, 32, {}};
  s.eta = eta, s.k = k;
  return s;
}
Arriving<double, Rgb> light(double degrees) {
  const double a = degrees * M_PI / 180;
  return {{std::sin(a), std::cos(a), 0}, {{2, 2, 2}}};
}

TEST(WavelengthSpecular, IsFresnelsFactorHeadOn) {
  // w = ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2) at theta = 0, (cos beta)^n = 1. Gold at 658.8 nm, 548.6 nm and
  // 450.9 nm after Johnson and Christy
  const Rgb n{{0.14, 0.43, 1.38}}, k{{3.697, 2.455, 1.914}}, ks{{1, 0.5, 1}};
  const auto terms = WavelengthSpecular::evaluate(surface(0, n, k), light(0));
  for (int c = 0; c < 3; ++c) {
    const double w = ((n[c] - 1) * (n[c] - 1) + k[c] * k[c]) / ((n[c] + 1) * (n[c] + 1) + k[c] * k[c]);
    EXPECT_NEAR(terms.specular[c], 2 * ks[c] * w, 1e-14);
  }
  EXPECT_TRUE(is_black(terms.diffuse));
}

TEST(WavelengthSpecular, IsTheDielectricsAtBrewstersAngle) {
  // At tan theta = n nothing that swings in the plane of incidence is reflected: w = (1 - n^2)^2 / (1 +
  // n^2)^2 / 2
  const double n = 1.5, brewster = std::atan(n) * 180 / M_PI;
  const auto terms = WavelengthSpecular::evaluate(surface(brewster, grey(n), grey(0.0)), light(brewster));
  const double rs = (1 - n * n) / (1 + n * n);
  EXPECT_NEAR(terms.specular[0], 2 * rs * rs / 2, 1e-14);
}

TEST(WavelengthSpecular, OfAConductorAgreesWithComplexNumbers) {
  // rs = (cos - q) / (cos + q), rp = (m^2 cos - q) / (m^2 cos + q), q = sqrt(m^2 - sin^2), m = n + i k
  struct {
    double re, im;
  } m{0.62, 2.081};  // gold at 520.9 nm
  for (const double degrees : {10.0, 45.0, 70.0, 85.0}) {
    const double c = std::cos(degrees * M_PI / 180), s2 = 1 - c * c;
    const double re2 = m.re * m.re - m.im * m.im, im2 = 2 * m.re * m.im;  // m^2
    const double x = re2 - s2, size = std::hypot(x, im2), qr = std::sqrt((size + x) / 2),
                 qi = std::sqrt((size - x) / 2);
    const auto square = [](double re, double im) { return re * re + im * im; };
    const double rs = square(c - qr, -qi) / square(c + qr, qi),
                 rp = square(re2 * c - qr, im2 * c - qi) / square(re2 * c + qr, im2 * c + qi);
    const auto terms = WavelengthSpecular::evaluate(surface(degrees, grey(m.re), grey(m.im)), light(degrees));
    EXPECT_NEAR(terms.specular[0], 2 * (rs + rp) / 2, 1e-12) << degrees;
  }
}

TEST(WavelengthSpecular, IsWhiteAtGrazingAngles) {
  const auto terms =
      WavelengthSpecular::evaluate(surface(89.999, {{0.14, 0.43, 1.38}}, {{3.7, 2.5, 1.9}}), light(89.999));
  EXPECT_NEAR(terms.specular[0], 2, 1e-3);
  EXPECT_NEAR(terms.specular[2], 2, 1e-3);
}

}  // namespace
}  // namespace lambent
