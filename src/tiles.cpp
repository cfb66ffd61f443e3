#include "tiles.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace lambent {

TileRun render_tiles(const Frame& frame, const Kernel& kernel, int threads, int tile_size,
                     const std::function<bool(double)>& progress) {
  const std::int64_t columns = (frame.film_width + tile_size - 1) / tile_size,
                     rows = (frame.film_height + tile_size - 1) / tile_size;
  const std::int64_t tiles = columns * rows;
  std::atomic<std::int64_t> next{0};
  std::atomic<bool> stop{false};
  std::mutex mutex;  // guards what follows
  std::int64_t done = 0;
  TileRun run;
  std::exception_ptr failure;

  const auto work = [&] {
    try {
      Scratch scratch;
      RayCounts counts;
      for (std::int64_t i; !stop && (i = next++) < tiles;) {
        const int x = int(i % columns) * tile_size, y = int(i / columns) * tile_size;
        kernel.render_tile(
            frame,
            {x, y, std::min(x + tile_size, frame.film_width), std::min(y + tile_size, frame.film_height)},
            scratch, counts);
        if (!progress) continue;
        const std::lock_guard lock(mutex);
        if (!stop && !progress(double(++done) / double(tiles))) stop = run.cancelled = true;
      }
      const std::lock_guard lock(mutex);
      run.counts.eye += counts.eye;
      run.counts.eye_hits += counts.eye_hits;
      run.counts.reflection += counts.reflection;
      run.counts.refraction += counts.refraction;
      run.counts.shadow += counts.shadow;
    } catch (...) {
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
      stop = true;
    }
  };
  {
    std::vector<std::jthread> crew;
    for (std::int64_t i = 1; i < std::min<std::int64_t>(threads, tiles); ++i) crew.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
  return run;
}

}  // namespace lambent
