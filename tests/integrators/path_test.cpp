// The path tracer against closed forms, identities and itself.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "explain/derivation.h"
#include "lambent/explain.h"
#include "lambent/lambent.h"
#include "random_scene.h"
#include "scene/scene.h"
#include "scenefile/errors.h"

namespace lambent::test {
namespace {

using Set = std::vector<std::pair<std::string, std::string>>;

RenderResult shown(const std::string& yaml, const Set& set = {}, const RenderOptions& options = {}) {
  return render(parse_scene(yaml, "scene", {set}), options);
}

struct Mean {
  double mean, error;  ///< Of the mean: one standard deviation, from the pixels' own spread.
};
Mean mean_of(const Image& image, int channel = 0) {
  double sum = 0, squares = 0;
  const std::size_t n = std::size_t(image.width) * std::size_t(image.height);
  for (std::size_t i = 0; i < n; ++i) {
    const double value = image.data[i * image.channels.size() + std::size_t(channel)];
    sum += value, squares += value * value;
  }
  return {sum / double(n),
          std::sqrt(std::max(squares / double(n) - sum / double(n) * sum / double(n), 0.0) / double(n))};
}
bool same_bits(const Image& a, const Image& b) {
  return a.data.size() == b.data.size() &&
         std::memcmp(a.data.data(), b.data.data(), a.data.size() * sizeof(float)) == 0;
}

// EQUATIONS.md section 7: with a point light of radiant intensity pi Il, albedo Kd and no bounces, a path is
// Il Kd (N.L)+ / r^2: the lecture's `attenuated` without its ambient term.
TEST(Path, WithoutBouncesIsTheLecturesAttenuatedModel) {
  const std::string yaml = R"(lambent: 1
camera: {eye: [0, 2, 5], target: [0, 0.5, 0], fov: 45}
image: {size: [48, 36], samples: 4}
illumination: {model: attenuated, ambient: 0}
lights:
  - {name: key, point: {position: [2, 4, 3], color: [1, 0.9, 0.7], intensity: 20}}
materials:
  - {name: matt, diffuse: [0.7, 0.5, 0.2]}
objects:
  - {sphere: {center: [0, 1, 0], radius: 1}, material: matt}
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: matt}
)";
  const Image lecture = shown(yaml, {{"integrator", "{whitted: {max_depth: 1}}"}}).image;
  const Image path = shown(yaml, {{"integrator", "{path: {max_depth: 1}}"}}).image;
  for (std::size_t i = 0; i < lecture.data.size(); ++i)
    ASSERT_NEAR(path.data[i], lecture.data[i], 2e-7 * lecture.data[i]) << "value " << i;
}

// A closed furnace of albedo a and emission 1: every ray meets 1 + a (1 + a (1 + ...)), cut at the depth:
// with D rays in a row and light looked for at the last, the sum of a^k for k = 0 to D.
TEST(Path, AClosedFurnaceGivesTheGeometricSeries) {
  for (const double a : {0.2, 0.5, 0.9})
    for (const int depth : {1, 2, 5, 12}) {
      const std::string yaml = fmt::format(R"(lambent: 1
camera: {{eye: [0.1, 0, 0.3], target: [0, 0.2, -1], fov: 70}}
image: {{size: [24, 24], samples: 32}}
integrator: {{path: {{max_depth: {}, roulette_depth: 3}}}}
materials: [{{name: wall, diffuse: {}, emission: 1}}]
objects: [{{sphere: {{center: [0, 0, 0], radius: 1}}, material: wall}}]
)",
                                           depth, a);
      const double series = (1 - std::pow(a, depth + 1)) / (1 - a);
      const Mean got = mean_of(shown(yaml).image);
      EXPECT_NEAR(got.mean, series, 5 * got.error + 1e-6) << "albedo " << a << ", depth " << depth;
      EXPECT_LT(got.error, 0.02 * series);
    }
}

