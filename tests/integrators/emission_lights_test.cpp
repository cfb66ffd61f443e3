// Surfaces and a background that shine, in the lecture's sum over lights: against closed forms, against area
// lights, and against paths.

#include "integrators/emission_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "explain/derivation.h"
#include "integrators/emitters.h"
#include "integrators/kernels.h"
#include "integrators/prepare.h"
#include "lambent/lambent.h"
#include "lambent/relight.h"
#include "random_scene.h"
#include "what_shines.h"

namespace lambent {
namespace {

using V = Vec3<double>;

/// A white floor at y = 0, seen from above in one point; `more`: further objects, settings before them.
std::string floor_scene(const V& at, const std::string& settings, const std::string& more) {
  const auto text = [](double x) { return std::to_string(x); };
  return "lambent: 1\ncamera: {projection: orthographic, height: 0.001, up: [0, 0, -1], eye: [" + text(at.x) +
         ", 0.3, " + text(at.z) + "], target: [" + text(at.x) + ", 0, " + text(at.z) +
         "]}\nimage: {size: [1, 1]}\nillumination: {model: attenuated, ambient: 0}\n" + settings +
         "objects:\n  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: {diffuse: 1, ambient: "
         "0}}\n" +
         more;
}
std::string emission(int samples) {
  return "integrator: {whitted: {emission_samples: " + std::to_string(samples) + "}}\n";
}
std::string background(int samples, const std::string& color) {
  return "integrator: {whitted: {background_samples: " + std::to_string(samples) +
         "}}\nbackground: " + color + "\n";
}
Rgb color_at(const std::string& scene) {
  const Image image = render(parse_scene(scene)).image;
  return {image.pixel(0, 0)[0], image.pixel(0, 0)[1], image.pixel(0, 0)[2]};
}

/// Two triangles, or a grid of 2 n n of them, over x and z in -1..1 at the height 1; facing down.
std::string panel(int n, const std::string& material) {
  std::string text = "  - {mesh: {vertices: [", triangles;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      text += "[" + std::to_string(-1 + 2.0 * i / n) + ", 1, " + std::to_string(-1 + 2.0 * j / n) + "], ";
      if (i == n || j == n) continue;
      const int a = i * (n + 1) + j, b = a + n + 1;
      const auto triangle = [&](int p, int q, int r) {
        triangles += "[" + std::to_string(p) + ", " + std::to_string(q) + ", " + std::to_string(r) + "], ";
      };
      triangle(a, b, a + 1), triangle(a + 1, b, b + 1);
    }
  return text + "], triangles: [" + triangles + "]}, material: {" + material + "}}\n";
}

TEST(EmissionLights, OfAPanelTendToItsFormFactor) {
  const V at{0.5, 0, 0.25};
  // Kd / pi times the irradiance.
  const double whole =
      test::polygon_irradiance(at, {0, 1, 0}, {{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}) / M_PI;
  for (const int grid : {1, 2, 16})
    for (const int samples : {16, 64, 256, 1024}) {
      const Rgb color =
          color_at(floor_scene(at, emission(samples), panel(grid, "emission: [2, 1, 0.5], one_sided: true")));
      EXPECT_NEAR(color[0], 2 * whole, 2 * whole * (0.01 + 1.0 / samples)) << grid << ", " << samples;
      EXPECT_NEAR(color[1] / color[0], 0.5, 1e-6);
      EXPECT_NEAR(color[2] / color[0], 0.25, 1e-6);
    }
}

TEST(EmissionLights, HaveAllOfThePower) {
  // From afar a panel of area 4 is Il = Le A / pi, with a cosine at either end, however few stand for it.
  const V at{30, 0, 0};
  const double cosine = 1 / std::sqrt(901), r2 = 901;
  for (const int samples : {1, 2, 3, 5, 7, 31})
    EXPECT_NEAR(color_at(floor_scene(at, emission(samples), panel(5, "emission: 1")))[0],
                4 / M_PI * cosine * cosine / r2, 3e-2 * 4 / M_PI * cosine * cosine / r2)
        << samples;
}

TEST(EmissionLights, OfOneSideShineFromIt) {
  const std::string
      up = "  - {disc: {center: [0, 1, 0], normal: [0, 1, 0], radius: 1}, material: {emission: 1",
      down =
          "  - {disc: {center: [0, 1, 0], normal: [0, -1, 0], radius: 1}, material: "
          "{emission: 1";
  const auto lit = [](const std::string& disc) {
    return color_at(floor_scene({0.2, 0, 0}, emission(16), disc))[0];
  };
  EXPECT_EQ(lit(up + ", one_sided: true}}\n"), 0);
  EXPECT_GT(lit(down + ", one_sided: true}}\n"), 0);
  EXPECT_EQ(lit(up + "}}\n"), lit(down + "}}\n"));
  EXPECT_EQ(lit(down + "}}\n"), lit(down + ", one_sided: true}}\n"));
  // On the axis of a disc: Il = Le A / pi, and Il / (R^2 + d^2).
  EXPECT_NEAR(color_at(floor_scene({0, 0, 0}, emission(1024), down + "}}\n"))[0], 1 / (1.0 + 1.0), 2e-3);
}

TEST(EmissionLights, OfASphereAreASphereLight) {
  const V at{0.7, 0, -0.2};
  for (const int samples : {1, 4, 16}) {
    const std::string ball = "center: [0, 2, 0], radius: 0.8";
    const Rgb shining = color_at(floor_scene(
        at, emission(samples), "  - {sphere: {" + ball + "}, material: {emission: [3, 2, 1]}}\n"));
    // Il = Le R^2
    const Rgb light =
        color_at(floor_scene(at,
                             "lights: [{sphere: {" + ball + ", color: [3, 2, 1], intensity: 0.64, samples: " +
                                 std::to_string(samples) + "}}]\n",
                             ""));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(shining[c], light[c], 1e-6 * light[c]) << samples;
  }
  // Above the horizon as a whole: Le R^2 / d^2, of a mesh of one too.
  EXPECT_NEAR(
      color_at(floor_scene({0, 0, 0}, emission(256),
                           "  - {sphere: {center: [0, 2, 0], radius: 0.8}, material: {emission: 1}}\n"))[0],
      0.64 / 4, 1e-4);
}

TEST(EmissionLights, OfInstancesAreWhereTheseAre) {
  const std::string moved =
      "transform: [{scale: [-1, 1, 1]}, {rotate: {axis: [0, 1, 0], degrees: 40}}, {scale: 0.5}], ";
  const std::string cone = "cone: {from: [0, 1.2, 0], radius_from: 0.4, to: [0.3, 2, 0], radius_to: 0.1}";
  const V at{0.4, 0, 0.3};
  const auto direct = [&](const std::string& integrator) {
    return color_at(
        floor_scene(at, integrator, "  - {" + moved + cone + ", material: {emission: 2, diffuse: 0}}\n"))[0];
  };
  // A path of two rays: what the floor gets directly.
  const double path = direct("integrator: {path: {max_depth: 2, max_samples: 16384, until: 0.001}}\n");
  EXPECT_NEAR(direct(emission(512)), path, 0.02 * path);
}

TEST(EmissionLights, AreBlocked) {
  const std::string lamp = panel(4, "emission: 1");
  const std::string screen = "  - {disc: {center: [0, 0.6, 0], normal: [0, 1, 0], radius: 5}}\n";
  EXPECT_GT(color_at(floor_scene({0, 0, 0}, emission(16), lamp))[0], 0.4);
  EXPECT_EQ(color_at(floor_scene({0, 0, 0}, emission(16), lamp + screen))[0], 0);
}

TEST(EmissionLights, DoNotBlockThemselves) {
  // The closest thing to a lamp is its own surface.
  for (const double far : {0.0, 1000.0, 1e5}) {
    const std::string place = ", transform: {translate: [" + std::to_string(far) + ", 0, 0]}}\n";
    std::string lamp = panel(7, "emission: 1");
    lamp.replace(lamp.rfind("}\n"), 2, place);
    const double at_origin = color_at(floor_scene({0.1, 0, 0.2}, emission(37), panel(7, "emission: 1")))[0];
    EXPECT_NEAR(color_at(floor_scene({far + 0.1, 0, 0.2}, emission(37), lamp))[0], at_origin,
                2e-2 * at_origin)
        << far;
  }
}

TEST(EmissionLights, AreNoneUnlessAskedFor) {
  EXPECT_EQ(color_at(floor_scene({0, 0, 0}, "background: 1\n", panel(1, "emission: 1")))[0], 0);
}

// ---- the background

TEST(BackgroundLights, OfAnEvenSkyGiveItsColorBack) {
  // E / pi = L for an open floor; the error goes down with the number of lights.
  for (const int samples : {16, 64, 256, 1024}) {
    const Rgb color = color_at(floor_scene({0, 0, 0}, background(samples, "[0.5, 0.7, 0.9]"), ""));
    EXPECT_NEAR(color[0], 0.5, 0.5 * 2.0 / samples + 0.002) << samples;
    EXPECT_NEAR(color[2] / color[0], 0.9 / 0.5, 1e-6);
  }
}

TEST(BackgroundLights, AreHiddenByWhatStandsBefore) {
  // Below a disc of radius R at the height h the floor sees the ring from tan a = R/h on: L cos^2 a.
  const std::string disc = "  - {disc: {center: [0, 1, 0], normal: [0, 1, 0], radius: 1}}\n";
  EXPECT_NEAR(color_at(floor_scene({0, 0, 0}, background(1024, "1"), disc))[0], 0.5, 0.02);
}

/// A floor under a picture, with a point to look at.
Scene under_picture(int width, int height, bool z_up, double turn) {
  Scene scene =
      *parse_scene(floor_scene({0, 0, 0}, "integrator: {whitted: {background_samples: 1024}}\n", ""));
  test::surround_by_specks(scene, width, height, 0.1f, z_up, turn);
  return scene;
}

TEST(BackgroundLights, OfAPictureHaveItsLight) {
  for (const bool z_up : {false, true}) {
    const Scene scene = under_picture(32, 17, z_up, 35);
    const auto prepared = prepare(scene);
    const Frame& frame = prepared->frame;
    // Against the integral over the upper half of all directions.
    double expected = 0;
    constexpr int fine = 1000;
    for (int y = 0; y < fine; ++y)
      for (int x = 0; x < fine; ++x) {
        const double up = (y + 0.5) / fine, across = std::sqrt(1 - up * up),
                     turn = 2 * M_PI * (x + 0.5) / fine;
        const V L{across * std::cos(turn), up, across * std::sin(turn)};
        expected += background_along(frame, L, 0)[0] * up * 2 / (double(fine) * fine);
      }
    const Image image = render(std::make_shared<Scene>(scene)).image;
    EXPECT_NEAR(image.pixel(0, 0)[0], expected, 0.02 * expected) << z_up;
    // Its mean over all directions is kept exactly, whatever the number of lights: no power is lost.
    double sum = 0;
    for (const AnyLight& light : Emission(frame, prepared->world, 0, 1024).lights(frame).lights)
      sum += with_light(light, [](const auto& one) { return one.color[0]; });
    double few = 0;
    for (const AnyLight& light : Emission(frame, prepared->world, 0, 7).lights(frame).lights)
      few += with_light(light, [](const auto& one) { return one.color[0]; });
    EXPECT_NEAR(few, sum, 1e-9 * sum);
  }
}

TEST(BackgroundLights, FindASmallSun) {
  // One texel of 64 x 32 is the sun: one light stands for it, in its place.
  Scene scene = *parse_scene(floor_scene({0, 0, 0}, "integrator: {whitted: {background_samples: 8}}\n", ""));
  test::surround(scene, 64, 32, [](int x, int y) { return grey(x == 20 && y == 8 ? 1000.0 : 0.1); });
  scene.background = grey(1.0);
  const auto prepared = prepare(scene);
  double brightest_of_all = 0;
  V direction{};
  for (const AnyLight& light :
       Emission(prepared->frame, prepared->world, 0, 8).lights(prepared->frame).lights) {
    const auto& sun = std::get<DirectionalLight>(light);
    if (sun.color[0] > brightest_of_all) brightest_of_all = sun.color[0], direction = -sun.direction;
  }
  const double angle = 180 * 8.5 / 32;
  EXPECT_NEAR(direction.y, std::cos(angle * M_PI / 180), 0.02);
  const double solid_angle = 2 * M_PI / 64 * (std::cos(M_PI * 8 / 32) - std::cos(M_PI * 9 / 32));
  EXPECT_NEAR(brightest_of_all, 1000 * solid_angle / M_PI, 0.02 * 1000 * solid_angle / M_PI);
}

// ---- for those who look closer

LoadOptions with_both(unsigned seed) {
  LoadOptions options;
  options.set = {{"integrator.whitted.emission_samples", std::to_string(seed % 4)},
                 {"integrator.whitted.background_samples", std::to_string(3 + seed % 5)},
                 {"background", "[0.2, 0.3, 0.5]"}};
  return options;
}
std::string shining_scene(unsigned seed) {
  return test::random_scene(seed, 12, 9, "2") +
         "  - {sphere: {center: [0.5, 1, 0.5], radius: 0.2}, material: {emission: [2, 1, 1]}}\n" +
         panel(2, "emission: [0.2, 0.4, 0.1], diffuse: 0.3");
}

TEST(EmissionLights, AreExplainedBitForBit) {
  int seen = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    const ScenePtr scene = parse_scene(shining_scene(seed), "scene", with_both(seed));
    const Image image = render(scene).image;
    Exposure exposure(*scene);
    for (int y = 0; y < 9; y += 2)
      for (int x = 0; x < 12; x += 3) {
        const Derivation d = derive(scene, exposure, choose_kernel(""), x, y, exposure.portions());
        for (int c = 0; c < 3; ++c) ASSERT_EQ(d.pixel[c], image.pixel(x, y)[c]) << seed;
        for (const DerivedRay& ray : d.rays)
          for (const DerivedLight& light : ray.lights)
            seen += light.point.source >= int(scene->lights.size()) && !is_black(light.diffuse);
      }
  }
  EXPECT_GT(seen, 500);
}

TEST(EmissionLights, HaveLayersOfTheirOwn) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    LoadOptions options = with_both(4 * seed + 2);
    options.set.emplace_back("film.layers", "true");
    const RenderResult both = render(parse_scene(shining_scene(seed), "scene", options));
    options.set.emplace_back("integrator.whitted.emission_samples", "0");
    options.set.emplace_back("integrator.whitted.background_samples", "0");
    const Image without = render(parse_scene(shining_scene(seed), "scene", options)).image;
    Relighting relighting;
    relighting.lights = {{"surfaces", {0, 0, 0}}, {"sky", {0, 0, 0}}};
    const Image relit = relight({both.image, both.metadata}, relighting).image;
    double sum = 0;
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 12; ++x)
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(relit.pixel(x, y)[c], without.pixel(x, y)[c], 1e-5f * (1 + without.pixel(x, y)[c]));
          sum += both.image.pixel(x, y)[c] - without.pixel(x, y)[c];
        }
    EXPECT_GT(sum, 1) << "nothing shone";
  }
}

TEST(EmissionLights, StayGreyInAGreyWorldOfWavelengths) {
  const std::string spectral =
      "integrator: {spectral: {wavelengths: 9, emission_samples: 8, background_samples: "
      "8}}\nbackground: 0.4\n";
  const std::string rgb =
      "integrator: {whitted: {emission_samples: 8, background_samples: 8}}\nbackground: 0.4\n";
  for (const std::string& lamp :
       {panel(3, "emission: 1"), std::string("  - {sphere: {center: [0, 2, 0], radius: "
                                             "0.5}, material: {emission: 1}}\n")}) {
    const Rgb a = color_at(floor_scene({0.3, 0, 0}, spectral, lamp)),
              b = color_at(floor_scene({0.3, 0, 0}, rgb, lamp));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-3 * b[c]);
  }
}

}  // namespace
}  // namespace lambent
