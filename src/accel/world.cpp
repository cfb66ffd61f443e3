#include "accel/world.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>

#include "accel/tree.h"

namespace lambent {
namespace {

float round_down(double a) {
  const float f = float(a);
  return double(f) > a ? std::nextafterf(f, -std::numeric_limits<float>::infinity()) : f;
}
float round_up(double a) { return -round_down(-a); }

BoxedPrimitive boxed(PrimitiveRef ref, const Bounds& b) {
  return {{round_down(b.lower.x), round_down(b.lower.y), round_down(b.lower.z)},
          ref.geometry,
          {round_up(b.upper.x), round_up(b.upper.y), round_up(b.upper.z)},
          ref.primitive};
}

/// The factor by which t scales all lengths, or 0 where it does not scale all alike.
double uniform_scale(const Transform& t) {
  const double xx = dot(t.x, t.x), yy = dot(t.y, t.y), zz = dot(t.z, t.z), tolerance = 1e-12 * xx;
  const bool similar = std::fabs(xx - yy) <= tolerance && std::fabs(xx - zz) <= tolerance &&
                       std::fabs(dot(t.x, t.y)) <= tolerance && std::fabs(dot(t.y, t.z)) <= tolerance &&
                       std::fabs(dot(t.x, t.z)) <= tolerance;
  return similar ? std::sqrt(xx) : 0;
}

PlacedCone placed(const Cone& c) {
  const Vec3<double> way = c.to - c.from;
  const double height = length(way);
  return {c.from, way / height, height, c.radius_from, (c.radius_to - c.radius_from) / height};
}

/// The same for a triangle, whose corners are floats already.
BoxedPrimitive boxed_triangle(PrimitiveRef ref, const Geometry& g) {
  const auto& [i, j, k] = g.triangles[ref.primitive];
  const Vec3<float>&a = g.vertices[i], &b = g.vertices[j], &c = g.vertices[k];
  return {{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})},
          ref.geometry,
          {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})},
          ref.primitive};
}

void add_circle(Bounds& b, const Vec3<double>& center, const Vec3<double>& axis, double radius) {
  // Of a circle across a unit axis, the extent along x is radius sqrt(1 - axis.x^2).
  const auto reach = [&](double a) { return radius * std::sqrt(std::fmax(0, 1 - a * a)); };
  const Vec3<double> r{reach(axis.x), reach(axis.y), reach(axis.z)};
  b.add(center - r);
  b.add(center + r);
}

/// Of a shape's primitive that is neither a triangle nor a plane.
Bounds bounds_of(const Geometry& g, std::uint32_t i) {
  Bounds b;
  switch (g.kind) {
    case PrimitiveKind::sphere: {
      const Sphere& s = g.spheres[i];
      const Vec3<double> r{s.radius, s.radius, s.radius};
      b.add(s.center - r);
      b.add(s.center + r);
      break;
    }
    case PrimitiveKind::cone: {
      const PlacedCone& c = g.cones[i];
      add_circle(b, c.base, c.axis, c.radius);
      add_circle(b, c.base + c.height * c.axis, c.axis, c.radius + c.slope * c.height);
      break;
    }
    case PrimitiveKind::disc:
      add_circle(b, g.discs[i].center, g.discs[i].normal, g.discs[i].radius);
      break;
    case PrimitiveKind::triangle:
    case PrimitiveKind::plane:
    case PrimitiveKind::instance:
      break;
  }
  return b;
}

template <class T> T* keep(std::vector<std::unique_ptr<std::vector<T>>>& store, std::vector<T> values) {
  store.push_back(std::make_unique<std::vector<T>>(std::move(values)));
  return store.back()->data();
}

class Builder {
 public:
  Builder(const Scene& scene, TreeQuality quality, double time)
      : scene_(scene), quality_(quality), time_(time) {}