// A convex body in front of an even background of radiance 1 sends back what it does not absorb: nothing of
// it where the material conserves energy. The edges' pixels see 1 in any case.
TEST(Path, TheWhiteFurnaceLosesLessThanAHundredthAndGainsNothing) {
  for (const char* material :
       {"diffuse: 1", "{model: phong, diffuse: 0, specular: 1, shininess: 10}",
        "{model: blinn_phong, diffuse: 0.4, specular: 0.6, shininess: 40}", "{diffuse: 0, reflect: 1}",
        "{diffuse: 0, transmit: 1, ior: 1.5}",
        "{metallic_roughness: {base_color: 1, metallic: 1, roughness: 0.1}}",
        "{metallic_roughness: {base_color: 1, metallic: 1, roughness: 0.5}}",
        "{metallic_roughness: {base_color: 1, metallic: 1, roughness: 1}}",
        "{metallic_roughness: {base_color: 1, metallic: 0, roughness: 0.3}}",
        "{metallic_roughness: {base_color: 1, metallic: 0.5, roughness: 0.7, clearcoat: 1}}",
        "{diffuse: 1, opacity: 0.4}"}) {
    const std::string as_mapping = material[0] == '{' ? material : "{" + std::string(material) + "}";
    const Image image = shown(fmt::format(R"(lambent: 1
camera: {{eye: [0, 0, 4], target: [0, 0, 0], fov: 30}}
image: {{size: [24, 24], samples: 64}}
integrator: {{path: {{}}}}
background: 1
objects: [{{sphere: {{center: [0, 0, 0], radius: 1}}, material: {}}}]
)",
                                          as_mapping))
                            .image;
    const Mean got = mean_of(image);
    EXPECT_LT(got.mean, 1 + 5 * got.error + 1e-6) << material;
    // The ball fills two thirds of the picture. A lobe about the mirror direction loses what falls below the
    // surface: Phong's is not asked for a hundredth.
    const bool lobe = as_mapping.find("shininess") != std::string::npos;
    EXPECT_GT(got.mean, (lobe ? 0.8 : 0.993) - 5 * got.error) << material;
  }
}

// Direct light of a rectangle on a facing patch, by Lambert's closed form: for a square of side 2s in height
// h above the point, parallel to the surface,
//   F = (4 / (2 pi)) (2 x / sqrt(1 + x^2)) atan(x / sqrt(1 + x^2)),  x = s / h,
// and the surface sends back Kd Le F, with Le = pi Il / (4 s^2).
TEST(Path, ARectanglesDirectLightIsItsFormFactor) {
  for (const double s : {0.2, 1.0, 3.0}) {
    const double h = 1.5, Il = 2, Kd = 0.6, x = s / h, root = std::sqrt(1 + x * x);
    const double F = 4 / (2 * M_PI) * (2 * x / root) * std::atan(x / root);
    const double expected = Kd * (M_PI * Il / (4 * s * s)) * F;
    // A camera that sees a spot of 1e-3 around the point, from below the light, between the two.
    const std::string yaml = fmt::format(R"(lambent: 1
camera: {{projection: orthographic, eye: [0, 1, 0], target: [0, 0, 0], up: [0, 0, -1], height: 0.001}}
image: {{size: [8, 8], samples: 64}}
integrator: {{path: {{max_depth: 1}}}}
lights: [{{name: a, rectangle: {{center: [0, {}, 0], u: [{}, 0, 0], v: [0, 0, {}], intensity: {}}}}}]
objects: [{{plane: {{point: [0, 0, 0], normal: [0, 1, 0]}}, material: {{diffuse: {}}}}}]
)",
                                         h, 2 * s, 2 * s, Il, Kd);
    const Mean got = mean_of(shown(yaml).image);
    EXPECT_NEAR(got.mean, expected, 5 * got.error + 1e-6 * expected) << "s = " << s;
    EXPECT_LT(got.error, 0.01 * expected);
    // And with the light found in both ways.
    const Mean both = mean_of(shown(yaml, {{"integrator.path.max_depth", "2"}}).image);
    EXPECT_NEAR(both.mean, expected, 5 * both.error + 1e-6 * expected) << "s = " << s;
  }
}

// A light with a dark back: from there it is black, and Le from its front, 4 pi / 1.
TEST(Path, ALightShinesOnItsFrontAlone) {
  const auto seen_from = [](const char* eye) {
    return mean_of(shown(std::string("lambent: 1\ncamera: {projection: orthographic, eye: ") + eye +
                         R"(, target: [0, 0, 0], height: 0.5}
image: {size: [4, 4], samples: 1}
integrator: {path: {}}
lights: [{name: a, rectangle: {center: [0, 0, 0], u: [1, 0, 0], v: [0, 1, 0], intensity: 4}}]
objects: [{sphere: {center: [0, 9, 0], radius: 0.1}}]
)")
                       .image)
        .mean;
  };
  EXPECT_NEAR(seen_from("[0, 0, 3]"), 4 * M_PI, 1e-5);
  EXPECT_EQ(seen_from("[0, 0, -3]"), 0);
}

