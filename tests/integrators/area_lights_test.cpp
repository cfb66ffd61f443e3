// Lights with extent in the lecture's sum, and as things in the world.

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "explain/derivation.h"
#include "integrators/kernels.h"
#include "integrators/light_pattern.h"
#include "integrators/prepare.h"
#include "lambent/lambent.h"
#include "scene/standing_lights.h"
#include "what_shines.h"

namespace lambent {
namespace {

using V = Vec3<double>;

/// A white floor at y = 0 that is lit by nothing but `lights`, seen from above at one point, and the colour
/// there.
std::string floor_scene(const std::string& lights, const V& at, const std::string& more = "") {
  const auto text = [](double x) { return std::to_string(x); };
  return "lambent: 1\ncamera: {projection: orthographic, height: 0.001, up: [0, 0, -1], eye: [" + text(at.x) +
         ", 0.5, " + text(at.z) + "], target: [" + text(at.x) + ", 0, " + text(at.z) +
         "]}\nimage: {size: [1, 1]}\nillumination: {model: attenuated, ambient: 0}\n" + more + "lights: [" +
         lights +
         "]\nobjects:\n  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: {diffuse: 1, ambient: "
         "0}}\n";
}
double color_at(const std::string& scene) { return render(parse_scene(scene)).image.pixel(0, 0)[0]; }
double color_at(const std::string& lights, const V& at) { return color_at(floor_scene(lights, at)); }

// ---- the pattern

TEST(PatternOfALight, HasOnePointInEachRowAndColumnAndIsSymmetric) {
  EXPECT_EQ(point_of_light(0, 1).x, 0.5);
  EXPECT_EQ(point_of_light(0, 1).y, 0.5);
  for (const int count : {2, 3, 4, 9, 16, 25, 64, 100, 1024}) {
    std::set<double> rows;
    for (int i = 0; i < count; ++i) {
      const Vec2<double> at = point_of_light(i, count), opposite = point_of_light(count - 1 - i, count);
      EXPECT_DOUBLE_EQ(at.x, (i + 0.5) / count);
      EXPECT_NEAR(at.x + opposite.x, 1, 1e-12);
      EXPECT_NEAR(at.y + opposite.y, 1, 1e-12);
      rows.insert(at.y);
    }
    EXPECT_EQ(int(rows.size()), count);
    EXPECT_DOUBLE_EQ(*rows.begin(), 0.5 / count);
  }
}

// ---- light on surfaces

TEST(AreaLight, OfOneSampleIsAPointLightAtItsCentreWithACosine) {
  // Il cos^2 / r^2: one cosine for the floor, one for the light.
  const V at{1, 0, 0.5};
  const double r2 = 1 + 4 + 0.25, cosine = 2 / std::sqrt(r2);
  EXPECT_NEAR(color_at("{rectangle: {center: [0, 2, 0], u: [1, 0, 0], v: [0, 0, 1], intensity: 3}}", at),
              3 * cosine * cosine / r2, 1e-6);
  EXPECT_NEAR(color_at("{disc: {center: [0, 2, 0], normal: [0, -1, 0], radius: 1, intensity: 3}}", at),
              3 * cosine * cosine / r2, 1e-6);
  EXPECT_NEAR(color_at("{sphere: {center: [0, 2, 0], radius: 0.5, intensity: 3}}", at),
              3 * cosine / r2 * 2 / (1 + std::sqrt(1 - 0.25 / r2)), 1e-6);
}

TEST(AreaLight, TendsToTheWholeLightAsItsSamplesGrow) {
  const V at{0.5, 0, 0.25};
  const std::string light =
      "{rectangle: {center: [0, 1, 0], u: [2, 0, 0], v: [0, 0, 1.5], intensity: 3, samples: ";
  // E / pi with Le = pi 3 / A
  const double whole =
      test::polygon_irradiance(at, {0, 1, 0}, {{-1, 1, -0.75}, {1, 1, -0.75}, {1, 1, 0.75}, {-1, 1, 0.75}}) *
      3 / 3.0;
  // The error goes down with the number of samples, about as its inverse.
  for (const int samples : {4, 16, 17, 64, 100, 256})
    EXPECT_NEAR(color_at(light + std::to_string(samples) + "}}", at), whole, 0.5 / samples * whole)
        << samples;
  EXPECT_NEAR(color_at(light + "1024}}", at), whole, 1e-3 * whole);
  // A disc on its axis: Il / (R^2 + d^2). A sphere, all of it above the horizon: Il / d^2.
  EXPECT_NEAR(
      color_at("{disc: {center: [0, 1, 0], normal: [0, -1, 0], radius: 0.8, samples: 256}}", {0, 0, 0}),
      1 / (0.64 + 1), 2e-3);
  EXPECT_NEAR(color_at("{sphere: {center: [0, 2, 0], radius: 0.9, samples: 256}}", {0, 0, 0}), 1 / 4.0, 1e-4);
}

TEST(AreaLight, LightsAsWellWhereItIsNotSeen) {
  const std::string light =
      "{rectangle: {center: [0, 2, 0], u: [1, 0, 0], v: [0, 0, 1], samples: 9, visible: ";
  EXPECT_NEAR(color_at(light + "true}}", {1, 0, 0}), color_at(light + "false}}", {1, 0, 0}), 1e-7);
}

TEST(AreaLight, CastsSoftShadows) {
  // A square of side 1 in the middle between the light and the floor: at the edge of its shadow half of the
  // light is seen.
  const std::string light =
      "{rectangle: {center: [0, 2, 0], u: [0.5, 0, 0], v: [0, 0, 0.01], samples: 64, visible: false}}";
  const std::string screen = "  - {disc: {center: [-10, 1, 0], normal: [0, 1, 0], radius: 10}}\n";
  const auto lit = [&](double x) {
    return color_at(floor_scene(light, {x, 0, 0}) + screen) / color_at(floor_scene(light, {x, 0, 0}));
  };
  EXPECT_EQ(lit(-0.3), 0);
  EXPECT_NEAR(lit(0), 0.5, 0.02);
  EXPECT_NEAR(lit(0.125), 0.75, 0.03);
  EXPECT_EQ(lit(0.3), 1);
}

TEST(AreaLight, DoesNotStandInItsOwnLight) {
  // On a curved mesh points are lifted to the smooth surface; and far from the origin float is coarse.
  for (const double far : {0.0, 1000.0, 1e5})
    for (const char* kind : {"rectangle: {center: [C, 1.2, 0], u: [2, 0, 0], v: [0, 0.3, 2]",
                             "disc: {center: [C, 1.2, 0], normal: [0.1, -1, 0], radius: 1",
                             "sphere: {center: [C, 1.8, 0], radius: 0.8"}) {
      std::string light = kind;
      light.replace(light.find('C'), 1, std::to_string(far));
      const auto picture = [&](const char* integrator, bool visible) {
        std::string mesh = "mesh: {vertices: [";
        std::string triangles, normals;
        for (int i = 0; i <= 4; ++i)
          for (int j = 0; j <= 4; ++j) {
            const double x = (i - 2) * 0.5, z = (j - 2) * 0.5;
            const auto text = [](double a, double b, double c) {
              return "[" + std::to_string(a) + ", " + std::to_string(b) + ", " + std::to_string(c) + "], ";
            };
            mesh += text(far + x, -0.2 * (x * x + z * z), z);
            normals += text(0.4 * x, 1, 0.4 * z);
            if (i < 4 && j < 4) {
              const int a = i * 5 + j;
              triangles += "[" + std::to_string(a) + ", " + std::to_string(a + 1) + ", " +
                           std::to_string(a + 6) + "], [" + std::to_string(a) + ", " + std::to_string(a + 6) +
                           ", " + std::to_string(a + 5) + "], ";
            }
          }
        mesh += "], normals: [" + normals + "], triangles: [" + triangles + "]}";
        const std::string x = std::to_string(far);
        return render(parse_scene("lambent: 1\ncamera: {eye: [" + x + ", 0.8, 4], target: [" + x +
                                  ", -0.2, 0], fov: 30}\nimage: {size: [60, 30], samples: 1}\nintegrator: " +
                                  integrator +
                                  "\nillumination: {model: "
                                  "attenuated, ambient: 0}\n"
                                  "lights: [{" +
                                  light + ", samples: 16, visible: " + (visible ? "true" : "false") +
                                  "}}]\nobjects:\n  - {" + mesh + ", material: {diffuse: 1, ambient: 0}}\n"))
            .image;
      };
      // Paths of one ray take the same points of the light, seen or not.
      for (const char* integrator : {"{whitted: {}}", "{path: {max_depth: 1}}"}) {
        const Image with = picture(integrator, true), without = picture(integrator, false);
        int lit = 0;
        for (int y = 0; y < 30; ++y)
          for (int i = 0; i < 60; ++i) {
            if (with.pixel(i, y)[0] > 1) continue;  // the light itself
            EXPECT_NEAR(with.pixel(i, y)[0], without.pixel(i, y)[0], 1e-6)
                << integrator << " " << kind << " at " << far << ": " << i << "," << y;
            lit += without.pixel(i, y)[0] > 0.01;
          }
        EXPECT_GT(lit, 100);
      }
    }
}

// ---- as a thing

std::string seen_scene(const std::string& light, const char* eye, const std::string& more = "") {
  return std::string("lambent: 1\ncamera: {eye: ") + eye +
         ", target: [0, 0, 0], up: [0.1, 0.2, 1]}\nimage: {size: [9, 9]}\n" +
         "illumination: {model: attenuated, ambient: 1}\nlights: [{name: lamp, " + light + "}]\nobjects:\n" +
         more + "  - {sphere: {center: [0, -50, 0], radius: 1}}\n";
}

TEST(AreaLight, IsSeenAsBrightAsItIs) {
  const auto middle = [](const std::string& light, const char* eye) {
    return render(parse_scene(seen_scene(light, eye))).image.pixel(4, 4)[0];
  };
  // Le = pi Il / A, on the front alone.
  const std::string square = "rectangle: {center: [0, 0, 0], u: [2, 0, 0], v: [0, 0, 1], intensity: 3";
  EXPECT_NEAR(middle(square + "}", "[0.1, -4, 0]"), M_PI * 3 / 2, 1e-6);
  EXPECT_EQ(middle(square + "}", "[0.1, 4, 0]"), 0);
  EXPECT_NEAR(middle(square + ", two_sided: true}", "[0.1, 4, 0]"), M_PI * 3 / 2, 1e-6);
  EXPECT_EQ(middle(square + ", visible: false}", "[0.1, -4, 0]"), 0);
  EXPECT_NEAR(middle("disc: {center: [0, 0, 0], normal: [0, 1, 0], radius: 2, intensity: 3}", "[0, 4, 0]"),
              3 / 4.0, 1e-6);
  EXPECT_NEAR(middle("sphere: {center: [0, 0, 0], radius: 2, intensity: 3}", "[0, 5, 0]"), 3 / 4.0, 1e-6);
  EXPECT_EQ(middle("sphere: {center: [0, 0, 0], radius: 2, intensity: 3}", "[0, 1, 0]"), 0) << "dark inside";
}

TEST(AreaLight, IsSeenInMirrorsAndBlocksOtherLights) {
  // A mirror below a lamp that faces down.
  const std::string mirror =
      floor_scene("{rectangle: {center: [0, 2, 0], u: [1, 0, 0], v: [0, 0, 1], intensity: 3}}", {0, 0, 0}) +
      "  - {disc: {center: [0, 0.1, 0], normal: [0, 1, 0], radius: 0.1}, material: {diffuse: 0, ambient: 0, "
      "reflect: 0.5}}\n";
  EXPECT_NEAR(color_at(mirror), 0.5 * M_PI * 3, 1e-5);
  // A panel between a point light and the floor: its own light, and not the other's.
  const std::string panel = "{rectangle: {center: [0, 1, 0], v: [1, 0, 0], u: [0, 0, 1], intensity: 1}}";
  EXPECT_EQ(color_at(panel + ", {point: {position: [0, 2, 0], intensity: 4}}", {0, 0, 0}), 0);
}

TEST(AreaLight, HasANameAmongObjectsAndMaterials) {
  const ScenePtr scene = parse_scene(seen_scene("sphere: {center: [0, 0, 0], radius: 1}", "[0, 5, 0]"));
  ASSERT_EQ(standing_lights(*scene).size(), 1u);
  Exposure exposure(*scene);
  const Derivation d = derive(scene, exposure, choose_kernel(""), 4, 4, exposure.portions());
  ASSERT_TRUE(d.rays[0].hits);
  EXPECT_EQ(d.rays[0].object, 1u);
  EXPECT_EQ(d.rays[0].hit.material, 1u);
  EXPECT_EQ(d.rays[0].material.name, "lamp");
  EXPECT_TRUE(d.adds_up());
}

}  // namespace
}  // namespace lambent