  World build() {
    place_lights();
    world_.material_transmits = std::make_unique<bool[]>(scene_.materials.size() + world_.lights.size() + 1);
    for (std::size_t i = 0; i < scene_.materials.size(); ++i)
      world_.material_transmits[i] = may_transmit(scene_.materials[i]);
    // What vertices let through, their material does.
    for (const Object& object : scene_.objects)
      if (const Mesh* mesh = std::get_if<Mesh>(&scene_.shapes[object.shape].primitives))
        if (std::any_of(mesh->colors.begin(), mesh->colors.end(), [](const auto& c) { return c[3] < 1; }))
          for (std::uint32_t m : object.materials) world_.material_transmits[m] = true;

    std::vector<int> shown(scene_.shapes.size());
    for (const Object& object : scene_.objects) ++shown[object.shape];

    world_.bvhs.emplace_back();  // the world's own, built last
    std::vector<TreeOfShape> tree_of_shape(scene_.shapes.size());
    std::size_t at_top = 0;
    for (const Object& object : scene_.objects) {
      const Shape& shape = scene_.shapes[object.shape];
      at_top += can_bake(shape, placed_at(object, time_), shown[object.shape]) ? primitive_count(shape) : 1;
    }
    for (const StandingLight& light : world_.lights) at_top += primitive_count(light.shape);
    Pages<BoxedPrimitive> top(at_top);
    for (const Object& object : scene_.objects) {
      const auto index = std::uint32_t(world_.objects.size());
      world_.objects.push_back({object.materials.data()});
      for (std::uint32_t m : object.materials) world_.any_transmits |= world_.material_transmits[m];
      const Shape& shape = scene_.shapes[object.shape];
      if (primitive_count(shape) == 0) continue;
      const Transform placed = placed_at(object, time_);
      if (can_bake(shape, placed, shown[object.shape])) {
        bake(shape, placed, index, top);
      } else {
        TreeOfShape& tree = tree_of_shape[object.shape];
        if (tree.bvh < 0) {
          Pages<BoxedPrimitive> boxes(primitive_count(shape));
          tree.geometry = add_geometry(shape, {});
          add_boxes(tree.geometry, boxes);
          tree.bvh = std::int64_t(world_.bvhs.size());
          world_.bvhs.push_back(build_tree(std::move(boxes), quality_, world_));
        }
        add_instance(placed, index, tree, top);
      }
    }
    for (std::size_t i = 0; i < world_.lights.size(); ++i) {
      const auto index = std::uint32_t(world_.objects.size());
      world_.objects.push_back({&world_.light_materials[i]});
      bake(world_.lights[i].shape, {}, index, top);
    }
    close_joined(top);
    world_.bvhs[0] = build_tree(std::move(top), quality_, world_);
    lay_out_spheres();
    return std::move(world_);
  }

 private:
  // An instance costs every ray that comes near a change of space, a copy costs memory: small shapes are
  // copied.
  static bool can_bake(const Shape& shape, const Transform& t, int shown) {
    if (std::holds_alternative<std::vector<Plane>>(shape.primitives)) return true;
    const bool small = primitive_count(shape) <= 16;
    if (shown > 1 && !small) return false;
    return std::holds_alternative<Mesh>(shape.primitives) || uniform_scale(t) > 0;
  }

  void place_lights() {
    world_.lights = standing_lights(scene_);
    for (std::size_t i = 0; i < world_.lights.size(); ++i)
      world_.light_materials.push_back(std::uint32_t(scene_.materials.size() + i));
  }

  /// Takes an object's primitives into the world.
  void bake(const Shape& shape, const Transform& t, std::uint32_t object, Pages<BoxedPrimitive>& boxes) {
    if (joins_others(shape)) return join(shape, t, object);
    const std::int32_t geometry = add_geometry(shape, t);
    world_.geometries[std::size_t(geometry)].object = object;
    add_boxes(geometry, boxes);
  }

  /// Of a shape that is shown by instances.
  struct TreeOfShape {
    std::int64_t bvh = -1;
    std::int32_t geometry = -1;
  };

  // ---- shapes of few primitives, of which a scene may have thousands: one geometry for all of a kind

  template <class T> struct Joined {
    std::vector<T> primitives;
    std::vector<std::uint32_t> objects, materials;
  };

  static bool joins_others(const Shape& shape) {
    return !std::holds_alternative<Mesh>(shape.primitives) && primitive_count(shape) <= 16;
  }

  template <class T> Joined<T>& joined() { return std::get<Joined<T>>(joined_); }

  void join(const Shape& shape, const Transform& t, std::uint32_t object) {
    std::visit(
        [&](const auto& primitives) {
          using T = typename std::decay_t<decltype(primitives)>;
          if constexpr (!std::is_same_v<T, Mesh>) {
            auto placed = placed_in_world(primitives, t);
            auto& all = joined<typename decltype(placed)::value_type>();
            for (std::size_t i = 0; i < placed.size(); ++i) {
              all.primitives.push_back(placed[i]);
              all.objects.push_back(object);
              all.materials.push_back(
                  world_.objects[object]
                      .materials[shape.material_of_primitive.empty() ? 0 : shape.material_of_primitive[i]]);
            }
          }
        },
        shape.primitives);
  }