// The light behind a pane of which a third is there: the pane's own light aside, two thirds of it.
TEST(Path, WhatIsNotWhollyThereLetsLightThrough) {
  const std::string yaml = R"(lambent: 1
camera: {projection: orthographic, eye: [0, 0.5, 0], target: [0, 0, 0], up: [0, 0, -1], height: 0.1}
image: {size: [8, 8], samples: 64}
integrator: {path: {max_depth: 2}}
lights: [{name: a, point: {position: [0, 2, 0], intensity: 4}}]
objects:
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: {diffuse: 0.5}}
  - {disc: {center: [0, 1, 0], normal: [0, 1, 0], radius: 9}, material: {diffuse: 0, opacity: 0.3333333333}}
)";
  // Il Kd / r^2 = 4 * 0.5 / 4 = 0.5, of which two thirds.
  // Seen within 0.05 of the point below the light: (N.L) / r^2 falls by 1 - 1.5 (0.05 / 2)^2 at the most.
  const Mean got = mean_of(shown(yaml).image);
  EXPECT_NEAR(got.mean, 0.5 * 2 / 3, 0.001 * 0.5 * 2 / 3);
}

const std::string room = R"(lambent: 1
camera: {eye: [0, 1, 3.9], target: [0, 1, 0], fov: 38}
image: {size: [32, 32], samples: 16}
integrator: {path: {max_depth: 6, roulette_depth: 3}}
background: [0.1, 0.1, 0.2]
lights:
  - {name: ceiling, rectangle: {center: [0, 1.98, 0], u: [0.5, 0, 0], v: [0, 0, 0.4], intensity: 1.2}}
  - {name: lamp, point: {position: [0.5, 1.5, 0.8], color: [0.2, 0.3, 1], intensity: 0.5}}
materials:
  - {name: white, diffuse: 0.73}
  - {name: shiny, diffuse: 0.3, specular: 0.5, shininess: 60}
  - {name: brass, metallic_roughness: {base_color: [0.9, 0.7, 0.4], metallic: 1, roughness: 0.25}}
  - {name: glass, diffuse: 0, reflect: 0.1, transmit: 0.9, ior: 1.5}
  - {name: glow, diffuse: 0.2, emission: [1, 0.4, 0.1]}
  - {name: veil, diffuse: 0.8, opacity: 0.5}
objects:
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0], size: [2, 2]}, material: white}
  - {plane: {point: [0, 2, 0], normal: [0, -1, 0], size: [2, 2]}, material: white}
  - {plane: {point: [0, 1, -1], normal: [0, 0, 1], size: [2, 2]}, material: shiny}
  - {sphere: {center: [0.4, 0.35, 0.3], radius: 0.35}, material: brass}
  - {sphere: {center: [-0.4, 0.35, 0.3], radius: 0.35}, material: glass}
  - {cylinder: {from: [-0.8, 0, -0.5], to: [-0.8, 1.6, -0.5], radius: 0.1}, material: glow}
  - {disc: {center: [0.3, 1.2, -0.2], normal: [0, 0, 1], radius: 0.3}, material: veil}
)";

TEST(SameBits, OfPathsForThreadsTilesAndInstructionSets) {
  const Image one = shown(room).image;
  for (const int threads : {2, 5})
    for (const int tile : {5, 64}) {
      RenderOptions options;
      options.threads = threads, options.tile_size = tile;
      EXPECT_TRUE(same_bits(one, shown(room, {}, options).image)) << threads << " threads, tiles of " << tile;
    }
  for (const std::string& isa : available_isas()) {
    RenderOptions options;
    options.isa = isa;
    EXPECT_TRUE(same_bits(one, shown(room, {}, options).image)) << isa;
  }
}

TEST(SameBits, OfPathsUntilTheNoiseIsLow) {
  const Set until{{"integrator.path.until", "0.08"}, {"image.samples", "8"}};
  RenderOptions options;
  options.threads = 3, options.tile_size = 7;
  const RenderResult one = shown(room, until), other = shown(room, until, options);
  EXPECT_TRUE(same_bits(one.image, other.image));
  EXPECT_LE(one.stats.noise, 0.08);
  EXPECT_EQ(one.stats.noise, other.stats.noise);
  EXPECT_GT(one.stats.samples_per_pixel, 8);
}

// The estimate is of what it says: the distance to a picture of many samples is no more.
TEST(Path, TheNoiseIsAnUpperEstimateOfTheError) {
  const RenderResult few = shown(room, {{"image.samples", "32"}}),
                     many = shown(room, {{"image.samples", "2048"}});
  double squares = 0, sum = 0;
  const std::size_t n = std::size_t(few.image.width) * std::size_t(few.image.height);
  for (std::size_t i = 0; i < n; ++i) {
    const auto luminance = [&](const Image& image) {
      return luminance_of(Rgb{image.data[3 * i], image.data[3 * i + 1], image.data[3 * i + 2]});
    };
    const double off = luminance(few.image) - luminance(many.image);
    squares += off * off, sum += luminance(many.image);
  }
  const double error = std::sqrt(squares * double(n)) / sum;
  EXPECT_LT(error, 1.1 * few.stats.noise);
  EXPECT_GT(error, 0.2 * few.stats.noise) << "an estimate that is far too high says nothing";
}

