#include "import/gltf_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "import/text_file.h"

namespace lambent::gltf {

namespace {

using Quaternion = std::array<double, 4>;  // x y z w

/// What animations change of a node.
struct Parts {
  std::array<double, 3> translation{0, 0, 0}, scale{1, 1, 1};
  Quaternion rotation{0, 0, 0, 1};
};

template <std::size_t N> void read_list(const Json& list, std::array<double, N>& values) {
  for (std::size_t i = 0; i < list.size() && i < N; ++i) values[i] = list[i].get<double>();
}

double length_of(const double* q) { return std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]); }

Transform transform_of(const Parts& parts) {
  double x = parts.rotation[0], y = parts.rotation[1], z = parts.rotation[2], w = parts.rotation[3];
  const double length = length_of(parts.rotation.data());
  if (length > 0) x /= length, y /= length, z /= length, w /= length;
  else w = 1;
  const auto [sx, sy, sz] = parts.scale;
  return {sx * Vec3<double>{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
          sy * Vec3<double>{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
          sz * Vec3<double>{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)},
          {parts.translation[0], parts.translation[1], parts.translation[2]}};
}

/// The shorter way round, at constant speed.
void slerp(const double* a, const double* b, double t, double* result) {
  double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const double sign = cosine < 0 ? -1 : 1;
  cosine = std::min(std::abs(cosine), 1.0);
  const double angle = std::acos(cosine), sine = std::sin(angle);
  const double from = sine > 1e-6 ? std::sin((1 - t) * angle) / sine : 1 - t,
               to = sine > 1e-6 ? std::sin(t * angle) / sine : t;
  for (int i = 0; i < 4; ++i) result[i] = from * a[i] + sign * to * b[i];
}

/// A sampler at a time: `values` numbers (Appendix C of the specification).
std::vector<double> sample(const Accessor& input, const Accessor& output, const std::string& interpolation,
                           std::size_t values, bool rotation, double time) {
  const bool cubic = interpolation == "CUBICSPLINE";
  const std::size_t keys = input.count();
  // Key `key`; of cubic splines part 0 is the tangent before it, 1 the value, 2 the tangent behind.
  const auto at = [&](std::size_t key, std::size_t part) {
    std::vector<double> result(values);
    const std::size_t first = (cubic ? 3 * key + part : key) * values;
    const auto components = std::size_t(output.components());
    for (std::size_t i = 0; i < values; ++i)
      result[i] = output.value((first + i) / components, int((first + i) % components));
    return result;
  };
  std::size_t low = 0, high = keys;  // the last key that is not after `time`
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (input.raw(middle, 0) <= time ? low : high) = middle;
  }
  const double begin = input.raw(low, 0);
  if (low + 1 == keys || time <= begin || interpolation == "STEP") return at(low, 1);
  const double duration = input.raw(low + 1, 0) - begin, t = (time - begin) / duration;
  std::vector<double> a = at(low, 1);
  const std::vector<double> b = at(low + 1, 1);
  if (cubic) {
    const std::vector<double> out = at(low, 2), in = at(low + 1, 0);
    const double t2 = t * t, t3 = t2 * t;
    for (std::size_t i = 0; i < values; ++i)
      a[i] = (2 * t3 - 3 * t2 + 1) * a[i] + duration * (t3 - 2 * t2 + t) * out[i] + (3 * t2 - 2 * t3) * b[i] +
             duration * (t3 - t2) * in[i];
  } else if (rotation) {
    slerp(std::vector<double>(a).data(), b.data(), t, a.data());
  } else {
    for (std::size_t i = 0; i < values; ++i) a[i] += t * (b[i] - a[i]);
  }
  return a;
}

class Poser {
 public:
  Poser(const Json& root, Buffers& buffers, Remarks& remarks)
      : root_(root),
        buffers_(buffers),
        remarks_(remarks),
        nodes_(member(root, "nodes")),
        parts_(nodes_.size()) {}

  Pose pose(std::optional<double> time) {
    pose_.weights.resize(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      read_list(member(nodes_[i], "translation"), parts_[i].translation);
      read_list(member(nodes_[i], "rotation"), parts_[i].rotation);
      read_list(member(nodes_[i], "scale"), parts_[i].scale);
      for (const Json& weight : member(nodes_[i], "weights"))
        pose_.weights[i].push_back(weight.get<double>());
    }
    if (time) animate(*time);
    place();
    return std::move(pose_);
  }

