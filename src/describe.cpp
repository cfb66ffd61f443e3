#include "describe.h"

namespace lambent {
namespace {

template <class T> std::uint64_t bytes_of(const std::vector<T>& list) { return list.size() * sizeof(T); }
template <class T> std::uint64_t bytes_of(const std::vector<std::unique_ptr<std::vector<T>>>& lists) {
  std::uint64_t sum = 0;
  for (const auto& list : lists) sum += bytes_of(*list);
  return sum;
}

}  // namespace

void describe(const Scene& scene, const PreparedFrame& prepared, Stats& stats) {
  const World& world = prepared.world;
  for (const Geometry& geometry : world.geometries) stats.scene.primitives += geometry.count;
  stats.scene.instances = world.instances.size();
  for (const Bvh& bvh : world.bvhs) stats.scene.trees += !bvh.empty;
  stats.scene.nodes = world.nodes.size();
  stats.scene.lights = scene.lights.size();
  stats.tree_quality = prepared.tree_quality == TreeQuality::quick ? "quick" : "thorough";

  auto& bytes = stats.bytes;
  for (const Shape& shape : scene.shapes) {
    if (const auto* mesh = std::get_if<Mesh>(&shape.primitives)) {
      bytes.vertices += bytes_of(mesh->vertices);
      bytes.normals += bytes_of(mesh->normals);
      bytes.uvs +=
          bytes_of(mesh->uvs) + bytes_of(mesh->uvs2) + bytes_of(mesh->colors) + bytes_of(mesh->tangents);
      bytes.indices += bytes_of(mesh->triangles);
    } else {
      std::visit(
          [&](const auto& list) {
            if constexpr (requires { bytes_of(list); }) bytes.shapes += bytes_of(list);
          },
          shape.primitives);
    }
  }
  for (const Texture& texture : scene.textures)
    bytes.textures += bytes_of(texture.bytes) + bytes_of(texture.floats);
  bytes.placed = bytes_of(world.placed_points) + bytes_of(world.placed_tangents) +
                 bytes_of(world.placed_spheres) + bytes_of(world.placed_cones) +
                 bytes_of(world.placed_discs) + bytes_of(world.placed_planes) +
                 bytes_of(world.placed_numbers);
  bytes.nodes = bytes_of(world.nodes);
  bytes.refs = bytes_of(world.refs) + bytes_of(world.leaf_spheres);
}

}  // namespace lambent
