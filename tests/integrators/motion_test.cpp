// Motion blur against closed forms: what a pixel sees of a moving thing is the share of the time for which it
// is there.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "lambent/explain.h"
#include "lambent/lambent.h"
#include "scene/scene.h"
#include "scenefile/errors.h"

namespace lambent {
namespace {

constexpr int n = 40;

// An orthographic camera looks along -z at the square from -1 to 1.
std::string head(int samples, const std::string& image = "") {
  return fmt::format(
      "lambent: 1\ncamera: {{projection: orthographic, eye: [0, 0, 5], target: [0, 0, 0], height: 2}}\n"
      "image: {{size: [{0}, {0}], samples: {1}{2}}}\n",
      n, samples, image);
}
std::string glowing(const std::string& shape, const std::string& motion) {
  return "objects:\n  - {name: it, " + shape + ", material: {ambient: 0, diffuse: 0, emission: 1}" +
         (motion.empty() ? "" : ", motion: " + motion) + "}\n";
}
/// What is wrong with a scene, and the remedy.
std::string only_error(const std::string& scene) {
  const auto errors = test::errors_of(scene);
  EXPECT_EQ(1u, errors.size());
  return errors.empty() ? "" : errors[0].message + " | " + errors[0].hint;
}
double centre(int pixel) { return (pixel + 0.5) * 2 / n - 1; }
bool same(const Image& a, const Image& b) {
  return a.data.size() == b.data.size() &&
         std::memcmp(a.data.data(), b.data.data(), a.data.size() * sizeof(float)) == 0;
}

TEST(Motion, OfABallCoversAPixelForAShareOfTheTime) {
  // A ball of radius r goes from x = -s/2 to s/2. At height y its chord is 2 w, w = sqrt(r^2 - y^2); at x it
  // is there while its centre lies within w of x: for the share of [x - w, x + w] that lies in [-s/2, s/2],
  // over s.
  const double r = 0.3, s = 1;
  const Image image =
      render(parse_scene(head(256, ", shutter_slices: 64") +
                         glowing("sphere: {center: [-0.5, 0, 0], radius: 0.3}", "{translate: [1, 0, 0]}")))
          .image;
  double worst = 0, sum = 0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const auto covered = [&](double X, double Y) {
        const double w = std::sqrt(std::max(r * r - Y * Y, 0.0));
        return w > 0 ? std::max(std::min(X + w, s / 2) - std::max(X - w, -s / 2), 0.0) / s : 0;
      };
      double expected = 0;  // the mean over the pixel
      constexpr int parts = 16;
      for (int j = 0; j < parts; ++j)
        for (int i = 0; i < parts; ++i)
          expected += covered(centre(x) + ((i + 0.5) / parts - 0.5) * 2 / n,
                              centre(y) + ((j + 0.5) / parts - 0.5) * 2 / n) /
                      (parts * parts);
      worst = std::max(worst, std::fabs(expected - image.pixel(x, y)[0]));
      sum += image.pixel(x, y)[0];
    }
  // One of 64 moments at each end of what is seen.
  EXPECT_LT(worst, 2.0 / 64);
  // The picture as a whole has the light of the ball: its area, whatever it does.
  EXPECT_NEAR(3.141592653589793 * r * r, sum * 4 / (n * n), 0.003);
}

TEST(Motion, OfAPropellerIsEvenAlongEachCircle) {
  // A blade from the centre to the right, 2 w wide, turns half around: at the distance R it covers the angle
  // 2 asin(w / R) of pi.
  const double w = 0.1;
  const Image image = render(parse_scene(head(256, ", shutter_slices: 256") +
                                         glowing("box: {min: [0, -0.1, -0.1], max: [2, 0.1, 0.1]}",
                                                 "{rotate: {axis: z, degrees: 180}}")))
                          .image;
  int looked_at = 0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const double X = centre(x), Y = -centre(y), R = std::hypot(X, Y);
      if (Y < 0.3 || R > 0.9 || std::fabs(X) > 2 * Y) continue;  // where the blade comes and goes
      EXPECT_NEAR(2 * std::asin(w / R) / 3.141592653589793, image.pixel(x, y)[0], 0.02);
      ++looked_at;
    }
  EXPECT_GT(looked_at, 200);
}

