// Debug views against closed forms: what the eye's ray meets first, and how many rays were asked.

#include "integrators/view.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "lambent/explain.h"
#include "lambent/lambent.h"
#include "random_scene.h"
#include "scenefile/errors.h"

namespace lambent::test {
namespace {

using Set = std::vector<std::pair<std::string, std::string>>;
using Pixel3 = std::tuple<float, float, float>;

RenderResult view(const std::string& yaml, const std::string& settings, const RenderOptions& options = {}) {
  return render(parse_scene(yaml, "scene", {Set{{"integrator", "{view: {show: " + settings + "}}"}}}),
                options);
}
Pixel3 at(const Image& image, int x, int y) {
  const float* pixel = image.pixel(x, y);
  return {pixel[0], pixel[1], pixel[2]};
}
std::string said_in(const Metadata& metadata, const std::string& key) {
  for (const auto& [name, value] : metadata)
    if (name == key) return value;
  return "";
}

const Pixel3 black{0, 0, 0};

// An orthographic camera looks along -z at the square from -1 to 1: pixel (x, y) of n by n has this x and y.
std::string flat(int n, int samples = 1) {
  return fmt::format(
      "lambent: 1\ncamera: {{projection: orthographic, eye: [0, 0, 5], target: [0, 0, 0], height: 2}}\n"
      "image: {{size: [{}, {}], samples: {}}}\nbackground: [0.2, 0.4, 0.6]\n",
      n, n, samples);
}
double centre(int pixel, int n) { return (pixel + 0.5) * 2 / n - 1; }

TEST(View, NormalsOfASphere) {
  const int n = 41;
  const std::string ball = "objects: [{sphere: {center: [0, 0, 0], radius: 0.9}}]\n";
  const Image image = view(flat(n) + ball, "normals").image;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const double X = centre(x, n) / 0.9, Y = -centre(y, n) / 0.9, beyond = 1 - X * X - Y * Y;
      if (beyond < 0) {
        EXPECT_EQ(black, at(image, x, y)) << "whatever the scene's background";
        continue;
      }
      // At the rim the sphere is steep: there the normal's error is that of the ray over sqrt(beyond).
      EXPECT_NEAR((X + 1) / 2, image.pixel(x, y)[0], 1e-6);
      EXPECT_NEAR((Y + 1) / 2, image.pixel(x, y)[1], 1e-6);
      EXPECT_NEAR((std::sqrt(beyond) + 1) / 2, image.pixel(x, y)[2], 1e-6);
    }
}

TEST(View, NormalsLieOnTheEyesSideAndTurnWithTheObject) {
  const auto normal = [&](const std::string& object) {
    return at(view(flat(1) + "objects: [" + object + "]\n", "normals").image, 0, 0);
  };
  EXPECT_EQ(Pixel3(0.5f, 0.5f, 1.0f), normal("{plane: {point: [0, 0, 0], normal: [0, 0, -1]}}"));
  const auto [x, y, z] =
      normal("{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, transform: {rotate: {axis: y, degrees: 30}}}");
  EXPECT_NEAR(0.75, x, 1e-6);
  EXPECT_NEAR(0.5, y, 1e-6);
  EXPECT_NEAR((std::sqrt(0.75) + 1) / 2, z, 1e-6);
}

TEST(View, DepthOfAPlaneSeenHeadOn) {
  // The plane lies half as far behind the target as the eye stands before it: R = 6 / cos, s = 4.
  const int n = 16;
  const std::string yaml =
      "lambent: 1\ncamera: {eye: [0, 0, 4], target: [0, 0, 0], fov: 90}\nimage: {size: [16, 16]}\n"
      "objects: [{plane: {point: [0, 0, -2], normal: [0, 0, 1]}}]\n";
  const Image image = view(yaml, "depth").image;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const double R = 6 * std::hypot(centre(x, n), centre(y, n), 1.0);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(1 / (1 + R / 4), image.pixel(x, y)[c], 1e-6);
    }
}

TEST(View, UvOfASquareRepeats) {
  const std::string square =
      "objects: [{mesh: {vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], "
      "uvs: [[-1, 0], [1, 0], [1, 3], [-1, 3]], triangles: [[0, 1, 2], [0, 2, 3]]}}]\n";
  const int n = 8;
  const Image image = view(flat(n) + square, "uv").image;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const double u = centre(x, n), v = 3 * (1 - centre(y, n)) / 2;
      EXPECT_NEAR(u - std::floor(u), image.pixel(x, y)[0], 1e-6);
      EXPECT_NEAR(v - std::floor(v), image.pixel(x, y)[1], 1e-6);
      EXPECT_EQ(0, image.pixel(x, y)[2]);
    }
}

