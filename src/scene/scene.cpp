#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace lambent {
namespace {

bool in_reach(const Vec3<double>& p) {
  return max_abs(p) <= largest_coordinate && p.x == p.x && p.y == p.y && p.z == p.z;
}

/// Where the three world coordinates of a transformed sphere end: an affine map takes the unit sphere to an
/// ellipsoid whose half-width along a world axis is the length of the matrix's row.
Vec3<double> half_widths(const Transform& t) {
  return {std::sqrt(t.x.x * t.x.x + t.y.x * t.y.x + t.z.x * t.z.x),
          std::sqrt(t.x.y * t.x.y + t.y.y * t.y.y + t.z.y * t.z.y),
          std::sqrt(t.x.z * t.x.z + t.y.z * t.y.z + t.z.z * t.z.z)};
}

/// The same for a circle about the unit vector `n`: of each row only what lies in the circle's plane counts.
Vec3<double> half_widths(const Transform& t, const Vec3<double>& n) {
  const auto row = [&](double a, double b, double c) {
    const Vec3<double> r{a, b, c};
    return length(r - dot(r, n) * n);
  };
  return {row(t.x.x, t.y.x, t.z.x), row(t.x.y, t.y.y, t.z.y), row(t.x.z, t.y.z, t.z.z)};
}

void add_around(Bounds& bounds, const Transform& t, const Vec3<double>& center, const Vec3<double>& half) {
  const Vec3<double> c = transform_point(t, center);
  bounds.add(c - half);
  bounds.add(c + half);
}

void add(Bounds& bounds, const Transform& t, const Mesh& mesh) {
  for (const Vec3<float>& v : mesh.vertices) bounds.add(transform_point(t, cast<double>(v)));
}
void add(Bounds& bounds, const Transform& t, const std::vector<Sphere>& spheres) {
  for (const Sphere& s : spheres) add_around(bounds, t, s.center, s.radius * half_widths(t));
}
void add(Bounds& bounds, const Transform& t, const std::vector<Cone>& cones) {
  for (const Cone& c : cones) {
    const Vec3<double> half = half_widths(t, normalize(c.to - c.from));
    add_around(bounds, t, c.from, c.radius_from * half);
    add_around(bounds, t, c.to, c.radius_to * half);
  }
}
void add(Bounds& bounds, const Transform& t, const std::vector<Disc>& discs) {
  for (const Disc& d : discs) add_around(bounds, t, d.center, d.radius * half_widths(t, normalize(d.normal)));
}
void add(Bounds&, const Transform&, const std::vector<Plane>&) {}

/// What is wrong with a shape by itself, or empty.
std::string fault(const Mesh& mesh) {
  const std::size_t count = mesh.vertices.size();
  if (!mesh.normals.empty() && mesh.normals.size() != count)
    return "has " + std::to_string(count) + " vertices, but " + std::to_string(mesh.normals.size()) +
           " normals";
  if (!mesh.uvs.empty() && mesh.uvs.size() != count)
    return "has " + std::to_string(count) + " vertices, but " + std::to_string(mesh.uvs.size()) + " uvs";
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      if (vertex >= count)
        return "has a triangle with vertex " + std::to_string(vertex) + ", but only " +
               std::to_string(count) + " vertices";
  return {};
}
template <class P> std::string fault(const std::vector<P>&) { return {}; }

/// Everything that an infinite plane is made of; what is bounded is judged by its bounds.
bool planes_in_reach(const Shape& shape, const Transform& world_from_object) {
  if (const auto* planes = std::get_if<std::vector<Plane>>(&shape.primitives))
    for (const Plane& plane : *planes)
      if (!in_reach(transform_point(world_from_object, plane.point))) return false;
  return true;
}

}  // namespace

Transform placed_at(const Object& object, double time) {
  Transform placed = object.world_from_object;
  for (const MotionStep& step : object.motion) {
    if (step.degrees != 0) placed = rotation_about(step.center, step.axis, time * step.degrees) * placed;
    else placed = translation(time * step.translate) * placed;
  }
  return placed;
}

bool is_moving(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(),
                     [](const Object& object) { return !object.motion.empty(); });
}

double focus_distance(const Camera& camera) {
  return camera.focus_distance > 0 ? camera.focus_distance : length(camera.target - camera.eye);
}

bool may_transmit(const Material& material) {
  return !is_black(material.transmit) || material.opacity < 1 ||
         (material.metallic_roughness && material.metallic_roughness->transmission > 0) ||
         std::any_of(material.maps.begin(), material.maps.end(),
                     [](const MaterialMap& one) { return one.slot == MapSlot::opacity; });
}

