// Explain: what is told of a pixel is what the renderer did, and adds up to it.

#include "lambent/explain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "explain/derivation.h"
#include "explain/terms.h"
#include "integrators/prepare.h"
#include "random_scene.h"
#include "scene/scene.h"
#include "scenefile/json_schema.h"
#include "support.h"

namespace lambent {
namespace {

using Json = nlohmann::json;
using Triple = std::array<double, 3>;

Triple triple(const Json& json) {
  if (json.is_number()) return {json.get<double>(), json.get<double>(), json.get<double>()};
  return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

void expect_same_bits(const float* expected, const std::vector<float>& got, const std::string& where) {
  EXPECT_EQ(0, std::memcmp(expected, got.data(), 3 * sizeof(float)))
      << where << ": rendered " << expected[0] << " " << expected[1] << " " << expected[2] << ", explained "
      << got[0] << " " << got[1] << " " << got[2];
}

/// Every third scene has a lens, every third fog.
LoadOptions settings_for(unsigned seed, std::vector<std::pair<std::string, std::string>> set = {}) {
  if (seed % 3 == 1) set.insert(set.end(), {{"camera.aperture", "0.4"}, {"camera.focus_distance", "5"}});
  if (seed % 3 == 2) set.emplace_back("fog", "{color: [0.3, 0.4, 0.5], density: 0.1, start: 4}");
  LoadOptions options;
  options.set = std::move(set);
  return options;
}

// 100 scenes, 100 pixels each: every kind of light, shape, model, depth and number of samples.
TEST(Explain, TheTermsSumToTheRenderedPixelBitForBit) {
  std::size_t pixels = 0, mirrored = 0, refracted = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const std::string yaml = test::random_scene(seed, 24, 18, std::to_string(1 + seed % 5));
    const ScenePtr scene = parse_scene(yaml, "scene", settings_for(seed));
    const Image image = render(scene).image;
    Exposure exposure(*scene);
    std::mt19937 random(seed);
    for (int i = 0; i < 100; ++i, ++pixels) {
      const int x = std::uniform_int_distribution<int>(0, 23)(random),
                y = std::uniform_int_distribution<int>(0, 17)(random);
      const Derivation d = derive(scene, exposure, choose_kernel(""), x, y, exposure.portions());
      ASSERT_NO_FATAL_FAILURE(expect_same_bits(
          image.pixel(x, y), {d.pixel, d.pixel + 3},
          "seed " + std::to_string(seed) + ", pixel " + std::to_string(x) + "," + std::to_string(y)));
      for (const DerivedRay& ray : d.rays)
        mirrored += ray.seen.way == Way::reflection, refracted += ray.seen.way == Way::refraction;
    }
    if (HasFailure()) FAIL() << yaml;
  }
  EXPECT_EQ(10000u, pixels);
  EXPECT_GT(mirrored, 1000u) << "the scenes hardly reflect";
  EXPECT_GT(refracted, 300u) << "the scenes hardly refract";
}

TEST(Explain, AFormulaHasTheBitsOfTheRenderersTerm) {
  std::size_t terms = 0;
  for (unsigned seed = 200; seed < 230; ++seed) {
    const ScenePtr scene = parse_scene(test::random_scene(seed, 16, 12, "1"));
    Exposure exposure(*scene);
    for (int y = 0; y < 12; ++y)
      for (int x = 0; x < 16; ++x) {
        const Derivation d = derive(scene, exposure, choose_kernel(""), x, y, exposure.portions());
        for (const DerivedRay& ray : d.rays) {
          if (!ray.hits) continue;
          EXPECT_EQ(ray.ambient, ambient_formula(d, ray).value);
          for (const DerivedLight& light : ray.lights) {
            if (is_black(light.seen.arriving)) continue;
            const LightFormulas formulas = light_formulas(d, ray, light);
            ASSERT_EQ(light.seen.arriving, formulas.arriving.value);
            ASSERT_EQ(light.diffuse, formulas.diffuse.value);
            ASSERT_EQ(light.specular, formulas.specular.value);
            ++terms;
          }
        }
      }
  }
  EXPECT_GT(terms, 2000u);
}

TEST(Explain, AdaptiveSamplesAndTheSpdPatternAddUp) {
  for (const char* samples : {"{adaptive: {start: 4, max: 64, error: 1}}", "7"})
    for (unsigned seed : {3u, 4u, 5u}) {
      std::string yaml = test::random_scene(seed, 20, 14, samples);
      if (samples[0] == '7') yaml += "\n";
      const ScenePtr scene =
          parse_scene(yaml, "scene", {{{"image.pattern", samples[0] == '7' ? "corners" : "stratified"}}});
      const Image image = render(scene).image;
      for (const auto& [x, y] : {std::pair{0, 0}, {10, 7}, {19, 13}, {5, 9}}) {
        const DerivationPtr d = explain(scene, x, y);
        EXPECT_TRUE(adds_up(d)) << seed << " " << x << "," << y << ": " << d->pixel[0] << " "
                                << d->rendered[0];
        expect_same_bits(image.pixel(x, y), pixel_of(d), samples);
        if (samples[0] == '7') {
          EXPECT_EQ(4, sample_count(d)) << "one for each corner";
        }
      }
    }
}

// ---- what is told, read back from the JSON alone

/// The colour that a ray adds, by the JSON's numbers: in the order of the equation, emission + (ambient +
/// ...).
Triple color_of(const Json& ray, const Json& background) {
  if (ray["hit"].is_null()) return triple(background);
  const Json& hit = ray["hit"];
  Triple I = triple(hit["ambient"]["value"]);
  for (const Json& light : hit["lights"]) {
    if (!light.contains("diffuse") || light["diffuse"].is_null()) continue;
    for (const char* term : {"diffuse", "specular"})
      for (std::size_t c = 0; c < 3; ++c) I[c] += triple(light[term]["value"])[c];
  }
  for (std::size_t c = 0; c < 3; ++c) I[c] = triple(hit["emission"])[c] + I[c];
  return I;
}

void collect(const Json& ray, std::map<unsigned, Json>& rays) {
  rays[ray["ray"].get<unsigned>()] = ray;
  for (const Json& child : ray["rays"]) collect(child, rays);
}

TEST(Explain, TheJsonHasAllThatThePixelIsMadeOf) {
  for (unsigned seed = 300; seed < 320; ++seed) {
    const ScenePtr scene = parse_scene(test::random_scene(seed, 16, 12, "3"), "scene",
                                       settings_for(seed, {{"image.pattern", "stratified"}}));
    const Image image = render(scene).image;
    for (const auto& [x, y] : {std::pair{8, 6}, {3, 4}, {12, 9}}) {
      const Json json = Json::parse(explanation(explain(scene, x, y), {ExplainFormat::json, {}, false}));
      Triple sum{};
      for (const Json& sample : json["samples"]) {
        std::map<unsigned, Json> rays;
        collect(sample["ray"], rays);
        Triple color{};
        std::set<unsigned> through_fog;
        for (const Json& number : sample["order"]) {
          const Json& ray = rays.at(number.get<unsigned>());
          const bool is_fog = ray.contains("fog") && through_fog.insert(number.get<unsigned>()).second;
          const Triple weight = triple(ray.contains("fog") && !is_fog ? ray["fog"]["weight"] : ray["weight"]),
                       brings = is_fog ? triple(ray["fog"]["brings"]) : color_of(ray, json["background"]);
          for (std::size_t c = 0; c < 3; ++c) color[c] += weight[c] * brings[c];
        }
        for (std::size_t c = 0; c < 3; ++c) sum[c] += color[c];
      }
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_EQ(image.pixel(x, y)[c], float(sum[c] / double(json["sample_count"]))) << "seed " << seed;
    }
  }
}

// Phong's equation by the JSON's vectors and coefficients: independent of how the renderer computes it.
TEST(Explain, TheNumbersSatisfyTheEquation) {
  const ScenePtr scene = parse_scene(
      "lambent: 1\ncamera: {eye: [0, 1, 5], target: [0, 0.5, 0]}\nimage: {size: [40, 30]}\n"
      "illumination: {model: phong, ambient: [0.5, 1, 1]}\n"
      "lights:\n  - {name: key, point: {position: [3, 4, 4], color: [1, 0.9, 0.8], intensity: 8}}\n"
      "  - {name: fill, directional: {direction: [1, -1, -1], intensity: 0.3}}\n"
      "materials: [{name: red, ambient: 0.1, diffuse: [0.8, 0.1, 0.1], specular: 0.5, shininess: 7, reflect: "
      "0.2}]\n"
      "objects: [{sphere: {center: [0, 0.6, 0], radius: 0.6}, material: red}, {plane: {point: [0, 0, 0], "
      "normal: [0, 1, 0]}, material: red}]\n");
  int lit = 0;
  for (int x = 4; x < 40; x += 4)
    for (int y = 12; y < 30; y += 3) {
      const Json json = Json::parse(explanation(explain(scene, x, y), {ExplainFormat::json, {}, false}));
      const Json& hit = json["samples"][0]["ray"]["hit"];
      if (hit.is_null()) continue;
      const Triple N = triple(hit["N"]), V = triple(hit["V"]), Ka = triple(hit["Ka"]), Kd = triple(hit["Kd"]),
                   Ks = triple(hit["Ks"]);
      const double R = hit["R"], n = hit["n"];
      const auto dot3 = [](const Triple& a, const Triple& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
      };
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(Ka[c] * triple(json["ambient"])[c] / R, triple(hit["ambient"]["value"])[c],
                    1e-15);  // Ka Ia / R
      for (const Json& light : hit["lights"]) {
        if (light["state"] != "visible") continue;
        ++lit;
        const Triple L = triple(light["L"]), Il = triple(light["Il"]);
        const double NL = dot3(N, L), faded = light["r"].is_null() ? 1 : 1 / light["r"].get<double>();
        Triple Rl;
        for (std::size_t i = 0; i < 3; ++i) Rl[i] = 2 * NL * N[i] - L[i];  // R = 2 (N.L) N - L
        const double highlight = std::pow(std::max(dot3(Rl, V), 0.0), n);
        for (std::size_t c = 0; c < 3; ++c) {
          EXPECT_NEAR(Il[c] * faded * Kd[c] * NL, triple(light["diffuse"]["value"])[c], 1e-12);
          EXPECT_NEAR(Il[c] * faded * Ks[c] * highlight, triple(light["specular"]["value"])[c], 1e-12);
        }
        EXPECT_EQ("(N.L)+ Kd I", light["diffuse"]["equation"]);
        EXPECT_EQ("(R.V)+^n Ks I", light["specular"]["equation"]);
      }
    }
  EXPECT_GT(lit, 20);
}

// A ball hangs between the light and the floor: 3 away from the floor's point, by its lower pole.
TEST(Explain, SaysWhatBlocksALightAndWhereItWasWritten) {
  const std::string yaml =
      "lambent: 1\ncamera: {projection: orthographic, eye: [0, 1, 5], target: [0, 0, 0], height: 2}\n"
      "image: {size: [1, 1]}\n"
      "lights: [{name: key, point: {position: [0, 9, 0]}}]\n"
      "objects:\n  - {name: floor, plane: {point: [0, 0, 0], normal: [0, 1, 0]}}\n"
      "  - name: ball\n    sphere: {center: [0, 4, 0], radius: 1}\n";
  const Json json = Json::parse(
      explanation(explain(parse_scene(yaml, "mine.yaml"), 0, 0), {ExplainFormat::json, {}, false}));
  const Json& light = json["samples"][0]["ray"]["hit"]["lights"][0];
  EXPECT_EQ("blocked", light["state"]);
  ASSERT_EQ(1u, light["on_the_way"].size());
  EXPECT_EQ("ball", light["on_the_way"][0]["object"]);
  EXPECT_NEAR(3, light["on_the_way"][0]["distance"].get<double>(), 1e-5);
  EXPECT_EQ("floor", json["samples"][0]["ray"]["hit"]["object"]);
  EXPECT_EQ(6, json["samples"][0]["ray"]["hit"]["object_place"]["line"]);
}

// Light through two panes, 0.5 each: a quarter arrives.
TEST(Explain, SaysWhatLightGoesThrough) {
  const std::string yaml =
      "lambent: 1\ncamera: {projection: orthographic, eye: [0, 1, 5], target: [0, 0, 0], height: 2}\n"
      "image: {size: [1, 1]}\nlights: [{name: key, point: {position: [0, 9, 0]}}]\n"
      "materials: [{name: glass, transmit: 0.5, ior: 1}]\n"
      "objects:\n  - {name: floor, plane: {point: [0, 0, 0], normal: [0, 1, 0]}}\n  - {name: low, plane: "
      "{point: [0, 2, 0], normal: [0, 1, 0]}, material: glass}\n"
      "  - {name: high, plane: {point: [0, 4, 0], normal: [0, 1, 0]}, material: glass}\n";
  const Json json =
      Json::parse(explanation(explain(parse_scene(yaml), 0, 0), {ExplainFormat::json, {}, false}));
  const Json& light = json["samples"][0]["ray"]["hit"]["lights"][0];
  EXPECT_EQ("visible", light["state"]);
  EXPECT_EQ((Triple{0.25, 0.25, 0.25}), triple(light["share"]));
  ASSERT_EQ(2u, light["on_the_way"].size());
  EXPECT_NEAR(2, light["on_the_way"][0]["distance"].get<double>(), 1e-5);
  EXPECT_NEAR(4, light["on_the_way"][1]["distance"].get<double>(), 1e-5);
}

TEST(Explain, TheJsonIsAsItsSchemaSays) {
  const test::JsonSchema schema(
      Json::parse(test::read_text(std::string(LAMBENT_SOURCE_DIR) + "/docs/explain.schema.json")));
  for (unsigned seed = 500; seed < 540; ++seed) {
    std::string yaml = test::random_scene(seed, 16, 12, "2");
    if (seed % 2)
      yaml += "  - {sphere: {center: [0, 0, 0], radius: 0.3}, motion: {translate: [0.2, 0, 0]}}\n";
    const ScenePtr scene = parse_scene(yaml, "scene", settings_for(seed, {{"image.pattern", "stratified"}}));
    Json json = Json::parse(explanation(explain(scene, 8, 6), {ExplainFormat::json, {}, false}));
    EXPECT_TRUE(schema.accepts(json)) << json.dump(1);
    json["samples"][0]["ray"]["something"] = 1;
    EXPECT_FALSE(schema.accepts(json));
  }
}

TEST(Explain, TheJsonOfWavelengthsGivesThePixel) {
  const test::JsonSchema schema(
      Json::parse(test::read_text(std::string(LAMBENT_SOURCE_DIR) + "/docs/explain.schema.json")));
  const ScenePtr scene = parse_scene(R"(
lambent: 1
camera: {eye: [0, 0, 5], target: [0, 0, 0]}
image: {size: [1, 1], samples: 2}
integrator: {spectral: {wavelengths: 4}}
lights: [{point: {position: [2, 2, 4], intensity: 4}}]
objects: [{sphere: {center: [0, 0, 0], radius: 1}, material: {metal: gold, roughness: 0.4}}]
)");
  const Json json = Json::parse(explanation(explain(scene, 0, 0), {ExplainFormat::json, {}, false}));
  EXPECT_TRUE(schema.accepts(json)) << json.dump(1);
  ASSERT_EQ(json["wavelengths"].size(), 4u);
  double sum[3] = {};
  for (std::size_t s = 0; s < 2; ++s) {
    double color[3] = {};
    for (const Json& pass : json["passes"]) {
      double add[3] = {};
      for (std::size_t i = 0; i < pass["weights"].size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
          add[c] += pass["samples"][s]["color"][i].get<double>() * pass["weights"][i][c].get<double>();
      for (std::size_t c = 0; c < 3; ++c) color[c] += add[c];
    }
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(color[c], json["samples"][s]["color"][c].get<double>());
      sum[c] += color[c];
    }
  }
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(float(sum[c] / 2), json["linear"][c].get<float>());
}

TEST(Explain, TextStaysWithin80ColumnsAndSaysThatItAddsUp) {
  for (unsigned seed = 400; seed < 420; ++seed) {
    const ScenePtr scene = parse_scene(test::random_scene(seed, 16, 12, "2"));
    for (const auto& [x, y] : {std::pair{8, 6}, {3, 4}}) {
      const std::string text = explanation(explain(scene, x, y));
      EXPECT_NE(std::string::npos, text.find("add up to the rendered pixel, bit for bit"));
      std::size_t begin = 0;
      int depth_of_nesting = 0;
      for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
        const std::size_t indent = text.find_first_not_of(' ', begin) - begin;
        depth_of_nesting = std::max(depth_of_nesting, int(indent));
        if (indent <= 8) {
          EXPECT_LE(end - begin, 80u) << text.substr(begin, end - begin);
        }
      }
    }
  }
}

TEST(Explain, EveryFormatIsWellFormed) {
  const ScenePtr scene = parse_scene(test::random_scene(7, 16, 12, "2"));
  const DerivationPtr d = explain(scene, 8, 6);
  const std::string latex = explanation(d, {ExplainFormat::latex, {}, false});
  const auto count = [](const std::string& text, const std::string& what) {
    std::size_t n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
  };
  for (const char* environment : {"document", "align*", "quote", "pmatrix"})
    EXPECT_EQ(count(latex, std::string("\\begin{") + environment + "}"),
              count(latex, std::string("\\end{") + environment + "}"));
  EXPECT_GT(count(latex, "\\begin{align*}"), 3u);
  const std::string html = explanation(d, {ExplainFormat::mathml, {}, false});
  for (const char* element : {"math", "mrow", "mfrac", "msup", "mo", "mn", "mi", "section", "p"}) {
    const std::string name = element;
    EXPECT_EQ(count(html, "<" + name + ">") + count(html, "<" + name + " "), count(html, "</" + name + ">"))
        << name;
  }
  EXPECT_GT(count(html, "<math"), 3u);
}

TEST(Explain, TraceListsEveryRayThatWasAsked) {
  const ScenePtr scene =
      parse_scene(test::random_scene(11, 16, 12, "2"), "scene", {{{"image.pattern", "stratified"}}});
  const std::string trace = ray_trace(explain(scene, 8, 6));
  std::size_t eye = 0;
  for (std::size_t at = trace.find("eye "); at != std::string::npos; at = trace.find("eye ", at + 1)) ++eye;
  EXPECT_EQ(2u, eye);
}

TEST(Explain, RefusesPixelsAndSamplesThatAreNotThere) {
  const ScenePtr scene = parse_scene(test::random_scene(1, 16, 12, "2"));
  EXPECT_THROW(explain(scene, 16, 0), InputError);
  EXPECT_THROW(explain(scene, 0, -1), InputError);
  EXPECT_THROW(explanation(explain(scene, 0, 0), {ExplainFormat::text, 99, false}), InputError);
}

}  // namespace
}  // namespace lambent
