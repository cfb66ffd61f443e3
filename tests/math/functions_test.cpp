#include "math/functions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "math/gather.h"
#include "math/pack.h"
#include "math/transform.h"

namespace lambent {
namespace {

using DoublePack = Pack<double, native_float_lanes>;
constexpr int lanes = lanes_of<DoublePack>;

TEST(Functions, PowerAgreesWithTheCLibrary) {
  // glibc's pow is right to 1 ulp. Ours carries the rounding of y log2 x: |y log2 x| 2^-53 in the exponent.
  std::mt19937 random(1);
  std::uniform_real_distribution<double> base(0, 2), power(0, 300);
  for (int i = 0; i < 200000; ++i) {
    const double x = base(random), y = power(random), expected = std::pow(x, y);
    if (expected < 1e-300) continue;
    const double exponent = std::fabs(std::log2(x) * y);
    EXPECT_NEAR(pow(x, y) / expected, 1, 4e-16 * (4 + exponent)) << x << "^" << y;
  }
}

TEST(Functions, PowerOfFloatIsRightToOneUlp) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> base(0, 1), power(1, 128);
  for (int i = 0; i < 200000; ++i) {
    const float x = base(random), y = power(random), got = pow(x, y);
    const double expected = std::pow(double(x), double(y));
    if (expected < std::numeric_limits<float>::min()) continue;
    EXPECT_LE(std::fabs(got - expected), std::ldexp(1.0, std::ilogb(expected) - 23)) << x << "^" << y;
  }
}

TEST(Functions, PowerAtTheEdges) {
  EXPECT_EQ(pow(0.0, 0.0), 1);  // a highlight with shininess 0 is everywhere
  EXPECT_EQ(pow(0.0, 5.0), 0);
  EXPECT_EQ(pow(1.0, 1e6), 1);
  EXPECT_EQ(pow(0.5, 1e6), 0);
  EXPECT_EQ(pow(2.0, 10.0), 1024);
  EXPECT_EQ(pow(2.0, 2000.0), std::numeric_limits<double>::infinity());
  EXPECT_EQ(exp2(-1022.0), std::numeric_limits<double>::min());
  EXPECT_EQ(exp2(1023.0), std::ldexp(1.0, 1023));
}

TEST(Functions, ALaneOfAPacketHasTheBitsOfTheNumber) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> base(-0.1, 1.1), power(0, 200), angle(-1000, 1000);
  for (int i = 0; i < 20000; ++i) {
    const auto numbers = [&](auto& from) { return gather<DoublePack>([&](int) { return from(random); }); };
    const DoublePack x = numbers(base), y = numbers(power), a = numbers(angle);
    const DoublePack p = pow(x, y);
    const auto turn = sincos_degrees(a);
    for (int k = 0; k < lanes; ++k) {
      EXPECT_EQ(to_bits(lane(p, k)), to_bits(pow(lane(x, k), lane(y, k))));
      EXPECT_EQ(to_bits(lane(turn.sin, k)), to_bits(sincos_degrees(lane(a, k)).sin));
      EXPECT_EQ(to_bits(lane(turn.cos, k)), to_bits(sincos_degrees(lane(a, k)).cos));
    }
  }
}

TEST(Functions, APacketThatAsksForNoPowerGetsWhatTheNumbersGet) {
  for (const double x : {-1.0, 0.0, 1e-310, 0.5, 3.0})
    for (const double y : {0.0, 7.0}) {
      const double number = pow(x, y);
      EXPECT_DOUBLE_EQ(number, std::pow(x < 1e-308 ? 0 : x, y));  // below 0 counts as 0, and 0^0 = 1
      const DoublePack all = pow(DoublePack(x), DoublePack(y));
      for (int k = 0; k < lanes; ++k) EXPECT_EQ(lane(all, k), number) << x << "^" << y;
    }
}

TEST(Pack, AMaskOfBitsHasThem) {
  using DoubleMask = MaskOf<DoublePack>;
  using FloatMask = MaskOf<Pack<float, lanes>>;
  for (std::uint32_t bits = 0; bits <= all_lane_bits<lanes>; ++bits) {
    EXPECT_EQ(lane_bits(mask_of_bits<DoubleMask>(bits)), bits);
    EXPECT_EQ(lane_bits(mask_of_bits<FloatMask>(bits)), bits);
    const DoublePack ones = select(mask_of_bits<DoubleMask>(bits), DoublePack(1.0), DoublePack(0.0));
    for (int k = 0; k < lanes; ++k) EXPECT_EQ(lane(ones, k), bits >> k & 1 ? 1 : 0);
  }
}

