#include "integrators/build_light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "math/directions.h"

namespace lambent {
namespace {

constexpr int bucket_count = 12;
/// So many lights are parted along the longest side of their box alone; with fewer all three are tried.
constexpr std::size_t many = 4096;
/// From here on lights are parted in equal numbers, so that the tree's depth stays below max_light_depth.
constexpr int deep = 32;

double angle_between(const Vec3<double>& a, const Vec3<double>& b) {
  return turns(length(cross(a, b)), dot(a, b));
}

Vec3<double> center_of(const Bounds& box) { return 0.5 * (box.lower + box.upper); }
double along(const Vec3<double>& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// The directions in which the lights shine, as Conty Estevez and Kulla weigh them: the integral over the
/// sphere of the cosine that is left of the angle beyond the spread.
double measure_of_directions(const LightBounds& b) {
  const double spread = 2 * pi * b.spread, end = std::min(2 * pi * (b.spread + b.reach), pi);
  const auto at = sincos_degrees(360 * b.spread),
             beyond = sincos_degrees(360 * b.spread - 2 * (180 / pi) * end);
  return 2 * pi * (1 - at.cos) + pi / 2 * (2 * end * at.sin - beyond.cos - 2 * spread * at.sin + at.cos);
}

/// What the lights cost wherever they may be of use: their intensity, their directions, and in place of the
/// surface of their box, which lights in a line have none of, the square of its diagonal.
double cost_of(const LightBounds& b) {
  const Vec3<double> size = b.box.upper - b.box.lower;
  return b.intensity * measure_of_directions(b) * dot(size, size);
}

class TreeBuilder {
 public:
  TreeBuilder(std::vector<LightBounds> lights, std::vector<LightNode>& nodes, std::vector<LightPath>& paths)
      : lights_(std::move(lights)), nodes_(nodes), paths_(paths) {}

  void build() {
    nodes_.emplace_back();
    build(nodes_.size() - 1, 0, lights_.size(), 0, 0);
  }

 private:
  void build(std::size_t node, std::size_t first, std::size_t last, int depth, std::uint64_t path) {
    if (last - first == 1) {
      nodes_[node] = light_node(lights_[first]);
      paths_.push_back({lights_[first].emitter, path});
      return;
    }
    const std::size_t middle = split(first, last, depth);
    const std::size_t child = nodes_.size();
    nodes_.resize(child + 2);
    LightBounds all = lights_[first];
    for (std::size_t i = first + 1; i < last; ++i) all = both_bounds(all, lights_[i]);
    nodes_[node] = light_node(all);
    nodes_[node].child = std::int32_t(child);
    build(child, first, middle, depth + 1, path);
    build(child + 1, middle, last, depth + 1, path | std::uint64_t{1} << depth);
  }

  struct Plane {
    int axis = -1;
    int bucket = 0;  ///< Up to this one, that one included, they go to the first child.
    double cost = std::numeric_limits<double>::infinity();
  };

  /// Parts the lights in two; where the second part begins.
  std::size_t split(std::size_t first, std::size_t last, int depth) {
    const std::size_t half = first + (last - first) / 2;
    Bounds centers;
    for (std::size_t i = first; i < last; ++i) centers.add(center_of(lights_[i].box));
    const Vec3<double> size = centers.upper - centers.lower;
    const double longest = max_abs(size);
    if (depth >= deep || !(longest > 0)) return half;
    Plane best;
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = along(size, axis);
      if (!(extent > 0) || (last - first > many && extent < longest)) continue;
      const Plane plane = best_plane(first, last, axis, centers, longest / extent);
      if (plane.cost < best.cost) best = plane;
    }
    if (best.axis < 0) return half;
    const auto begin = lights_.begin();
    const auto middle = std::stable_partition(
        begin + std::ptrdiff_t(first), begin + std::ptrdiff_t(last),
        [&](const LightBounds& light) { return bucket_of(light, best.axis, centers) <= best.bucket; });
    return std::size_t(middle - begin);
  }

  static int bucket_of(const LightBounds& light, int axis, const Bounds& centers) {
    const double low = along(centers.lower, axis), high = along(centers.upper, axis);
    return std::min(int((along(center_of(light.box), axis) - low) / (high - low) * bucket_count),
                    bucket_count - 1);
  }

  Plane best_plane(std::size_t first, std::size_t last, int axis, const Bounds& centers, double thin) const {
    std::array<LightBounds, bucket_count> buckets;
    std::array<bool, bucket_count> filled{};
    const auto add = [](LightBounds& to, bool& there, const LightBounds& more) {
      to = there ? both_bounds(to, more) : more;
      there = true;
    };
    for (std::size_t i = first; i < last; ++i) {
      const auto b = std::size_t(bucket_of(lights_[i], axis, centers));
      add(buckets[b], filled[b], lights_[i]);
    }
    std::array<double, bucket_count> below{};  // the cost of all up to a bucket
    LightBounds sum;
    bool any = false;
    for (std::size_t b = 0; b < bucket_count; ++b) {
      if (filled[b]) add(sum, any, buckets[b]);
      below[b] = any ? cost_of(sum) : 0;
    }
    Plane best;
    any = false;
    for (std::size_t b = bucket_count - 1; b > 0; --b) {
      if (filled[b]) add(sum, any, buckets[b]);
      const double cost = thin * (below[b - 1] + (any ? cost_of(sum) : 0));
      // The first bucket and the last one are never empty.
      if (cost < best.cost) best = {axis, int(b) - 1, cost};
    }
    return best;
  }

  std::vector<LightBounds> lights_;
  std::vector<LightNode>& nodes_;
  std::vector<LightPath>& paths_;
};

}  // namespace

LightBounds both_bounds(const LightBounds& a, const LightBounds& b) {
  LightBounds out = a;
  out.emitter = -1;
  out.box.add(b.box.lower), out.box.add(b.box.upper);
  out.intensity = a.intensity + b.intensity;
  out.two_sided = a.two_sided || b.two_sided;
  out.reach = std::max(a.reach, b.reach);
  // The narrowest cone around two (Conty Estevez and Kulla, algorithm 1).
  const LightBounds &wide = a.spread >= b.spread ? a : b, &narrow = a.spread >= b.spread ? b : a;
  const double apart = angle_between(wide.axis, narrow.axis);
  out.axis = wide.axis, out.spread = wide.spread;
  if (std::min(apart + narrow.spread, 0.5) <= wide.spread) return out;
  out.spread = (wide.spread + apart + narrow.spread) / 2;
  const Vec3<double> across = narrow.axis - dot(wide.axis, narrow.axis) * wide.axis;
  if (out.spread >= 0.5 || !(dot(across, across) > 0)) {
    out.spread = 0.5;
    return out;
  }
  const auto turn = sincos_degrees(360 * (out.spread - wide.spread));
  out.axis = normalize(turn.cos * wide.axis + turn.sin * normalize(across));
  return out;
}

LightNode light_node(const LightBounds& b) {
  const Vec3<double> center = center_of(b.box);
  const Vec3<float> as_float = cast<float>(center);
  const Vec3<double> half = 0.5 * (b.box.upper - b.box.lower), off = cast<double>(as_float) - center;
  const auto no_less = [](double size) {
    return size > 0 ? std::nextafter(float(size), std::numeric_limits<float>::infinity()) : 0.0f;
  };
  LightNode node{};
  node.center[0] = as_float.x, node.center[1] = as_float.y, node.center[2] = as_float.z;
  node.half[0] = no_less(half.x + abs(off.x)), node.half[1] = no_less(half.y + abs(off.y)),
  node.half[2] = no_less(half.z + abs(off.z));
  node.axis[0] = float(b.axis.x), node.axis[1] = float(b.axis.y), node.axis[2] = float(b.axis.z);
  node.cos_spread = b.spread >= 0.5 ? -1.0f : float(sincos_degrees(360 * b.spread).cos);
  node.cos_reach = float(sincos_degrees(360 * b.reach).cos);
  node.intensity = float(b.intensity);
  node.child = -1;
  node.emitter = b.emitter;
  node.two_sided = b.two_sided;
  return node;
}

void build_light_tree(std::vector<LightBounds> lights, std::vector<LightNode>& nodes,
                      std::vector<LightPath>& paths) {
  TreeBuilder(std::move(lights), nodes, paths).build();
}

}  // namespace lambent
