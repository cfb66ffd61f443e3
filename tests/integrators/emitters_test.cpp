// What shines, as paths look for it: against closed forms, and against itself, as rays that go anywhere find
// it.

#include "integrators/emitters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "integrators/build_light_tree.h"
#include "integrators/prepare.h"
#include "integrators/prepare_emitters.h"
#include "lambent/lambent.h"
#include "what_shines.h"

namespace lambent {
namespace {

using V = Vec3<double>;

/// A scene, laid out for paths.
struct Prepared {
  std::shared_ptr<Scene> scene;
  std::unique_ptr<PreparedFrame> frame;
  std::unique_ptr<PreparedEmitters> emitters;

  explicit Prepared(const Scene& from) : scene(std::make_shared<Scene>(from)), frame(prepare(*scene)) {
    emitters = prepare_emitters(frame->frame, frame->world);
    frame->frame.emitters = &emitters->table;
  }
  explicit Prepared(const std::string& yaml) : Prepared(*parse_scene(with_camera(yaml))) {}
  static std::string with_camera(const std::string& yaml) {
    return "lambent: 1\ncamera: {eye: [0, 0, 9], target: [0, 0, 0]}\n" + yaml;
  }
  const Frame& operator*() const { return frame->frame; }
};

/// Points that fill the unit cube evenly: Roberts' R3 sequence.
struct Points {
  std::uint64_t i = 0;
  V next() {
    const double g = 1.2207440846057596;  // g^4 = g + 1
    const auto at = [&](double step) { return std::fmod(0.5 + double(i) * step, 1.0); };
    const V p{at(1 / g), at(1 / (g * g)), at(1 / (g * g * g))};
    ++i;
    return p;
  }
};

struct Mean {
  double sum = 0, squares = 0;
  int count = 0;
  void add(double x) { sum += x, squares += x * x, ++count; }
  double mean() const { return sum / count; }
  /// Its standard deviation, were the numbers independent.
  double error() const { return std::sqrt(std::max(squares / count - mean() * mean(), 0.0) / count); }
};

/// What a surface at P that faces N gets of all that shines, nothing in the way: the integral of radiance
/// times cosine.
Mean irradiance(const Frame& frame, const V& P, const V& N, int count) {
  Points points;
  Mean mean;
  for (int i = 0; i < count; ++i) {
    const V p = points.next();
    const EmitterSample s = sample_emitters(frame, P, N, p.x, p.y, p.z);
    mean.add(s.radiance_over_density[0] * std::max(dot(N, s.L), 0.0));
  }
  return mean;
}

void expect_irradiance(const Prepared& prepared, const V& P, const V& N, double expected) {
  const Mean mean = irradiance(*prepared, P, N, 1 << 14);
  EXPECT_NEAR(mean.mean(), expected, 4 * mean.error() + 1e-6 * expected);
}

TEST(Emitters, RectangleGivesWhatLambertsFormulaSays) {
  // Le = pi Il / A = pi 3 / 2; seen from a floor below, and from a wall at a right angle to the light.
  const Prepared p("lights: [{rectangle: {center: [0, 2, 0], u: [2, 0, 0], v: [0, 0, 1], intensity: 3}}]\n");
  const std::vector<V> corners{{-1, 2, -0.5}, {1, 2, -0.5}, {1, 2, 0.5}, {-1, 2, 0.5}};
  const double Le = M_PI * 3 / 2;
  for (const V& P : {V{0, 0, 0}, V{0.7, 1, 0.3}, V{-3, 0, 2}}) {
    expect_irradiance(p, P, {0, 1, 0}, Le * test::polygon_irradiance(P, {0, 1, 0}, corners));
    expect_irradiance(p, P, normalize(V{0.1, 1, 0}),
                      Le * test::polygon_irradiance(P, normalize(V{0.1, 1, 0}), corners));
  }
  expect_irradiance(p, {-2, 0.5, 0}, {1, 0, 0},
                    Le * test::polygon_irradiance({-2, 0.5, 0}, {1, 0, 0}, corners));
  EXPECT_EQ(irradiance(*p, {0, 3, 0}, {0, -1, 0}, 64).mean(), 0) << "behind it";
}

TEST(Emitters, DiscAndSphereGiveTheirClosedForms) {
  // On the axis of a disc E = pi Le R^2 / (R^2 + d^2), Le = Il / R^2.
  const Prepared disc(
      "lights: [{disc: {center: [0, 2, 0], normal: [0, -1, 0], radius: 1.5, intensity: 4}}]\n");
  expect_irradiance(disc, {0, 0, 0}, {0, 1, 0}, M_PI * 4 / (1.5 * 1.5 + 4));
  // Of a sphere that is all above the horizon E = pi Le (R / d)^2 cos = pi Il cos / d^2.
  const Prepared ball("lights: [{sphere: {center: [0, 2, 0], radius: 0.9, intensity: 4}}]\n");
  expect_irradiance(ball, {0, 0, 0}, {0, 1, 0}, M_PI * 4 / 4);
  expect_irradiance(ball, {0, 0, 0}, {0.6, 0.8, 0}, M_PI * 4 / 4 * 0.8);
}

TEST(Emitters, LightsWithoutExtentGiveTheEquationsNumbers) {
  // pi Il / r^2 and pi Il.
  const Prepared p(
      "lights:\n  - {point: {position: [0, 2, 0], intensity: 8}}\n"
      "  - {spot: {position: [0, 4, 0], target: [0, 0, 0], softness: 0, intensity: 16}}\n"
      "  - {directional: {direction: [0, -1, 0], intensity: 0.5}}\n");
  expect_irradiance(p, {0, 0, 0}, {0, 1, 0}, M_PI * (8 / 4.0 + 16 / 16.0 + 0.5));
  expect_irradiance(p, {3, 0, 0}, {0, 1, 0}, M_PI * (8 / 13.0 * 2 / std::sqrt(13) + 0.5));  // out of the cone
  EXPECT_EQ(sample_emitters(*p, {0, 0, 0}, {0, 1, 0}, 0.3, 0.5, 0.5).density, 0);
}

TEST(Emitters, SurfacesThatShineAreLights) {
  // A square of radiance 2 as two triangles, and the same as one of an instance's, stretched from half the
  // size.
  const std::string square =
      "mesh: {vertices: [[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1]], triangles: [[0, 1, 2], [0, 2, 3]]}";
  const Prepared p("objects: [{" + square + ", material: {emission: 2, diffuse: 0}}]\n");
  const std::vector<V> corners{{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}};
  expect_irradiance(p, {0.3, 0, 0}, {0, 1, 0}, 2 * test::polygon_irradiance({0.3, 0, 0}, {0, 1, 0}, corners));
  // Both sides shine, unless the material is one-sided: the square faces down.
  expect_irradiance(p, {0.3, 4, 0}, {0, -1, 0},
                    2 * test::polygon_irradiance({0.3, 4, 0}, {0, -1, 0}, corners));
  const Prepared one("objects: [{" + square + ", material: {emission: 2, diffuse: 0, one_sided: true}}]\n");
  expect_irradiance(one, {0.3, 0, 0}, {0, 1, 0},
                    2 * test::polygon_irradiance({0.3, 0, 0}, {0, 1, 0}, corners));
  EXPECT_EQ(irradiance(*one, {0.3, 4, 0}, {0, -1, 0}, 64).mean(), 0);
  // Spheres and discs as the lights of their kind: Le = Il / R^2.
  const Prepared ball(
      "objects: [{sphere: {center: [0, 3, 0], radius: 0.5}, material: {emission: 2, opacity: 0.5}}]\n");
  expect_irradiance(ball, {0, 0, 0}, {0, 1, 0}, 0.5 * M_PI * 2 * 0.25 / 9);
  const Prepared disc(
      "objects: [{disc: {center: [0, 2, 0], normal: [0, 1, 0], radius: 1}, material: {emission: 2}}]\n");
  expect_irradiance(disc, {0, 0, 0}, {0, 1, 0}, M_PI * 2 / (1 + 4));
  // From inside, a sphere is all the sky: pi Le.
  expect_irradiance(
      Prepared("objects: [{sphere: {center: [0, 0, 0], radius: 50}, material: {emission: 2}}]\n"),
      {10, 20, 5}, {0, 1, 0}, M_PI * 2);
}

TEST(Emitters, APointOnASphereThatShinesSeesItsInside) {
  const Prepared p("objects: [{sphere: {center: [0.1, 0.2, 0.3], radius: 1.7}, material: {emission: 2}}]\n");
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    const V n = normalize(V{normal(random), normal(random), normal(random)});
    const V P = V{0.1, 0.2, 0.3} + 1.7 * n;
    // The point opposite is 2 R away, and no point has the radiance of a ball that is seen from outside.
    const EmitterSample s = sample_emitters(*p, P, -n, 0.5, 0.37, 0.61);
    EXPECT_NEAR(length(P + s.r * s.L - V{0.1, 0.2, 0.3}), 1.7, 1e-12);
    EXPECT_GT(s.r, 0.01);
    // All of the sphere counts alike: r^2 / (A cos) with cos = r / (2 R).
    EXPECT_NEAR(s.density, 2 * 1.7 * s.r / (4 * M_PI * 1.7 * 1.7), 1e-9 * s.density);
  }
}

TEST(Emitters, ABackgroundOfOneColourGivesPiTimesIt) {
  const Prepared p("background: [0.5, 0.7, 0.9]\n");
  expect_irradiance(p, {0, 0, 0}, {0.6, 0.8, 0}, M_PI * 0.5);
  EXPECT_EQ(p.emitters->table.background, 0);
  EXPECT_EQ(Prepared("background: 0\n").emitters->table.root_count, 0);
}

// Of the background B = 0.2 pi counts (B / 2 - S) / 2, S = pi N.L the sun, and its chance is 3/4 of its share
// and an even part of the last quarter. The densities below are those along N, 1 / pi times the chance.
TEST(Emitters, ABackgroundOfOneColourIsLeftToPathsThatGoOnWhereOthersLight) {
  const Prepared p("background: 0.2\nlights: [{directional: {direction: [0, -1, 0]}}]\n");
  const V P{0, 0, 0}, up{0, 1, 0}, down{0, -1, 0}, aside{std::sqrt(1 - 0.05 * 0.05), 0.05, 0};
  EXPECT_EQ(background_density(*p, P, up, up), 0);
  EXPECT_NEAR(background_density(*p, P, down, down), 1 / M_PI, 1e-12);
  const double chance = 0.75 * (0.025 / (0.025 + 0.05)) + 0.125;
  EXPECT_NEAR(background_density(*p, P, aside, aside), chance / M_PI, 1e-12);
  for (int i = 0; i < 64; ++i) {
    const double u = (i + 0.5) / 64;
    EXPECT_EQ(sample_emitters(*p, P, up, u, u, u).light, 0) << "the sun alone";
  }
  // Where the path ends nothing else finds the sky.
  Points points;
  Mean mean;
  for (int i = 0; i < 1 << 14; ++i) {
    const V at = points.next();
    const EmitterSample s = sample_emitters(*p, P, up, at.x, at.y, at.z, false);
    mean.add(s.radiance_over_density[0] * std::max(dot(up, s.L), 0.0));
  }
  EXPECT_NEAR(mean.mean(), M_PI * 1.2, 4 * mean.error());
}

TEST(Emitters, NothingThatShinesGivesNothing) {
  const Prepared p("objects: [{sphere: {center: [0, 0, 0], radius: 1}}]\n");
  const EmitterSample s = sample_emitters(*p, {0, 2, 0}, {0, 1, 0}, 0.5, 0.5, 0.5);
  EXPECT_TRUE(is_black(s.radiance_over_density));
  EXPECT_EQ(s.density, 0);
}

// ---- densities, as rays in all directions find them

V direction(double u, double v) {
  const double z = 1 - 2 * v, across = std::sqrt(std::max(1 - z * z, 0.0));
  return {across * std::cos(2 * M_PI * u), z, across * std::sin(2 * M_PI * u)};
}

/// The density with which sample_emitters would have chosen what a ray from P meets.
double density_along(const Frame& frame, const V& P, const V& N, const V& L) {
  const QueryRay<float> ray(cast<float>(P), cast<float>(L));
  Closest<float> hit{__builtin_inff()};
  find_closest(frame.world, ray, true, hit);
  if (hit.ids.geometry < 0) return background_density(frame, P, N, L);
  const SurfacePoint<double> s = surface_at(frame.world, hit.ids, P, L, hit.t);
  return emitter_density(frame, P, N, hit.ids, s.P, s.Ng, L);
}
bool is_open(const Frame& frame, const V& P, const EmitterSample& s) {
  const QueryRay<float> ray(cast<float>(P), cast<float>(s.L));
  return !find_occluded(frame.world, ray, true, float(s.clear), true);
}

/// Samples that are open, sorted into cells of equal solid angle, against the integral of the density over
/// each cell; and the density of a sample against what the ray along it finds.
void expect_density_as_sampled(const Prepared& prepared, const V& P, const V& N, const std::string& what) {
  SCOPED_TRACE(what);
  const Frame& frame = *prepared;
  constexpr int across = 8, up = 8, count = 40000, fine = 60;
  std::vector<double> seen(across * up), expected(across * up);
  const auto cell = [&](const V& L) {
    const double turn = std::atan2(L.z, L.x) / (2 * M_PI), u = turn < 0 ? turn + 1 : turn, v = (1 - L.y) / 2;
    return std::min(int(v * up), up - 1) * across + std::min(int(u * across), across - 1);
  };
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  int open = 0, compared = 0, found_there = 0, close = 0;
  for (int i = 0; i < count; ++i) {
    const EmitterSample s = sample_emitters(frame, P, N, uniform(random), uniform(random), uniform(random));
    if (!(s.density > 0) || !is_open(frame, P, s)) continue;
    ++open;
    ++seen[std::size_t(cell(s.L))];
    if (i >= 2000) continue;
    // Rays in float may miss an edge, and at the rim of something round the density grows without end.
    const double found = density_along(frame, P, N, s.L);
    ++compared;
    found_there += found > 0;
    close += std::fabs(found - s.density) <= 1e-4 * s.density;
  }
  EXPECT_GE(found_there, 0.99 * compared);
  EXPECT_GE(close, 0.95 * compared);
  double integral = 0;
  for (int y = 0; y < up * fine; ++y)
    for (int x = 0; x < across * fine; ++x) {
      const V L = direction((x + 0.5) / (across * fine), (y + 0.5) / (up * fine));
      const double part = density_along(frame, P, N, L) * 4 * M_PI / (across * up * fine * fine);
      expected[std::size_t(cell(L))] += part * count;
      integral += part;
    }
  EXPECT_NEAR(integral, double(open) / count, 0.015);
  double chi = 0;
  int cells = 0;
  for (std::size_t c = 0; c < seen.size(); ++c) {
    if (expected[c] < 20) continue;
    // The grid's own error beside that of counting: some thousandths of what is seen.
    const double error = expected[c] + std::pow(0.02 * expected[c], 2);
    chi += std::pow(seen[c] - expected[c], 2) / error;
    ++cells;
  }
  ASSERT_GT(cells, 0);
  EXPECT_LT(chi, cells + 5 * std::sqrt(2.0 * cells));
}

TEST(Emitters, DensitiesAgreeWithWhatIsChosen) {
  const V none{0, 0, 0};
  const struct {
    const char *what, *yaml;
  } kinds[] = {
      {"rectangle", "lights: [{rectangle: {center: [0.3, 1, 0.2], u: [2, 0, 0.3], v: [0, 0.2, 1.5]}}]\n"},
      {"rectangle, two-sided",
       "lights: [{rectangle: {center: [0.3, 1, 0.2], v: [2, 0, 0], u: [0, 0, 1.5], two_sided: true}}]\n"},
      {"disc", "lights: [{disc: {center: [0.3, 1, 0.2], normal: [0.1, -1, 0], radius: 1.2}}]\n"},
      {"sphere", "lights: [{sphere: {center: [0.3, 1.5, 0.2], radius: 1.1}}]\n"},
      {"triangles",
       "objects: [{mesh: {vertices: [[-1, 1, -1], [1, 1, -1], [1, 2, 1], [-1, 1, 1]], triangles: [[0, 1, 2], "
       "[0, 2, 3]]}, material: {emission: 1}}]\n"},
      {"sphere of an object",
       "objects: [{sphere: {center: [0.3, 1.5, 0.2], radius: 1.1}, material: {emission: 1}}]\n"},
      {"sphere from inside",
       "objects: [{sphere: {center: [0.3, 0.5, 0.2], radius: 2}, material: {emission: 1}}]\n"},
      {"stretched sphere",
       "objects: [{sphere: {center: [0, 0, 0], radius: 1}, transform: [{scale: [1.5, 0.5, 1]}, {translate: "
       "[0, 1, 0]}], material: {emission: 1}}]\n"},
      {"disc of an object",
       "objects: [{disc: {center: [0.3, 1, 0.2], normal: [0.1, -1, 0], radius: 1.2}, material: {emission: "
       "1}}]\n"},
      {"cylinder",
       "objects: [{cylinder: {from: [-1, 1, 0], to: [1, 1.2, 0.3], radius: 0.4}, material: {emission: "
       "1}}]\n"},
      {"cone",
       "objects: [{cone: {from: [-1, 1, 0], to: [1, 1.2, 0.3], radius_from: 0.9, radius_to: 0}, material: "
       "{emission: 1}}]\n"},
      {"background", "background: 1\n"},
      {"several",
       "background: 0.1\nlights: [{sphere: {center: [2, 1.5, 0.2], radius: 0.8, intensity: 0.5}}]\n"
       "objects: [{disc: {center: [-1, 1.5, 0], normal: [0, 1, 0], radius: 1.2}, material: {emission: "
       "1}}]\n"},
  };
  for (const auto& kind : kinds) {
    const Prepared p(kind.yaml);
    expect_density_as_sampled(p, {0.1, 0, 0.05}, none, kind.what);
    expect_density_as_sampled(p, {0.1, 0, 0.05}, normalize(V{0.3, 1, 0.1}), kind.what);
  }
}

TEST(Emitters, InstancesOfASurfaceAreLightsEachForItself) {
  // 20 triangles, shown three times: mirrored, stretched and turned.
  std::string mesh = "mesh: {vertices: [[0, 0, 0]";
  for (int i = 0; i < 20; ++i) {
    const double a = i * M_PI / 10;
    mesh += ", [" + std::to_string(std::cos(a)) + ", " + std::to_string(0.1 * (i % 3)) + ", " +
            std::to_string(std::sin(a)) + "]";
  }
  mesh += "], triangles: [[0, 20, 1]";
  for (int i = 1; i < 20; ++i) mesh += ", [0, " + std::to_string(i) + ", " + std::to_string(i + 1) + "]";
  mesh += "]}, material: {emission: 1, one_sided: true}";
  std::string yaml = "objects:\n";
  for (const char* transform : {"[{scale: [-1, 1, 1.5]}, {translate: [0, 2, 0]}]",
                                "[{rotate: {axis: [0, 0, 1], degrees: -60}}, {translate: [-2, 0.5, 0]}]",
                                "[{scale: 0.5}, {translate: [2, 1, 1]}]"})
    yaml += "  - {" + mesh + ", transform: " + transform + "}\n";
  Scene scene = *parse_scene(Prepared::with_camera(yaml));
  // The reader makes a shape of each; let all three show one.
  for (Object& object : scene.objects) object.shape = scene.objects[0].shape;
  const Prepared p(scene);
  ASSERT_EQ(p.frame->world.instances.size(), 3u);
  EXPECT_EQ(p.emitters->emitters.size(), 60u);
  expect_density_as_sampled(p, {0.1, 0, 0.05}, {0, 0, 0}, "instances");
  expect_density_as_sampled(p, {0.1, 0, 0.05}, {0, 1, 0}, "instances");
}

// ---- pictures around the scene

Scene with_picture(int width, int height, bool z_up, double turn) {
  Scene scene;
  test::surround_by_specks(scene, width, height, 0.15f, z_up, turn);
  return scene;
}

TEST(Emitters, PicturesAroundTheSceneAreChosenByTheirBrightness) {
  for (const bool z_up : {false, true}) {
    const Prepared p(with_picture(16, 9, z_up, 35));
    ASSERT_EQ(p.emitters->table.environment.width, 16);
    expect_density_as_sampled(p, {0, 0, 0}, {0, 0, 0}, z_up ? "z up" : "y up");
    // Against a sum over all directions.
    const V N = normalize(V{0.3, 0.5, -0.4});
    double expected = 0;
    constexpr int fine = 300;
    for (int y = 0; y < fine; ++y)
      for (int x = 0; x < fine; ++x) {
        const V L = direction((x + 0.5) / fine, (y + 0.5) / fine);
        expected += background_along(*p, L, 0)[0] * std::max(dot(N, L), 0.0) * 4 * M_PI / (fine * fine);
      }
    const Mean mean = irradiance(*p, {0, 0, 0}, N, 1 << 15);
    EXPECT_NEAR(mean.mean(), expected, 4 * mean.error());
  }
}

TEST(Emitters, OfALargePictureACoarserLevelIsChosenFrom) {
  const Prepared p(with_picture(2050, 1030, false, 0));
  EXPECT_EQ(p.emitters->table.environment.width, 1025);
  double sum = 0;
  for (int i = 0; i < 2000; ++i) {
    const double u = (i + 0.5) / 2000, v = std::fmod(0.5 + i * 0.618033988749895, 1.0);
    const EmitterSample s = sample_emitters(*p, {0, 0, 0}, {0, 0, 0}, 0.5, u, v);
    EXPECT_GT(s.density, 0);
    EXPECT_DOUBLE_EQ(background_density(*p, {0, 0, 0}, {0, 0, 0}, s.L), s.density);
    sum += s.radiance_over_density[0];
  }
  EXPECT_GT(sum, 0);
}

// ---- the tree

Scene many_lights(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-5, 5), bright(0.2, 3), small(0.05, 0.5);
  Scene scene;
  scene.background = Rgb{};
  for (int i = 0; i < count; ++i) {
    Light light;
    light.name = std::to_string(i);
    const V at{u(random), u(random), u(random)}, to{u(random), u(random), u(random)};
    const Rgb color{bright(random), bright(random), bright(random)};
    switch (i % 5) {
      case 0:
        light.light = PointLight{at, color, bright(random)};
        break;
      case 1:
        light.light = SpotLight{at, to, color, bright(random), 90, 0.3};
        break;
      case 2:
        light.light = RectangleLight{at, {small(random), 0, 0}, {0, small(random), small(random)}, color};
        break;
      case 3:
        light.light = DiscLight{at, to - at, small(random), color};
        break;
      default:
        light.light = SphereLight{at, small(random), color};
    }
    scene.lights.push_back(light);
  }
  return scene;
}

