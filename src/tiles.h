#pragma once
#include <functional>

#include "film/film.h"
#include "integrators/prepare.h"
#include "integrators/view.h"

namespace lambent {

struct TileRun {
  RayCounts counts;
  bool cancelled = false;
  int samples = 0;                ///< Of each pixel, where all have the same.
  double noise = 0;               ///< Of paths: NoiseSum's. Otherwise 0.
  std::vector<Portion> portions;  ///< Of render_until: which samples each pixel got, in their order.
};

/// Seconds since some moment in the past.
double steady_seconds();

struct TileOptions {
  int threads = 1;
  int tile_size = 32;                    ///< Pixels; at least 1.
  std::function<bool(double)> progress;  ///< As in RenderOptions.
  double time_limit = 0;                 ///< Of render_until, in seconds, as in RenderOptions; 0: none.
  std::function<double()> seconds = steady_seconds;  ///< The clock for it.
};

/// As many threads as are wanted; 0: as many as there are processors.
int thread_count(int wanted);

/// Renders every tile of the film: all samples of the frame. A tile depends on the frame alone.
TileRun render_tiles(const Frame& frame, const Kernel& kernel, Film& film, const TileOptions& options);

/// The same slice by slice of the shutter's time.
TileRun render_slices(Exposure& exposure, const Kernel& kernel, const ImageSettings& settings, Film& film,
                      const TileOptions& options);

/// The same with samples where the picture needs them (settings.adaptive, which must be set): in several goes
/// over the film, each over the pixels that the one before has left uncertain.
///   samples  if not null: how many each pixel got, row by row
TileRun render_adaptively(const Frame& frame, const Kernel& kernel, const ImageSettings& settings, Film& film,
                          const TileOptions& options, std::vector<int>* samples = nullptr);

/// The same in passes, until the picture's noise is no more than `settings.until`, where that is above 0,
/// each pixel has `settings.max_samples`, or the time is spent. The first pass has `image.samples`, the next
/// as many as the noise lets one expect to be needed, or as many again. With a limit in time they begin with
/// a single sample, and no pass is begun that would go beyond the limit by what a sample took in the last.
/// Where something moves, each slice of the shutter's time gets as many samples. A pixel depends on how many
/// it got; where something moves, in its last digits also on where the passes ended, which the number tells.
TileRun render_until(Exposure& exposure, const Kernel& kernel, const PathSettings& settings,
                     const ImageSettings& image, Film& film, const TileOptions& options);

/// Renders a view in place of the colours: `samples` samples of every pixel, the first of the frame's.
struct ViewRun {
  TileRun tiles;
  std::uint64_t most_rays = 0;  ///< Of View::rays: those of the pixel that asked the most. Otherwise 0.
};
ViewRun render_view(const Frame& frame, const Kernel& kernel, const ViewRecord& view, int samples, Film& film,
                    const TileOptions& options);

}  // namespace lambent
