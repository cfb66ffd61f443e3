#pragma once
// An image in levels of detail, each half as large as the one before.

#include "scene/texture.h"

namespace lambent {

/// Fills texture.levels from the second on, down to one texel, and their texels. The first level, its texels
/// and texture.channels must be there.
///
/// Each level is the one before, halved each way (rounded down, at least 1), by a box filter: an output
/// texel is the mean of exactly the area that it covers. Where a side is odd that is two texels and a bit,
/// so that nothing is left out and nothing moves. Means are taken in linear light: bytes of colour are
/// decoded where texture.srgb says so, and encoded again, rounded to the nearest. Alpha is averaged by
/// itself; colours are not weighted by it, so what a transparent texel hides shines through at its edge as
/// it does when texels are interpolated.
void build_levels(Texture& texture);

}  // namespace lambent
