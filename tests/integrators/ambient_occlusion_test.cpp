// A alone against closed forms: the share of the sky, weighed by the cosine, that a place sees.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

#include "lambent/explain.h"
#include "lambent/lambent.h"

namespace lambent {
namespace {

// One pixel that sees the floor's point (x, 0, 0), from low beside it.
std::string seen_from_beside(double x, const std::string& objects, const std::string& settings = "rays: 16") {
  return fmt::format(
      "lambent: 1\ncamera: {{projection: orthographic, eye: [{0}, 0.1, 3], target: [{0}, 0, 0], height: "
      "1e-4}}\nimage: {{size: [1, 1]}}\nintegrator: {{ambient_occlusion: {{{1}}}}}\nobjects:\n"
      "  - {{plane: {{point: [0, 0, 0], normal: [0, 1, 0]}}}}\n{2}",
      x, settings, objects);
}
float openness(const std::string& yaml) {
  const Image image = render(parse_scene(yaml)).image;
  EXPECT_EQ(image.pixel(0, 0)[0], image.pixel(0, 0)[1]);
  EXPECT_EQ(image.pixel(0, 0)[0], image.pixel(0, 0)[2]);
  return image.pixel(0, 0)[0];
}

TEST(AmbientOcclusionIntegrator, UnderTheOpenSkyItIsWhite) {
  EXPECT_EQ(1.0f, openness(seen_from_beside(0, "")));
}

TEST(AmbientOcclusionIntegrator, UnderADisc) {
  // The form factor of a disc of radius r straight above, at height h: r^2 / (r^2 + h^2).
  for (const auto& [r, h] : {std::pair{1.0, 1.0}, {2.0, 1.0}, {1.0, 2.0}}) {
    const std::string disc =
        fmt::format("  - {{disc: {{center: [0, {}, 0], normal: [0, 1, 0], radius: {}}}}}\n", h, r);
    EXPECT_NEAR(1 - r * r / (r * r + h * h), openness(seen_from_beside(0, disc)), 0.005) << r << " " << h;
    EXPECT_EQ(1.0f, openness(seen_from_beside(0, disc, "rays: 16, distance: 0.9")))
        << "what is farther away than `distance` hides nothing";
  }
}

TEST(AmbientOcclusionIntegrator, BesideAWall) {
  // A wall of height h, as good as endless, x away. Of an endless strip only the angles across it count: what
  // lies between a and b from the normal has the share (sin b - sin a) / 2. The wall reaches from the
  // horizon, sin b = 1, up to sin a = x / sqrt(x^2 + h^2).
  for (const double x : {0.01, 0.5, 1.0, 3.0}) {
    const double h = 1;
    const std::string wall =
        fmt::format("  - {{plane: {{point: [0, {}, 0], normal: [1, 0, 0], size: [200, {}]}}}}\n", h / 2, h);
    EXPECT_NEAR((1 + x / std::sqrt(x * x + h * h)) / 2, openness(seen_from_beside(x, wall)), 0.005) << x;
  }
  // An endlessly high one, a corner of two planes: one half, wherever one stands.
  EXPECT_NEAR(0.5, openness(seen_from_beside(0.3, "  - {plane: {point: [0, 0, 0], normal: [1, 0, 0]}}\n")),
              0.005);
}

TEST(AmbientOcclusionIntegrator, ShapesAloneCount) {
  const std::string shapes =
      "  - {sphere: {center: [0.4, 0.5, -0.5], radius: 0.5}MATERIAL}\n  - {box: {min: [-1, 0, -1], max: "
      "[-0.2, "
      "0.7, -0.3]}MATERIAL}\n";
  const auto with_material = [&](const std::string& material) {
    std::string text = shapes;
    for (std::size_t at; (at = text.find("MATERIAL")) != std::string::npos;) text.replace(at, 8, material);
    return text;
  };
  const std::string head =
      "lambent: 1\ncamera: {eye: [0, 1, 3], target: [0, 0.4, 0]}\nimage: {size: [24, 16], samples: 4}\n"
      "integrator: {ambient_occlusion: {}}\n";
  const std::string floor = "objects:\n  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}}\n";
  const Image plain = render(parse_scene(head + floor + with_material(""))).image;
  const Image rich =
      render(parse_scene(head +
                         "background: [0.1, 0.2, 0.3]\nillumination: {model: conventional, ambient: 0.2}\n"
                         "lights: [{point: {position: [0, 3, 3], intensity: 5}}]\n" +
                         floor +
                         with_material(", material: {diffuse: [1, 0, 0], transmit: 0.5, reflect: 0.3, "
                                       "emission: 1, opacity: 0.5}")))
          .image;
  ASSERT_EQ(plain.data.size(), rich.data.size());
  EXPECT_EQ(0, std::memcmp(plain.data.data(), rich.data.data(), plain.data.size() * sizeof(float)));
  float least = 1, most = 0;
  for (const float value : plain.data) least = std::min(least, value), most = std::max(most, value);
  EXPECT_EQ(1.0f, most);
  EXPECT_LT(least, 0.6f) << "nothing hides anything";
}

TEST(AmbientOcclusionIntegrator, HasLayersAndExplains) {
  const ScenePtr scene =
      parse_scene(seen_from_beside(0, "  - {disc: {center: [0, 1, 0], normal: [0, 1, 0], radius: 1}}\n") +
                      "lights: [{name: key, point: {position: [0, 3, 3]}}]\n",
                  "scene", {{{"film.layers", "true"}, {"image.size", "[4, 4]"}, {"image.samples", "3"}}});
  const Image image = render(scene).image;
  for (const std::string& channel : image.channels) EXPECT_EQ(std::string::npos, channel.find("light"));
  for (int y = 0; y < 4; ++y) EXPECT_TRUE(adds_up(explain(scene, 1, y)));
  const std::string text = explanation(explain(scene, 1, 1));
  EXPECT_NE(std::string::npos, text.find("Ka A Ia")) << text;
}

TEST(AmbientOcclusionIntegrator, TakesManySamplesWhereNoneAreGiven) {
  const auto samples = [](const std::string& image) {
    return summarize(parse_scene("lambent: 1\ncamera: {eye: [0, 0, 5], target: [0, 0, 0]}\n" + image +
                                 "integrator: {ambient_occlusion: {}}\n"))
        .samples;
  };
  EXPECT_EQ(64, samples(""));
  EXPECT_EQ(3, samples("image: {samples: 3}\n"));
}

}  // namespace
}  // namespace lambent
