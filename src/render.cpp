// The whole way of the data: scene -> world and frame -> tiles -> film -> picture.

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>

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

/// How many samples of the frame's a view takes: it has no colours by which a pixel could need more.
int view_samples(const ImageSettings& image, const Frame& frame) {
  return image.is_adaptive() ? image.adaptive->start : frame.samples;
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
  const bool is_view = scene->integrator == Integrator::view;
  if (is_view && options.guides) {
    Diagnostic diagnostic;
    diagnostic.message = "a view has no noise that could be taken away";
    diagnostic.hint = "denoising is for integrators that choose by chance: --integrator path";
    throw InputError(diagnostic);
  }
  const int threads = thread_count(options.threads);
  if (options.time_limit > 0 && !is_progressive(*scene)) {
    Diagnostic diagnostic;
    diagnostic.message = "a limit in time is for pictures whose samples go on";
    diagnostic.hint = "integrator: {path: {progressive: true}} is one";
    throw InputError(diagnostic);
  }
  Clock clock;
  RenderResult result;
  Stats& stats = result.stats;
  Exposure exposure(*scene);
  const Frame& frame = exposure.at(0).frame;  // of the first slice; none needs it beyond that
  const int passes = std::max(1, frame.pass_count);
  describe(*scene, exposure.at(0), stats);
  stats.seconds.build = clock.lap();
  std::optional<LayerBook> book;
  if (scene->film.layers) book.emplace(*scene, frame.layers, frame.samples);
  Film film(scene->image, book ? &*book : nullptr, threads);
  if (options.guides) film.guides.resize(std::size_t(film.width) * std::size_t(film.height));
  stats.bytes.film = film.values.size() * sizeof(float) + film.guides.size() * sizeof(GuideSums);
  const double pixels = double(film.width) * film.height;
  const TileOptions tile_options{threads, std::max(1, options.tile_size), options.progress,
                                 options.time_limit};
  ViewRun view;
  if (is_view)
    view = render_view(frame, kernel, view_record(*scene, scene->view), view_samples(scene->image, frame),
                       film, tile_options);
  const TileRun run =
      is_view                  ? view.tiles
      : is_progressive(*scene) ? render_until(exposure, kernel, scene->path, scene->image, film, tile_options)
      : exposure.slices().size() > 1 ? render_slices(exposure, kernel, scene->image, film, tile_options)
      : scene->image.is_adaptive()   ? render_adaptively(frame, kernel, scene->image, film, tile_options)
                                     : render_tiles(frame, kernel, film, tile_options);
  stats.seconds.render = clock.lap();

  if (options.guides) result.guides = develop_guides(film, scene->image);
  result.image = develop(std::move(film), scene->image);
  result.metadata = settings_metadata(*scene);
  if (book) result.metadata.insert(result.metadata.end(), book->metadata().begin(), book->metadata().end());
  if (view.most_rays > 0) result.metadata.emplace_back("lambent:most_rays", std::to_string(view.most_rays));
  if (is_progressive(*scene)) result.metadata.emplace_back("lambent:samples", std::to_string(run.samples));
  result.write.png_encoded = scene->image.encoding == Encoding::srgb;
  result.cancelled = run.cancelled;
  const RayCounts& rays = run.counts;
  stats.rays = {rays.eye, rays.eye_hits, rays.reflection, rays.refraction, rays.shadow, rays.ambient};
  stats.seconds.develop = clock.lap();
  stats.samples_per_pixel = double(rays.eye) / pixels / passes;
  stats.noise = run.noise;
  stats.peak_memory_bytes = peak_memory_bytes();
  stats.threads = threads;
  stats.isa = kernel.isa;
  return result;
}

}  // namespace lambent
