// Depth of field against the closed form of a thin lens: of diameter A, in focus at f, it shows a point at
// the depth d as a disc that is as large as one of diameter c = A |d - f| / f at that depth.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "lambent/explain.h"
#include "lambent/lambent.h"

namespace lambent {
namespace {

constexpr int n = 48;

/// A camera at the origin that looks along -z at the square from -0.5 to 0.5 at the depth d.
std::string camera(bool flat, double d, const std::string& lens, int samples) {
  constexpr double degrees = 57.29577951308232;
  return fmt::format(
      "lambent: 1\ncamera: {{projection: {}, eye: [0, 0, 0], target: [0, 0, {}], {}: {}{}}}\nimage: {{size: "
      "[{}, {}], samples: {}}}\n",
      flat ? "orthographic" : "perspective", -d, flat ? "height" : "fov",
      flat ? 1 : 2 * degrees * std::atan(0.5 / d), lens, n, n, samples);
}
std::string glowing(const std::string& shape) {
  return "objects:\n  - {" + shape + ", material: {ambient: 0, diffuse: 0, emission: 1}}\n";
}

/// Of a picture of that square: how far light lies from the middle.
struct Spread {
  double mean_square = 0, farthest = 0;
};
Spread spread_of(const Image& image) {
  Spread spread;
  double sum = 0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const double value = image.pixel(x, y)[0], X = (x + 0.5) / n - 0.5, Y = (y + 0.5) / n - 0.5;
      sum += value;
      spread.mean_square += value * (X * X + Y * Y);
      if (value > 0) spread.farthest = std::max(spread.farthest, std::hypot(X, Y));
    }
  spread.mean_square /= sum;
  return spread;
}

TEST(Lens, BlursAPointToACircleOfConfusion) {
  const double A = 0.6, s = 0.04, pixel = 1.0 / n;
  for (const bool flat : {false, true})
    for (const auto& [d, f] : {std::pair{4.0, 2.5}, {3.0, 5.0}, {5.0, 3.0}}) {
      const Image image =
          render(parse_scene(camera(flat, d, fmt::format(", aperture: {}, focus_distance: {}", A, f), 64) +
                             glowing(fmt::format("sphere: {{center: [0, 0, {}], radius: {}}}", -d, s))))
              .image;
      const double c = A * std::fabs(d - f) / f;
      // The mean square distance from the middle of an even disc of diameter c is c^2 / 8; that of the little
      // sphere adds to it, and that of a pixel, a square: 1/6 of its side's.
      const Spread seen = spread_of(image);
      EXPECT_NEAR(c * c / 8 + s * s / 2 + pixel * pixel / 6, seen.mean_square, 0.04 * c * c / 8)
          << d << " " << f;
      EXPECT_LE(seen.farthest, c / 2 + 1.1 * s + pixel);
      EXPECT_GE(seen.farthest, c / 2 - pixel);
    }
}

TEST(Lens, IsSharpInThePlaneInFocus) {
  for (const bool flat : {false, true}) {
    const std::string disc = glowing("disc: {center: [0.1, 0.05, -3], normal: [0, 0, 1], radius: 0.2}");
    const Image pinhole = render(parse_scene(camera(flat, 3, "", 16) + disc)).image;
    // Without `focus_distance` as far as the target.
    for (const char* lens : {", aperture: 0.8", ", aperture: 0.8, focus_distance: 3"}) {
      const Image through_lens = render(parse_scene(camera(flat, 3, lens, 16) + disc)).image;
      double difference = 0, sum = 0;
      for (std::size_t i = 0; i < pinhole.data.size(); ++i)
        difference += std::fabs(pinhole.data[i] - through_lens.data[i]), sum += pinhole.data[i];
      EXPECT_LT(difference, 1e-4 * sum) << lens;
    }
  }
}

TEST(Lens, OfNoDiameterIsAPinhole) {
  const std::string ball = glowing("sphere: {center: [0, 0, -3], radius: 0.3}");
  const Image plain = render(parse_scene(camera(false, 4, "", 4) + ball)).image;
  const Image closed =
      render(parse_scene(camera(false, 4, ", aperture: 0, focus_distance: 1", 4) + ball)).image;
  EXPECT_EQ(0, std::memcmp(plain.data.data(), closed.data.data(), plain.data.size() * sizeof(float)));
}

TEST(Lens, ItsPointsAreSpreadOverItAndDifferFromPixelToPixel) {
  using Json = nlohmann::json;
  const ScenePtr scene = parse_scene(camera(false, 4, ", aperture: 2, focus_distance: 8", 64) +
                                     glowing("sphere: {center: [0, 0, -4], radius: 0.3}"));
  const auto samples = [&](int x, int y) {
    const DerivationPtr derivation = explain(scene, x, y);
    EXPECT_TRUE(adds_up(derivation));
    return Json::parse(explanation(derivation, {ExplainFormat::json, {}, false}))["samples"];
  };
  const Json here = samples(20, 20), beside = samples(21, 20);
  double x = 0, y = 0, square = 0, in_pixel = 0;
  int alike = 0;
  for (std::size_t i = 0; i < 64; ++i) {
    const Json& at = here[i]["lens"]["at"];
    const double u = at[0], v = at[1];
    EXPECT_LE(std::hypot(u, v), 1 + 1e-12);
    x += u / 64, y += v / 64, square += (u * u + v * v) / 64;
    in_pixel += u * (here[i]["position"][0].get<double>() - 20.5) / 64;
    alike += std::fabs(u - beside[i]["lens"]["at"][0].get<double>()) < 0.02;
    // The ray starts there, and goes through the point in focus.
    EXPECT_NEAR(u, here[i]["ray"]["origin"][0].get<double>(), 1e-12);
    EXPECT_NEAR(-8, here[i]["lens"]["focus"][2].get<double>(), 1e-9);
  }
  EXPECT_NEAR(0, x, 0.03);
  EXPECT_NEAR(0, y, 0.03);
  EXPECT_NEAR(0.5, square, 0.02) << "the mean of r^2 over the unit disc";
  EXPECT_NEAR(0, in_pixel, 0.05) << "a covariance with the place in the pixel would show as a slant";
  EXPECT_LT(alike, 8);
}

TEST(Lens, GoesWithAdaptiveSamples) {
  const ScenePtr scene = parse_scene(camera(false, 4, ", aperture: 0.5, focus_distance: 3", 4) +
                                         glowing("sphere: {center: [0, 0, -4], radius: 0.2}"),
                                     "scene", {{{"image.samples", "{adaptive: {start: 4, max: 64}}"}}});
  const Image image = render(scene).image;
  for (const auto& [px, py] : {std::pair{24, 24}, {30, 24}, {16, 20}}) {
    const DerivationPtr derivation = explain(scene, px, py);
    EXPECT_TRUE(adds_up(derivation));
    EXPECT_EQ(image.pixel(px, py)[0], pixel_of(derivation)[0]);
  }
}

TEST(Lens, TellsAndWarns) {
  const ScenePtr scene = parse_scene(camera(false, 4, ", aperture: 0.5", 4));
  EXPECT_NE(std::string::npos, summarize(scene).camera.find("aperture 0.5, in focus 4 away"));
  const ScenePtr useless = parse_scene(camera(false, 4, ", focus_distance: 3", 4));
  ASSERT_EQ(1u, warnings(useless).size());
  EXPECT_EQ("'focus_distance' has no effect: the camera is a pinhole", warnings(useless)[0].message);
}

}  // namespace
}  // namespace lambent