TEST(Motion, GoesOnInTheOrderWritten) {
  const ScenePtr scene = parse_scene(
      head(4) + glowing("sphere: {center: [0, 0, 0], radius: 0.1}",
                        "[{rotate: {axis: z, degrees: 90, center: [1, 0, 0]}}, {translate: [0, 0, 3]}]"));
  const Object& object = scene->objects[0];
  const auto at = [&](double time) { return transform_point(placed_at(object, time), {0, 0, 0}); };
  EXPECT_EQ((Vec3<double>{0, 0, 0}), at(0));
  const double half = std::sqrt(0.5);
  EXPECT_LT(max_abs(at(0.5) - Vec3<double>{1 - half, -half, 1.5}), 1e-12);
  EXPECT_LT(max_abs(at(1) - Vec3<double>{1, -1, 3}), 1e-12);
}

TEST(Motion, AlongTheViewShowsNothing) {
  const std::string ball = "sphere: {center: [0.1, 0.2, 0], radius: 0.4}";
  // The samples lie elsewhere in the pixels than those of still scenes, but are spread as well: both have the
  // ball's area.
  for (const char* motion :
       {"", "{translate: [0, 0, 0.5]}", "{rotate: {axis: z, degrees: 70, center: [0.1, 0.2, 0]}}"}) {
    const Image image = render(parse_scene(head(16) + glowing(ball, motion))).image;
    double sum = 0;
    for (const float value : image.data) sum += value;
    EXPECT_NEAR(3.141592653589793 * 0.4 * 0.4, sum / 3 * 4 / (n * n), 0.005) << motion;
  }
}

TEST(Motion, ReachesShadows) {
  // What blocks the light moves away half way through: half of the light arrives.
  const std::string scene =
      "illumination: {model: attenuated, ambient: 0, attenuation: none}\n"
      "lights: [{directional: {direction: [0, 0, -1]}}]\nobjects:\n"
      "  - {plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: {diffuse: 0.8}}\n"
      "  - {box: {min: [-1, -2, 9], max: [1, 2, 10]}, motion: {translate: [2, 0, 0]}}\n";
  const Image image = render(parse_scene(head(16) + scene)).image;
  EXPECT_NEAR(0.8 * 0.5, image.pixel(n / 2, n / 2)[0], 0.8 / 16);
}

TEST(Motion, HasLayersAndExplainsAndIsTheSameForAnyThreads) {
  const std::string scene =
      "background: 0.1\nfog: {density: 0.02}\n"
      "lights: [{name: key, point: {position: [2, 3, 4], intensity: 4}}]\n" +
      glowing("sphere: {center: [-0.3, 0, 0], radius: 0.4}", "{translate: [0.6, 0.2, 0]}") +
      "  - {sphere: {center: [0.4, -0.4, -0.5], radius: 0.4}, material: {reflect: 0.5}}\n"
      "  - {plane: {point: [0, 0, -2], normal: [0, 0, 1]}}\n";
  for (const auto& [samples, integrator] :
       {std::pair{1, "whitted"}, {6, "whitted"}, {20, "whitted"}, {6, "path"}}) {
    LoadOptions loading;
    loading.integrator = integrator;
    const ScenePtr plain = parse_scene(head(samples) + scene, "scene", loading);
    loading.set = {{"film.layers", "true"}};
    const ScenePtr layered = parse_scene(head(samples) + scene, "scene", loading);
    RenderOptions options;
    options.threads = 3;
    options.tile_size = 7;
    const Image image = render(plain).image, other = render(plain, options).image,
                with_layers = render(layered).image;
    EXPECT_TRUE(same(image, other));
    // The layers of colours stand first; behind them what the eye sees.
    std::size_t end = 0;
    while (with_layers.channels[end] != "Z") ++end;
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        for (int c = 0; c < 3; ++c) {
          EXPECT_EQ(image.pixel(x, y)[c], with_layers.pixel(x, y)[c]);
          double sum = 0;
          for (std::size_t i = 3; i < end; i += 3) sum += with_layers.pixel(x, y)[i + std::size_t(c)];
          EXPECT_EQ(double(image.pixel(x, y)[c]), sum);
        }
    for (const auto& [x, y] : {std::pair{8, 20}, {20, 20}, {27, 26}, {13, 18}}) {
      const DerivationPtr derivation = explain(plain, x, y);
      EXPECT_TRUE(adds_up(derivation));
      EXPECT_EQ(samples, sample_count(derivation));
      EXPECT_EQ(0, std::memcmp(image.pixel(x, y), pixel_of(derivation).data(), 3 * sizeof(float)));
      EXPECT_NE(std::string::npos, explanation(derivation).find("of the time that the shutter is open"));
    }
  }
}

