#include "import/gltf_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "import/tangents.h"

namespace lambent::gltf {

namespace {

enum Mode { points, lines, line_loop, line_strip, triangles, triangle_strip, triangle_fan };

// Shares of the diagonal of all that is shown: about three pixels, and about two.
constexpr double point_radius = 1.0 / 400, line_radius = 1.0 / 600;

/// How many primitives so many corners make.
std::uint64_t primitives_of(Mode mode, std::uint64_t corners) {
  switch (mode) {
    case points:
      return corners;
    case lines:
      return corners / 2;
    case line_loop:
      return corners < 2 ? 0 : corners;
    case line_strip:
      return corners < 2 ? 0 : corners - 1;
    case triangles:
      return corners / 3;
    case triangle_strip:
    case triangle_fan:
      return corners < 3 ? 0 : corners - 2;
  }
  return 0;
}

/// The corners of primitive `i`, of as many as there are of it.
std::array<std::size_t, 3> corners_of(Mode mode, std::size_t i, std::size_t corners) {
  switch (mode) {
    case points:
      return {i, 0, 0};
    case lines:
      return {2 * i, 2 * i + 1, 0};
    case line_loop:
      return {i, (i + 1) % corners, 0};
    case line_strip:
      return {i, i + 1, 0};
    case triangles:
      return {3 * i, 3 * i + 1, 3 * i + 2};
    case triangle_strip:
      return {i, i + 1 + i % 2, i + 2 - i % 2};
    case triangle_fan:
      return {i + 1, i + 2, 0};
  }
  return {};
}

bool has_area(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Vec3<double> a = cast<double>(mesh.vertices[t[0]]), b = cast<double>(mesh.vertices[t[1]]),
                     c = cast<double>(mesh.vertices[t[2]]);
  return !(cross(b - a, c - a) == Vec3<double>{});
}

/// The triangles of a primitive, with the vertices that they have.
Mesh read_triangles(PrimitiveReader& reader, Mode mode, const MaterialTraits& traits,
                    std::vector<std::uint32_t>& place) {
  const std::size_t corners = reader.corners(), count = primitives_of(mode, corners);
  std::vector<std::array<std::uint32_t, 3>> found;
  found.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = corners_of(mode, i, corners);
    const std::array<std::uint32_t, 3> t{reader.corner(at[0]), reader.corner(at[1]), reader.corner(at[2])};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) found.push_back(t);
  }
  // Many primitives may share one large set of vertices: each takes only those that it has.
  constexpr std::uint32_t unused = ~0u;
  if (place.size() < reader.vertices()) place.resize(reader.vertices(), unused);
  std::vector<std::uint32_t> used;
  for (const auto& t : found)
    for (const std::uint32_t vertex : t)
      if (place[vertex] == unused) place[vertex] = 0, used.push_back(vertex);
  std::sort(used.begin(), used.end());
  for (std::size_t i = 0; i < used.size(); ++i) place[used[i]] = std::uint32_t(i);
  for (auto& t : found)
    for (std::uint32_t& vertex : t) vertex = place[vertex];
  for (const std::uint32_t vertex : used) place[vertex] = unused;

  Mesh mesh = reader.read(used, traits.opaque);
  found.erase(std::remove_if(found.begin(), found.end(), [&](const auto& t) { return !has_area(mesh, t); }),
              found.end());
  mesh.triangles = std::move(found);
  const bool has_uvs =
      traits.normal_uvs == 0 ? !mesh.uvs.empty() : traits.normal_uvs == 1 && !mesh.uvs2.empty();
  if (has_uvs && mesh.tangents.empty() && !mesh.normals.empty()) make_tangents(mesh, traits.normal_uvs);
  return mesh;
}

std::vector<Sphere> read_points(PrimitiveReader& reader, double radius) {
  std::vector<Sphere> spheres;
  spheres.reserve(reader.corners());
  for (std::size_t i = 0; i < reader.corners(); ++i)
    spheres.push_back({reader.position(reader.corner(i)), radius});
  return spheres;
}

