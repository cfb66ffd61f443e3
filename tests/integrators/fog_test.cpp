// Fog by ray distance against its closed form: exp(-density t) colour + (1 - exp(-density t)) fog colour.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "lambent/explain.h"
#include "lambent/lambent.h"
#include "math/color.h"

namespace lambent {
namespace {

const std::string head =
    "lambent: 1\ncamera: {eye: [0, 0, 0], target: [0, 0, -1], fov: 0.01}\nimage: {size: [1, 1]}\n"
    "background: [9, 9, 9]\n";
// A colour of its own, whatever shines.
std::string glowing(double r, double g, double b, const std::string& more = "") {
  return fmt::format("material: {{ambient: 0, diffuse: 0, emission: [{}, {}, {}]{}}}", r, g, b, more);
}
void expect_color(const Rgb& expected, const std::string& yaml) {
  const Image image = render(parse_scene(yaml)).image;
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(expected[c], image.pixel(0, 0)[c], 1e-6 * (1 + expected[c])) << yaml;
}

TEST(Fog, ByTheLengthOfTheRay) {
  for (const double density : {0.01, 0.2, 3.0})
    for (const double t : {0.5, 2.0, 10.0})
      for (const double start : {0.0, 1.5}) {
        const double left = std::exp(-density * std::max(t - start, 0.0));
        expect_color(
            {left * 0.8 + (1 - left) * 0.1, left * 0.4 + (1 - left) * 0.2, left * 0.2 + (1 - left) * 0.7},
            head + fmt::format(
                       "fog: {{color: [0.1, 0.2, 0.7], density: {}, start: {}}}\nobjects: [{{plane: {{point: "
                       "[0, 0, {}], normal: [0, 0, 1]}}, {}}}]\n",
                       density, start, -t, glowing(0.8, 0.4, 0.2)));
      }
}

TEST(Fog, WhatMeetsNothingIsWhollyFog) {
  expect_color({0.1, 0.2, 0.7}, head + "fog: {color: [0.1, 0.2, 0.7], density: 1e-6}\n");
  expect_color({9, 9, 9}, head + "fog: {color: [0.1, 0.2, 0.7], density: 0}\n");
}

TEST(Fog, OnEveryWayOfMirroredAndRefractedRays) {
  // A mirror 3 away that reflects half, and 5 behind the eye a wall of 0.8: the mirror shows it through a way
  // of 8, which is in the fog from the first 2 on; the first of these belong to the eye's ray. Behind the
  // mirror, which lets a quarter through, stands a wall of 0.3 at 4.
  const double density = 0.3, fog = 0.6, start = 2;
  const auto left = [&](double from, double to) {
    return std::exp(-density * (std::max(to - start, 0.0) - std::max(from - start, 0.0)));
  };
  const double first = left(0, 3), mirrored = left(3, 11), through = left(3, 4);
  const double expected = (1 - first) * fog + first * (0.05 + 0.5 * ((1 - mirrored) * fog + mirrored * 0.8) +
                                                       0.25 * ((1 - through) * fog + through * 0.3));
  const std::string scene =
      head + fmt::format(
                 "fog: {{color: {}, density: {}, start: {}}}\nobjects:\n"
                 "  - {{plane: {{point: [0, 0, -3], normal: [0, 0, 1]}}, {}}}\n"
                 "  - {{plane: {{point: [0, 0, 5], normal: [0, 0, 1]}}, {}}}\n"
                 "  - {{plane: {{point: [0, 0, -4], normal: [0, 0, 1]}}, {}}}\n",
                 fog, density, start, glowing(0.05, 0.05, 0.05, ", reflect: 0.5, transmit: 0.25, ior: 1"),
                 glowing(0.8, 0.8, 0.8), glowing(0.3, 0.3, 0.3));
  expect_color(grey(expected), scene);

  // Each way has its own fog among the layers, and they add up.
  const ScenePtr layered = parse_scene(scene, "scene", {{{"film.layers", "true"}}});
  const Image image = render(layered).image;
  const auto channel = [&](const std::string& name) {
    const auto at = std::find(image.channels.begin(), image.channels.end(), name);
    EXPECT_NE(at, image.channels.end()) << name;
    return double(image.pixel(0, 0)[at - image.channels.begin()]);
  };
  EXPECT_NEAR((1 - first) * fog, channel("fog.R"), 1e-6);
  EXPECT_NEAR(first * 0.5 * (1 - mirrored) * fog, channel("reflection.fog.R"), 1e-6);
  EXPECT_NEAR(first * 0.25 * (1 - through) * fog, channel("refraction.fog.R"), 1e-6);
  EXPECT_EQ(0, channel("background.R"));
  EXPECT_EQ(channel("R"), channel("fog.R") + channel("emission.R") + channel("reflection.fog.R") +
                              channel("reflection.emission.R") + channel("refraction.fog.R") +
                              channel("refraction.emission.R"));

  const DerivationPtr derivation = explain(layered, 0, 0);
  EXPECT_TRUE(adds_up(derivation));
  const std::string text = explanation(derivation);
  EXPECT_NE(std::string::npos, text.find("goes through fog for t = ")) << text;
  EXPECT_NE(std::string::npos, text.find("the fog before it"));
}

TEST(Fog, PathsSeeItOnTheEyesWayAndInMirrors) {
  // What shines behind fog is the same as ever.
  const double left = std::exp(-0.2 * 2);
  expect_color({left * 0.8 + (1 - left) * 0.1, left * 0.4 + (1 - left) * 0.2, left * 0.2 + (1 - left) * 0.7},
               head +
                   "integrator: {path: {}}\nfog: {color: [0.1, 0.2, 0.7], density: 0.2}\nobjects: [{plane: "
                   "{point: [0, 0, -2], normal: [0, 0, 1]}, " +
                   glowing(0.8, 0.4, 0.2) + "}]\n");
  // A mirror of 0.5 at 3, and a wall of 0.8 at 8 on that way: either the path goes on, or it ends there.
  const double first = std::exp(-0.3 * 3), mirrored = std::exp(-0.3 * 8);
  const double expected = (1 - first) * 0.6 + first * 0.5 * ((1 - mirrored) * 0.6 + mirrored * 0.8);
  const std::string mirror = head +
                             "integrator: {path: {until: 0.001}}\nfog: {color: 0.6, density: 0.3}\nobjects:\n"
                             "  - {plane: {point: [0, 0, -3], normal: [0, 0, 1]}, " +
                             glowing(0, 0, 0, ", reflect: 0.5") +
                             "}\n  - {plane: {point: [0, 0, 5], normal: [0, 0, 1]}, " +
                             glowing(0.8, 0.8, 0.8) + "}\n";
  const ScenePtr scene = parse_scene(mirror, "scene", {{{"film.layers", "true"}}});
  const RenderResult result = render(scene);
  EXPECT_NEAR(expected, result.image.pixel(0, 0)[0], 5 * 0.001 * expected);
  const DerivationPtr derivation = explain(scene, 0, 0);
  EXPECT_TRUE(adds_up(derivation));
  // Of matt surfaces fog hides only what the eye sees: a floor below a lamp is the same as in Whitted's sum.
  const double through = std::exp(-0.5 * 4);
  const std::string dark = head.substr(0, head.find("background")) + "background: 0\n";
  expect_color(grey(through * 0.6 / (54.0 * 54.0) * 3000 + (1 - through) * 0.2),
               dark +
                   "integrator: {path: {max_depth: 2}}\nfog: {color: 0.2, density: 0.5}\n"
                   "lights: [{point: {position: [0, 0, 50], intensity: 3000}}]\n"
                   "objects: [{plane: {point: [0, 0, -4], normal: [0, 0, 1]}, material: {diffuse: 0.6}}]\n");
}

TEST(Fog, WithoutItNothingChanges) {
  const std::string scene =
      "objects: [{sphere: {center: [0, 0, -4], radius: 1}, " + glowing(0.5, 0.4, 0.3) + "}]\n";
  const Image without = render(parse_scene(head + scene)).image,
              thin = render(parse_scene(head + "fog: {density: 0}\n" + scene)).image;
  EXPECT_EQ(0, std::memcmp(without.data.data(), thin.data.data(), 3 * sizeof(float)));
  const ScenePtr layered =
      parse_scene(head + "fog: {density: 0}\n" + scene, "scene", {{{"film.layers", "true"}}});
  for (const std::string& channel : render(layered).image.channels)
    EXPECT_EQ(std::string::npos, channel.find("fog"));
}

TEST(Fog, LeavesLightOnItsWayToSurfacesAlone) {
  // A floor lit by a lamp behind the fog's first 2 units: the fog lies on the eye's way alone.
  const std::string scene =
      "illumination: {model: attenuated, ambient: 0, attenuation: none}\n"
      "lights: [{point: {position: [0, 0, 50], intensity: 1}}]\n"
      "objects: [{plane: {point: [0, 0, -4], normal: [0, 0, 1]}, material: {diffuse: 0.6}}]\n";
  const double left = std::exp(-0.5 * 4);
  expect_color(grey(left * 0.6 + (1 - left) * 0.2), head + "fog: {color: 0.2, density: 0.5}\n" + scene);
}

}  // namespace
}  // namespace lambent