TEST(LightTree, SaysWithWhichProbabilityItChooses) {
  const Prepared p(many_lights(300, 1));
  const EmitterTable& table = p.emitters->table;
  ASSERT_EQ(table.root_count, 1);
  ASSERT_EQ(p.emitters->nodes.size(), 2 * 300 - 1u);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-5, 5), unit(0, 1);
  double total = 0;
  for (int i = 0; i < 200; ++i) {
    const V P{u(random), u(random), u(random)};
    const V N = i % 2 ? normalize(V{u(random), u(random), u(random)}) : V{};
    double sum = 0;
    for (std::int32_t e = 0; e < 300; ++e) sum += detail::probability_of_emitter(*p, e, P, N);
    EXPECT_LE(sum, 1 + 1e-12);  // less where a node promises more than its lights keep
    total += sum;
    for (int k = 0; k < 20; ++k) {
      const PickedLight picked = detail::pick_emitter(*p, P, N, unit(random));
      if (picked.emitter < 0) continue;
      EXPECT_EQ(picked.probability, detail::probability_of_emitter(*p, picked.emitter, P, N));
      EXPECT_GT(picked.probability, 0);
    }
  }
  EXPECT_GT(total / 200, 0.7);
}

TEST(LightTree, ChoosesAsOftenAsItSays) {
  const Prepared p(many_lights(40, 3));
  const V P{0.5, 0.2, -0.3}, N{0, 1, 0};
  constexpr int count = 100000;
  std::vector<int> chosen(40);
  int none = 0;
  for (int i = 0; i < count; ++i) {
    const PickedLight picked = detail::pick_emitter(*p, P, N, (i + 0.5) / count);
    if (picked.emitter < 0) ++none;
    else ++chosen[std::size_t(picked.emitter)];
  }
  double sum = 0;
  for (std::int32_t e = 0; e < 40; ++e) {
    const double probability = detail::probability_of_emitter(*p, e, P, N);
    // Each light has one interval of `pick`: off by one at each end.
    EXPECT_NEAR(chosen[std::size_t(e)], probability * count, 2);
    sum += probability;
  }
  EXPECT_NEAR(none, (1 - sum) * count, 80);
}