ModelId model_of(const Scene& scene, const Material& material) {
  return material.model.value_or(scene.illumination.model);
}
double own_number(const Material& material, const ModelParameter& parameter) {
  const auto given = material.own.find(parameter.name);
  return given == material.own.end() ? parameter.default_value : given->second;
}
Attenuation attenuation_of(const Illumination& illumination, ModelId model) {
  return illumination.attenuation.value_or(info(model).attenuation);
}
AmbientAttenuation ambient_attenuation_of(const Illumination& illumination, ModelId model) {
  return illumination.ambient_attenuation.value_or(info(model).ambient_attenuation);
}

std::size_t primitive_count(const Shape& shape) {
  if (const auto* mesh = std::get_if<Mesh>(&shape.primitives)) return mesh->triangles.size();
  return std::visit(
      [](const auto& primitives) -> std::size_t {
        if constexpr (requires { primitives.size(); }) return primitives.size();
        else return primitives.triangles.size();
      },
      shape.primitives);
}

void Bounds::add(const Vec3<double>& p) {
  lower = {min(lower.x, p.x), min(lower.y, p.y), min(lower.z, p.z)};
  upper = {max(upper.x, p.x), max(upper.y, p.y), max(upper.z, p.z)};
}

Bounds bounds(const Shape& shape, const Transform& world_from_object) {
  Bounds result;
  std::visit([&](const auto& primitives) { add(result, world_from_object, primitives); }, shape.primitives);
  return result;
}

Bounds bounds(const Scene& scene) {
  Bounds result;
  for (const Object& object : scene.objects) {
    const Bounds one = bounds(scene.shapes[object.shape], object.world_from_object);
    if (one.empty()) continue;
    result.add(one.lower);
    result.add(one.upper);
  }
  return result;
}

std::vector<Diagnostic> validate(const Scene& scene) {
  std::vector<Diagnostic> found;
  const auto report = [&](const Place& place, std::string message, std::string hint = {}) {
    Diagnostic diagnostic;
    diagnostic.place = place;
    diagnostic.message = std::move(message);
    diagnostic.hint = std::move(hint);
    found.push_back(std::move(diagnostic));
  };
  // Objects that show one shape share its faults; each shape is looked at once.
  std::vector<std::string> faults(scene.shapes.size());
  for (std::size_t i = 0; i < scene.shapes.size(); ++i)
    faults[i] =
        std::visit([](const auto& primitives) { return fault(primitives); }, scene.shapes[i].primitives);

  for (const Object& object : scene.objects) {
    const std::string who = "'" + object.name + "'";
    if (object.shape >= scene.shapes.size()) {
      report(object.place, who + " shows shape " + std::to_string(object.shape) + ", but there are only " +
                               std::to_string(scene.shapes.size()));
      continue;
    }
    const Shape& shape = scene.shapes[object.shape];
    if (!faults[object.shape].empty()) {
      report(object.place, who + " " + faults[object.shape]);
      continue;
    }
    if (object.materials.empty()) report(object.place, who + " has no material");
    for (const std::uint32_t material : object.materials)
      if (material >= scene.materials.size())
        report(object.place, who + " has material " + std::to_string(material) + ", but there are only " +
                                 std::to_string(scene.materials.size()));
    if (!shape.material_of_primitive.empty()) {
      if (shape.material_of_primitive.size() != primitive_count(shape))
        report(object.place, who + " has " + std::to_string(primitive_count(shape)) +
                                 " primitives, but materials for " +
                                 std::to_string(shape.material_of_primitive.size()));
      for (const std::uint32_t index : shape.material_of_primitive)
        if (index >= object.materials.size()) {
          report(object.place, who + " has a primitive with its material " + std::to_string(index) +
                                   ", but only " + std::to_string(object.materials.size()) + " materials");
          break;
        }
    }
    const auto is_in_reach = [&](const Transform& t) {
      const Bounds box = bounds(shape, t);
      return in_reach(t.x) && in_reach(t.y) && in_reach(t.z) && in_reach(t.translation) &&
             (box.empty() || (in_reach(box.lower) && in_reach(box.upper))) && planes_in_reach(shape, t);
    };
    bool placed = is_in_reach(object.world_from_object);
    if (!object.motion.empty())
      for (const double time : {0.25, 0.5, 0.75, 1.0})
        placed = placed && is_in_reach(placed_at(object, time));
    if (!placed)
      report(object.place, who + " reaches beyond 1e10 scene units from the origin",
             "choose a larger unit of length: scale the scene down");
  }
  for (const Light& light : scene.lights)
    with_light(light.light, [&]<class L>(const L& one) {
      if constexpr (HasExtent<L>) {
        const LightBody body = body_of(one);
        const double size = length(body.u) + length(body.v) + body.radius;
        if (!(max_abs(body.center) + size <= largest_coordinate))
          report(light.place, "'" + light.name + "' reaches beyond 1e10 scene units from the origin",
                 "choose a larger unit of length: scale the scene down");
      }
    });
  return found;
}

}  // namespace lambent
