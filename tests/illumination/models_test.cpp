// Each model against its closed form, and what all models have in common. The formula stands beside the
// number.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <string>

#include "illumination/equation.h"
#include "illumination/models.h"
#include "math/gather.h"
#include "math/pack.h"

namespace lambent {
namespace {

using C = Color<double>;

/// A point with N up, the eye at angle `eye` and the light at angle `light` from N, in degrees, in one plane;
/// positive to the right.
struct Situation {
  Surface<double, C> s;
  Arriving<double, C> light;
};
Situation situation(double light, double eye, double n) {
  const auto direction = [](double degrees) {
    return Vec3<double>{std::sin(degrees * M_PI / 180), std::cos(degrees * M_PI / 180), 0};
  };
  Situation result{};
  result.s = {{0, 1, 0}, direction(eye), {}, {{0.8, 0.4, 0.2}}, {{0.5, 0.6, 0.7}}, n, {}};
  result.light = {direction(light), {{1, 2, 4}}};
  return result;
}
double cosine(double degrees) { return std::cos(degrees * M_PI / 180); }

template <class Model> void expect_terms(const Situation& situation, double diffuse, double specular) {
  const Terms<C> got = Model::evaluate(situation.s, situation.light);
  for (int c = 0; c < color_channels; ++c) {
    const double I = situation.light.I[c];
    EXPECT_NEAR(got.diffuse[c], I * situation.s.kd[c] * diffuse, 1e-14 * I);
    EXPECT_NEAR(got.specular[c], I * situation.s.ks[c] * specular, 1e-13 * I);
  }
}

TEST(Conventional, IsLambertsCosine) {
  expect_terms<Conventional>(situation(60, 10, 32), 0.5, 0);  // cos 60 = 1/2
  expect_terms<Conventional>(situation(0, 80, 32), 1, 0);
  expect_terms<Conventional>(situation(90.001, 10, 32), 0, 0);
}

TEST(Attenuated, IsConventionalWithOneOverRSquared) {
  expect_terms<Attenuated>(situation(60, 10, 32), 0.5, 0);
  EXPECT_EQ(info(ModelId::attenuated).attenuation, attenuation_1_over_r2);
  EXPECT_EQ(info(ModelId::conventional).attenuation, attenuation_none);
}

TEST(Phong, HighlightIsAroundTheMirroredLight) {
  // L at 30 to the left, R at 30 to the right; V at 50 to the right: the angle between R and V is 20.
  expect_terms<Phong>(situation(-30, 50, 10), cosine(30), std::pow(cosine(20), 10));
  expect_terms<Phong>(situation(-30, 30, 1e6), cosine(30), 1);  // V = R
  expect_terms<Phong>(situation(-30, -61, 3), cosine(30), 0);   // R.V < 0
  expect_terms<Phong>(situation(-91, 89, 1), 0, 0);  // light behind: no highlight, though R.V is 0.99
}

TEST(BlinnPhong, HighlightIsAroundTheHalfVector) {
  // H halves the angle between L at -30 and V at 50: it stands at 10.
  expect_terms<BlinnPhong>(situation(-30, 50, 10), cosine(30), std::pow(cosine(10), 10));
  expect_terms<BlinnPhong>(situation(-30, 30, 1e6), cosine(30), 1);
  expect_terms<BlinnPhong>(situation(-91, 89, 1), 0, 0);
}

TEST(BlinnPhong, NothingWhereLightAndEyeAreOpposite) {
  const Terms<C> got = BlinnPhong::evaluate(situation(89, -91, 1).s, situation(89, -91, 1).light);
  EXPECT_LT(got.specular[0], 1e-12);  // L + V vanishes: there is no halfway, and no NaN
}

TEST(BlinnPhongHalfway, IsBlinnsTimesACosine) {
  // |(L + V) / 2| = cos 40, half the angle of 80 between L and V; so N.H = cos 10 cos 40.
  expect_terms<BlinnPhongHalfway>(situation(-30, 50, 10), cosine(30), std::pow(cosine(10) * cosine(40), 10));
}

TEST(Equation, IsAmbientPlusTheSumOfTheLights) {
  // I = Ka Ia / R + sum Il / r [ Kd (N.L)+ + Ks ((R.V)+)^n ], by hand for two lights.
  Situation a = situation(-30, 50, 10), b = situation(60, 50, 10);
  a.s.ka = {{0.1, 0.2, 0.3}};
  const double R = 5, r[2] = {2, 4};
  const C Ia = attenuate(AmbientAttenuation::one_over_R, R, 1e-3) * C{{1, 1, 1}};
  const C I = illuminate<Phong>(a.s, Ia, 2, [&](int l) {
    Arriving<double, C> light = l == 0 ? a.light : b.light;
    light.I = attenuate(attenuation_1_over_r, r[l], 1e-3) * light.I;
    return light;
  });
  for (int c = 0; c < color_channels; ++c) {
    const double Il = a.light.I[c], kd = a.s.kd[c], ks = a.s.ks[c];
    const double expected = a.s.ka[c] / 5 + Il / 2 * (kd * cosine(30) + ks * std::pow(cosine(20), 10)) +
                            Il / 4 * (kd * cosine(60) + ks * std::pow(std::fmax(0, cosine(110)), 10));
    EXPECT_NEAR(I[c], expected, 1e-14);
  }
}

TEST(Equation, ObserverSeesTheSummandsInOrder) {
  const Situation a = situation(-30, 50, 10);
  C sum{};
  std::string order;
  const C I = illuminate<Phong>(
      a.s, C{{1, 1, 1}}, 2, [&](int) { return a.light; },
      [&](Term term, int light, const C& value) {
        sum = sum + value;
        order += std::string(term == Term::ambient   ? "a"
                             : term == Term::diffuse ? "d"
                                                     : "s") +
                 (light < 0 ? "" : std::to_string(light)) + " ";
      });
  EXPECT_EQ(order, "a d0 s0 d1 s1 ");
  EXPECT_TRUE(sum == I);  // bit for bit
}

TEST(Attenuation, ClosedForms) {
  EXPECT_EQ(attenuate(attenuation_none, 7.0, 1e-3), 1);
  EXPECT_EQ(attenuate(Attenuation{2, 0, 0}, 7.0, 1e-3),
            1 / 2.0);  // 1 / (constant + linear r + quadratic r^2)
  EXPECT_EQ(attenuate(Attenuation{2, 0, 0}, double(INFINITY), 1e-3), 1);
  EXPECT_EQ(attenuate(attenuation_1_over_r, 4.0, 1e-3), 1 / 4.0);
  EXPECT_EQ(attenuate(attenuation_1_over_r2, 4.0, 1e-3), 1 / 16.0);
  EXPECT_DOUBLE_EQ(attenuate(Attenuation{1, 2, 3}, 2.0, 1e-3), 1 / (1 + 2 * 2 + 3 * 4.0));
  EXPECT_EQ(attenuate(attenuation_1_over_r, 0.0, 1e-3), 1000);  // r counts as at least the minimum
  EXPECT_EQ(attenuate(attenuation_1_over_r2, double(INFINITY), 1e-3),
            1);  // a light at infinity does not fade
  EXPECT_EQ(attenuate(AmbientAttenuation::none, 9.0, 1e-3), 1);
  EXPECT_EQ(attenuate(AmbientAttenuation::one_over_R, 8.0, 1e-3), 1 / 8.0);
}

// ---- what holds for every model of models.def: a new one is tested here without a word

Vec3<double> random_direction(std::mt19937& random) {
  std::normal_distribution<double> d;
  return normalize(Vec3<double>{d(random), d(random), d(random)});
}

Situation random_situation(std::mt19937& random, const ModelInfo& model) {
  std::uniform_real_distribution<double> u(0, 1);
  Situation result{};
  result.s.N = random_direction(random);
  result.s.V = random_direction(random);
  if (dot(result.s.N, result.s.V) < 0) result.s.V = -result.s.V;
  result.s.kd = {{u(random), u(random), u(random)}};
  result.s.ks = {{u(random), u(random), u(random)}};
  result.s.n = 200 * u(random);
  // The model's own numbers: as they are by default, or anywhere in their ranges.
  const bool by_default = u(random) < 0.3;
  for (int i = 0; i < max_model_parameters && model.parameters[i].name; ++i) {
    const ModelParameter& own = model.parameters[i];
    const double anywhere = own.min + (min(own.max, own.min + 20) - own.min) * u(random);
    result.s.own[i] = by_default ? own.default_value : own.whole ? std::round(anywhere) : anywhere;
  }
  result.s.to_camera = random_direction(random);
  const double faded = u(random);
  const C Il{{u(random), u(random), u(random)}};
  result.light = {random_direction(random), faded * Il, Il, faded};
  return result;
}

template <class Visitor> void for_each_model(const Visitor& visitor) {
  for (int id = 0; id < model_count; ++id) {
    SCOPED_TRACE(info(ModelId(id)).name);
    with_model(ModelId(id), [&]<class Model>() { visitor.template operator()<Model>(); });
  }
}

TEST(EveryModel, HasAManualPage) {
  std::set<std::string> names;
  for (const ModelInfo& model : model_infos) {
    EXPECT_TRUE(names.insert(model.name).second) << model.name << " twice";
    EXPECT_NE(std::string(model.title), "");
    EXPECT_NE(std::string(model.equation), "");
    EXPECT_NE(std::string(model.source), "");
    EXPECT_NE(std::string(model.differs), "") << model.name;
    for (const ModelParameter& parameter : model.parameters) {
      if (!parameter.name) break;
      EXPECT_LE(parameter.min, parameter.default_value);
      EXPECT_LE(parameter.default_value, parameter.max);
      EXPECT_NE(std::string(parameter.sentence), "");
    }
  }
}

TEST(EveryModel, HasATestSuiteOfItsOwnName) {
  const auto* tests = testing::UnitTest::GetInstance();
  const auto tested = [&](const std::string& name) {
    for (int i = 0; i < tests->total_test_suite_count(); ++i)
      if (tests->GetTestSuite(i)->name() == name) return true;
    return false;
  };
#define LAMBENT_MODEL(name, Struct) \
  EXPECT_TRUE(tested(#Struct)) << "write TEST(" #Struct ", ...) with the closed form of the model " #name;
#include "illumination/models.def"
#undef LAMBENT_MODEL
}

TEST(EveryModel, SendsNothingBackOfALightBehindTheSurface) {
  for_each_model([]<class Model>() {
    std::mt19937 random(5);
    for (int i = 0; i < 2000; ++i) {
      Situation x = random_situation(random, Model::info);
      if (dot(x.s.N, x.light.L) > 0) x.light.L = -x.light.L;
      const auto terms = Model::evaluate(x.s, x.light);
      EXPECT_TRUE(is_black(terms.diffuse) && is_black(terms.specular));
    }
  });
}

TEST(EveryModel, IsFiniteNotNegativeAndLinearInTheLight) {
  for_each_model([]<class Model>() {
    std::mt19937 random(6);
    for (int i = 0; i < 2000; ++i) {
      Situation x = random_situation(random, Model::info);
      const auto once = Model::evaluate(x.s, x.light);
      x.light.I = 2.0 * x.light.I, x.light.Il = 2.0 * x.light.Il;
      const auto twice = Model::evaluate(x.s, x.light);
      for (int c = 0; c < color_channels; ++c) {
        EXPECT_TRUE(std::isfinite(once.diffuse[c]) && once.diffuse[c] >= 0);
        EXPECT_TRUE(std::isfinite(once.specular[c]) && once.specular[c] >= 0);
        EXPECT_EQ(twice.diffuse[c], 2 * once.diffuse[c]);
        EXPECT_EQ(twice.specular[c], 2 * once.specular[c]);
      }
    }
  });
}

TEST(EveryModel, GivesTheSameBitsForANumberAndForALane) {
  using P = Pack<double, native_float_lanes>;
  using CP = Color<P>;
  for_each_model([]<class Model>() {
    std::mt19937 random(7);
    for (int i = 0; i < 2000; ++i) {
      Situation one[lanes_of<P>];
      for (Situation& situation : one) {
        situation = random_situation(random, Model::info);
        situation.s.outside = random() % 2 == 0 ? 1 : -1;
      }
      const auto vectors = [&](const auto& of) {
        return gather_points<P>([&](int k) { return of(one[k]); });
      };
      Surface<P, CP> s;
      Arriving<P, CP> light;
      s.N = vectors([](const Situation& a) { return a.s.N; });
      s.V = vectors([](const Situation& a) { return a.s.V; });
      s.to_camera = vectors([](const Situation& a) { return a.s.to_camera; });
      s.outside = gather<P>([&](int k) { return one[k].s.outside; });
      light.L = vectors([](const Situation& a) { return a.light.L; });
      light.faded = gather<P>([&](int k) { return one[k].light.faded; });
      s.n = gather<P>([&](int k) { return one[k].s.n; });
      for (int c = 0; c < color_channels; ++c) {
        s.kd[c] = gather<P>([&](int k) { return one[k].s.kd[c]; });
        s.ks[c] = gather<P>([&](int k) { return one[k].s.ks[c]; });
        light.I[c] = gather<P>([&](int k) { return one[k].light.I[c]; });
        light.Il[c] = gather<P>([&](int k) { return one[k].light.Il[c]; });
      }
      for (int j = 0; j < max_model_parameters; ++j)
        s.own[j] = gather<P>([&](int k) { return one[k].s.own[j]; });
      const auto together = Model::evaluate(s, light);
      for (int k = 0; k < lanes_of<P>; ++k) {
        const auto alone = Model::evaluate(one[k].s, one[k].light);
        for (int c = 0; c < color_channels; ++c) {
          EXPECT_EQ(to_bits(lane(together.diffuse[c], k)), to_bits(alone.diffuse[c]));
          EXPECT_EQ(to_bits(lane(together.specular[c], k)), to_bits(alone.specular[c]));
        }
      }
    }
  });
}

// ---- a model of somebody else's

/// CONTRIBUTING.md's example, as it would stand in a file of its own.
struct Minnaert {
  static constexpr ModelInfo info{
      .name = "minnaert",
      .title = "the dark or bright limb of moons and velvet",
      .equation = "Il Kd (N.L)+ ((N.L)(N.V))^(k - 1)",
      .source = "Minnaert, The reciprocity principle in lunar photometry, 1941",
      .parameters = {{"limb", 1.0, 1.0, 4.0, "", "k: 1 is Lambert's law, more darkens the limb."}}};
  template <class F, class C> static Terms<C> evaluate(const Surface<F, C>& s, const Arriving<F, C>& light) {
    const F nl = max(dot(s.N, light.L), F(0)), nv = max(dot(s.N, s.V), F(0));
    return {nl * pow(nl * nv, s.own[0] - F(1)) * (s.kd * light.I), C{}};
  }
};

TEST(ANewModel, NeedsNothingButItsStruct) {
  Situation x = situation(60, 30, 1);
  x.s.own[0] = 2;
  expect_terms<Minnaert>(x, 0.5 * (0.5 * cosine(30)), 0);
  x.s.own[0] = 1;
  expect_terms<Minnaert>(x, 0.5, 0);  // k = 1 is Lambert
  const Surface<float, Color<float>> s{{0, 1, 0}, {0, 1, 0}, {}, {{1, 1, 1}}, {}, 1, {2}};
  EXPECT_FLOAT_EQ(illuminate<Minnaert>(s, Color<float>{}, 1,
                                       [](int) {
                                         return Arriving<float, Color<float>>{{0, 1, 0}, {{1, 1, 1}}};
                                       })[0],
                  1.f);
}

}  // namespace
}  // namespace lambent
