#pragma once
#include <functional>

#include "film/film.h"
#include "integrators/frame.h"

namespace lambent {

struct TileRun {
  RayCounts counts;
  bool cancelled = false;
};

/// Renders every tile of the film with `threads` threads. Which thread takes which tile is chance, and does
/// not matter: a tile depends on the frame alone. `progress` as in RenderOptions.
TileRun render_tiles(const Frame& frame, const Kernel& kernel, int threads, int tile_size, Film& film,
                     const std::function<bool(double)>& progress);

}  // namespace lambent