 private:
  void animate(double time) {
    const Json& animations = member(root_, "animations");
    std::set<std::pair<std::size_t, std::string>> moved;
    for (std::size_t i = 0; i < animations.size(); ++i) {
      std::set<std::pair<std::size_t, std::string>> moves;
      for (const Json& channel : animations[i]["channels"])
        if (const Json& node = member(channel["target"], "node"); !node.is_null())
          moves.insert({node.get<std::size_t>(), text(channel["target"], "path")});
      if (std::any_of(moves.begin(), moves.end(),
                      [&](const auto& target) { return moved.contains(target); })) {
        remarks_.warn(std::string("/animations") / i,
                      in_quotes(text(animations[i], "name", "unnamed")) +
                          " moves what an earlier animation moves; it is left out");
        continue;
      }
      moved.merge(moves);
      for (const Json& channel : animations[i]["channels"])
        move(channel, animations[i]["samplers"][whole(channel, "sampler", 0)], time);
    }
  }
  void move(const Json& channel, const Json& sampler, double time) {
    const Json& target = channel["target"];
    const std::string path = text(target, "path");
    const bool known = path == "translation" || path == "rotation" || path == "scale" || path == "weights";
    if (member(target, "node").is_null() || !known) return;
    const auto node = target["node"].get<std::size_t>();
    std::size_t values = path == "rotation" ? 4 : 3;
    if (path == "weights") {
      const std::size_t mesh = nodes_[node]["mesh"].get<std::size_t>();
      values = member(root_["meshes"][mesh]["primitives"][0], "targets").size();
      weights_ += values;
      if (weights_ > 16 * buffers_.total())
        remarks_.fail("/animations", "they move more morph targets than the file has bytes");
    }
    const Accessor input(root_, sampler["input"].get<std::size_t>(), buffers_, remarks_),
        output(root_, sampler["output"].get<std::size_t>(), buffers_, remarks_);
    const std::vector<double> result =
        sample(input, output, text(sampler, "interpolation", "LINEAR"), values, path == "rotation", time);
    Parts& parts = parts_[node];
    if (path == "translation") std::copy(result.begin(), result.end(), parts.translation.begin());
    else if (path == "rotation") std::copy(result.begin(), result.end(), parts.rotation.begin());
    else if (path == "scale") std::copy(result.begin(), result.end(), parts.scale.begin());
    else pose_.weights[node] = result;
  }

  Transform local(std::size_t node) const {
    const Json& matrix = member(nodes_[node], "matrix");
    if (matrix.is_null()) return transform_of(parts_[node]);
    const auto column = [&](std::size_t i) {
      return Vec3<double>{matrix[i].get<double>(), matrix[i + 1].get<double>(), matrix[i + 2].get<double>()};
    };
    return {column(0), column(4), column(8), column(12)};
  }
  /// From the roots down.
  void place() {
    std::vector<char> is_child(nodes_.size(), 0);
    for (const Json& node : nodes_)
      for (const Json& child : member(node, "children")) is_child[child.get<std::size_t>()] = 1;
    std::vector<std::size_t> ready;
    pose_.world_from_node.resize(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (is_child[i] != 0) continue;
      pose_.world_from_node[i] = local(i);
      ready.push_back(i);
    }
    while (!ready.empty()) {
      const std::size_t node = ready.back();
      ready.pop_back();
      for (const Json& index : member(nodes_[node], "children")) {
        const auto child = index.get<std::size_t>();
        pose_.world_from_node[child] = pose_.world_from_node[node] * local(child);
        ready.push_back(child);
      }
    }
  }

  const Json& root_;
  Buffers& buffers_;
  Remarks& remarks_;
  const Json& nodes_;
  std::vector<Parts> parts_;
  Pose pose_;
  std::uint64_t weights_ = 0;  ///< How many animations have set.
};

}  // namespace

Pose make_pose(const Json& root, Buffers& buffers, std::optional<double> time, Remarks& remarks) {
  return Poser(root, buffers, remarks).pose(time);
}

void check_animations(const Json& root, Buffers& buffers, Remarks& remarks) {
  const Json& animations = member(root, "animations");
  std::set<std::pair<std::size_t, int>> seen;  // many channels may share one accessor
  for (std::size_t i = 0; i < animations.size(); ++i)
    for (std::size_t c = 0; c < animations[i]["channels"].size(); ++c) {
      const Json& channel = animations[i]["channels"][c];
      const Json& sampler = animations[i]["samplers"][whole(channel, "sampler", 0)];
      const std::string at = std::string("/animations") / i / std::string_view("channels") / c;
      const auto input = sampler["input"].get<std::size_t>(), output = sampler["output"].get<std::size_t>();
      if (buffers.has_accessor(input) && seen.insert({input, 0}).second) {
        const Accessor times(root, input, buffers, remarks);
        for (std::size_t k = 0; k < times.count(); ++k)
          if (times.raw(k, 0) < 0 || (k > 0 && !(times.raw(k, 0) > times.raw(k - 1, 0)))) {
            remarks.error(at, "its times do not grow: key " + std::to_string(k));
            break;
          }
      }
      const int step = text(sampler, "interpolation") == "CUBICSPLINE" ? 3 : 1;
      if (text(channel["target"], "path") != "rotation" || !buffers.has_accessor(output) ||
          !seen.insert({output, step}).second)
        continue;
      const Accessor rotations(root, output, buffers, remarks);
      for (std::size_t k = step == 3 ? 1 : 0; k < rotations.count(); k += std::size_t(step)) {
        const double q[4] = {rotations.value(k, 0), rotations.value(k, 1), rotations.value(k, 2),
                             rotations.value(k, 3)};
        if (std::abs(length_of(q) - 1) <= 0.02) continue;  // bytes hold no better unit quaternions
        remarks.error(at, "the rotation at element " + std::to_string(k) + " is no unit quaternion");
        break;
      }
    }
}

}  // namespace lambent::gltf