  void close_joined(Pages<BoxedPrimitive>& boxes) {
    std::apply([&](auto&... all) { (close(all, boxes), ...); }, joined_);
  }
  template <class T> void close(Joined<T>& all, Pages<BoxedPrimitive>& boxes) {
    if (all.primitives.empty()) return;
    Geometry g{};
    g.count = std::uint32_t(all.primitives.size());
    refer(g, std::move(all.primitives));
    g.one_material = std::ranges::adjacent_find(all.materials, std::not_equal_to{}) == all.materials.end();
    g.object_of_primitive = keep(world_.placed_numbers, std::move(all.objects));
    g.scene_material = keep(world_.placed_numbers, std::move(all.materials));
    world_.geometries.push_back(g);
    add_boxes(std::int32_t(world_.geometries.size()) - 1, boxes);
  }

  // ---- shapes with a geometry of their own

  std::int32_t add_geometry(const Shape& shape, const Transform& t) {
    Geometry g{};
    g.material_of_primitive =
        shape.material_of_primitive.empty() ? nullptr : shape.material_of_primitive.data();
    g.one_material = !g.material_of_primitive;
    g.count = std::uint32_t(primitive_count(shape));
    std::visit([&](const auto& primitives) { place(primitives, t, g); }, shape.primitives);
    world_.geometries.push_back(g);
    return std::int32_t(world_.geometries.size()) - 1;
  }

  void place(const Mesh& mesh, const Transform& t, Geometry& g) {
    g.kind = PrimitiveKind::triangle;
    g.triangles = mesh.triangles.data();
    g.flipped = determinant(t) < 0;
    g.vertices = mesh.vertices.data();
    g.normals = mesh.normals.empty() ? nullptr : mesh.normals.data();
    g.uvs = mesh.uvs.empty() ? nullptr : mesh.uvs.data();
    g.uvs2 = mesh.uvs2.empty() ? nullptr : mesh.uvs2.data();
    g.colors = mesh.colors.empty() ? nullptr : mesh.colors.data();
    g.tangents = mesh.tangents.empty() ? nullptr : mesh.tangents.data();
    if (is_identity(t)) return;
    if (g.tangents) {
      std::vector<std::array<float, 4>> tangents;
      tangents.reserve(mesh.tangents.size());
      for (const auto& [x, y, z, side] : mesh.tangents) {
        const Vec3<double> turned = transform_vector(t, {x, y, z});
        const double size = length(turned);
        const Vec3<float> unit = size > 0 ? cast<float>(turned / size) : Vec3<float>{};
        tangents.push_back({unit.x, unit.y, unit.z, g.flipped ? -side : side});
      }
      g.tangents = keep(world_.placed_tangents, std::move(tangents));
    }
    std::vector<Vec3<float>> points;
    points.reserve(mesh.vertices.size());
    for (const auto& v : mesh.vertices) points.push_back(cast<float>(transform_point(t, cast<double>(v))));
    g.vertices = keep(world_.placed_points, std::move(points));
    if (mesh.normals.empty()) return;
    const Transform inverse_t = inverse(t);
    std::vector<Vec3<float>> normals;
    normals.reserve(mesh.normals.size());
    for (const auto& n : mesh.normals) {
      const Vec3<double> turned = transform_normal(inverse_t, cast<double>(n));
      const double size = length(turned);
      normals.push_back(size > 0 ? cast<float>(turned / size) : Vec3<float>{});
    }
    g.normals = keep(world_.placed_points, std::move(normals));
  }
  void place(const std::vector<Sphere>& spheres, const Transform& t, Geometry& g) {
    if (is_identity(t)) {
      g.kind = PrimitiveKind::sphere;
      g.spheres = spheres.data();
    } else {
      refer(g, placed_in_world(spheres, t));
    }
  }
  template <class T> void place(const std::vector<T>& primitives, const Transform& t, Geometry& g) {
    refer(g, placed_in_world(primitives, t));
  }

