#pragma once
#include <functional>

#include "film/film.h"
#include "integrators/frame.h"

namespace lambent {

struct TileRun {
  RayCounts counts;
  bool cancelled = false;
};

struct TileOptions {
  int threads = 1;
  int tile_size = 32;                    ///< Pixels; at least 1.
  std::function<bool(double)> progress;  ///< As in RenderOptions.
};

/// Renders every tile of the film: all samples of the frame. A tile depends on the frame alone.
TileRun render_tiles(const Frame& frame, const Kernel& kernel, Film& film, const TileOptions& options);

/// The same with samples where the picture needs them (settings.adaptive, which must be set): in several goes
/// over the film, each over the pixels that the one before has left uncertain.
///   samples  if not null: how many each pixel got, row by row
TileRun render_adaptively(const Frame& frame, const Kernel& kernel, const ImageSettings& settings, Film& film,
                          const TileOptions& options, std::vector<int>* samples = nullptr);

}  // namespace lambent