TEST(LightTree, NeverLeavesOutWhatLights) {
  // Against the sum over all lights, each of which alone is looked for with certainty.
  for (const int count : {3, 8, 9, 60}) {
    const Scene scene = many_lights(count, unsigned(count));
    const Prepared p(scene);
    EXPECT_EQ(p.emitters->table.root_count, count <= 8 ? count : 1);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> u(-5, 5);
    for (int i = 0; i < 6; ++i) {
      const V P{u(random), u(random), u(random)}, N = normalize(V{u(random), u(random), u(random)});
      double expected = 0;
      Scene one = scene;
      for (const Light& light : scene.lights) {
        one.lights = {light};
        const Prepared alone(one);
        expected += irradiance(*alone, P, N, 1 << 10).mean();
      }
      const Mean mean = irradiance(*p, P, N, 1 << 14);
      EXPECT_NEAR(mean.mean(), expected, 4 * mean.error() + 0.003 * expected)
          << count << " lights, point " << i;
    }
  }
}

TEST(LightTree, IsBetterThanChoosingEvenly) {
  // The mean square of what a sample brings, which its variance grows with, over all of 2000 lights.
  const Prepared p(many_lights(2000, 7));
  double tree = 0, even = 0;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-5, 5);
  for (int i = 0; i < 10; ++i) {
    const V P{u(random), u(random), u(random)}, N = normalize(V{u(random), u(random), u(random)});
    for (int e = 0; e < 2000; ++e) {
      const EmitterSample s = detail::sample_light(*p, e, P, 0.5, 0.5);
      const double brings = s.radiance_over_density[0] * std::max(dot(N, s.L), 0.0);
      if (!(brings > 0)) continue;
      const double probability = detail::probability_of_emitter(*p, e, P, N);
      ASSERT_GT(probability, 0);
      tree += brings * brings / probability, even += brings * brings * 2000;
    }
  }
  EXPECT_LT(tree, 0.2 * even);
}