// Two ways of looking for the same light: where it cannot be met, only the search finds it, and its weight
// is 1.
TEST(Path, SearchAndChanceAgree) {
  const auto seen_with = [](const char* visible) {
    return mean_of(shown(room, {{"lights.ceiling.rectangle.visible", visible},
                                {"image.samples", "256"},
                                {"camera.eye", "[0, 0.9, 3.5]"},
                                {"camera.target", "[0, 0.3, 0]"},
                                {"camera.fov", "12"}})
                       .image);
  };
  const Mean both = seen_with("true"), search = seen_with("false");
  // Mirrors and glass see the light or do not: keep to what is matt and brass by the camera's choice; the
  // little that the balls reflect of the lamp itself stays below a hundredth.
  EXPECT_NEAR(both.mean, search.mean, 0.02 * both.mean + 4 * std::hypot(both.error, search.error) / 16);
}

TEST(Path, ExplainsEverySampleBitForBit) {
  const ScenePtr scene = parse_scene(room, "scene", {Set{{"image.samples", "4"}}});
  const Image image = render(scene).image;
  std::size_t searches = 0, finds = 0;
  for (int y = 1; y < 32; y += 3)
    for (int x = 1; x < 32; x += 3) {
      const DerivationPtr derivation = explain(scene, x, y);
      EXPECT_TRUE(adds_up(derivation)) << x << "," << y;
      const std::vector<float> pixel = pixel_of(derivation);
      EXPECT_EQ(0, std::memcmp(pixel.data(), image.pixel(x, y), 3 * sizeof(float))) << x << "," << y;
      for (const DerivedRay& ray : derivation->rays) {
        searches += ray.search.has_value(), finds += ray.find.has_value();
        if (!ray.search || !ray.search->open) continue;
        // brings = w * arriving * f |N.L| * share
        for (int c = 0; c < color_channels; ++c)
          EXPECT_NEAR(
              ray.search->brings[c],
              ray.search->weight * ray.search->arriving[c] * ray.search->scattered[c] * ray.search->share,
              1e-12 * ray.search->brings[c]);
      }
    }
  EXPECT_GT(searches, 400u);
  EXPECT_GT(finds, 50u);
}

TEST(Path, ExplainsInWordsAndInJson) {
  const ScenePtr scene = parse_scene(room, "scene", {Set{{"image.samples", "4"}}});
  const DerivationPtr derivation = explain(scene, 20, 24);
  ExplainText text;
  const std::string page = explanation(derivation, text);
  for (const char* words : {"throughput", "Light is looked for", "f |N.L|", "bit for bit"})
    EXPECT_NE(page.find(words), std::string::npos) << words << "\n" << page;
  text.format = ExplainFormat::json;
  // Added up from the JSON alone, in its order: weight * brings of what was found, then of what was looked
  // for.
  const auto json = nlohmann::json::parse(explanation(derivation, text));
  double pixel[3] = {};
  for (const auto& sample : json["samples"])
    for (const nlohmann::json* ray = &sample["ray"]; ray;) {
      for (int c = 0; c < 3; ++c) {
        const double weight = (*ray)["weight"][std::size_t(c)].get<double>();
        if (!(*ray)["find"].is_null())
          pixel[c] += weight * (*ray)["find"]["brings"][std::size_t(c)].get<double>();
        if (!(*ray)["search"].is_null() && (*ray)["search"]["state"] == "visible")
          pixel[c] += weight * (*ray)["search"]["brings"][std::size_t(c)].get<double>();
      }
      ray = (*ray)["rays"].empty() ? nullptr : &(*ray)["rays"][0];
    }
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(pixel[c] / 4, json["linear"][std::size_t(c)].get<double>(), 1e-6 * pixel[c]);
}

