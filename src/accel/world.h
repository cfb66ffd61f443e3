#pragma once
// The world: a scene laid out for ray queries. Primitives of all objects, placed, in trees of boxes.
//
// Triangles and analytic shapes stand in the same trees. A shape that one object shows stands in the world's
// own tree, its coordinates taken into the world; a shape that several objects show has a tree of its own,
// and the objects are instances of it: one level, never deeper.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "scene/standing_lights.h"

namespace lambent {

enum class PrimitiveKind : std::int32_t { triangle, sphere, cone, disc, plane, instance };

/// A cone's side, as the queries want it.
struct PlacedCone {
  Vec3<double> base;  ///< Centre of the end z = 0.
  Vec3<double> axis;  ///< Unit vector along which z grows.
  double height;      ///< z of the other end.
  double radius;      ///< At z = 0.
  double slope;       ///< Growth of the radius with z.
};

/// Primitives of one kind in one space: the world's, or that of a shape with a tree of its own.
struct Geometry {
  PrimitiveKind kind;
  bool flipped = false;       ///< Triangles: the placing mirrored them, the counter-clockwise side is inside.
  bool one_material = false;  ///< All primitives that one object shows are of the same material.
  std::uint32_t count = 0;
  std::uint32_t object = 0;  ///< Baked geometry: the object that shows it. Otherwise the instance says.
  const Vec3<float>* vertices = nullptr;
  const std::array<std::uint32_t, 3>* triangles = nullptr;
  const Vec3<float>* normals = nullptr;  ///< Null, or one for each vertex.
  const Vec2<float>* uvs = nullptr;      ///< Likewise; and these:
  const Vec2<float>* uvs2 = nullptr;
  const std::array<float, 4>* colors = nullptr;
  const std::array<float, 4>* tangents = nullptr;
  const Sphere* spheres = nullptr;
  const PlacedCone* cones = nullptr;
  const Disc* discs = nullptr;                           ///< Unit normals.
  const Plane* planes = nullptr;                         ///< Unit normals.
  const std::uint32_t* material_of_primitive = nullptr;  ///< Null: all the first of the object's materials.
  const std::uint32_t* object_of_primitive = nullptr;    ///< Null: all `object`'s. Otherwise
  const std::uint32_t* scene_material = nullptr;         ///< each one's material is here.
};

struct PrimitiveRef {
  std::int32_t geometry;   ///< Index into World::geometries; instance_geometry for an instance.
  std::int32_t primitive;  ///< Index into that geometry, or into World::instances.
};
inline constexpr std::int32_t instance_geometry = -1;

/// What a leaf holds. Leaves of one kind are asked without looking at each primitive's kind.
enum class LeafKind : std::uint8_t {
  triangles,  ///< Of one geometry.
  spheres,    ///< Of any; LeafSphere has what the queries want.
  mixed,      ///< Anything, instances too.
};

/// A child of a node: another node, or a leaf.
struct BvhChild {
  std::uint32_t first = 0;  ///< Of a node: its index in World::nodes. Of a leaf: its first in World::refs.
  std::uint32_t count = 0;  ///< Primitives of a leaf; 0: a node.
  LeafKind kind = LeafKind::mixed;
};
inline constexpr int bvh_width = 4, max_tree_depth = 48;

/// Up to four boxes side by side. Where there are fewer children the other boxes are turned inside out.
struct alignas(64) BvhNode {
  float plane[6][bvh_width];  ///< Lower x, y, z of each child, then upper x, y, z.
  std::uint32_t first[bvh_width];
  std::uint16_t count[bvh_width];
  LeafKind kind[bvh_width];
  std::uint32_t children;
};
static_assert(sizeof(BvhNode) == 128);

/// A sphere as the queries want it, beside its PrimitiveRef.
struct LeafSphere {
  float x, y, z, radius;
};

/// One tree. `extent` is the largest absolute coordinate in it.
struct Bvh {
  std::uint32_t root;
  float extent;
  bool empty;
  Vec3<float> lower, upper;
};

/// A shape's tree, placed by an object.
struct Instance {
  Transform world_from_object, object_from_world;
  std::uint32_t bvh;      ///< Index into World::bvhs.
  std::uint32_t object;   ///< Index into World::objects.
  std::int32_t geometry;  ///< What its tree holds.
};

struct ObjectRecord {
  const std::uint32_t* materials;  ///< Indices into the scene's materials.
};

/// What the kernels read: plain pointers into a World.
struct WorldView {
  const Bvh* bvhs;  ///< The first is the world's own.
  const BvhNode* nodes;
  const PrimitiveRef* refs;
  const LeafSphere* leaf_spheres;  ///< For each of refs, where there are spheres in trees; otherwise null.
  const Geometry* geometries;
  const Instance* instances;
  const ObjectRecord* objects;
  const PrimitiveRef* planes;  ///< Infinite planes: they have no box, and are asked apart.
  std::uint32_t plane_count;
  const bool* material_transmits;  ///< For each material of the scene and of standing lights.
};

/// Owns what WorldView points at. Objects and materials are the scene's, then those of its lights that stand
/// in the world (standing_lights). It refers to the scene's arrays where it can, so the scene must outlive
/// it.
struct World {
  std::vector<Bvh> bvhs;
  std::vector<BvhNode> nodes;
  std::vector<PrimitiveRef> refs;
  std::vector<LeafSphere> leaf_spheres;
  std::vector<Geometry> geometries;
  std::vector<Instance> instances;
  std::vector<ObjectRecord> objects;
  std::vector<PrimitiveRef> planes;
  std::unique_ptr<bool[]> material_transmits;
  bool any_transmits = false;

  // What had to be made new: coordinates taken into the world, cones and discs in the queries' form.
  std::vector<std::unique_ptr<std::vector<Vec3<float>>>> placed_points;
  std::vector<std::unique_ptr<std::vector<std::array<float, 4>>>> placed_tangents;
  std::vector<std::unique_ptr<std::vector<Sphere>>> placed_spheres;
  std::vector<std::unique_ptr<std::vector<PlacedCone>>> placed_cones;
  std::vector<std::unique_ptr<std::vector<Disc>>> placed_discs;
  std::vector<std::unique_ptr<std::vector<Plane>>> placed_planes;
  std::vector<std::unique_ptr<std::vector<std::uint32_t>>> placed_numbers;
  std::vector<StandingLight> lights;           ///< Objects after the scene's own,
  std::vector<std::uint32_t> light_materials;  ///< each with its material.

  WorldView view() const;
};

/// How much work goes into the trees. The picture does not depend on it.
enum class TreeQuality {
  quick,     ///< Along a curve through space: built in a fraction of the time.
  thorough,  ///< By the surface area heuristic: faster to query.
};

/// `time`: of the shutter's; it matters where something moves.
World build_world(const Scene& scene, TreeQuality quality = TreeQuality::thorough, double time = 0);

}  // namespace lambent
