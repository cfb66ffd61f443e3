// How a frame is made ready: the trees' quality is chosen by the work, and changes no bit of the picture.

#include "integrators/prepare.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>

#include "integrators/kernels.h"
#include "lambent/lambent.h"
#include "tiles.h"

namespace lambent {
namespace {

/// A wavy sheet of 2 * side^2 triangles, some balls and a mirror.
std::string waves(int side) {
  std::string vertices, triangles;
  for (int y = 0; y <= side; ++y)
    for (int x = 0; x <= side; ++x)
      vertices +=
          fmt::format("[{}, {}, {}], ", 4.0 * x / side - 2, 0.1 * ((3 * x + 5 * y) % 7), 2 - 4.0 * y / side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const int a = y * (side + 1) + x, b = a + side + 1;
      triangles += fmt::format("[{}, {}, {}], [{}, {}, {}], ", a, a + 1, b + 1, a, b + 1, b);
    }
  std::string text = fmt::format(R"(
lambent: 1
camera: {{eye: [0, 3, 6], target: [0, 0, 0], fov: 40}}
image: {{size: [90, 60]}}
lights: [{{point: {{position: [3, 4, 4], intensity: 4}}}}]
materials:
  - {{name: sheet, diffuse: [0.8, 0.5, 0.1], specular: 0.5, reflect: 0.3}}
objects:
  - {{mesh: {{vertices: [{}], triangles: [{}]}}, material: sheet}}
  - {{cone: {{from: [0, 0, 0], to: [0, 2, 0], radius_from: 0.5, radius_to: 0}}, material: sheet}}
)",
                                 vertices, triangles);
  for (int i = 0; i < 30; ++i)
    text += fmt::format("  - {{sphere: {{center: [{}, 1, {}], radius: 0.1}}, material: sheet}}\n",
                        i % 6 - 2.5, i / 6 - 2.5);
  return text;
}

TEST(Prepare, ThePictureDoesNotDependOnTheQualityOfTheTrees) {
  const ScenePtr scene = parse_scene(waves(60));
  const auto prepared = prepare(*scene);
  std::vector<float> pictures[2];
  std::size_t nodes[2];
  for (const TreeQuality quality : {TreeQuality::quick, TreeQuality::thorough}) {
    prepared->world = build_world(*scene, quality);
    prepared->frame.world = prepared->world.view();
    Film film(scene->image);
    render_tiles(prepared->frame, choose_kernel(""), film, {});
    nodes[int(quality)] = prepared->world.nodes.size();
    pictures[int(quality)] = std::move(film.values);
  }
  EXPECT_NE(nodes[0], nodes[1]) << "these are the same trees";
  ASSERT_EQ(pictures[0].size(), pictures[1].size());
  EXPECT_EQ(std::memcmp(pictures[0].data(), pictures[1].data(), pictures[0].size() * sizeof(float)), 0);
}

TEST(Prepare, AFewSamplesGetQuickTreesAndManyThoroughOnes) {
  const auto quality = [](const char* samples) {
    const ScenePtr scene = parse_scene(waves(60), "scene", {{{"image.samples", samples}}});
    return prepare(*scene)->tree_quality;
  };
  EXPECT_EQ(quality("1"), TreeQuality::quick);  // 90 * 60 of them for 7231 primitives
  EXPECT_EQ(quality("16"), TreeQuality::thorough);
}

TEST(Prepare, StatsSayWhatTheFrameConsistsOf) {
  const Stats stats = render(parse_scene(waves(60))).stats;
  EXPECT_EQ(stats.scene.primitives, 60u * 60 * 2 + 30 + 1);
  EXPECT_EQ(stats.scene.trees, 1u);
  EXPECT_EQ(stats.scene.instances, 0u);
  EXPECT_EQ(stats.scene.lights, 1u);
  EXPECT_EQ(stats.bytes.vertices, 61u * 61 * 12);
  EXPECT_EQ(stats.bytes.normals, 0u);
  EXPECT_EQ(stats.bytes.indices, 60u * 60 * 2 * 12);
  EXPECT_EQ(stats.bytes.shapes, 30 * sizeof(Sphere) + sizeof(Cone));
  EXPECT_EQ(stats.bytes.nodes, stats.scene.nodes * sizeof(BvhNode));
  EXPECT_EQ(stats.bytes.refs, stats.scene.primitives * (sizeof(PrimitiveRef) + sizeof(LeafSphere)));
  EXPECT_EQ(stats.bytes.film, 90u * 60 * 3 * 4);
  EXPECT_EQ(stats.samples_per_pixel, 1);
  EXPECT_EQ(stats.tree_quality, "quick");
  EXPECT_GT(stats.peak_memory_bytes, stats.bytes.vertices + stats.bytes.indices + stats.bytes.nodes);
}

}  // namespace
}  // namespace lambent
