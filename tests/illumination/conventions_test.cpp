// The conventions of other systems, each against a twin: the same written down a second time, from the other
// system's text, in plain doubles and with the C library's functions.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "illumination/equation.h"
#include "illumination/models.h"

namespace lambent {
namespace {

using C = Color<double>;
using V3 = std::array<double, 3>;

/// All that a convention may ask for, in arrays.
struct Given {
  V3 N, L, V, camera;  ///< `camera`: to a viewer infinitely far behind the camera.
  V3 ka, kd, ks, I, Il, Ia;
  double n, outside, faded;
  std::array<double, max_model_parameters> own;
};

double dot3(const V3& a, const V3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double plus(double a) { return a > 0 ? a : 0; }
/// (N.H)+^n with H = (L + V) / |L + V|.
double blinn(const V3& N, const V3& L, const V3& V, double n) {
  double length = 0, along = 0;
  for (int i = 0; i < 3; ++i) length += (L[i] + V[i]) * (L[i] + V[i]), along += N[i] * (L[i] + V[i]);
  return std::pow(plus(along / std::sqrt(length)), n);
}
/// (R.V)+^n with R the eye ray mirrored about N, seen from the light.
double phong(const V3& N, const V3& L, const V3& V, double n) {
  double along = 0;
  for (int i = 0; i < 3; ++i) along += (2 * dot3(N, V) * N[i] - V[i]) * L[i];
  return std::pow(plus(along), n);
}

Given random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> u(0, 1);
  std::normal_distribution<double> d;
  const auto direction = [&] {
    V3 v{d(random), d(random), d(random)};
    const double length = std::sqrt(dot3(v, v));
    for (double& x : v) x /= length;
    return v;
  };
  const auto color = [&] { return V3{u(random), u(random), u(random)}; };
  Given g{direction(),
          direction(),
          direction(),
          direction(),
          color(),
          color(),
          color(),
          {},
          color(),
          color(),
          std::exp(6 * u(random)),
          u(random) < 0.5 ? 1.0 : -1.0,
          u(random),
          {}};
  if (dot3(g.N, g.V) < 0)
    for (double& x : g.V) x = -x;
  if (u(random) < 0.7 && dot3(g.N, g.L) < 0)  // mostly lit
    for (double& x : g.L) x = -x;
  for (int c = 0; c < 3; ++c) g.I[c] = g.faded * g.Il[c];
  return g;
}

Surface<double, C> surface(const Given& g) {
  const auto vec = [](const V3& v) { return Vec3<double>{v[0], v[1], v[2]}; };
  const auto color = [](const V3& v) { return C{{v[0], v[1], v[2]}}; };
  Surface<double, C> s{vec(g.N), vec(g.V), color(g.ka), color(g.kd),  color(g.ks),
                       g.n,      {},       g.outside,   vec(g.camera)};
  for (int i = 0; i < max_model_parameters; ++i) s.own[i] = g.own[std::size_t(i)];
  return s;
}
Arriving<double, C> light(const Given& g) {
  return {{g.L[0], g.L[1], g.L[2]}, {{g.I[0], g.I[1], g.I[2]}}, {{g.Il[0], g.Il[1], g.Il[2]}}, g.faded};
}

/// What the twin says of a channel: the ambient term, and the two terms of the light.
struct Said {
  double ambient, diffuse, specular;
};

/// The model and its twin at 5000 random points; `own` draws the model's own numbers. Counts how often there
/// was a highlight.
template <class Model, class Own, class Twin> int compare(const Own& own, const Twin& twin) {
  std::mt19937 random(9);
  int highlights = 0;
  for (int i = 0; i < 5000; ++i) {
    Given g = random_point(random);
    g.own = own(random);
    const auto s = surface(g);
    const auto terms = Model::evaluate(s, light(g));
    const C ambient = ambient_term<Model>(s, C{{g.Ia[0], g.Ia[1], g.Ia[2]}});
    for (int c = 0; c < 3; ++c) {
      const Said want = twin(g, c);
      EXPECT_NEAR(ambient[c], want.ambient, 1e-15);
      EXPECT_NEAR(terms.diffuse[c], want.diffuse, 1e-13);
      EXPECT_NEAR(terms.specular[c], want.specular, 1e-12 * (1 + want.specular));
      highlights += want.specular > 1e-3;
    }
  }
  return highlights;
}

using Own = std::array<double, max_model_parameters>;

TEST(Mtl, IsTheTextOfTheFormat) {
  const auto own = [](std::mt19937& random) { return Own{double(random() % 11)}; };
  const int highlights = compare<lambent::Mtl>(own, [](const Given& g, int c) -> Said {
    const int illum = int(g.own[0]);
    if (illum == 0) return {g.kd[c], 0, 0};
    if (illum == 10) return {0, 0, 0};
    const double ambient = g.ka[c] * g.Ia[c], nl = dot3(g.N, g.L);
    if (nl <= 0) return {ambient, 0, 0};
    double specular = 0;
    if (illum >= 2) specular = g.ks[c] * blinn(g.N, g.L, g.V, g.n) * g.I[c];
    if (illum == 5 || illum == 7)  // L.H is the cosine of half the angle between L and V
      specular *= g.ks[c] + (1 - g.ks[c]) * std::pow(1 - std::sqrt((1 + dot3(g.L, g.V)) / 2), 5);
    return {ambient, g.kd[c] * nl * g.I[c], specular};
  });
  EXPECT_GT(highlights, 500);
}

TEST(OpenGl, IsTheSpecifications) {
  const auto own = [](std::mt19937& random) { return Own{double(random() % 2), double(random() % 2)}; };
  const int highlights = compare<OpenGl>(own, [](const Given& g, int c) -> Said {
    V3 N = g.N;
    if (g.own[1] == 0)
      for (double& x : N) x *= g.outside;
    const double nl = dot3(N, g.L), ambient = g.ka[c] * g.Ia[c];
    if (nl <= 0) return {ambient, 0, 0};
    return {ambient, nl * g.kd[c] * g.I[c],
            g.ks[c] * blinn(N, g.L, g.own[0] == 1 ? g.V : g.camera, g.n) * g.I[c]};
  });
  EXPECT_GT(highlights, 500);
}

TEST(Povray, IsItsFinish) {
  const auto own = [](std::mt19937& random) {
    std::uniform_real_distribution<double> u(0, 1);
    return Own{2 * u(random), std::exp(-5 * u(random)), 3 * u(random)};
  };
  const int highlights = compare<Povray>(own, [](const Given& g, int c) -> Said {
    const double nl = dot3(g.N, g.L), ambient = g.ka[c] * g.Ia[c];
    if (nl <= 0) return {ambient, 0, 0};
    return {ambient, g.kd[c] * std::pow(nl, g.own[2]) * g.I[c],
            (g.ks[c] * phong(g.N, g.L, g.V, g.n) + g.own[0] * blinn(g.N, g.L, g.V, 1 / g.own[1])) * g.I[c]};
  });
  EXPECT_GT(highlights, 500);
}

TEST(Tachyon, IsItsShading) {
  const auto own = [](std::mt19937& random) { return Own{double(random() % 3)}; };
  const int highlights = compare<Tachyon>(own, [](const Given& g, int c) -> Said {
    const double nl = dot3(g.N, g.L), ambient = g.ka[c] * g.Ia[c];
    if (g.faded * nl <= 1 / 512.) return {ambient, 0, 0};
    const double t = blinn(g.N, g.L, g.V, 1);
    const double f = g.own[0] == 0   ? blinn(g.N, g.L, g.V, g.n)
                     : g.own[0] == 1 ? phong(g.N, g.L, g.V, g.n)
                                     : t / (g.n - g.n * t + t);
    return {ambient, nl * g.kd[c] * g.I[c], f * g.ks[c] * g.Il[c]};
  });
  EXPECT_GT(highlights, 500);
}

TEST(Tachyon, NoHighlightInFullShadowAndAWholeOneBehindGlass) {
  Given g{{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {}, {1, 1, 1}, {1, 1, 1},
          {},        {2, 2, 2}, {},        8,         1,  1,         {}};
  EXPECT_EQ(Tachyon::evaluate(surface(g), light(g)).specular[0], 0);  // nothing arrives
  g.I = {0, 0.5, 0};                                                  // green glass on the way
  const auto terms = Tachyon::evaluate(surface(g), light(g));
  EXPECT_EQ(terms.diffuse[0], 0);
  EXPECT_EQ(terms.diffuse[1], 0.5);
  for (int c = 0; c < 3; ++c) EXPECT_DOUBLE_EQ(terms.specular[c], 2);
}

TEST(OpenGl, OppositeDirectionsHaveNoHalfway) {
  Given g{{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, -1, 0}, {}, {}, {1, 1, 1}, {1, 1, 1}, {}, {}, 8, 1, 1, {}};
  EXPECT_EQ(OpenGl::evaluate(surface(g), light(g)).specular[0], 0);
}

}  // namespace
}  // namespace lambent
