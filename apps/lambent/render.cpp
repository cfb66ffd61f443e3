#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "commands.h"
#include "console.h"
#include "files.h"
#include "interrupt.h"
#include "lambent/denoise.h"
#include "lambent/lambent.h"
#include "numbered.h"
#include "progress.h"

namespace lambent::app {

namespace {

constexpr std::size_t most_warnings = 20;

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::string default_output(const std::string& input, bool numbered, const std::string& ending) {
  std::string name = std::filesystem::path(input).stem().string();
  if (!numbered) return name + ending;
  for (std::size_t at = 0; (at = name.find('%', at)) != std::string::npos; at += 2) name.insert(at, "%");
  return name + "-%04d" + ending;
}

/// The statistics of all pictures from those of each: sums, but for what does not change from one to the
/// next, or is a mean or the most.
void add(Stats& sum, const Stats& one, int frames_before) {
  const auto rays = sum.rays;
  const auto seconds = sum.seconds;
  const double samples = sum.samples_per_pixel * frames_before;
  sum = one;
  sum.rays.eye += rays.eye;
  sum.rays.eye_hits += rays.eye_hits;
  sum.rays.reflection += rays.reflection;
  sum.rays.refraction += rays.refraction;
  sum.rays.shadow += rays.shadow;
  sum.seconds.parse = seconds.parse;
  sum.seconds.build += seconds.build;
  sum.seconds.render += seconds.render;
  sum.seconds.develop += seconds.develop;
  sum.seconds.denoise = seconds.denoise;
  sum.seconds.write = seconds.write;
  sum.noise = std::max(sum.noise, one.noise);
  sum.samples_per_pixel = (samples + one.samples_per_pixel) / (frames_before + 1);
}

std::string stats_as_json(const Stats& stats) {
  nlohmann::ordered_json json;
  json["rays"] = {{"eye", stats.rays.eye},
                  {"eye_hits", stats.rays.eye_hits},
                  {"reflection", stats.rays.reflection},
                  {"refraction", stats.rays.refraction},
                  {"shadow", stats.rays.shadow},
                  {"ambient", stats.rays.ambient}};
  json["seconds"] = {{"parse", stats.seconds.parse},     {"build", stats.seconds.build},
                     {"render", stats.seconds.render},   {"develop", stats.seconds.develop},
                     {"denoise", stats.seconds.denoise}, {"write", stats.seconds.write}};
  json["scene"] = {{"primitives", stats.scene.primitives},
                   {"instances", stats.scene.instances},
                   {"trees", stats.scene.trees},
                   {"nodes", stats.scene.nodes},
                   {"lights", stats.scene.lights}};
  json["bytes"] = {{"vertices", stats.bytes.vertices}, {"normals", stats.bytes.normals},
                   {"uvs", stats.bytes.uvs},           {"indices", stats.bytes.indices},
                   {"shapes", stats.bytes.shapes},     {"placed", stats.bytes.placed},
                   {"nodes", stats.bytes.nodes},       {"refs", stats.bytes.refs},
                   {"textures", stats.bytes.textures}, {"film", stats.bytes.film}};
  json["peak_memory_bytes"] = stats.peak_memory_bytes;
  json["samples_per_pixel"] = stats.samples_per_pixel;
  json["noise"] = stats.noise;
  json["tree_quality"] = stats.tree_quality;
  json["threads"] = stats.threads;
  json["isa"] = stats.isa;
  json["version"] = version();
  return json.dump(2) + "\n";
}

/// "950", "1.2 million": few digits, for people.
std::string rounded(std::uint64_t count) {
  if (count < 10'000) return fmt::format("{}", count);
  if (count < 1'000'000) return fmt::format("{:.0f} thousand", double(count) / 1e3);
  return fmt::format("{:.1f} million", double(count) / 1e6);
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// The picture with the denoised one as one more layer: R, G and B stay what was rendered, and what layers
/// add up to.
Image with_layer(const Image& picture, const Image& denoised) {
  Image image;
  image.width = picture.width, image.height = picture.height;
  image.channels = picture.channels;
  for (const char* name : {"denoised.R", "denoised.G", "denoised.B"}) image.channels.emplace_back(name);
  image.data.reserve(picture.data.size() + denoised.data.size());
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const float *from = picture.pixel(x, y), *more = denoised.pixel(x, y);
      image.data.insert(image.data.end(), from, from + picture.channels.size());
      image.data.insert(image.data.end(), more, more + denoised.channels.size());
    }
  return image;
}

}  // namespace

ExitCode run(const RenderCommand& command) {
  const bool turning = command.turntable > 0;
  constexpr int most_frames = 100'000;
  if (command.turntable > most_frames)
    throw usage_error(fmt::format("--turntable makes {} pictures at most", most_frames));
  const int frames = turning ? command.turntable : 1;
  // Whatever can be known to fail is looked at before the work, not after it.
  const auto names_of = [&](const std::vector<std::string>& outputs) {
    std::vector<std::vector<std::string>> names(static_cast<std::size_t>(frames));
    for (const std::string& output : outputs)
      for (int frame = 0; frame < frames; ++frame) {
        names[std::size_t(frame)].push_back(turning ? NumberedName(output).with(frame) : output);
        check_image_output(names[std::size_t(frame)].back());
      }
    return names;
  };
  std::vector<std::vector<std::string>> outputs = names_of(command.outputs);
  if (!command.stats.empty() && command.stats != "-") check_output(command.stats);

  const Stopwatch total, parsing;
  const ScenePtr scene = load_scene(command.input, command.load);
  Stats stats;
  stats.seconds.parse = parsing.seconds();
  if (command.outputs.empty())
    outputs = names_of({default_output(command.input, turning, wants_layers(scene) ? ".exr" : ".png")});
  if (wants_layers(scene) && std::none_of(outputs[0].begin(), outputs[0].end(),
                                          [](const std::string& output) { return ending(output) == ".exr"; }))
    throw usage_error("layers need an EXR; a PNG holds colours alone", "for example -o layers.exr");
  std::optional<Denoiser> denoiser;
  if (command.denoise) denoiser.emplace(command.threads);
  if (!command.quiet) report(warnings(scene), most_warnings);

  const Interruptible interruptible;
  Progress progress(command.quiet);
  int frame = 0;
  RenderOptions options;
  options.threads = command.threads;
  options.tile_size = command.tile;
  options.isa = command.isa;
  options.time_limit = command.time_limit;
  options.guides = command.denoise;
  options.progress = [&](double share) {
    progress.update((frame + share) / frames);
    return !interrupted();
  };
  std::string size;
  for (; frame < frames; ++frame) {
    RenderResult result = render(turned(scene, 360.0 * frame / frames), options);
    Image denoised;
    if (denoiser && !result.cancelled) {
      const Stopwatch denoising;
      denoised = denoiser->denoise(result.image, result.guides);
      result.image = with_layer(result.image, denoised);
      result.metadata.emplace_back("lambent:denoised", "Open Image Denoise " + denoiser->version());
      stats.seconds.denoise += denoising.seconds();
    }
    if (result.cancelled || interrupted()) {
      progress.finish();
      throw Failure(frame == 0 ? "interrupted; no file was written"
                               : fmt::format("interrupted; {} of {} pictures are written", frame, frames));
    }
    const Stopwatch writing;
    for (const std::string& output : outputs[std::size_t(frame)])
      write_image(output, denoiser && ending(output) == ".png" ? denoised : result.image, result.metadata,
                  {command.bits, result.write.png_encoded, command.threads});
    add(stats, result.stats, frame);
    stats.seconds.write += writing.seconds();
    size = fmt::format("{} x {}", result.image.width, result.image.height);
  }
  progress.finish();
  if (command.stats == "-") print(stats_as_json(stats));
  else if (!command.stats.empty()) write_text_file(command.stats, stats_as_json(stats));

  if (!command.quiet) {
    const std::uint64_t rays = stats.rays.eye + stats.rays.reflection + stats.rays.refraction +
                               stats.rays.shadow + stats.rays.ambient;
    const std::string names =
        frames == 1 ? joined(outputs[0]) : joined(outputs.front()) + " to " + joined(outputs.back());
    print_error(fmt::format("{}: {}, {}, {} rays\n", names, size, duration(total.seconds()), rounded(rays)));
  }
  return done;
}

}  // namespace lambent::app
