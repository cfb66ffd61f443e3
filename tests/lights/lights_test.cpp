#include "lights/lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "math/pack.h"

namespace lambent {
namespace {

TEST(PointLight, GivesDirectionDistanceAndColour) {
  const PointLight light{{3, 4, 0}, {{1, 0.5, 0.25}}, 8};
  const auto s = sample(light, Vec3<double>{0, 0, 0}, 0.5, 0.5);
  EXPECT_EQ(s.r, 5);  // sqrt(3^2 + 4^2)
  EXPECT_NEAR(length(s.L - Vec3<double>{0.6, 0.8, 0}), 0, 1e-15);
  EXPECT_TRUE(s.I == (Rgb{{8, 4, 2}}));
  EXPECT_EQ(s.density, 0);
}

TEST(PointLight, HasNoDirectionAtItsOwnPosition) {
  const auto s = sample(PointLight{{1, 2, 3}, {{1, 1, 1}}, 1}, Vec3<double>{1, 2, 3}, 0.5, 0.5);
  EXPECT_EQ(s.r, 0);
  EXPECT_EQ(s.L, Vec3<double>{});
}

TEST(DirectionalLight, ComesFromInfinityAgainstItsDirection) {
  const auto s = sample(DirectionalLight{{0, -2, 0}, {{1, 1, 1}}, 3}, Vec3<double>{7, 7, 7}, 0.5, 0.5);
  EXPECT_EQ(s.L, (Vec3<double>{0, 1, 0}));
  EXPECT_EQ(s.r, double(INFINITY));
  EXPECT_EQ(s.I[1], 3);
}

/// Brightness at theta degrees from the axis of a spot that looks down from height 1.
double spot_at(double theta, double angle, double softness, double exponent) {
  const SpotLight light{{0, 1, 0}, {0, 0, 0}, {{1, 1, 1}}, 1, angle, softness, exponent};
  return sample(light, Vec3<double>{std::tan(theta * M_PI / 180), 0, 0}, 0.5, 0.5).I[0];
}

TEST(SpotLight, FadesBetweenTheInnerAndTheOuterCone) {
  const auto smooth = [](double x) { return x * x * (3 - 2 * x); };
  const auto c = [](double degrees) { return std::cos(degrees * M_PI / 180); };
  EXPECT_EQ(spot_at(0, 60, 0.5, 0), 1);
  EXPECT_EQ(spot_at(14.9, 60, 0.5, 0), 1);  // b = (1 - 0.5) 30 = 15
  EXPECT_NEAR(spot_at(20, 60, 0.5, 0), smooth((c(20) - c(30)) / (c(15) - c(30))), 1e-12);
  EXPECT_EQ(spot_at(30.1, 60, 0.5, 0), 0);
  EXPECT_NEAR(spot_at(10, 60, 0.5, 4), std::pow(c(10), 4), 1e-12);
  EXPECT_EQ(spot_at(29.9, 60, 0, 0), 1);  // softness 0: a hard edge
  EXPECT_EQ(spot_at(30.1, 60, 0, 0), 0);
}

TEST(EveryLight, HandsOutItsColourTimesOneFactor) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> u(-3, 3), size(0, 1);
  const Rgb color{{0.2, 0.9, 0.4}};
  int between = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3<double> position{u(random), u(random), u(random)}, target{u(random), u(random), u(random)};
    const Vec3<double> P{u(random), u(random), u(random)};
    for (const AnyLight& light :
         {AnyLight(PointLight{position, color, 3, 4}), AnyLight(DirectionalLight{target, color, 3}),
          AnyLight(SpotLight{position, target, color, 3, 120, 0.9, 2}),
          AnyLight(RectangleLight{position, {1, 0, 0}, {0, 0, 2}, color, 3}),
          AnyLight(DiscLight{position, normalize(target), 1, color, 3}),
          AnyLight(SphereLight{position, 0.8, color, 3})})
      with_light(light, [&]<class Light>(const Light& one) {
        const Rgb I = sample(one, P, 0.5, 0.5).I, whole = brightest<double>(one);
        const double share = share_of(I, whole);
        EXPECT_GE(share, 0);
        EXPECT_LE(share, (std::is_same_v<Light, SphereLight> ? 2 : 1));
        between += share > 0 && share < 1;
        for (int c = 0; c < color_channels; ++c) EXPECT_NEAR(I[c], share * whole[c], 1e-15);
      });
  }
  EXPECT_GT(between, 100);
  EXPECT_EQ(share_of(Rgb{}, Rgb{}), 0);
}