TEST(View, CosineOfAPointLightAboveAPlane) {
  const int n = 15;
  const std::string yaml = flat(n) +
                           "lights: [{name: side, directional: {direction: [1, 0, -1]}},\n"
                           "  {name: key, point: {position: [0.3, -0.2, 0.7], max_distance: 0.1}}]\n"
                           "objects: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}}]\n";
  const Image image = view(yaml, "cosine, light: key").image;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const double r = std::hypot(0.3 - centre(x, n), -0.2 + centre(y, n), 0.7);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(0.7 / r, image.pixel(x, y)[c], 1e-6);
    }
  EXPECT_FLOAT_EQ(float(std::sqrt(0.5)), view(yaml, "cosine, light: side").image.pixel(3, 4)[0]);
}

TEST(View, CosineIsZeroBehindAndTakesTheOnlyLight) {
  const std::string behind = flat(2) +
                             "lights: [{point: {position: [0, 0, -1]}}]\n"
                             "objects: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}}]\n";
  EXPECT_EQ(black, at(view(behind, "cosine").image, 0, 0));
}

TEST(View, ObjectsMaterialsAndPrimitivesHaveColoursOfTheirOwn) {
  // Four squares of two triangles: two objects of one material, then one of another, which is shown twice.
  std::string yaml = flat(16) + "materials: [{name: a}, {name: b}]\nobjects:\n";
  for (int i = 0; i < 4; ++i)
    yaml += fmt::format(
        "  - {{mesh: {{vertices: [[-1, -1, 0], [0, -1, 0], [0, 0, 0], [-1, 0, 0]], triangles: [[0, 1, 2], "
        "[0, 2, 3]]}}, material: {}, transform: {{translate: [{}, {}, 0]}}}}\n",
        i < 2 ? "a" : "b", i % 2, i / 2);
  const auto colors = [&](const char* show) {
    const Image image = view(yaml, show).image;
    // By quarter of the picture: an object's colours.
    std::vector<std::set<Pixel3>> result(4);
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) result[std::size_t(2 * (y / 8) + x / 8)].insert(at(image, x, y));
    return result;
  };
  const auto all = [](const std::vector<std::set<Pixel3>>& quarters) {
    std::set<Pixel3> result;
    for (const auto& quarter : quarters) result.insert(quarter.begin(), quarter.end());
    return result.size();
  };
  const auto objects = colors("objects"), materials = colors("materials"), primitives = colors("primitives");
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(1u, objects[std::size_t(i)].size()) << "one colour all over an object";
    EXPECT_EQ(2u, primitives[std::size_t(i)].size()) << "a colour for each triangle";
  }
  EXPECT_EQ(4u, all(objects));
  EXPECT_EQ(8u, all(primitives));
  EXPECT_EQ(2u, all(materials));
  EXPECT_EQ(materials[0], materials[1]);
  EXPECT_EQ(materials[2], materials[3]);
}

TEST(View, ColoursOfNamesDifferAndAreNotDark) {
  std::set<std::tuple<double, double, double>> seen;
  for (int i = 0; i < 20000; ++i) {
    const Rgb color = color_of_name(std::to_string(i));
    EXPECT_TRUE(seen.emplace(color[0], color[1], color[2]).second) << i;
    const double greatest = std::max({color[0], color[1], color[2]});
    EXPECT_GE(greatest, 0.4) << i;
    EXPECT_LE(greatest, 1) << i;
    EXPECT_GE(std::min({color[0], color[1], color[2]}), 0) << i;
  }
}

TEST(View, APixelIsTheMeanOfItsSamples) {
  // The lower half of the one pixel: half of its 16 samples meet it, the others are black.
  const std::string lower =
      "objects: [{polygon: {vertices: [[-2, -2, 0], [2, -2, 0], [2, 0, 0], [-2, 0, 0]]}}]\n";
  EXPECT_EQ(Pixel3(0.25f, 0.25f, 0.5f), at(view(flat(1, 16) + lower, "normals").image, 0, 0));
}

TEST(View, CornersAreTheMeanOfFour) {
  const std::string plane =
      "image: {size: [1, 1], pattern: corners}\nobjects: [{plane: {point: [0, 0, -2], normal: [0, 0, 1]}}]\n";
  const Image image =
      view("lambent: 1\ncamera: {eye: [0, 0, 4], target: [0, 0, 0], fov: 90}\n" + plane, "depth").image;
  EXPECT_NEAR(1 / (1 + 6 * std::sqrt(3.0) / 4), image.data[0], 1e-6);
}