using Rgba = std::array<float, 4>;

Rgba mean(std::initializer_list<Rgba> colors) {
  Rgba sum{};
  for (const Rgba& color : colors)
    for (std::size_t i = 0; i < 4; ++i) sum[i] += color[i] / float(colors.size());
  return sum;
}

/// To one of 32 steps in each channel, even to the eye.
Rgba rounded(Rgba color) {
  for (float& x : color) {
    const float step = std::round(31 * std::sqrt(x)) / 31;
    x = step * step;
  }
  return color;
}

std::vector<Cone> read_lines(PrimitiveReader& reader, Mode mode, double radius, bool opaque,
                             std::vector<Rgba>& colors) {
  const std::size_t corners = reader.corners(), count = primitives_of(mode, corners);
  std::vector<Cone> cylinders;
  cylinders.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = corners_of(mode, i, corners);
    const std::uint32_t a = reader.corner(at[0]), b = reader.corner(at[1]);
    const Vec3<double> from = reader.position(a), to = reader.position(b);
    if (from == to) continue;
    cylinders.push_back({from, to, radius, radius});
    if (reader.has_colors()) colors.push_back(mean({reader.color(a, opaque), reader.color(b, opaque)}));
  }
  return cylinders;
}

}  // namespace

const std::vector<Meshes::Part>& Meshes::of_node(std::size_t number) {
  const Json& node = root_["nodes"][number];
  const Json& skin = member(node, "skin");
  return parts(node["mesh"].get<std::size_t>(), skin.is_null() ? none : skin.get<std::size_t>(),
               pose_.weights[number], std::cbrt(std::abs(determinant(pose_.world_from_node[number]))));
}

const std::vector<Meshes::Part>& Meshes::of_mesh(std::size_t mesh) { return parts(mesh, none, {}, 1); }

std::vector<double> Meshes::own_weights(const Json& mesh) const {
  std::vector<double> weights;
  for (const Json& weight : member(mesh, "weights")) weights.push_back(weight.get<double>());
  return weights;
}

bool Meshes::is_open(const Json& primitive) const {
  const auto open = [&](const Json& index) { return buffers_.is_open(index.get<std::size_t>()); };
  if (const Json& indices = member(primitive, "indices"); !indices.is_null() && open(indices)) return true;
  if (std::any_of(primitive["attributes"].begin(), primitive["attributes"].end(), open)) return true;
  const Json& targets = member(primitive, "targets");
  return std::any_of(targets.begin(), targets.end(),
                     [&](const Json& target) { return std::any_of(target.begin(), target.end(), open); });
}

const std::vector<Meshes::Part>& Meshes::parts(std::size_t mesh, std::size_t skin,
                                               const std::vector<double>& weights, double scale) {
  const auto [found, is_new] = parts_.try_emplace(Key{mesh, skin, weights});
  if (!is_new) return found->second;
  const Json& json = root_["meshes"][mesh];
  const std::string name = name_in(json);
  const std::vector<double> used = weights.empty() ? own_weights(json) : weights;
  for (std::size_t i = 0; i < json["primitives"].size(); ++i) {
    const Json& primitive = json["primitives"][i];
    const std::string at = std::string("/meshes") / mesh / std::string_view("primitives") / i;
    if (!primitive["attributes"].contains("POSITION")) {
      remarks_.warn(at + "/attributes", "there is no POSITION; the primitive is left out");
      continue;
    }
    if (is_open(primitive)) {
      remarks_.warn(at, "its buffer has no uri, so there are no bytes; the primitive is left out");
      continue;
    }
    const auto mode = Mode(whole(primitive, "mode", triangles));
    PrimitiveReader reader(root_, primitive, at, used, skin == none ? nullptr : &joints(skin), buffers_,
                           remarks_);
    count_primitives(primitives_of(mode, reader.corners()), at);
    Shape shape = read(reader, mode, materials_.of(primitive), diagonal_ / (reader.is_skinned() ? 1 : scale));
    if (primitive_count(shape) == 0) continue;
    shape.name = name.empty() ? "mesh " + std::to_string(mesh + 1) : name;
    found->second.push_back({std::uint32_t(model_.shapes.size()), reader.is_skinned()});
    model_.shapes.push_back(std::move(shape));
  }
  return found->second;
}

