// Lights with extent: their points together give what the closed forms say.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "lights/lights.h"

namespace lambent {
namespace {

using V = Vec3<double>;

/// The mean of pi I / r^2 (N.L)+ over a grid of points: the irradiance.
template <class Light> double irradiance(const Light& light, const V& P, const V& N, int side) {
  double sum = 0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const auto s = sample(light, P, (i + 0.5) / side, (j + 0.5) / side);
      sum += M_PI * s.I[0] / (s.r * s.r) * std::max(dot(N, s.L), 0.0);
    }
  return sum / (side * side);
}

TEST(RectangleLight, HasItsCentreInTheMiddleAndTheCosineOfItsAngle) {
  // It faces u x v = (0, -2, 0).
  const RectangleLight light{{1, 2, 3}, {2, 0, 0}, {0, 0, 1}, {{1, 0.5, 0.25}}, 8};
  EXPECT_EQ(body_of(light).normal, (V{0, -1, 0}));
  const auto below = sample(light, V{1, 0, 3}, 0.5, 0.5);
  EXPECT_EQ(below.L, (V{0, 1, 0}));
  EXPECT_EQ(below.r, 2);
  EXPECT_TRUE(below.I == (Rgb{{8, 4, 2}}));
  EXPECT_EQ(below.density, 2.0 * 2.0 / 2.0);  // r^2 / (A cos)
  EXPECT_NEAR(sample(light, V{4, -1, 3}, 0.5, 0.5).I[0], 8 * 3 / std::sqrt(18.0), 1e-14);
  EXPECT_TRUE(is_black(sample(light, V{1, 4, 3}, 0.5, 0.5).I)) << "from behind";
  RectangleLight both = light;
  both.two_sided = true;
  EXPECT_TRUE(sample(both, V{1, 4, 3}, 0.5, 0.5).I == (Rgb{{8, 4, 2}}));
  const auto corner = sample(light, V{1, 0, 3}, 0.0, 1.0);
  EXPECT_NEAR(length(corner.r * corner.L - V{-1, 2, 0.5}), 0, 1e-15);
}

// Parallel squares of side a, opposite each other at the distance a: form factor 0.19982 (Howell, A catalog
// of radiation heat transfer configuration factors, C-11). At a right angle with a common edge: 0.20004
// (C-14).
TEST(RectangleLight, HasTheFormFactorsOfSquares) {
  const RectangleLight light{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, grey(1.0), 1};
  const double emitted = M_PI * radiance(light)[0];
  double opposite = 0, across = 0;
  constexpr int side = 20;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const double a = (i + 0.5) / side, b = (j + 0.5) / side;
      opposite += irradiance(light, V{a - 0.5, 0, b - 0.5}, V{0, 1, 0}, side);
      across += irradiance(light, V{-0.5, a, b - 0.5}, V{1, 0, 0}, side);
    }
  EXPECT_NEAR(opposite / (side * side) / emitted, 0.19982, 3e-4);
  EXPECT_NEAR(across / (side * side) / emitted, 0.20004, 0.01);  // the common edge is a singularity
}

TEST(DiscLight, GivesItsClosedFormOnTheAxis) {
  // E = pi Le R^2 / (R^2 + d^2), Le = pi Il / (pi R^2)
  const DiscLight light{{0, 2, 0}, {0, -3, 0}, 1.5, grey(1.0), 4};
  EXPECT_NEAR(radiance(light)[0], 4 / 2.25, 1e-15);
  EXPECT_NEAR(irradiance(light, {0, 0, 0}, {0, 1, 0}, 128), M_PI * 4 / (2.25 + 4), 2e-4);
  const auto center = sample(light, V{1, 0, 0}, 0.5, 0.5);
  EXPECT_NEAR(length(center.r * center.L - V{-1, 2, 0}), 0, 1e-15);
  for (const double u : {0.0, 0.3, 0.5, 0.99})
    for (const double v : {0.0, 0.5, 0.7, 0.99}) {
      const auto s = sample(light, V{0, 0, 0}, u, v);
      const V Q = s.r * s.L;
      EXPECT_NEAR(Q.y, 2, 1e-14);
      EXPECT_LE(Q.x * Q.x + Q.z * Q.z, 2.25 + 1e-12);
    }
}