  static std::vector<Sphere> placed_in_world(const std::vector<Sphere>& spheres, const Transform& t) {
    const double scale = uniform_scale(t);
    std::vector<Sphere> result;
    result.reserve(spheres.size());
    for (const Sphere& s : spheres) result.push_back({transform_point(t, s.center), scale * s.radius});
    return result;
  }
  static std::vector<PlacedCone> placed_in_world(const std::vector<Cone>& cones, const Transform& t) {
    const double scale = uniform_scale(t);
    std::vector<PlacedCone> result;
    result.reserve(cones.size());
    for (const Cone& c : cones)
      result.push_back(placed({transform_point(t, c.from), transform_point(t, c.to), scale * c.radius_from,
                               scale * c.radius_to}));
    return result;
  }
  static std::vector<Disc> placed_in_world(const std::vector<Disc>& discs, const Transform& t) {
    const double scale = uniform_scale(t);
    const Transform inverse_t = inverse(t);
    std::vector<Disc> result;
    result.reserve(discs.size());
    for (const Disc& d : discs)
      result.push_back(
          {transform_point(t, d.center), normalize(transform_normal(inverse_t, d.normal)), scale * d.radius});
    return result;
  }
  static std::vector<Plane> placed_in_world(const std::vector<Plane>& planes, const Transform& t) {
    const Transform inverse_t = inverse(t);
    std::vector<Plane> result;
    result.reserve(planes.size());
    for (const Plane& p : planes)
      result.push_back({transform_point(t, p.point), normalize(transform_normal(inverse_t, p.normal))});
    return result;
  }

  void refer(Geometry& g, std::vector<Sphere> spheres) {
    g.kind = PrimitiveKind::sphere;
    g.spheres = keep(world_.placed_spheres, std::move(spheres));
  }
  void refer(Geometry& g, std::vector<PlacedCone> cones) {
    g.kind = PrimitiveKind::cone;
    g.cones = keep(world_.placed_cones, std::move(cones));
  }
  void refer(Geometry& g, std::vector<Disc> discs) {
    g.kind = PrimitiveKind::disc;
    g.discs = keep(world_.placed_discs, std::move(discs));
  }
  void refer(Geometry& g, std::vector<Plane> planes) {
    g.kind = PrimitiveKind::plane;
    g.planes = keep(world_.placed_planes, std::move(planes));
  }

  void add_boxes(std::int32_t geometry, Pages<BoxedPrimitive>& boxes) {
    const Geometry& g = world_.geometries[geometry];
    for (std::uint32_t i = 0; i < g.count; ++i) {
      const PrimitiveRef ref{geometry, std::int32_t(i)};
      if (g.kind == PrimitiveKind::plane) world_.planes.push_back(ref);
      else if (g.kind == PrimitiveKind::triangle) boxes.push_back(boxed_triangle(ref, g));
      else boxes.push_back(boxed(ref, bounds_of(g, i)));
    }
  }

  void add_instance(const Transform& placed, std::uint32_t index, const TreeOfShape& tree,
                    Pages<BoxedPrimitive>& boxes) {
    const Bvh& root = world_.bvhs[std::size_t(tree.bvh)];
    Bounds b;
    for (int corner = 0; corner < 8; ++corner)
      b.add(transform_point(placed, {double(corner & 1 ? root.upper.x : root.lower.x),
                                     double(corner & 2 ? root.upper.y : root.lower.y),
                                     double(corner & 4 ? root.upper.z : root.lower.z)}));
    boxes.push_back(boxed({instance_geometry, std::int32_t(world_.instances.size())}, b));
    world_.instances.push_back({placed, inverse(placed), std::uint32_t(tree.bvh), index, tree.geometry});
  }

  void lay_out_spheres() {
    const auto is_sphere = [&](const PrimitiveRef& ref) {
      return ref.geometry != instance_geometry &&
             world_.geometries[ref.geometry].kind == PrimitiveKind::sphere;
    };
    if (std::none_of(world_.refs.begin(), world_.refs.end(), is_sphere)) return;
    world_.leaf_spheres.resize(world_.refs.size());
    for (std::size_t i = 0; i < world_.refs.size(); ++i) {
      const PrimitiveRef& ref = world_.refs[i];
      if (!is_sphere(ref)) continue;
      const Sphere& s = world_.geometries[ref.geometry].spheres[ref.primitive];
      world_.leaf_spheres[i] = {float(s.center.x), float(s.center.y), float(s.center.z), float(s.radius)};
    }
  }

  const Scene& scene_;
  TreeQuality quality_;
  double time_;
  World world_;
  std::tuple<Joined<Sphere>, Joined<PlacedCone>, Joined<Disc>, Joined<Plane>> joined_;
};

}  // namespace

WorldView World::view() const {
  return {bvhs.data(),
          nodes.data(),
          refs.data(),
          leaf_spheres.empty() ? nullptr : leaf_spheres.data(),
          geometries.data(),
          instances.data(),
          objects.data(),
          planes.data(),
          std::uint32_t(planes.size()),
          material_transmits.get()};
}

World build_world(const Scene& scene, TreeQuality quality, double time) {
  return Builder(scene, quality, time).build();
}

}  // namespace lambent
