// Fresnel's equations against their closed forms, complex arithmetic, and each other.

#include "illumination/fresnel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>

namespace lambent {
namespace {

using DoublePack = Pack<double, native_float_lanes>;

/// As the textbooks have it, with complex numbers: r_s = (c - g) / (c + g), r_p = (m^2 c - g) / (m^2 c + g),
/// g = sqrt(m^2 - 1 + c^2), m = eta + i k.
PolarisedReflectance<double> textbook(double c, double eta, double k) {
  const std::complex<double> m(eta, k), g = std::sqrt(m * m - 1.0 + c * c);
  return {std::norm((c - g) / (c + g)), std::norm((m * m * c - g) / (m * m * c + g))};
}

TEST(Fresnel, AlongTheNormal) {
  EXPECT_NEAR(fresnel_dielectric(1.0, 1.5), 0.04, 1e-15);  // ((1.5 - 1) / (1.5 + 1))^2
  EXPECT_NEAR(fresnel_dielectric(1.0, 1 / 1.5), 0.04, 1e-15);
  EXPECT_EQ(fresnel_dielectric(1.0, 1.0), 0);
  // Copper at 550 nm and gold at 600 nm, about: ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2)
  for (const auto& [eta, k] : {std::pair{0.96, 2.58}, {0.25, 3.0}, {1.5, 0.0}, {3.0, 3.0}}) {
    const double closed = ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
    EXPECT_NEAR(fresnel_conductor(1.0, eta, k), closed, 1e-15);
    EXPECT_NEAR(fresnel_conductor_at_normal(eta, k), closed, 1e-15);
  }
}

TEST(Fresnel, AtBrewstersAngleNothingIsReflectedThatSwingsInThePlane) {
  for (const double eta : {1.1, 1.5, 2.4, 1 / 1.5}) {
    // tan(Brewster) = eta, and there s = ((1 - eta^2) / (1 + eta^2))^2.
    const double cosine = 1 / std::sqrt(1 + eta * eta);
    const double s = (1 - eta * eta) / (1 + eta * eta);
    EXPECT_NEAR(polarised_fresnel_dielectric(cosine, eta).p, 0, 1e-30);
    EXPECT_NEAR(polarised_fresnel_dielectric(cosine, eta).s, s * s, 1e-15);
    EXPECT_NEAR(polarised_fresnel_conductor(cosine, eta, 0.0).p, 0, 1e-15);
  }
}

TEST(Fresnel, FromTheCriticalAngleOnAllIsReflected) {
  const double eta = 1 / 1.5, critical = std::sqrt(1 - eta * eta);  // sin(critical) = eta
  EXPECT_EQ(fresnel_dielectric(critical * (1 - 1e-12), eta), 1);
  EXPECT_LT(fresnel_dielectric(critical * 1.001, eta), 0.9);
  EXPECT_EQ(fresnel_dielectric(0.1, eta), 1);
  EXPECT_EQ(fresnel_dielectric(0.0, eta), 1);
  EXPECT_NEAR(fresnel_conductor(0.1, eta, 0.0), 1, 1e-15);
}

TEST(Fresnel, AlongTheBoundaryAllIsReflected) {
  for (const double eta : {0.5, 1.0, 1.5, 3.0}) EXPECT_NEAR(fresnel_dielectric(0.0, eta), 1, 1e-15);
  EXPECT_NEAR(fresnel_conductor(0.0, 0.2, 3.0), 1, 1e-15);
  EXPECT_EQ(fresnel_conductor(0.0, 1.0, 0.0), 1);
}

TEST(Fresnel, IsWhatComplexNumbersSay) {
  std::mt19937 random(31);
  std::uniform_real_distribution<double> cosine(0, 1), index(0.05, 4), absorption(0, 8);
  for (int i = 0; i < 100000; ++i) {
    const double c = cosine(random), eta = index(random), k = absorption(random);
    const auto metal = textbook(c, eta, k), glass = textbook(c, eta, 0);
    EXPECT_NEAR(polarised_fresnel_conductor(c, eta, k).s, metal.s, 1e-12);
    EXPECT_NEAR(polarised_fresnel_conductor(c, eta, k).p, metal.p, 1e-12);
    EXPECT_NEAR(polarised_fresnel_dielectric(c, eta).s, glass.s, 1e-12);
    EXPECT_NEAR(polarised_fresnel_dielectric(c, eta).p, glass.p, 1e-12);
    // k = 0 is a dielectric; near the critical angle a root of a difference has half the digits.
    EXPECT_NEAR(fresnel_conductor(c, eta, 0.0), fresnel_dielectric(c, eta), 1e-7);
  }
}

TEST(Fresnel, ReflectsAlikeFromBothSides) {
  // Light that goes the refracted way back loses the same share: R(c, eta) = R(c', 1 / eta).
  std::mt19937 random(32);
  std::uniform_real_distribution<double> cosine(0.001, 1), index(1, 3);
  for (int i = 0; i < 10000; ++i) {
    const double c = cosine(random), eta = index(random),
                 refracted = std::sqrt(1 - (1 - c * c) / (eta * eta));
    EXPECT_NEAR(fresnel_dielectric(c, eta), fresnel_dielectric(refracted, 1 / eta), 1e-11);
  }
}

TEST(Fresnel, ReflectsAndTransmitsAllThereIs) {
  // T = g |t|^2 / c with t_s = 2 c / (c + g) and t_p = 2 eta c / (eta^2 c + g), beside R: nothing is left.
  std::mt19937 random(33);
  std::uniform_real_distribution<double> cosine(0.001, 1), index(1, 3);
  for (int i = 0; i < 10000; ++i) {
    const double c = cosine(random), eta = index(random), g = std::sqrt(eta * eta - 1 + c * c);
    const double ts = 2 * c / (c + g), tp = 2 * eta * c / (eta * eta * c + g);
    const auto reflected = polarised_fresnel_dielectric(c, eta);
    EXPECT_NEAR(reflected.s + g / c * ts * ts, 1, 1e-12);
    EXPECT_NEAR(reflected.p + g / c * tp * tp, 1, 1e-12);
  }
}

TEST(Fresnel, ALaneOfAPacketHasTheBitsOfTheNumber) {
  std::mt19937 random(34);
  std::uniform_real_distribution<double> cosine(-0.05, 1), index(0.2, 3), absorption(-1, 5);
  for (int i = 0; i < 10000; ++i) {
    const auto numbers = [&](auto& from) {
      return gather<DoublePack>([&](int) { return max(from(random), 0.0); });
    };
    const DoublePack c = numbers(cosine), eta = numbers(index), k = numbers(absorption);
    const DoublePack glass = fresnel_dielectric(c, eta), metal = fresnel_conductor(c, eta, k);
    for (int lane_index = 0; lane_index < lanes_of<DoublePack>; ++lane_index) {
      const double c1 = lane(c, lane_index), eta1 = lane(eta, lane_index), k1 = lane(k, lane_index);
      EXPECT_EQ(lane(glass, lane_index), fresnel_dielectric(c1, eta1));
      EXPECT_EQ(lane(metal, lane_index), fresnel_conductor(c1, eta1, k1));
    }
  }
}

}  // namespace
}  // namespace lambent
