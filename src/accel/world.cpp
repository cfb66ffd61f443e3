#include "accel/world.h"

#include <cmath>
#include <limits>

#include "accel/tree.h"

namespace lambent {
namespace {

float round_down(double a) {
  const float f = float(a);
  return double(f) > a ? std::nextafterf(f, -std::numeric_limits<float>::infinity()) : f;
}
float round_up(double a) { return -round_down(-a); }

BoxedPrimitive boxed(PrimitiveRef ref, const Bounds& b) {
  return {ref,
          {round_down(b.lower.x), round_down(b.lower.y), round_down(b.lower.z)},
          {round_up(b.upper.x), round_up(b.upper.y), round_up(b.upper.z)}};
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

void add_circle(Bounds& b, const Vec3<double>& center, const Vec3<double>& axis, double radius) {
  // Of a circle across a unit axis, the extent along x is radius sqrt(1 - axis.x^2).
  const auto reach = [&](double a) { return radius * std::sqrt(std::fmax(0, 1 - a * a)); };
  const Vec3<double> r{reach(axis.x), reach(axis.y), reach(axis.z)};
  b.add(center - r);
  b.add(center + r);
}

Bounds bounds_of(const Geometry& g, std::uint32_t i) {
  Bounds b;
  switch (g.kind) {
    case PrimitiveKind::triangle:
      for (std::uint32_t v : g.triangles[i]) b.add(cast<double>(g.vertices[v]));
      break;
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
  explicit Builder(const Scene& scene) : scene_(scene) {}

  World build() {
    world_.material_transmits = std::make_unique<bool[]>(scene_.materials.size() + 1);
    for (std::size_t i = 0; i < scene_.materials.size(); ++i)
      world_.material_transmits[i] = !is_black(scene_.materials[i].transmit);

    std::vector<int> shown(scene_.shapes.size());
    for (const Object& object : scene_.objects) ++shown[object.shape];

    world_.bvhs.emplace_back();  // the world's own, built last
    std::vector<std::int64_t> bvh_of_shape(scene_.shapes.size(), -1);
    std::vector<BoxedPrimitive> top;
    for (const Object& object : scene_.objects) {
      const auto index = std::uint32_t(world_.objects.size());
      world_.objects.push_back({object.materials.data()});
      for (std::uint32_t m : object.materials) world_.any_transmits |= world_.material_transmits[m];
      const Shape& shape = scene_.shapes[object.shape];
      if (primitive_count(shape) == 0) continue;
      if (can_bake(shape, object.world_from_object, shown[object.shape])) {
        const std::int32_t geometry = add_geometry(shape, object.world_from_object);
        world_.geometries[geometry].object = index;
        add_boxes(geometry, top);
      } else {
        std::int64_t& bvh = bvh_of_shape[object.shape];
        if (bvh < 0) {
          std::vector<BoxedPrimitive> boxes;
          add_boxes(add_geometry(shape, {}), boxes);
          bvh = std::int64_t(world_.bvhs.size());
          world_.bvhs.push_back(build_tree(std::move(boxes), world_.nodes, world_.refs));
        }
        add_instance(object, index, std::uint32_t(bvh), top);
      }
    }
    world_.bvhs[0] = build_tree(std::move(top), world_.nodes, world_.refs);
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

  std::int32_t add_geometry(const Shape& shape, const Transform& t) {
    Geometry g{};
    g.material_of_primitive =
        shape.material_of_primitive.empty() ? nullptr : shape.material_of_primitive.data();
    g.count = std::uint32_t(primitive_count(shape));
    const double scale = uniform_scale(t);
    const Transform inverse_t = inverse(t);
    std::visit([&](const auto& primitives) { place(primitives, t, inverse_t, scale, g); }, shape.primitives);
    world_.geometries.push_back(g);
    return std::int32_t(world_.geometries.size()) - 1;
  }

  void place(const Mesh& mesh, const Transform& t, const Transform& inverse_t, double, Geometry& g) {
    g.kind = PrimitiveKind::triangle;
    g.triangles = mesh.triangles.data();
    g.flipped = determinant(t) < 0;
    g.vertices = mesh.vertices.data();
    g.normals = mesh.normals.empty() ? nullptr : mesh.normals.data();
    if (is_identity(t)) return;
    std::vector<Vec3<float>> points;
    points.reserve(mesh.vertices.size());
    for (const auto& v : mesh.vertices) points.push_back(cast<float>(transform_point(t, cast<double>(v))));
    g.vertices = keep(world_.placed_points, std::move(points));
    if (mesh.normals.empty()) return;
    std::vector<Vec3<float>> normals;
    normals.reserve(mesh.normals.size());
    for (const auto& n : mesh.normals) {
      const Vec3<double> turned = transform_normal(inverse_t, cast<double>(n));
      const double size = length(turned);
      normals.push_back(size > 0 ? cast<float>(turned / size) : Vec3<float>{});
    }
    g.normals = keep(world_.placed_points, std::move(normals));
  }
  void place(const std::vector<Sphere>& spheres, const Transform& t, const Transform&, double scale,
             Geometry& g) {
    g.kind = PrimitiveKind::sphere;
    if (is_identity(t)) {
      g.spheres = spheres.data();
      return;
    }
    std::vector<Sphere> result;
    for (const Sphere& s : spheres) result.push_back({transform_point(t, s.center), scale * s.radius});
    g.spheres = keep(world_.placed_spheres, std::move(result));
  }
  void place(const std::vector<Cone>& cones, const Transform& t, const Transform&, double scale,
             Geometry& g) {
    g.kind = PrimitiveKind::cone;
    std::vector<PlacedCone> result;
    for (const Cone& c : cones)
      result.push_back(placed({transform_point(t, c.from), transform_point(t, c.to), scale * c.radius_from,
                               scale * c.radius_to}));
    g.cones = keep(world_.placed_cones, std::move(result));
  }
  void place(const std::vector<Disc>& discs, const Transform& t, const Transform& inverse_t, double scale,
             Geometry& g) {
    g.kind = PrimitiveKind::disc;
    std::vector<Disc> result;
    for (const Disc& d : discs)
      result.push_back(
          {transform_point(t, d.center), normalize(transform_normal(inverse_t, d.normal)), scale * d.radius});
    g.discs = keep(world_.placed_discs, std::move(result));
  }
  void place(const std::vector<Plane>& planes, const Transform& t, const Transform& inverse_t, double,
             Geometry& g) {
    g.kind = PrimitiveKind::plane;
    std::vector<Plane> result;
    for (const Plane& p : planes)
      result.push_back({transform_point(t, p.point), normalize(transform_normal(inverse_t, p.normal))});
    g.planes = keep(world_.placed_planes, std::move(result));
  }

  void add_boxes(std::int32_t geometry, std::vector<BoxedPrimitive>& boxes) {
    const Geometry& g = world_.geometries[geometry];
    for (std::uint32_t i = 0; i < g.count; ++i) {
      const PrimitiveRef ref{geometry, std::int32_t(i)};
      if (g.kind == PrimitiveKind::plane) world_.planes.push_back(ref);
      else boxes.push_back(boxed(ref, bounds_of(g, i)));
    }
  }

  void add_instance(const Object& object, std::uint32_t index, std::uint32_t bvh,
                    std::vector<BoxedPrimitive>& boxes) {
    const BvhNode& root = world_.nodes[world_.bvhs[bvh].root];
    Bounds b;
    for (int corner = 0; corner < 8; ++corner)
      b.add(transform_point(object.world_from_object, {double(corner & 1 ? root.upper.x : root.lower.x),
                                                       double(corner & 2 ? root.upper.y : root.lower.y),
                                                       double(corner & 4 ? root.upper.z : root.lower.z)}));
    boxes.push_back(boxed({instance_geometry, std::int32_t(world_.instances.size())}, b));
    world_.instances.push_back({object.world_from_object, inverse(object.world_from_object), bvh, index});
  }

  const Scene& scene_;
  World world_;
};

}  // namespace

WorldView World::view() const {
  return {bvhs.data(),
          nodes.data(),
          refs.data(),
          geometries.data(),
          instances.data(),
          objects.data(),
          planes.data(),
          std::uint32_t(planes.size()),
          material_transmits.get()};
}

World build_world(const Scene& scene) { return Builder(scene).build(); }

}  // namespace lambent
