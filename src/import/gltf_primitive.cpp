#include "import/gltf_primitive.h"

#include <algorithm>
#include <cmath>

namespace lambent::gltf {

namespace {

Vec3<double> unit_or_zero(const Vec3<double>& v) {
  const double l = length(v);
  return l > 0 && l < 1e300 ? (1 / l) * v : Vec3<double>{};
}

/// A normal under a transform: by the inverse of the transpose, but for a positive factor.
Vec3<double> normal_under(const Transform& t, const Vec3<double>& n) {
  const Vec3<double> turned = n.x * cross(t.y, t.z) + n.y * cross(t.z, t.x) + n.z * cross(t.x, t.y);
  return determinant(t) < 0 ? -turned : turned;
}

/// Fits into float; what is out of the scene's reach is said once the model stands in it.
constexpr double farthest = 1e30;

Vec3<float> to_float(const Vec3<double>& v) { return cast<float>(v); }

}  // namespace

double PrimitiveReader::Attribute::value(std::size_t element, int component) const {
  double x = component < base->components() ? base->value(element, component) : 0;
  for (const auto& [weight, target] : targets)
    if (component < target.components()) x += weight * target.value(element, component);
  return x;
}

PrimitiveReader::PrimitiveReader(const Json& root, const Json& primitive, std::string at,
                                 const std::vector<double>& weights, const std::vector<Transform>* joints,
                                 Buffers& buffers, Remarks& remarks)
    : root_(root),
      primitive_(primitive),
      at_(std::move(at)),
      weights_(weights),
      joints_(joints),
      buffers_(buffers),
      remarks_(remarks) {
  positions_ = attribute("POSITION");
  colors_ = attribute("COLOR_0");
  if (const Json& indices = member(primitive, "indices"); !indices.is_null())
    indices_.emplace(root, indices.get<std::size_t>(), buffers, remarks);
  if (!joints) return;
  for (int set = 0;; ++set) {
    const std::string number = std::to_string(set);
    const Json &joint = member(primitive["attributes"], ("JOINTS_" + number).c_str()),
               &weight = member(primitive["attributes"], ("WEIGHTS_" + number).c_str());
    if (joint.is_null() || weight.is_null()) break;
    joint_sets_.emplace_back(Accessor(root, joint.get<std::size_t>(), buffers, remarks),
                             Accessor(root, weight.get<std::size_t>(), buffers, remarks));
  }
}

PrimitiveReader::Attribute PrimitiveReader::attribute(const char* name) {
  Attribute result;
  const Json& base = member(primitive_["attributes"], name);
  if (base.is_null()) return result;
  result.base.emplace(root_, base.get<std::size_t>(), buffers_, remarks_);
  const Json& targets = member(primitive_, "targets");
  for (std::size_t i = 0; i < targets.size() && i < weights_.size(); ++i)
    if (const Json& target = member(targets[i], name); !target.is_null() && weights_[i] != 0)
      result.targets.emplace_back(weights_[i],
                                  Accessor(root_, target.get<std::size_t>(), buffers_, remarks_));
  return result;
}

/// The mean of the joints' transforms by the vertex's weights.
Transform PrimitiveReader::skin_of(std::uint32_t vertex) {
  Transform sum{{}, {}, {}, {}};
  double all = 0;
  for (const auto& [joints, weights] : joint_sets_)
    for (int c = 0; c < 4; ++c) {
      const double weight = weights.value(vertex, c);
      if (weight == 0) continue;
      const std::size_t joint = joints.index(vertex, c);
      if (joint >= joints_->size())
        remarks_.fail(at_ + "/attributes/JOINTS_0", "vertex " + std::to_string(vertex) + " has joint " +
                                                        std::to_string(joint) + ", but the skin has " +
                                                        std::to_string(joints_->size()));
      const Transform& t = (*joints_)[joint];
      sum.x = sum.x + weight * t.x, sum.y = sum.y + weight * t.y, sum.z = sum.z + weight * t.z;
      sum.translation = sum.translation + weight * t.translation;
      all += weight;
    }
  if (all == 0) return joints_->front();
  const double factor = 1 / all;
  return {factor * sum.x, factor * sum.y, factor * sum.z, factor * sum.translation};
}

Vec3<double> PrimitiveReader::placed(std::uint32_t vertex, const Transform& skin) {
  const Vec3<double> p = positions_.vector(vertex), result = is_skinned() ? transform_point(skin, p) : p;
  if (!(max_abs(result) <= farthest) || !std::isfinite(result.x + result.y + result.z))
    remarks_.fail(at_ + "/attributes/POSITION",
                  "vertex " + std::to_string(vertex) + " lies out of reach in its pose");
  return result;
}

Vec3<double> PrimitiveReader::position(std::uint32_t vertex) {
  return placed(vertex, is_skinned() ? skin_of(vertex) : Transform{});
}

std::array<float, 4> PrimitiveReader::color(std::uint32_t vertex, bool opaque) const {
  if (!colors_.base) return {1, 1, 1, 1};
  std::array<float, 4> color{0, 0, 0, 1};
  for (int c = 0; c < (opaque ? 3 : colors_.base->components()); ++c)
    color[std::size_t(c)] = float(std::max(colors_.value(vertex, c), 0.0));
  color[3] = std::min(color[3], 1.f);
  return color;
}

Mesh PrimitiveReader::read(const std::vector<std::uint32_t>& vertices, bool opaque) {
  const Attribute normals = attribute("NORMAL"), tangents = attribute("TANGENT"),
                  uvs = attribute("TEXCOORD_0"), uvs2 = attribute("TEXCOORD_1");
  const bool has_tangents = normals.base && tangents.base;  // without normals they have no meaning
  Mesh mesh;
  mesh.vertices.reserve(vertices.size());
  for (const std::uint32_t vertex : vertices) {
    const Transform skin = is_skinned() ? skin_of(vertex) : Transform{};
    const auto moved = [&](const Vec3<double>& v) { return is_skinned() ? transform_vector(skin, v) : v; };
    mesh.vertices.push_back(to_float(placed(vertex, skin)));
    if (normals.base) {
      const Vec3<double> n = normals.vector(vertex);
      mesh.normals.push_back(to_float(unit_or_zero(is_skinned() ? normal_under(skin, n) : n)));
    }
    if (has_tangents) {
      const Vec3<double> t = unit_or_zero(moved(tangents.vector(vertex)));
      const double side = tangents.base->value(vertex, 3) < 0 ? -1 : 1;
      // Theirs says where the image's upper edge is, and that is where v grows here.
      mesh.tangents.push_back({float(t.x), float(t.y), float(t.z), float(side)});
    }
    if (uvs.base) mesh.uvs.push_back({float(uvs.value(vertex, 0)), float(1 - uvs.value(vertex, 1))});
    if (uvs2.base) mesh.uvs2.push_back({float(uvs2.value(vertex, 0)), float(1 - uvs2.value(vertex, 1))});
    if (colors_.base) mesh.colors.push_back(color(vertex, opaque));
  }
  return mesh;
}

}  // namespace lambent::gltf