TEST(Motion, OfAMeshThatManyShow) {
  // Instances, not copies: a mesh of more than 16 triangles that two objects show, one of which moves.
  std::string vertices, triangles;
  for (int i = 0; i < 20; ++i) {
    const double a = i * 2 * 3.141592653589793 / 20, b = (i + 1) * 2 * 3.141592653589793 / 20;
    vertices += fmt::format("{}[0, 0, 0], [{}, {}, 0], [{}, {}, 0]", i ? ", " : "", 0.2 * std::cos(a),
                            0.2 * std::sin(a), 0.2 * std::cos(b), 0.2 * std::sin(b));
    triangles += fmt::format("{}[{}, {}, {}]", i ? ", " : "", 3 * i, 3 * i + 1, 3 * i + 2);
  }
  ScenePtr once =
      parse_scene(head(16) + glowing("mesh: {vertices: [" + vertices + "], triangles: [" + triangles + "]}",
                                     "{translate: [0.5, 0, 0]}"));
  auto twice = std::make_shared<Scene>(*once);
  twice->objects.push_back(twice->objects[0]);
  twice->objects[1].world_from_object = translation({0, 0.6, 0});
  twice->objects[1].motion.clear();
  const Image one = render(once).image, two = render(twice).image;
  double difference = 0;
  for (int y = n / 2 - 4; y < n / 2 + 4; ++y)
    for (int x = 0; x < n; ++x)
      difference = std::max(difference, double(std::fabs(one.pixel(x, y)[0] - two.pixel(x, y)[0])));
  EXPECT_LT(difference, 1e-6);
  EXPECT_EQ(1, two.pixel(n / 2, n / 2 - 12)[0]) << "the other stands still, and whole";
}

TEST(Motion, SaysWhatDoesNotGoTogether) {
  const std::string moving = glowing("sphere: {center: [0, 0, 0], radius: 1}", "{translate: [1, 0, 0]}");
  const std::string start =
      "lambent: 1\ncamera: {projection: orthographic, eye: [0, 0, 5], target: [0, 0, 0]}\n";
  EXPECT_EQ(only_error(start + "image: {samples: {adaptive: {}}}\n" + moving),
            "adaptive samples do not see what moves | give a number of them for all pixels: samples: 64");
  EXPECT_EQ(only_error(start + "image: {pattern: corners}\n" + moving),
            "'pattern: corners' takes one sample of each corner, which sees nothing move | leave the pattern "
            "out, and give samples: 64");
  const auto warned = warnings(parse_scene(start + moving));
  ASSERT_EQ(1u, warned.size());
  EXPECT_EQ("nothing is blurred by its motion: each pixel has one sample", warned[0].message);
  EXPECT_EQ(only_error(start + glowing("sphere: {center: [0, 0, 0], radius: 1}", "{scale: 2}")),
            "unknown key 'scale' in a motion | known are: rotate, translate");
  EXPECT_EQ(only_error(start + glowing("sphere: {center: [0, 0, 0], radius: 1}", "{translate: [2e10, 0, 0]}"))
                .substr(0, 11),
            "number 1 of");
}

TEST(Motion, ViewsShowTheMiddleOfTheTime) {
  const std::string moving = glowing("sphere: {center: [-0.5, 0, 0], radius: 0.2}", "{translate: [1, 0, 0]}");
  const std::string at_rest = glowing("sphere: {center: [0, 0, 0], radius: 0.2}", "");
  const auto view = [](const std::string& scene) {
    return render(parse_scene(scene, "scene", {{{"integrator", "{view: {show: depth}}"}}})).image;
  };
  EXPECT_TRUE(same(view(head(4) + at_rest), view(head(4) + moving)));
}

}  // namespace
}  // namespace lambent
