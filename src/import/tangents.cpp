#include "import/tangents.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace lambent {

namespace {

using V = Vec3<double>;

V perpendicular_part(const V& v, const V& unit) { return v - dot(v, unit) * unit; }
V unit_or_zero(const V& v) {
  const double l = length(v);
  return l > 0 ? (1 / l) * v : V{};
}

/// Any unit vector across N: where texture coordinates do not say which.
V across(const V& N) {
  const V axis = std::abs(N.x) < 0.7 ? V{1, 0, 0} : V{0, 1, 0};
  return unit_or_zero(perpendicular_part(axis, N));
}

/// What makes vertices count as one: the bits of their numbers.
using Key = std::array<std::uint32_t, 8>;
struct HashOfKey {
  std::size_t operator()(const Key& key) const {
    std::uint64_t h = 0x9e3779b97f4a7c15u;
    for (const std::uint32_t bits : key) {
      h = (h ^ bits) * 0xd6e8feb86659fd93u;
      h ^= h >> 32;
    }
    return std::size_t(h);
  }
};
std::uint32_t bits_of(float x) { return std::bit_cast<std::uint32_t>(x + 0); }  // 0 and -0 are alike

/// How the image lies on a triangle.
struct Frame {
  V tangent;     ///< Along growing u, of length 1; zero where the image has no extent.
  int side = 0;  ///< 1: normal x tangent is along growing v; -1: against it, the image is mirrored.
};

Frame frame_of(const V& p0, const V& p1, const V& p2, const Vec2<float>& t0, const Vec2<float>& t1,
               const Vec2<float>& t2) {
  const double u1 = double(t1.x) - t0.x, v1 = double(t1.y) - t0.y, u2 = double(t2.x) - t0.x,
               v2 = double(t2.y) - t0.y;
  const double area = u1 * v2 - u2 * v1;
  if (area == 0 || !std::isfinite(area)) return {};
  const int side = area > 0 ? 1 : -1;
  return {unit_or_zero(double(side) * (v2 * (p1 - p0) - v1 * (p2 - p0))), side};
}

template <class T> void append_copy(std::vector<T>& values, std::size_t index) {
  if (values.empty()) return;
  const T value = values[index];
  values.push_back(value);
}

}  // namespace

void make_tangents(Mesh& mesh, int uv_set) {
  const std::vector<Vec2<float>>& uvs = uv_set == 1 ? mesh.uvs2 : mesh.uvs;
  const std::size_t count = mesh.vertices.size();

  std::unordered_map<Key, std::uint32_t, HashOfKey> groups;
  std::vector<std::uint32_t> group(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto &p = mesh.vertices[i], &n = mesh.normals[i];
    const Key key{bits_of(p.x), bits_of(p.y), bits_of(p.z),      bits_of(n.x),
                  bits_of(n.y), bits_of(n.z), bits_of(uvs[i].x), bits_of(uvs[i].y)};
    group[i] = groups.try_emplace(key, std::uint32_t(groups.size())).first->second;
  }

  // Sums over the triangles around a vertex, apart for the two sides.
  std::vector<V> sums[2] = {std::vector<V>(groups.size()), std::vector<V>(groups.size())};
  std::vector<std::int8_t> sides(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    V p[3];
    for (int c = 0; c < 3; ++c) p[c] = cast<double>(mesh.vertices[corners[std::size_t(c)]]);
    const Frame frame = frame_of(p[0], p[1], p[2], uvs[corners[0]], uvs[corners[1]], uvs[corners[2]]);
    sides[t] = std::int8_t(frame.side);
    if (frame.side == 0) continue;
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t vertex = corners[std::size_t(c)];
      const V N = cast<double>(mesh.normals[vertex]);
      const V a = unit_or_zero(perpendicular_part(p[(c + 1) % 3] - p[c], N)),
              b = unit_or_zero(perpendicular_part(p[(c + 2) % 3] - p[c], N));
      const double angle = std::acos(std::clamp(dot(a, b), -1.0, 1.0));
      V& sum = sums[frame.side < 0 ? 1 : 0][group[vertex]];
      sum = sum + angle * unit_or_zero(perpendicular_part(frame.tangent, N));
    }
  }

  // Each vertex takes the side of the first triangle that has one; what differs gets a vertex of its own.
  std::vector<std::int8_t> side_of_vertex(count, 0);
  std::unordered_map<std::uint32_t, std::uint32_t> doubles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (sides[t] == 0) continue;
    for (std::uint32_t& vertex : mesh.triangles[t]) {
      if (side_of_vertex[vertex] == 0) side_of_vertex[vertex] = sides[t];
      if (side_of_vertex[vertex] == sides[t]) continue;
      const auto [found, is_new] = doubles.try_emplace(vertex, std::uint32_t(mesh.vertices.size()));
      if (is_new) {
        append_copy(mesh.vertices, vertex);
        append_copy(mesh.normals, vertex);
        append_copy(mesh.uvs, vertex);
        append_copy(mesh.uvs2, vertex);
        append_copy(mesh.colors, vertex);
        append_copy(group, vertex);
        side_of_vertex.push_back(sides[t]);
      }
      vertex = found->second;
    }
  }

  mesh.tangents.clear();
  mesh.tangents.reserve(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const V N = unit_or_zero(cast<double>(mesh.normals[i]));
    V T = unit_or_zero(perpendicular_part(sums[side_of_vertex[i] < 0 ? 1 : 0][group[i]], N));
    if (T == V{}) T = across(N);
    mesh.tangents.push_back({float(T.x), float(T.y), float(T.z), side_of_vertex[i] < 0 ? -1.f : 1.f});
  }
}

}  // namespace lambent
