#include "tiles.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace lambent {
namespace {

/// The pixels of a tile in squares of 4 by 4: the rays of a packet then lie close together.
void list_pixels(int x0, int y0, int x1, int y1, std::vector<Pixel>& pixels) {
  constexpr int square = 4;
  pixels.clear();
  for (int y = y0; y < y1; y += square)
    for (int x = x0; x < x1; x += square)
      for (int j = y; j < std::min(y + square, y1); ++j)
        for (int i = x; i < std::min(x + square, x1); ++i) pixels.push_back({i, j});
}

}  // namespace

TileRun render_tiles(const Frame& frame, const Kernel& kernel, int threads, int tile_size, Film& film,
                     const std::function<bool(double)>& progress) {
  const std::int64_t columns = (film.width + tile_size - 1) / tile_size,
                     rows = (film.height + tile_size - 1) / tile_size;
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
      std::vector<Pixel> pixels;
      std::vector<double> sums;
      RayCounts counts;
      for (std::int64_t i; !stop && (i = next++) < tiles;) {
        const int x = int(i % columns) * tile_size, y = int(i / columns) * tile_size;
        list_pixels(x, y, std::min(x + tile_size, film.width), std::min(y + tile_size, film.height), pixels);
        sums.assign(pixels.size() * color_channels, 0);
        kernel.render(frame, {pixels.data(), std::uint32_t(pixels.size()), 0, frame.samples, sums.data()},
                      scratch, counts);
        for (std::size_t p = 0; p < pixels.size(); ++p) {
          float* to = &film.colors[(std::size_t(pixels[p].y) * film.width + pixels[p].x) * color_channels];
          for (int c = 0; c < color_channels; ++c)
            to[c] = float(sums[p * color_channels + c] / frame.samples);
        }
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
