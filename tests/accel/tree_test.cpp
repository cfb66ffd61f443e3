// The trees themselves: whatever the builder, each primitive is in one leaf and inside all boxes on the way
// to it.

#include "accel/tree.h"

#include <gtest/gtest.h>

#include <random>

namespace lambent {
namespace {

/// A grid of `side` times `side` squares of two triangles, some of them very small.
Mesh bumpy_grid(std::uint32_t side) {
  std::mt19937 random(7);
  Mesh mesh;
  for (std::uint32_t y = 0; y <= side; ++y)
    for (std::uint32_t x = 0; x <= side; ++x)
      mesh.vertices.push_back({float(x * x), float(y), float(random() % 1000) / 500});
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t a = y * (side + 1) + x, b = a + side + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  return mesh;
}

void add_object(Scene& scene, Primitives primitives, int times = 1) {
  if (scene.materials.empty()) scene.materials.emplace_back();
  for (int i = 0; i < times; ++i)
    scene.objects.push_back({"", {}, std::uint32_t(scene.shapes.size()), {0}, translation({0, 0, 9.0 * i})});
  scene.shapes.push_back({"", std::move(primitives), {}});
}

struct Checked {
  const World& world;
  std::vector<int> found;  // of each of world.refs, in how many leaves it is
  int deepest = 0;

  void visit(std::uint32_t index, int depth) {
    deepest = std::max(deepest, depth);
    const BvhNode& node = world.nodes.at(index);
    ASSERT_GE(node.children, 1u);
    ASSERT_LE(node.children, std::uint32_t(bvh_width));
    for (std::uint32_t c = 0; c < node.children; ++c) {
      if (node.count[c] == 0) {
        const BvhNode& child = world.nodes.at(node.first[c]);
        for (std::uint32_t k = 0; k < child.children; ++k) {
          expect_inside(node, c, {child.plane[0][k], child.plane[1][k], child.plane[2][k]});
          expect_inside(node, c, {child.plane[3][k], child.plane[4][k], child.plane[5][k]});
        }
        visit(node.first[c], depth + 1);
      }
      for (std::uint32_t i = node.first[c]; i < node.first[c] + node.count[c]; ++i) {
        ++found.at(i);
        const PrimitiveRef& ref = world.refs.at(i);
        if (ref.geometry == instance_geometry) continue;
        const Geometry& g = world.geometries.at(std::size_t(ref.geometry));
        if (g.kind == PrimitiveKind::sphere) {
          const auto& s = g.spheres[ref.primitive];
          const float r = float(s.radius);
          expect_inside(node, c, cast<float>(s.center) + Vec3<float>{r, r, r});
          expect_inside(node, c, cast<float>(s.center) - Vec3<float>{r, r, r});
        } else {
          for (const std::uint32_t v : g.triangles[ref.primitive]) expect_inside(node, c, g.vertices[v]);
        }
      }
    }
    for (std::uint32_t c = node.children; c < bvh_width; ++c) ASSERT_GT(node.plane[0][c], node.plane[3][c]);
  }
  static void expect_inside(const BvhNode& node, std::uint32_t c, const Vec3<float>& p) {
    ASSERT_TRUE(node.plane[0][c] <= p.x && p.x <= node.plane[3][c] && node.plane[1][c] <= p.y &&
                p.y <= node.plane[4][c] && node.plane[2][c] <= p.z && p.z <= node.plane[5][c]);
  }
};

TEST(Tree, EveryPrimitiveIsInOneLeafAndInsideItsBoxes) {
  for (const TreeQuality quality : {TreeQuality::quick, TreeQuality::thorough})
    for (const std::uint32_t side : {1, 2, 3, 20, 150}) {
      Scene scene;
      add_object(scene, bumpy_grid(side));
      add_object(scene, std::vector<Sphere>{{{1, 2, 3}, 0.5}, {{1e6, 2, 3}, 0.25}});
      add_object(scene, bumpy_grid(side + 3), 3);  // instances, where they are large enough
      const World world = build_world(scene, quality);
      Checked checked{world, std::vector<int>(world.refs.size())};
      for (const Bvh& tree : world.bvhs) checked.visit(tree.root, 1);
      EXPECT_LE(checked.deepest, max_tree_depth);
      EXPECT_EQ(std::count(checked.found.begin(), checked.found.end(), 1), std::ptrdiff_t(world.refs.size()));

      // The refs are all different, and as many as there are primitives.
      std::size_t primitives = world.instances.size();
      for (const Geometry& g : world.geometries) primitives += g.count;
      std::vector<std::pair<int, int>> refs;
      for (const PrimitiveRef& ref : world.refs) refs.emplace_back(ref.geometry, ref.primitive);
      std::sort(refs.begin(), refs.end());
      EXPECT_EQ(std::unique(refs.begin(), refs.end()), refs.end());
      EXPECT_EQ(refs.size(), primitives);
    }
}

TEST(Tree, PagesThatAreGivenBackAreEmptyAndTheOthersAreNot) {
  constexpr std::size_t step = Pages<std::uint64_t>::step;
  Pages<std::uint64_t> pages(4 * step);
  for (std::size_t i = 0; i < 4 * step; ++i) pages.push_back(i + 1);
  pages.give_back(step, 2 * step);
  pages.give_back(3 * step + 1, 3 * step + 2);  // less than a page: stays
  for (std::size_t i = 0; i < 4 * step; ++i) ASSERT_EQ(pages[i], i / step == 1 ? 0 : i + 1);
}

}  // namespace
}  // namespace lambent
