#pragma once
#include "math/vec.h"

namespace lambent {

/// Point `number` of the pattern in which `count` points lie on a light. Each has one of `count` columns and
/// one of `count` rows of equal width for itself, and they lie alike about the centre; k x k points also have
/// a cell each of a grid of k x k (Kensler, Correlated multi-jittered sampling, Pixar technical memo 13-01,
/// 2013, without the jitter). So edges of shadows at any angle have as many steps as there are points.
Vec2<double> point_of_light(int number, int count);

}  // namespace lambent
