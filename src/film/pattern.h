#pragma once
#include <vector>

#include "scene/scene.h"

namespace lambent {

/// Where the rays of a pixel go through, in pixels from its top left corner; (0.5, 0.5) is its centre.
///
/// Stratified: of n samples, each row and each column of an n x n grid holds one, at the middle of its cell;
/// the order within is van der Corput's (so for n a power of two every dyadic box of area 1/n holds one:
/// Hammersley's points, centred). The pattern is the same in every pixel: a picture has no noise. A filter
/// wider than the pixel spreads the points by the inverse of its cumulative weight, so that all samples of a
/// pixel count alike and none is shared between pixels (Ernst, Stamminger, Greiner, Filter importance
/// sampling, 2006).
///   box    the pixel itself
///   tent   weight 1 - |x| over two pixels in width
/// `shift`, in [0, 1), moves all points of the pattern, round about at its ends (Cranley and Patterson,
/// Randomization of number theoretic methods for multiple integration, 1976): the mean over random shifts is
/// the integral over the filter.
std::vector<Vec2<double>> sample_pattern(int samples, Filter filter, const Vec2<double>& shift = {});

/// A pattern of which every beginning of a power of 4 is spread evenly by itself, for samples that are taken
/// in several goes: the first points of Sobol's (0, 2)-sequence in base 2 (Sobol, On the distribution of
/// points in a cube, 1967), moved by half a cell of the first `start` so that these lie evenly about the
/// pixel's centre.
std::vector<Vec2<double>> progressive_pattern(int samples, int start, Filter filter,
                                              const Vec2<double>& shift = {});

}  // namespace lambent
