// From a scene to one pixel's reasons.

#include <fmt/format.h>

#include "explain/derivation.h"
#include "explain/write.h"
#include "film/film.h"
#include "lambent/explain.h"
#include "tiles.h"

namespace lambent {
namespace {

/// Which samples a pixel gets. With adaptive samples that depends on its neighbours, and theirs, and with
/// samples until the noise is low on all of them; so the picture is taken.
std::vector<Portion> portions_of_pixel(const Scene& scene, Exposure& exposure, const Kernel& kernel,
                                       int threads, int x, int y) {
  if (!scene.image.is_adaptive() && !is_progressive(scene)) return exposure.portions();
  Film film(scene.image);
  TileOptions options;
  options.threads = thread_count(threads);
  if (is_progressive(scene))
    return render_until(exposure, kernel, scene.path, scene.image, film, options).portions;
  std::vector<int> samples;
  render_adaptively(exposure.at(0).frame, kernel, scene.image, film, options, &samples);
  return {{0, 0, samples[std::size_t(y) * std::size_t(film.width) + std::size_t(x)]}};
}

}  // namespace

DerivationPtr explain(const ScenePtr& scene, int x, int y, const ExplainOptions& options) {
  const ImageSettings& image = scene->image;
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) {
    Diagnostic diagnostic;
    diagnostic.message =
        fmt::format("there is no pixel {},{} in a picture of {} x {}", x, y, image.width, image.height);
    diagnostic.hint =
        fmt::format("pixels go from 0,0 at the top left to {},{}", image.width - 1, image.height - 1);
    throw InputError(diagnostic);
  }
  const Kernel& kernel = choose_kernel(options.isa);
  Exposure exposure(*scene);
  const std::vector<Portion> portions = portions_of_pixel(*scene, exposure, kernel, options.threads, x, y);
  return std::make_shared<Derivation>(derive(scene, exposure, kernel, x, y, portions));
}

int sample_count(const DerivationPtr& derivation) { return int(derivation->samples.size()); }
int central_sample(const DerivationPtr& derivation) { return derivation->central; }
std::vector<float> pixel_of(const DerivationPtr& derivation) {
  return {std::begin(derivation->pixel), std::end(derivation->pixel)};
}
bool adds_up(const DerivationPtr& derivation) { return derivation->adds_up(); }

std::string explanation(const DerivationPtr& derivation, const ExplainText& options) {
  if (options.sample && (*options.sample < 0 || *options.sample >= sample_count(derivation))) {
    Diagnostic diagnostic;
    diagnostic.message = fmt::format("the pixel has no sample {}", *options.sample);
    diagnostic.hint = fmt::format("its samples are 0 to {}", sample_count(derivation) - 1);
    throw InputError(diagnostic);
  }
  if (options.format == ExplainFormat::json) return json_of(*derivation, options.sample);
  const auto page = options.format == ExplainFormat::latex    ? latex_page()
                    : options.format == ExplainFormat::mathml ? html_page()
                                                              : text_page(options.color);
  return page_of(*derivation, options.sample.value_or(derivation->central), *page);
}

std::string ray_trace(const DerivationPtr& derivation) {
  std::string text;
  for (const AskedRay& ray : derivation->asked) {
    const char* kind = ray.kind == RayKind::eye      ? "eye"
                       : ray.kind == RayKind::shadow ? "shadow"
                                                     : "scattered";
    text += fmt::format("{:<9}  {:>12.6g} {:>12.6g} {:>12.6g}  {:>10.6f} {:>10.6f} {:>10.6f}{}\n", kind,
                        ray.ox, ray.oy, ray.oz, ray.dx, ray.dy, ray.dz,
                        ray.kind == RayKind::shadow ? fmt::format("  up to {:.6g}", ray.t_far) : "");
  }
  return text;
}

}  // namespace lambent
