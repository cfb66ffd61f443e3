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

#include "scene/scene.h"

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
  bool flipped = false;  ///< Triangles: the placing mirrored them, the counter-clockwise side is inside.
  std::uint32_t count = 0;
  std::uint32_t object = 0;  ///< Baked geometry: the object that shows it. Otherwise the instance says.
  const Vec3<float>* vertices = nullptr;
  const std::array<std::uint32_t, 3>* triangles = nullptr;
  const Vec3<float>* normals = nullptr;  ///< Null, or one for each vertex.
  const Sphere* spheres = nullptr;
  const PlacedCone* cones = nullptr;
  const Disc* discs = nullptr;                           ///< Unit normals.
  const Plane* planes = nullptr;                         ///< Unit normals.
  const std::uint32_t* material_of_primitive = nullptr;  ///< Null: all the first of the object's materials.
};

struct PrimitiveRef {
  std::int32_t geometry;   ///< Index into World::geometries; instance_geometry for an instance.
  std::int32_t primitive;  ///< Index into that geometry, or into World::instances.
};
inline constexpr std::int32_t instance_geometry = -1;

/// A box with two children (next to each other), or a leaf with some primitives.
struct BvhNode {
  Vec3<float> lower;
  std::uint32_t first;  ///< Of two children in World::nodes, or of `count` primitives in World::refs.
  Vec3<float> upper;
  std::uint32_t count;  ///< 0: an inner node.
};

/// One tree. `extent` is the largest absolute coordinate in it.
struct Bvh {
  std::uint32_t root;
  float extent;
  bool empty;
};

/// A shape's tree, placed by an object.
struct Instance {
  Transform world_from_object, object_from_world;
  std::uint32_t bvh;     ///< Index into World::bvhs.
  std::uint32_t object;  ///< Index into World::objects.
};

struct ObjectRecord {
  const std::uint32_t* materials;  ///< Indices into the scene's materials.
};

/// What the kernels read: plain pointers into a World.
struct WorldView {
  const Bvh* bvhs;  ///< The first is the world's own.
  const BvhNode* nodes;
  const PrimitiveRef* refs;
  const Geometry* geometries;
  const Instance* instances;
  const ObjectRecord* objects;
  const PrimitiveRef* planes;  ///< Infinite planes: they have no box, and are asked apart.
  std::uint32_t plane_count;
  const bool* material_transmits;  ///< For each material of the scene.
};

/// Owns what WorldView points at. It refers to the scene's arrays where it can, so the scene must outlive it.
struct World {
  std::vector<Bvh> bvhs;
  std::vector<BvhNode> nodes;
  std::vector<PrimitiveRef> refs;
  std::vector<Geometry> geometries;
  std::vector<Instance> instances;
  std::vector<ObjectRecord> objects;
  std::vector<PrimitiveRef> planes;
  std::unique_ptr<bool[]> material_transmits;
  bool any_transmits = false;

  // What had to be made new: coordinates taken into the world, cones and discs in the queries' form.
  std::vector<std::unique_ptr<std::vector<Vec3<float>>>> placed_points;
  std::vector<std::unique_ptr<std::vector<Sphere>>> placed_spheres;
  std::vector<std::unique_ptr<std::vector<PlacedCone>>> placed_cones;
  std::vector<std::unique_ptr<std::vector<Disc>>> placed_discs;
  std::vector<std::unique_ptr<std::vector<Plane>>> placed_planes;

  WorldView view() const;
};

World build_world(const Scene& scene);

}  // namespace lambent