TEST(View, OfAdaptiveSamplesItTakesThoseToStartWith) {
  const std::string half =
      "objects: [{polygon: {vertices: [[-2, -2, 0], [2, -2, 0], [2, 0, 0], [-2, 0, 0]]}}]\n";
  for (const char* show : {"normals", "rays"}) {
    const RenderResult result = view(flat(5) + half, std::string(show));
    const RenderResult adaptive =
        render(parse_scene(flat(5) + half, "scene",
                           {Set{{"integrator.view.show", show},
                                {"image.samples", "{adaptive: {start: 4, max: 64, error: 0}}"}}}));
    EXPECT_EQ(4 * result.stats.rays.eye, adaptive.stats.rays.eye) << "everywhere, at the edge too";
  }
}

// ---- rays

TEST(View, RaysAreThoseOfTheEyeAndToTheLightsThatShineOnTheFront) {
  // The left half is a plane under two lights, one of them behind it: two rays for each sample. On the right
  // there is nothing: one.
  const std::string yaml =
      flat(4, 3) +
      "lights: [{point: {position: [0, 0, 9]}}, {point: {position: [0, 0, -9]}}]\n"
      "objects: [{polygon: {vertices: [[-1, -1, 0], [0, -1, 0], [0, 1, 0], [-1, 1, 0]]}}]\n";
  const RenderResult result = view(yaml, "rays");
  EXPECT_EQ("6", said_in(result.metadata, "lambent:most_rays"));
  const Rgb few = color_of_ray_count(3, 6);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      EXPECT_EQ(x < 2 ? Pixel3(1, 1, 1) : Pixel3(float(few[0]), float(few[1]), float(few[2])),
                at(result.image, x, y));
  EXPECT_EQ(48u, result.stats.rays.eye);
  EXPECT_EQ(24u, result.stats.rays.shadow);
  EXPECT_EQ("3", said_in(view(yaml, "rays, shadows: false").metadata, "lambent:most_rays"));
  EXPECT_EQ("", said_in(view(yaml, "depth").metadata, "lambent:most_rays"));
}

TEST(View, RaysBetweenTwoMirrorsAreAsManyAsTheDepthAllows) {
  const std::string yaml = flat(1) +
                           "materials: [{name: mirror, diffuse: 0, reflect: 1}]\n"
                           "objects: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: mirror},\n"
                           "  {plane: {point: [0, 0, 6], normal: [0, 0, 1]}, material: mirror}]\n";
  for (int depth : {1, 2, 7})
    EXPECT_EQ(std::to_string(depth),
              said_in(view(yaml, fmt::format("rays, max_depth: {}", depth)).metadata, "lambent:most_rays"));
}

TEST(View, AllRaysAreThoseOfThePicture) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const std::string yaml = random_scene(seed, 20, 14, "4");
    const RenderResult picture = render(parse_scene(yaml));
    const RenderResult counted = render(parse_scene(yaml, "scene", {Set{{"integrator.view.show", "rays"}}}));
    EXPECT_EQ(picture.stats.rays.eye, counted.stats.rays.eye);
    EXPECT_EQ(picture.stats.rays.reflection, counted.stats.rays.reflection) << seed;
    EXPECT_EQ(picture.stats.rays.refraction, counted.stats.rays.refraction) << seed;
    EXPECT_EQ(picture.stats.rays.shadow, counted.stats.rays.shadow) << seed;
  }
}

TEST(View, MoreRaysAreBrighter) {
  double before = -1;
  for (std::uint64_t rays = 1; rays <= 1000; ++rays) {
    const Rgb color = color_of_ray_count(rays, 1000);
    const double luminance = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
    EXPECT_GT(luminance, before) << rays;
    before = luminance;
  }
  EXPECT_EQ(color_of_ray_count(1000, 1000), grey(1.0));
}

// ---- the same bits

TEST(View, IsTheSameForThreadsTilesAndInstructionSets) {
  const std::string views[] = {"normals", "depth",     "uv",   "primitives",
                               "objects", "materials", "rays", "cosine, light: \"l 0\""};
  for (const std::string& show : views) {
    const std::string yaml = random_scene(12, 40, 30, "4");
    const auto with_name = [&](const RenderOptions& options) {
      return render(
                 parse_scene(yaml, "scene",
                             {Set{{"lights.0.name", "l 0"}, {"integrator", "{view: {show: " + show + "}}"}}}),
                 options)
          .image;
    };
    const Image first = with_name({});
    for (const std::string& isa : available_isas())
      for (const auto& [threads, tile] : {std::pair{1, 7}, {3, 32}, {2, 1}}) {
        const Image other = with_name({threads, tile, isa, {}});
        EXPECT_EQ(0, std::memcmp(first.data.data(), other.data.data(), first.data.size() * sizeof(float)))
            << show << ", " << isa << ", " << threads << " threads, tiles of " << tile;
      }
  }
}

// ---- what scenes may say

const std::string two_lights =
    head +
    "lights: [{name: key, point: {position: [0, 1, 0]}}, {name: fill, point: {position: [1, 1, 0]}}]\n";

