#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace lambent {

/// Cuts a simple polygon, convex or concave, into points.size() - 2 triangles by ear clipping in its plane
/// (Newell's normal). Indices into `points`; the triangles turn the way the polygon does. Polygons that cross
/// themselves or have no area still give that many triangles, in some order, and never fail. Fewer than three
/// points give none.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Vec3<double>> points);

/// Newell's normal of a polygon, not normalised: its length is twice the area. Zero for fewer than three
/// points.
Vec3<double> newell_normal(std::span<const Vec3<double>> points);

}  // namespace lambent