TEST(Path, LayersAddUpExactlyAndTellLightsApart) {
  const Set layers{{"film.layers", "true"}};
  const Image whole = shown(room).image, parts = shown(room, layers).image;
  std::vector<std::size_t> summed;
  std::string names;
  for (std::size_t c = 0; c < parts.channels.size(); ++c) {
    const std::string& name = parts.channels[c];
    names += name + " ";
    if (name.ends_with(".R") && !name.starts_with("albedo") && !name.starts_with("Crypto"))
      summed.push_back(c);
  }
  for (const char* name :
       {"light.ceiling.direct.R", "light.lamp.indirect.R", "surfaces.direct.R", "sky.indirect.R"})
    EXPECT_NE(names.find(name), std::string::npos) << name << " in " << names;
  for (int y = 0; y < whole.height; ++y)
    for (int x = 0; x < whole.width; ++x) {
      float sum = 0;
      for (const std::size_t c : summed) sum += parts.pixel(x, y)[c];
      ASSERT_EQ(sum, whole.pixel(x, y)[0]) << x << "," << y;
    }
  // The lamp alone, in a scene without the others: its two layers, but for other random numbers.
  double by_layers = 0;
  for (std::size_t c = 0; c < parts.channels.size(); ++c)
    if (parts.channels[c] == "light.lamp.direct.B" || parts.channels[c] == "light.lamp.indirect.B")
      for (int i = 0; i < 32 * 32; ++i) by_layers += parts.data[std::size_t(i) * parts.channels.size() + c];
  const Mean alone = mean_of(shown(room, {{"lights.ceiling.rectangle.intensity", "0"},
                                          {"materials.glow.emission", "0"},
                                          {"background", "0"},
                                          {"image.samples", "64"}})
                                 .image,
                             2);
  EXPECT_NEAR(by_layers / (32 * 32), alone.mean, 0.06 * alone.mean);
}

// Every kind of scene: nothing negative, nothing infinite, explained to the bit.
// A lamp that is all that shines is looked for a packet at a time; where layers are asked for, point by point
// as all others.
TEST(SameBits, OfALoneLampForPacketsAndPoints) {
  for (const std::string lamp :
       {"rectangle: {center: [0, 2, 0.5], u: [0.6, 0, 0], v: [0, 0, 0.6]}",
        "rectangle: {center: [0, 0.8, 0.5], u: [0.6, 0, 0], v: [0, 0.2, 0.6], two_sided: true}",
        "disc: {center: [0, 2, 0], normal: [0.2, -1, 0], radius: 0.3}",
        "sphere: {center: [0.3, 1.8, 0.5], radius: 0.4}",
        "sphere: {center: [0.3, 0.5, 0.5], radius: 0.4, visible: false}"}) {
    const std::string scene =
        "lambent: 1\ncamera: {eye: [0, 1, 4], target: [0, 0.5, 0]}\n"
        "image: {size: [24, 24], samples: 4}\nintegrator: {path: {max_depth: 6}}\n"
        "lights: [{" +
        lamp + "}]\n" +
        "objects:\n"
        "  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: {diffuse: 0.6, specular: 0.3}}\n"
        "  - {sphere: {center: [-0.6, 0.5, 0], radius: 0.5}, material: {glass: bk7, roughness: 0.4}}\n"
        "  - {sphere: {center: [0.6, 0.5, 0], radius: 0.5}, material: {metal: gold, roughness: 0.4}}\n";
    const Image packets = shown(scene).image, points = shown(scene, {{"film.layers", "true"}}).image;
    ASSERT_EQ(points.channels[0], "R");
    for (int y = 0; y < packets.height; ++y)
      for (int x = 0; x < packets.width; ++x)
        for (int c = 0; c < 3; ++c)
          ASSERT_EQ(packets.pixel(x, y)[c], points.pixel(x, y)[c]) << lamp << " " << x << "," << y;
  }
}

TEST(Path, OfRandomScenesIsFiniteAndExplained) {
  for (unsigned seed = 500; seed < 530; ++seed) {
    const std::string yaml = random_scene(seed, 12, 9, "2");
    LoadOptions options;
    options.integrator = "path";
    const ScenePtr scene = parse_scene(yaml, "scene", options);
    const Image image = render(scene).image;
    for (const float value : image.data)
      ASSERT_TRUE(std::isfinite(value) && value >= 0) << seed << "\n" << yaml;
    for (const auto& [x, y] : {std::pair{5, 4}, {7, 5}, {3, 6}}) {
      const std::vector<float> pixel = pixel_of(explain(scene, x, y));
      ASSERT_EQ(0, std::memcmp(pixel.data(), image.pixel(x, y), 3 * sizeof(float))) << seed;
    }
  }
}

TEST(Path, RefusesWhatItCannotDo) {
  EXPECT_EQ(errors_of("lambent: 1\ncamera: {eye: [0, 0, 5], target: [0, 0, 0]}\nintegrator: {path: {}}\n"
                      "image: {samples: {adaptive: {}}}\n")
                .at(0)
                .message,
            "adaptive samples are for integrators without noise");
}

}  // namespace
}  // namespace lambent::test