TEST(ViewMessages, NameTheNearestRemedy) {
  EXPECT_EQ(report(head + "integrator: {view: {show: normls}}\n"),
            R"(scene.yaml:3:27: error: 'show' is 'normls', which is not known here
    integrator: {view: {show: normls}}
                              ^
    hint: did you mean 'normals'?
)");
  EXPECT_EQ(report(two_lights + "integrator: {view: {show: cosine, light: kye}}\n"),
            R"(scene.yaml:4:42: error: there is no light 'kye'
    integrator: {view: {show: cosine, light: kye}}
                                             ^
    hint: did you mean 'key'?
)");
  EXPECT_EQ(report(two_lights + "integrator: {view: {show: cosine}}\n"),
            R"(scene.yaml:4:27: error: the view 'cosine' needs 'light': it shows N.L of one light
    integrator: {view: {show: cosine}}
                              ^
    hint: integrator: {view: {show: cosine, light: NAME}}, with NAME one of: key, fill
)");
  EXPECT_EQ(report(head + "integrator: {view: {show: cosine}}\n"),
            R"(scene.yaml:3:27: error: the view 'cosine' needs 'light': it shows N.L of one light
    integrator: {view: {show: cosine}}
                              ^
    hint: the scene has no lights
)");
  EXPECT_EQ(report(head + "integrator: {whitted: {}, view: {show: uv}}\n"),
            R"(scene.yaml:3:27: error: 'view' stands beside 'whitted'
    integrator: {whitted: {}, view: {show: uv}}
                              ^
    hint: a picture is made by one of them; 'lambent render --integrator' and '--view' show any scene by others
)");
  EXPECT_EQ(report(head + "film: {layers: true}\nintegrator: {view: {show: uv}}\n"),
            R"(scene.yaml:3:16: error: a view has no layers
    film: {layers: true}
                   ^
    hint: layers are what the colours of 'whitted' are made of; leave out one of the two
)");
  EXPECT_EQ(errors_of(head + "integrator: {view: {}}\n").at(0).message, "the integrator view needs 'show'");
}

TEST(ViewSettings, FromOutsideTakeThePlaceOfTheFilesIntegrator) {
  const auto read = [](const std::string& integrator, const Set& set) {
    return parse_scene(head + "integrator: " + integrator + "\n", "s", {set});
  };
  const std::string whitted = "{whitted: {max_depth: 9}}", uv = "{view: {show: uv, max_depth: 9}}";
  ScenePtr scene = read(whitted, {{"integrator.view.show", "depth"}});
  ASSERT_EQ(scene->integrator, Integrator::view);
  EXPECT_EQ(scene->view.show, View::depth);
  EXPECT_EQ(scene->whitted.max_depth, 9) << "the rays that would be counted are the file's";
  scene = read(uv, {{"integrator.whitted.shadows", "false"}});
  EXPECT_EQ(scene->integrator, Integrator::whitted);
  EXPECT_FALSE(scene->whitted.shadows);
  scene = read(uv, {{"integrator.view.show", "depth"}, {"integrator.whitted.max_depth", "3"}});
  ASSERT_EQ(scene->integrator, Integrator::view);
  EXPECT_EQ(scene->view.show, View::depth);
  scene = read(whitted, {{"integrator", uv}});
  ASSERT_EQ(scene->integrator, Integrator::view);
  EXPECT_EQ(scene->view.show, View::uv);
  EXPECT_EQ(errors_of(head, {{{"integrator", "{whitted: {}, view: {show: uv}}"}}}).size(), 1u);
}

TEST(ViewSettings, AreInTheMetadataAndMakeTheSamePicture) {
  const RenderResult result =
      render(parse_scene(two_lights + "integrator: {view: {show: cosine, light: fill, max_depth: 3}}\n"));
  EXPECT_NE(said_in(result.metadata, "lambent:settings")
                .find("integrator: {view: {show: cosine, light: \"fill\", max_depth: 3, shadows: true"),
            std::string::npos)
      << said_in(result.metadata, "lambent:settings");
  EXPECT_EQ(report("lambent: 1\n" + said_in(result.metadata, "lambent:settings")), "");
}

TEST(ViewSettings, LeaveTheExplanationOfThePixelAsItIs) {
  const std::string yaml = random_scene(4, 12, 9, "{adaptive: {start: 4, max: 16, error: 1}}");
  const DerivationPtr plain = explain(parse_scene(yaml), 6, 5);
  const DerivationPtr viewed =
      explain(parse_scene(yaml, "scene", {Set{{"integrator.view.show", "normals"}}}), 6, 5);
  EXPECT_TRUE(adds_up(viewed));
  EXPECT_EQ(pixel_of(plain), pixel_of(viewed));
  EXPECT_EQ(explanation(plain), explanation(viewed));
}

}  // namespace
}  // namespace lambent::test
