// From metallic-roughness to the lecture's numbers, and back.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "illumination/metallic_roughness.h"

namespace lambent {
namespace {

using Rough = MetallicRoughnessOf<double, Rgb>;

Rough plain(const Rgb& base, double metallic, double roughness) {
  return {base, metallic, roughness, 1, grey(1.0), 1.5, 0, 0, 0};
}

TEST(MetallicRoughness, ADielectricScattersAllButItsReflection) {
  // ior 1.5: d = (0.5 / 2.5)^2 = 0.04; alpha = 0.25, w = 1/16, n = 2 * 16 - 2 = 30
  const auto lecture = lecture_material(plain({0.5, 0.25, 1}, 0, 0.5));
  EXPECT_NEAR(lecture.n, 30, 1e-12);
  for (int c = 0; c < 3; ++c) {
    const double base = c == 0 ? 0.5 : c == 1 ? 0.25 : 1, w = 1 / 16.0;
    EXPECT_NEAR(lecture.kd[c], base * 0.96 + w * 0.04, 1e-15);
    EXPECT_NEAR(lecture.ks[c], (1 - w) * 0.04 * 32 / 8, 1e-15);
    EXPECT_NEAR(lecture.reflect[c], 0.04 * 0.25, 1e-15);  // (1 - 2 * 0.25)^2
    EXPECT_EQ(lecture.transmit[c], 0);
  }
}

TEST(MetallicRoughness, AMetalReflectsItsColor) {
  const auto mirror = lecture_material(plain({1, 0.77, 0.34}, 1, 0));
  EXPECT_NEAR(mirror.n, largest_exponent, 1e-8);
  EXPECT_EQ(mirror.reflect[0], 1);
  EXPECT_EQ(mirror.reflect[2], 0.34);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(mirror.kd[c], 0);
    EXPECT_EQ(mirror.ka[c], 0);  // its surroundings come by the mirror ray
  }
  // As rough as can be it is Lambert's.
  const auto chalk = lecture_material(plain({1, 0.77, 0.34}, 1, 1));
  EXPECT_EQ(chalk.kd[1], 0.77);
  EXPECT_EQ(chalk.ks[1], 0);
  EXPECT_EQ(chalk.reflect[1], 0);
}

TEST(MetallicRoughness, UnderLightFromAllSidesNothingIsLostOrGained) {
  // Ambient term, mirror ray and refracted ray together see a white surrounding: base (1 - d) + d for
  // dielectrics, base for metals; and no more than 1.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 10000; ++i) {
    Rough m = plain({share(random), share(random), share(random)}, share(random), share(random));
    m.transmission = i % 3 ? 0 : share(random);
    m.clearcoat = i % 2 ? 0 : share(random);
    m.clearcoat_roughness = share(random);
    const auto lecture = lecture_material(m);
    for (int c = 0; c < 3; ++c) {
      const double all = lecture.ka[c] + lecture.reflect[c] + lecture.transmit[c];
      EXPECT_LE(all, 1 + 1e-12);
      if (m.clearcoat == 0) {
        const double F0 = (1 - m.metallic) * 0.04 + m.metallic * m.base_color[c];
        EXPECT_NEAR(all, (1 - m.metallic) * m.base_color[c] * 0.96 + F0, 1e-12);
      }
    }
  }
}

/// The way back, for ior 1.5 and neither transmission nor a coat: n gives alpha, Ks gives F0, and what is
/// left of Kd and F0 fix base color and metallic. With q = 1 - metallic, K = base q (1 - d), F0 = d q + base
/// (1 - q): d q^2 - (F0 + K / (1 - d)) q + K / (1 - d) = 0.
Rough back(const LectureMaterial<double, Rgb>& lecture, int c) {
  const double d = 0.04, alpha2 = 2 / (lecture.n + 2), w = alpha2,
               F0 = lecture.ks[c] * 8 / ((lecture.n + 2) * (1 - w));
  const double K = (lecture.kd[c] - w * F0) / (1 - d), s = F0 + K;
  const double q = (s - std::sqrt(std::max(s * s - 4 * d * K, 0.0))) / (2 * d), base = s - d * q;
  return plain(grey(base), 1 - q, std::sqrt(std::sqrt(alpha2)));
}

TEST(MetallicRoughness, GoesBackToWhereItCameFrom) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 10000; ++i) {
    const Rough m =
        plain({0.05 + 0.95 * share(random), 0.5, 0.9}, 0.98 * share(random), 0.13 + 0.85 * share(random));
    const auto lecture = lecture_material(m);
    for (int c = 0; c < 3; ++c) {
      const Rough again = back(lecture, c);
      EXPECT_NEAR(again.roughness, m.roughness, 1e-9);
      EXPECT_NEAR(again.base_color[c], m.base_color[c], 1e-6);
      EXPECT_NEAR(again.metallic, m.metallic, 1e-5);
    }
  }
}

TEST(MetallicRoughness, TheHighlightHasTheEnergyOfItsLobe) {
  // Seen from above under light from above, pi Il F D / 4 with D = (n + 2) / (2 pi) (N.H)^n integrates over
  // all H to what its normalisation says: int D (N.H) dH = 1.
  for (const double roughness : {0.3, 0.5, 0.7}) {
    const double n = exponent_of_alpha(roughness * roughness);
    double sum = 0;
    const int steps = 100000;
    for (int i = 0; i < steps; ++i) {
      const double theta = M_PI / 2 * (i + 0.5) / steps;
      sum +=
          (n + 2) / (2 * M_PI) * std::pow(std::cos(theta), n) * std::cos(theta) * 2 * M_PI * std::sin(theta);
    }
    EXPECT_NEAR(sum * (M_PI / 2) / steps, 1, 1e-6);
  }
}

}  // namespace
}  // namespace lambent