template <class F> void expect_least_and_greatest() {
  constexpr int count = lanes_of<F>;
  std::mt19937 random(7);
  std::uniform_real_distribution<decltype(lane(F(), 0))> number(-3, 3);
  for (int i = 0; i < 1000; ++i) {
    const F a = gather<F>([&](int) { return number(random); });
    auto least_of_all = lane(a, 0), greatest_of_all = lane(a, 0);
    for (int k = 1; k < count; ++k)
      least_of_all = std::min(least_of_all, lane(a, k)),
      greatest_of_all = std::max(greatest_of_all, lane(a, k));
    EXPECT_EQ(least(a), least_of_all);
    EXPECT_EQ(greatest(a), greatest_of_all);
  }
}
TEST(Pack, TheLeastAndTheGreatestLaneAreAmongAll) {
  expect_least_and_greatest<Pack<float, 4>>();
  expect_least_and_greatest<Pack<float, lanes>>();
  expect_least_and_greatest<DoublePack>();  // two registers
}

TEST(Pack, NumbersAreEqualOnlyIfAllAre) {
  std::int32_t numbers[lanes];
  for (std::int32_t& number : numbers) number = -5;
  EXPECT_TRUE(all_equal<lanes>(numbers));
  for (std::int32_t& number : numbers) {
    number = 5;
    EXPECT_FALSE(all_equal<lanes>(numbers));
    number = -5;
  }
  EXPECT_TRUE(all_equal<1>(numbers));
}

TEST(Pack, ARunOfEqualNumbersEndsAtTheFirstOther) {
  std::mt19937 random(7);
  for (int turn = 0; turn < 500; ++turn) {
    std::int32_t a[6 * lanes], b[6 * lanes];
    for (std::int32_t& number : a) number = random() % 40 == 0 ? 3 : -1;
    for (std::int32_t& number : b) number = random() % 40 == 0 ? 3 : -1;
    const std::uint32_t count = std::uint32_t(random() % (5 * lanes)) + 1,
                        first = std::uint32_t(random()) % count;
    const auto end_where = [&](const auto& goes_on) {
      std::uint32_t end = first;
      while (end < count && goes_on(end)) ++end;
      return end;
    };
    EXPECT_EQ(end_of_run<lanes>(first, count, a), end_where([&](auto i) { return a[i] == a[first]; }))
        << "of " << count << ", from " << first;
    EXPECT_EQ(end_of_run<lanes>(first, count, a, b),
              end_where([&](auto i) { return a[i] == a[first] && b[i] == b[first]; }))
        << "of " << count << ", from " << first;
  }
}

TEST(Functions, SineAndCosine) {
  for (int quarter = -8; quarter <= 8; ++quarter) {
    const auto [s, c] = sincos_degrees(90.0 * quarter);
    EXPECT_EQ(s, quarter % 2 == 0 ? 0 : ((quarter % 4 + 4) % 4 == 1 ? 1 : -1)) << quarter;
    EXPECT_EQ(c, quarter % 2 != 0 ? 0 : ((quarter % 4 + 4) % 4 == 0 ? 1 : -1)) << quarter;
  }
  EXPECT_NEAR(sincos_degrees(30.0).sin, 0.5, 1e-16);
  for (double degrees = -720; degrees < 720; degrees += 0.37) {
    const auto [s, c] = sincos_degrees(degrees);
    EXPECT_NEAR(s, std::sin(degrees * M_PI / 180), 4e-15);
    EXPECT_NEAR(c, std::cos(degrees * M_PI / 180), 4e-15);
    EXPECT_NEAR(s * s + c * c, 1, 1e-15);
  }
}

TEST(Transform, InverseUndoes) {
  const Transform t =
      translation({1, 2, 3}) * rotation(normalize(Vec3<double>{1, 2, -1}), 37) * scaling({2, 3, -0.5});
  const Vec3<double> p{0.3, -4, 2}, back = transform_point(inverse(t), transform_point(t, p));
  EXPECT_NEAR(length(back - p), 0, 1e-14);
  EXPECT_NEAR(determinant(t), 2 * 3 * -0.5, 1e-14);  // rotations keep volumes
}

TEST(Transform, RotationIsRightHanded) {
  const Vec3<double> x{1, 0, 0};
  EXPECT_EQ(transform_vector(rotation({0, 0, 1}, 90), x), (Vec3<double>{0, 1, 0}));  // x to y about z
  EXPECT_EQ(transform_vector(rotation({0, 1, 0}, 90), x), (Vec3<double>{0, 0, -1}));
}

TEST(Transform, NormalsStayAcross) {
  const Transform t = rotation({0, 1, 0}, 20) * scaling({1, 4, 2});
  const Vec3<double> a = normalize(Vec3<double>{1, 2, 3}),
                     b = normalize(cross(a, Vec3<double>{0, 1, 0}));  // b lies in the plane across a
  EXPECT_NEAR(dot(transform_normal(inverse(t), a), transform_vector(t, b)), 0, 1e-15);
}

}  // namespace
}  // namespace lambent