Shape Meshes::read(PrimitiveReader& reader, int mode_number, std::uint32_t material, double unit) {
  const auto mode = Mode(mode_number);
  const MaterialTraits traits = materials_.traits(material);
  Shape shape;
  std::vector<std::array<float, 4>> colors;  // of primitives that can have none themselves
  if (mode == points) {
    shape.primitives = read_points(reader, point_radius * unit);
    for (std::size_t i = 0; reader.has_colors() && i < reader.corners(); ++i)
      colors.push_back(reader.color(reader.corner(i), traits.opaque));
  } else if (mode < triangles) {
    shape.primitives = read_lines(reader, mode, line_radius * unit, traits.opaque, colors);
  } else {
    Mesh mesh = read_triangles(reader, mode, traits, place_of_vertex_);
    if (traits.unlit && !mesh.colors.empty()) {
      // What glows has no vertex colours: each triangle gets the mean of its corners'.
      for (const auto& t : mesh.triangles) {
        std::array<float, 4> color = mean({mesh.colors[t[0]], mesh.colors[t[1]], mesh.colors[t[2]]});
        color[3] = 1;
        colors.push_back(color);
      }
      for (auto& color : mesh.colors) color = {1, 1, 1, color[3]};
    }
    shape.primitives = std::move(mesh);
  }
  if (!colors.empty()) {
    // One colour is kept as it is; of many, those that hardly differ are taken together.
    const bool one =
        std::all_of(colors.begin(), colors.end(), [&](const auto& color) { return color == colors[0]; });
    for (const auto& color : colors)
      shape.material_of_primitive.push_back(materials_.tinted(material, one ? color : rounded(color)));
  } else if (material != 0) {
    shape.material_of_primitive.assign(primitive_count(shape), material);
  }
  return shape;
}

void Meshes::count_primitives(std::uint64_t more, const std::string& at) {
  primitives_ += more;
  if (primitives_ > options_.limits.primitives)
    remarks_.fail(at, "the model has more than " + std::to_string(options_.limits.primitives) +
                          " primitives, which is the limit");
  // Meshes and skins may share numbers, but not to the point that the file's size says nothing: where none
  // do, a byte makes one primitive at most.
  constexpr std::uint64_t most_per_byte = 4, harmless = 1 << 20;
  if (primitives_ > harmless && primitives_ / most_per_byte > buffers_.total())
    remarks_.fail(at, "the model has more than " + std::to_string(most_per_byte) +
                          " primitives for each byte of its file");
}

const std::vector<Transform>& Meshes::joints(std::size_t skin) {
  const auto [found, is_new] = joints_.try_emplace(skin);
  if (!is_new) return found->second;
  const Json& json = root_["skins"][skin];
  std::optional<Accessor> binds;
  if (const Json& index = member(json, "inverseBindMatrices"); !index.is_null())
    binds.emplace(root_, index.get<std::size_t>(), buffers_, remarks_);
  for (std::size_t i = 0; i < json["joints"].size(); ++i) {
    Transform bind;
    if (binds) {
      const auto column = [&](int c) {
        return Vec3<double>{binds->value(i, c), binds->value(i, c + 1), binds->value(i, c + 2)};
      };
      bind = {column(0), column(4), column(8), column(12)};
    }
    found->second.push_back(pose_.world_from_node[json["joints"][i].get<std::size_t>()] * bind);
  }
  return found->second;
}

}  // namespace lambent::gltf
