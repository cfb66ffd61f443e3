#pragma once
// The shapes of a scene file, made into primitives.

#include <array>
#include <vector>

#include "scene/scene.h"

namespace lambent {

/// A rectangle about `point`, facing `normal`. Its width runs horizontally, at a right angle to the normal
/// (along x where the normal is vertical); its height runs across it.
Mesh rectangle(const Plane& plane, double width, double height);

/// Twelve triangles, facing outward.
Mesh box(const Vec3<double>& lower, const Vec3<double>& upper);

/// The discs that close a cone's ends, facing outward; an end of radius 0 needs none.
std::vector<Disc> caps(const Cone& cone);

/// How far the corners lie from one plane, as a share of the polygon's extent; a negative number if it has no
/// area.
double unevenness(const std::vector<Vec3<double>>& corners);

Mesh polygon(const std::vector<Vec3<double>>& corners);

}  // namespace lambent
