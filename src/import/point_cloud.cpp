#include "import/point_cloud.h"

#include <algorithm>
#include <cmath>

#include "import/bare.h"
#include "import/vertex_table.h"

namespace lambent {

namespace {

constexpr std::size_t most_materials = 4096;

float coordinate(const Vec3<float>& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// The axis along which the points lie farthest apart, the outermost tenth on each side left out.
int widest_axis(const std::vector<Vec3<float>>& points) {
  std::vector<float> values;
  const std::size_t step = 1 + points.size() / 4096;
  int widest = 0;
  float width = -1;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (std::size_t i = 0; i < points.size(); i += step) values.push_back(coordinate(points[i], axis));
    std::sort(values.begin(), values.end());
    const float here = values[values.size() - 1 - values.size() / 10] - values[values.size() / 10];
    if (here > width) width = here, widest = axis;
  }
  return widest;
}

/// The distances to the nearest few, in ascending order; copies of a point that was met already do not count.
class Nearest {
 public:
  explicit Nearest(std::size_t wanted) : wanted_(wanted) {}
  void offer(double squared, const Vec3<float>& point) {
    if (squared == 0 || squared >= farthest()) return;
    for (std::size_t i = 0; i < count_; ++i)
      if (squared_[i] == squared && points_[i] == point) return;
    std::size_t i = count_ < wanted_ ? count_++ : count_ - 1;
    for (; i > 0 && squared_[i - 1] > squared; --i)
      squared_[i] = squared_[i - 1], points_[i] = points_[i - 1];
    squared_[i] = squared, points_[i] = point;
  }
  /// What is farther is not wanted any more.
  double farthest() const { return count_ < wanted_ ? INFINITY : squared_[count_ - 1]; }
  /// Of the last wanted, or of the last there is; 0 where there is none.
  double squared() const { return count_ == 0 ? 0 : squared_[count_ - 1]; }

 private:
  std::size_t wanted_, count_ = 0;
  double squared_[4]{};
  Vec3<float> points_[4]{};
};

/// The median distance of some points to their neighbours; 0 where all are at one place.
double spacing(const std::vector<Vec3<float>>& points, std::size_t wanted) {
  // Along one axis in order: what lies farther along it than the neighbours found is farther altogether.
  constexpr std::size_t most_asked = 4096, most_looked_at = 32768;
  const int axis = widest_axis(points);
  std::vector<Vec3<float>> sorted = points;
  std::sort(sorted.begin(), sorted.end(), [&](const Vec3<float>& a, const Vec3<float>& b) {
    const float ca = coordinate(a, axis), cb = coordinate(b, axis);
    if (ca != cb) return ca < cb;
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
  });
  std::vector<double> found;
  const std::size_t step = 1 + points.size() / most_asked;
  for (std::size_t at = step / 2; at < sorted.size(); at += step) {
    const Vec3<double> p = cast<double>(sorted[at]);
    Nearest nearest(wanted);
    const auto look = [&](std::size_t i) {  // false: none behind it can be nearer
      const Vec3<double> way = cast<double>(sorted[i]) - p;
      const double along = axis == 0 ? way.x : axis == 1 ? way.y : way.z;
      if (along * along > nearest.farthest()) return false;
      nearest.offer(dot(way, way), sorted[i]);
      return true;
    };
    for (std::size_t i = at + 1; i < std::min(sorted.size(), at + most_looked_at); ++i)
      if (!look(i)) break;
    for (std::size_t i = at; i-- > (at > most_looked_at ? at - most_looked_at : 0);)
      if (!look(i)) break;
    if (nearest.squared() > 0) found.push_back(nearest.squared());
  }
  if (found.empty()) return 0;
  std::nth_element(found.begin(), found.begin() + std::ptrdiff_t(found.size() / 2), found.end());
  return std::sqrt(found[found.size() / 2]);
}

/// Which of `sums` each point belongs to, by its colour; nothing where that would need too many.
std::vector<std::uint32_t> group_by_color(const std::vector<std::array<float, 4>>& colors, int bits) {
  VertexTable table;
  std::vector<std::uint32_t> group;
  group.reserve(colors.size());
  // By its root, about as the eye tells colours apart.
  const auto code = [&](float x) {
    return std::uint32_t(std::sqrt(std::clamp(double(x), 0.0, 1.0)) * 1023 + 0.5) >> (10 - bits);
  };
  for (const auto& c : colors) {
    group.push_back(table.index_of({code(c[0]), code(c[1]), code(c[2]), 0}));
    if (table.size() > most_materials) return {};
  }
  return group;
}

}  // namespace

double point_radius(const std::vector<Vec3<float>>& points) {
  const double distance = points.size() < 2 ? 0 : spacing(points, points.size() < 64 ? 1 : 4);
  return distance > 0 ? std::clamp(0.75 * distance, positive.min, largest_coordinate) : 1;
}

void add_points(Model& model, const std::string& name, const std::vector<Vec3<float>>& points,
                const std::vector<std::array<float, 4>>& colors) {
  const double radius = point_radius(points);
  std::vector<Sphere> spheres;
  spheres.reserve(points.size());
  for (const Vec3<float>& point : points) spheres.push_back({cast<double>(point), radius});
  Shape shape;
  shape.name = name;
  shape.primitives = std::move(spheres);
  const auto first = std::uint32_t(model.materials.size());
  if (colors.empty()) {
    model.materials.push_back(neutral_material());
  } else {
    std::vector<std::uint32_t> group;
    for (int bits = 10; group.empty() && bits >= 4; --bits) group = group_by_color(colors, bits);
    std::vector<Rgb> sums(most_materials);
    std::vector<double> counts(most_materials);
    for (std::size_t i = 0; i < colors.size(); ++i) {
      for (int c = 0; c < 3; ++c) sums[group[i]][c] += colors[i][std::size_t(c)];
      ++counts[group[i]];
    }
    for (std::size_t i = 0; i < sums.size() && counts[i] > 0; ++i) {
      Material material = neutral_material();
      material.name = "points " + std::to_string(i + 1);
      material.ambient = material.diffuse = sums[i] / counts[i];
      model.materials.push_back(std::move(material));
    }
    if (model.materials.size() - first > 1) {
      for (std::uint32_t& index : group) index += first;
      shape.material_of_primitive = std::move(group);
    }
  }
  if (first > 0 && shape.material_of_primitive.empty())
    shape.material_of_primitive.assign(points.size(), first);
  model.shapes.push_back(std::move(shape));
}

}  // namespace lambent