TEST(EveryLight, IsBlackWhereItSaysThatItDoesNotReach) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> u(-3, 3), size(0, 1), share(0, 1);
  int out_of_reach = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3<double> position{u(random), u(random), u(random)}, target{u(random), u(random), u(random)};
    const AnyLight lights[] = {
        PointLight{position, {{1, 1, 1}}, 1, 3 * size(random)},
        SpotLight{
            position, target, {{1, 1, 1}}, 1, 5 + 170 * share(random), 0.1, 0, i % 2 ? 3 * size(random) : 0},
        DirectionalLight{{0, -1, 0}, {{1, 1, 1}}, 1}};
    Reach box{{u(random), u(random), u(random)}, {}};
    box.upper = box.lower + Vec3<double>{size(random), size(random), size(random)};
    for (const AnyLight& any : lights)
      with_light(any, [&](const auto& light) {
        if (reaches(light, box)) return;
        ++out_of_reach;
        for (int k = 0; k < 8; ++k) {
          const Vec3<double> way = box.upper - box.lower;
          const Vec3<double> p =
              box.lower + Vec3<double>{share(random) * way.x, share(random) * way.y, share(random) * way.z};
          EXPECT_TRUE(is_black(sample(light, p, 0.5, 0.5).I));
        }
      });
  }
  EXPECT_GT(out_of_reach, 10000);
}

TEST(PointLightTest, ShinesUpToItsMaxDistance) {
  const PointLight light{{0, 0, 0}, {{1, 1, 1}}, 2, 3};
  EXPECT_EQ(sample(light, Vec3<double>{2.999, 0, 0}, 0.5, 0.5).I[0], 2);
  EXPECT_EQ(sample(light, Vec3<double>{3.001, 0, 0}, 0.5, 0.5).I[0], 0);
}

TEST(EveryLight, GivesTheSameBitsForANumberAndForALane) {
  using P = Pack<double, native_float_lanes>;
  const AnyLight lights[] = {PointLight{{1, 2, 3}, {{1, 0.5, 0.2}}, 2},
                             DirectionalLight{{1, -2, 0.5}, {{1, 1, 1}}, 1},
                             SpotLight{{0, 3, 0}, {0.2, 0, 0.1}, {{1, 1, 1}}, 2, 70, 0.4, 3},
                             RectangleLight{{0, 1, 0}, {1, 0, 0.5}, {0, 1, 1}, {{1, 0.3, 1}}, 2},
                             DiscLight{{0, 1, 0}, {0.2, -1, 0.3}, 1.5},
                             SphereLight{{0.5, 1, 0}, 2, {{1, 1, 0.2}}, 3}};
  static_assert(std::size(lights) == std::variant_size_v<AnyLight> - 1, "a light is missing in this test");
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-3, 3), unit(0, 1);
  for (const AnyLight& any : lights)
    for (int i = 0; i < 1000; ++i) {
      const auto numbers = [&] { return gather<P>([&](int) { return u(random); }); };
      const Vec3<P> p{numbers(), numbers(), numbers()};
      const P at_u = gather<P>([&](int) { return unit(random); }),
              at_v = gather<P>([&](int) { return unit(random); });
      with_light(any, [&]<class Light>(const Light& light) {
        const auto together = sample(light, p, at_u, at_v);
        for (int k = 0; k < lanes_of<P>; ++k) {
          const Vec3<double> one{lane(p.x, k), lane(p.y, k), lane(p.z, k)};
          const auto alone = sample(light, one, lane(at_u, k), lane(at_v, k));
          EXPECT_EQ(to_bits(lane(together.L.x, k)), to_bits(alone.L.x));
          EXPECT_EQ(to_bits(lane(together.L.y, k)), to_bits(alone.L.y));
          EXPECT_EQ(to_bits(lane(together.L.z, k)), to_bits(alone.L.z));
          EXPECT_EQ(to_bits(lane(together.r, k)), to_bits(alone.r));
          EXPECT_EQ(to_bits(lane(together.density, k)), to_bits(alone.density));
          EXPECT_EQ(to_bits(lane(together.clear, k)), to_bits(alone.clear));
          if constexpr (HasExtent<Light>) {
            const Vec3<P> Q = p + together.r * together.L;
            EXPECT_EQ(to_bits(lane(density(light, p, Q), k)),
                      to_bits(density(light, one, one + alone.r * alone.L)));
          }
          for (int c = 0; c < color_channels; ++c)
            EXPECT_EQ(to_bits(lane(together.I[c], k)), to_bits(alone.I[c]));
        }
      });
    }
}

}  // namespace
}  // namespace lambent