TEST(SphereLight, GivesItsClosedForm) {
  // E = pi Le (R / d)^2, Le = Il / R^2
  const SphereLight light{{0, 3, 0}, 1.2, grey(1.0), 5};
  EXPECT_NEAR(radiance(light)[0], 5 / 1.44, 1e-15);
  EXPECT_NEAR(irradiance(light, {0, 0, 0}, {0, 1, 0}, 64), M_PI * 5 / 9, 1e-4);
  const auto center = sample(light, V{0, 0, 0}, 0.5, 0.5);
  EXPECT_EQ(center.L, (V{0, 1, 0}));
  EXPECT_EQ(center.r, 3);
  EXPECT_NEAR(center.clear, 1.8, 1e-4);
  EXPECT_LT(center.clear, 1.8);
  // 2 / (1 + cos a): nearly 1 from afar, 2 at the surface.
  EXPECT_NEAR(center.I[0], 5 * 2 / (1 + std::sqrt(1 - 0.16)), 1e-14);
  EXPECT_NEAR(sample(light, V{0, 1e4, 0}, 0.5, 0.5).I[0], 5, 1e-6);
  EXPECT_NEAR(sample(light, V{0, 1.8 - 1e-9, 0}, 0.5, 0.5).I[0], 10, 1e-3);
  EXPECT_TRUE(is_black(sample(light, V{0.2, 3, 0}, 0.3, 0.4).I)) << "from inside";
}

/// Calls f(light) for lights of every kind with extent.
template <class F> void for_each_kind(std::mt19937& random, const F& f) {
  std::uniform_real_distribution<double> u(-3, 3), size(0.1, 2);
  const auto some = [&] { return V{u(random), u(random), u(random)}; };
  f(RectangleLight{some(), some(), some(), {{0.2, 0.9, 0.4}}, 3});
  RectangleLight both{some(), some(), some(), {{0.2, 0.9, 0.4}}, 3};
  both.two_sided = true;
  f(both);
  f(DiscLight{some(), some(), size(random), {{0.2, 0.9, 0.4}}, 3});
  f(SphereLight{some(), size(random), {{0.2, 0.9, 0.4}}, 3});
}

TEST(EveryLightWithExtent, HasOneRadianceEverywhere) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-4, 4), unit(0, 1);
  int lit = 0;
  for (int i = 0; i < 2000; ++i)
    for_each_kind(random, [&](const auto& light) {
      const V P{u(random), u(random), u(random)};
      const auto s = sample(light, P, unit(random), unit(random));
      if (is_black(s.I)) return;
      ++lit;
      const Rgb Le = radiance(light);
      for (int c = 0; c < color_channels; ++c)
        EXPECT_NEAR(M_PI * s.I[c] * s.density / (s.r * s.r), Le[c], 1e-9 * Le[c]);
      EXPECT_NEAR(length(s.L), 1, 1e-12);
      EXPECT_NEAR(density(light, P, P + s.r * s.L), s.density, 1e-9 * s.density);
    });
  EXPECT_GT(lit, 4000);
}

/// How far a point lies from a light's surface.
double height(const LightBody& body, const V& Q) {
  if (body.kind == LightBody::Kind::sphere) return length(Q - body.center) - body.radius;
  return std::fabs(dot(Q - body.center, body.normal));
}

TEST(EveryLightWithExtent, EndsShadowRaysJustBeforeItsSurface) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-4, 4), unit(0, 1);
  for (int i = 0; i < 2000; ++i)
    for_each_kind(random, [&](const auto& light) {
      const V P{u(random), u(random), u(random)};
      const auto s = sample(light, P, unit(random), unit(random));
      if (is_black(s.I) || s.clear == 0) return;
      const LightBody body = body_of(light);
      const double end = height(body, P + s.clear * s.L);
      const double largest =
          max_abs(P) + max_abs(body.center) + length(body.u) + length(body.v) + body.radius;
      EXPECT_GT(end, 0.9e-6 * max_abs(P));
      EXPECT_LT(end, 8e-6 * largest);
      EXPECT_LE(s.clear, s.r);
    });
}

TEST(OnDisc, KeepsAreasAndTheCentre) {
  EXPECT_EQ(on_disc(0.5, 0.5).x, 0);
  EXPECT_EQ(on_disc(0.5, 0.5).y, 0);
  // As many points in each ring as its area says, and in each octant.
  constexpr int side = 400, rings = 8;
  std::vector<int> ring(rings), octant(8);
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const Vec2<double> at = on_disc((i + 0.5) / side, (j + 0.5) / side);
      ++ring[std::size_t((at.x * at.x + at.y * at.y) * rings)];
      ++octant[std::size_t((std::atan2(at.y, at.x) / M_PI + 1) * 4) % 8];
    }
  for (const int count : ring) EXPECT_NEAR(count, side * side / rings, side * side / rings * 0.05);
  for (const int count : octant) EXPECT_NEAR(count, side * side / 8, side * side / 8 * 0.05);
}

TEST(AxesAround, AreOrthonormalAndRightHanded) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const V z = i == 0 ? V{0, 0, -1} : i == 1 ? V{0, 0, 1} : normalize(V{u(random), u(random), u(random)});
    const Axes<double> axes = axes_around(z);
    EXPECT_NEAR(length(cross(axes.x, axes.y) - z), 0, 1e-14);
    EXPECT_NEAR(dot(axes.x, axes.y), 0, 1e-14);
    EXPECT_NEAR(length(axes.x), 1, 1e-14);
  }
}

}  // namespace
}  // namespace lambent