TEST(LightTree, KeepsItsDepthWhereAllLightsStandInOnePlace) {
  std::vector<LightBounds> lights(5000);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    lights[i].box.add({1, 2, 3});
    lights[i].intensity = 1;
    lights[i].emitter = std::int32_t(i);
  }
  std::vector<LightNode> nodes;
  std::vector<LightPath> paths;
  build_light_tree(lights, nodes, paths);
  EXPECT_EQ(nodes.size(), 2 * lights.size() - 1);
  double sum = 0;
  for (const LightPath& path : paths)
    sum += pick_probability(nodes.data(), 0, path.path, {0, 0, 0}, {0, 0, 1}, attenuation_1_over_r2, 1e-3);
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(LightTree, BoundsOfTwoHoldBoth) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-1, 1), angle(0, 0.3);
  for (int i = 0; i < 2000; ++i) {
    const auto some = [&] {
      LightBounds b;
      b.box.add({u(random), u(random), u(random)});
      b.axis = normalize(V{u(random), u(random), u(random)});
      b.spread = angle(random);
      b.intensity = 1;
      return b;
    };
    const LightBounds a = some(), b = some(), both = both_bounds(a, b);
    for (const LightBounds& one : {a, b}) {
      const double apart = std::acos(std::clamp(dot(one.axis, both.axis), -1.0, 1.0)) / (2 * M_PI);
      EXPECT_LE(std::min(apart + one.spread, 0.5), both.spread + 1e-7);
    }
    EXPECT_EQ(both.intensity, 2);
  }
}

TEST(Emitters, FadeAsTheFrameSays) {
  Prepared p(
      "lights: [{point: {position: [0, 4, 0], intensity: 8}}, {rectangle: {center: [0, 2, 0], u: [1, 0, 0], "
      "v: [0, 0, 1]}}]\n");
  p.frame->frame.path_attenuation = attenuation_1_over_r;
  p.emitters = prepare_emitters(p.frame->frame, p.frame->world);
  p.frame->frame.emitters = &p.emitters->table;
  const std::vector<V> corners{{-0.5, 2, -0.5}, {0.5, 2, -0.5}, {0.5, 2, 0.5}, {-0.5, 2, 0.5}};
  // The light with extent fades by itself.
  expect_irradiance(p, {0, 0, 0}, {0, 1, 0},
                    M_PI * 8 / 4 + M_PI * test::polygon_irradiance({0, 0, 0}, {0, 1, 0}, corners));
}

}  // namespace
}  // namespace lambent
