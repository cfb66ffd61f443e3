// The whole way of the data: scene -> world and frame -> tiles -> film -> picture.

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>

#include "describe.h"
#include "film/film.h"
#include "integrators/kernels.h"
#include "integrators/prepare.h"
#include "lambent/lambent.h"
#include "scene/scene.h"
#include "scenefile/settings_text.h"
#include "tiles.h"

namespace lambent {
namespace {

class Clock {
 public:
  /// Seconds since the last call, or since the beginning.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::uint64_t(usage.ru_maxrss) * 1024;
}

}  // namespace

const char* version() { return LAMBENT_VERSION; }

std::vector<std::string> available_isas() {
  std::vector<std::string> names;
  for (const Kernel* kernel : kernels()) names.emplace_back(kernel->isa);
  return names;
}

RenderResult render(const ScenePtr& scene, const RenderOptions& options) {
  const Kernel& kernel = choose_kernel(options.isa);
  const int threads =
      options.threads > 0 ? options.threads : std::max(1, int(std::thread::hardware_concurrency()));
  Clock clock;
  RenderResult result;
  Stats& stats = result.stats;
  const auto prepared = prepare(*scene);
  describe(*scene, *prepared, stats);
  stats.seconds.build = clock.lap();
  std::optional<LayerBook> book;
  if (scene->film.layers) book.emplace(*scene, prepared->frame.layers, prepared->frame.samples);
  Film film(scene->image, book ? &*book : nullptr);
  stats.bytes.film = film.values.size() * sizeof(float);
  const double pixels = double(film.width) * film.height;
  const TileOptions tile_options{threads, std::max(1, options.tile_size), options.progress};
  const TileRun run = scene->image.adaptive && scene->image.pattern != Pattern::corners
                          ? render_adaptively(prepared->frame, kernel, scene->image, film, tile_options)
                          : render_tiles(prepared->frame, kernel, film, tile_options);
  stats.seconds.render = clock.lap();

  result.image = develop(std::move(film), scene->image);
  result.metadata = settings_metadata(*scene);
  if (book) result.metadata.insert(result.metadata.end(), book->metadata().begin(), book->metadata().end());
  result.write.png_encoded = scene->image.encoding == Encoding::srgb;
  result.cancelled = run.cancelled;
  const RayCounts& rays = run.counts;
  stats.rays = {rays.eye, rays.eye_hits, rays.reflection, rays.refraction, rays.shadow};
  stats.seconds.develop = clock.lap();
  stats.samples_per_pixel = double(rays.eye) / pixels;
  stats.peak_memory_bytes = peak_memory_bytes();
  stats.threads = threads;
  stats.isa = kernel.isa;
  return result;
}

}  // namespace lambent
