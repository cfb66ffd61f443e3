// What guides a denoiser: the means of what samples met first, whatever way they were taken.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "lambent/lambent.h"

namespace lambent::test {
namespace {

const std::string scene_of_two =
    "camera: {eye: [0, 1, 5], target: [0, 0.5, 0], fov: 40}\n"
    "lights: [{point: {position: [3, 4, 4], intensity: 8}}]\n"
    "materials:\n"
    "  - {name: red, diffuse: [0.8, 0.1, 0.1]}\n"
    "  - {name: grey, diffuse: 0.4}\n"
    "objects:\n"
    "  - {box: {min: [-0.5, 0, -0.5], max: [0.5, 1, 0.5]}, material: red, motion: {translate: [MOVE, 0, "
    "0]}}\n"
    "  - {disc: {center: [0, 0, 0], normal: [0, 1, 0], radius: 2}, material: grey}\n";
std::string with(const std::string& image, const std::string& integrator, bool moving = false) {
  std::string scene = scene_of_two;
  const std::size_t motion = scene.find(", motion");
  if (moving) scene.replace(scene.find("MOVE"), 4, "0.4");
  else scene.erase(motion, scene.find("}}\n", motion) + 1 - motion);
  return "lambent: 1\nimage: {size: [24, 18], " + image + "}\nintegrator: " + integrator + "\n" + scene;
}
std::size_t channel(const Image& image, const std::string& name) {
  return std::size_t(std::find(image.channels.begin(), image.channels.end(), name) - image.channels.begin());
}

/// The scenes that between them take samples in every way that there is.
const std::vector<std::string> every_way = {
    with("samples: 4", "{whitted: {}}"),
    with("pattern: corners", "{whitted: {}}"),
    with("samples: {adaptive: {start: 4, max: 16}}", "{whitted: {}}"),
    with("samples: 8, shutter_slices: 4", "{whitted: {}}", true),
    with("samples: 4", "{spectral: {wavelengths: 6}}"),
    with("samples: 4", "{ambient_occlusion: {rays: 4}}"),
    with("samples: 4", "{path: {max_depth: 3}}"),
    with("samples: 4", "{path: {max_depth: 3, progressive: true, max_samples: 16}}"),
    with("samples: 4, shutter_slices: 4", "{path: {max_depth: 3, progressive: true, max_samples: 16}}", true),
};

TEST(Guides, AreTheLayersAlbedoAndChangeNoPicture) {
  for (const std::string& yaml : every_way) {
    RenderOptions options;
    options.guides = true;
    const RenderResult guided = render(parse_scene(yaml), options),
                       layered = render(parse_scene(yaml, "scene", {{{"film.layers", "true"}}}));
    const Image plain = render(parse_scene(yaml)).image;
    ASSERT_EQ(plain.data.size(), guided.image.data.size());
    EXPECT_EQ(0, std::memcmp(plain.data.data(), guided.image.data.data(), plain.data.size() * sizeof(float)))
        << yaml;
    ASSERT_EQ(guided.guides.channels,
              (std::vector<std::string>{"albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z"}));
    for (int y = 0; y < plain.height; ++y)
      for (int x = 0; x < plain.width; ++x)
        for (std::size_t c = 0; c < 3; ++c)
          ASSERT_FLOAT_EQ(guided.guides.pixel(x, y)[c],
                          layered.image.pixel(x, y)[channel(layered.image, "albedo.R") + c])
              << yaml << x << "," << y;
  }
}

// At an edge the mean of unit normals is shorter than one, by Pythagoras for those of a box; the sample
// nearest the centre, which the layer N has, says nothing of that.
TEST(Guides, HaveTheMeanOfNormals) {
  RenderOptions options;
  options.guides = true;
  const RenderResult result = render(parse_scene(with("samples: 64", "{whitted: {}}")), options);
  int inside = 0, edges = 0, nothing = 0;
  for (int y = 0; y < result.guides.height; ++y)
    for (int x = 0; x < result.guides.width; ++x) {
      const float* n = result.guides.pixel(x, y) + 3;
      const double length = std::sqrt(double(n[0]) * n[0] + double(n[1]) * n[1] + double(n[2]) * n[2]);
      ASSERT_LE(length, 1 + 1e-6);
      (length > 1 - 1e-6 ? inside : length > 0 ? edges : nothing) += 1;
    }
  EXPECT_GT(inside, 50);
  EXPECT_GT(edges, 20);
  EXPECT_GT(nothing, 50);
}

TEST(Guides, AreNoneWhereNobodyAsks) { EXPECT_TRUE(render(parse_scene(every_way[0])).guides.data.empty()); }

TEST(Guides, OfAViewAreRefused) {
  RenderOptions options;
  options.guides = true;
  try {
    render(parse_scene(with("samples: 4", "{view: {show: normals}}")), options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics()[0].message, "a view has no noise that could be taken away");
  }
}

}  // namespace
}  // namespace lambent::test
