#pragma once
// Points as scanners see them, made to be seen: a small sphere for each.

#include <array>
#include <string>
#include <vector>

#include "import/model.h"

namespace lambent {

/// The radius by which spheres around `points` close up to a surface: 0.75 of the points' spacing. That is
/// the median distance to the fourth nearest neighbour, which is the side of a square in a regular grid and
/// nearly the same, 1.09 / sqrt(points per area), where points lie at random; among fewer than 64 points, to
/// the nearest. A few far outliers move no median. Points at one place count as one. 1 for a single point.
///
/// Some thousand points, evenly chosen, are asked; the answer depends on the points and their order alone.
double point_radius(const std::vector<Vec3<float>>& points);

/// Adds a shape of spheres to `model`, and its materials. Without `colors` (linear R, G, B; one for each
/// point otherwise) that is neutral_material(). Spheres have no colours of their own, so points of like
/// colour share a material: in at most 4096 of them, quantised as finely as that allows, each with the mean
/// of its points' colours. Points must be finite.
void add_points(Model& model, const std::string& name, const std::vector<Vec3<float>>& points,
                const std::vector<std::array<float, 4>>& colors);

}  // namespace lambent
