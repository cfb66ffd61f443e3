#pragma once
// What a frame consists of, counted.

#include "integrators/prepare.h"
#include "lambent/lambent.h"
#include "scene/scene.h"

namespace lambent {

/// Fills stats.scene, stats.bytes (but for the film's) and stats.tree_quality.
void describe(const Scene& scene, const PreparedFrame& prepared, Stats& stats);

}  // namespace lambent
