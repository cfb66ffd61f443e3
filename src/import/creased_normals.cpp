#include "import/creased_normals.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "import/vertex_table.h"
#include "math/functions.h"

namespace lambent {

namespace {

/// A corner of a triangle among those at one position.
struct Corner {
  std::uint32_t corner;   ///< 3 * triangle + which of its three.
  std::uint32_t group;    ///< Another corner of its group, by its place in the list; the first names itself.
  Vec3<double> normal{};  ///< Of the triangle; twice as long as its area.
};

/// An edge from the position to another one, as a corner sees it.
struct Spoke {
  std::uint32_t to;      ///< The other position.
  std::uint32_t corner;  ///< Index into the list of corners.
};

std::vector<std::uint32_t> number_positions(const std::vector<Vec3<float>>& vertices, std::uint32_t& count) {
  PositionTable table;
  std::vector<std::uint32_t> result;
  result.reserve(vertices.size());
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x + 0.0f); };  // -0 is 0
  for (const Vec3<float>& v : vertices)
    result.push_back(table.index_of({bits(v.x), bits(v.y), bits(v.z), 0}));
  count = table.size();
  return result;
}

class Creaser {
 public:
  Creaser(Mesh& mesh, double crease)
      : mesh_(mesh), cosine_(sincos_degrees(crease).cos), triangles_(mesh.triangles) {
    position_of_ = number_positions(mesh.vertices, positions_);
    sort_corners();
  }

  /// Whether anything is curved; if so, the mesh has its normals.
  bool run() {
    normals_.resize(mesh_.vertices.size());
    for (std::uint32_t position = 0; position < positions_; ++position) {
      gather(position);
      if (corners_.empty()) continue;
      join();
      hand_out();
    }
    if (!curved_) return false;
    split_vertices();
    mesh_.normals = std::move(normals_);
    mesh_.triangles = std::move(triangles_);
    return true;
  }

 private:
  std::uint32_t vertex_of(std::uint32_t corner) const { return mesh_.triangles[corner / 3][corner % 3]; }

  /// A list of corners for each position, all in one array.
  void sort_corners() {
    first_.assign(std::size_t(positions_) + 1, 0);
    for (const auto& triangle : mesh_.triangles)
      for (const std::uint32_t vertex : triangle) ++first_[position_of_[vertex] + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    sorted_.resize(3 * mesh_.triangles.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t corner = 0; corner < sorted_.size(); ++corner)
      sorted_[next[position_of_[vertex_of(corner)]]++] = corner;
  }

  void gather(std::uint32_t position) {
    corners_.clear();
    spokes_.clear();
    for (std::uint32_t i = first_[position]; i < first_[position + 1]; ++i) {
      const std::uint32_t corner = sorted_[i], here = std::uint32_t(corners_.size());
      const auto& t = mesh_.triangles[corner / 3];
      const auto p = [&](int k) { return cast<double>(mesh_.vertices[t[std::size_t(k)]]); };
      corners_.push_back({corner, here, cross(p(1) - p(0), p(2) - p(0))});
      spokes_.push_back({position_of_[t[(corner + 1) % 3]], here});
      spokes_.push_back({position_of_[t[(corner + 2) % 3]], here});
    }
  }

  /// Finds the groups. Of more than two faces at an edge, each is compared with the one before it.
  void join() {
    std::sort(spokes_.begin(), spokes_.end(), [](const Spoke& a, const Spoke& b) {
      return a.to != b.to ? a.to < b.to : a.corner < b.corner;
    });
    for (std::size_t i = 1; i < spokes_.size(); ++i) {
      if (spokes_[i].to != spokes_[i - 1].to) continue;
      const Vec3<double>&a = corners_[spokes_[i - 1].corner].normal, &b = corners_[spokes_[i].corner].normal;
      const double product = dot(a, b), lengths = std::sqrt(dot(a, a) * dot(b, b));
      if (!(product >= cosine_ * lengths) || lengths == 0) continue;
      // Faces of one plane differ by the rounding of their vertices: 1e-8 is an angle of 0.008 degrees.
      curved_ |= product < (1 - 1e-8) * lengths;
      unite(spokes_[i - 1].corner, spokes_[i].corner);
    }
  }

  std::uint32_t group_of(std::uint32_t i) {
    while (corners_[i].group != i) i = corners_[i].group = corners_[corners_[i].group].group;
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = group_of(a), b = group_of(b);
    corners_[std::max(a, b)].group = std::min(a, b);
  }

  /// One vertex for each group and each of the vertices at this position; the first group keeps the vertex.
  void hand_out() {
    for (std::uint32_t i = 0; i < corners_.size(); ++i) corners_[i].group = group_of(i);
    // In the order of the list, so that the sum is always the same.
    for (std::uint32_t i = 0; i < corners_.size(); ++i) {
      const std::uint32_t group = corners_[i].group;
      if (group != i) corners_[group].normal = corners_[group].normal + corners_[i].normal;
    }
    order_.resize(corners_.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) order_[i] = i;
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
      const std::uint32_t va = vertex_of(corners_[a].corner), vb = vertex_of(corners_[b].corner);
      if (va != vb) return va < vb;
      return corners_[a].group != corners_[b].group ? corners_[a].group < corners_[b].group : a < b;
    });
    std::uint32_t target = 0;
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const Corner& corner = corners_[order_[i]];
      const std::uint32_t vertex = vertex_of(corner.corner);
      const bool new_vertex = i == 0 || vertex != vertex_of(corners_[order_[i - 1]].corner);
      if (new_vertex || corner.group != corners_[order_[i - 1]].group) {
        target = new_vertex ? vertex : std::uint32_t(mesh_.vertices.size() + split_.size());
        if (!new_vertex) split_.push_back(vertex), normals_.push_back({});
        normals_[target] = unit(corners_[corner.group].normal);
      }
      triangles_[corner.corner / 3][corner.corner % 3] = target;
    }
  }

  static Vec3<float> unit(const Vec3<double>& n) {
    const double largest = max_abs(n);
    if (!(largest > 0) || !std::isfinite(largest)) return {};  // the face's own
    return cast<float>(normalize(n / largest));
  }

  void split_vertices() {
    const auto copy = [&](auto& list) {
      if (list.empty()) return;
      list.reserve(list.size() + split_.size());
      for (const std::uint32_t vertex : split_) list.push_back(list[vertex]);
    };
    copy(mesh_.vertices);
    copy(mesh_.uvs);
    copy(mesh_.uvs2);
    copy(mesh_.colors);
    copy(mesh_.tangents);
  }

  Mesh& mesh_;
  double cosine_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::uint32_t positions_ = 0;
  std::vector<std::uint32_t> position_of_;  ///< Of each vertex.
  std::vector<std::uint32_t> first_;        ///< Of each position, the first of its corners in sorted_.
  std::vector<std::uint32_t> sorted_;
  std::vector<std::uint32_t> split_;  ///< Which vertex each one is a copy of that follows the mesh's own.
  std::vector<Vec3<float>> normals_;
  bool curved_ = false;

  // Of the position at hand; kept for their memory.
  std::vector<Corner> corners_;
  std::vector<Spoke> spokes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace

void add_creased_normals(Mesh& mesh, double crease) {
  std::vector<Vec3<float>>().swap(mesh.normals);
  if (mesh.vertices.size() + 3 * std::uint64_t(mesh.triangles.size()) >= std::uint64_t(1) << 32) return;
  Creaser(mesh, crease).run();
}

}  // namespace lambent
