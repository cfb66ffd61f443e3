#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "console.h"
#include "files.h"
#include "interrupt.h"
#include "lambent/lambent.h"
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

std::string default_output(const std::string& input, const char* ending) {
  return std::filesystem::path(input).filename().replace_extension(ending).string();
}

std::string stats_as_json(const Stats& stats) {
  nlohmann::ordered_json json;
  json["rays"] = {{"eye", stats.rays.eye},
                  {"eye_hits", stats.rays.eye_hits},
                  {"reflection", stats.rays.reflection},
                  {"refraction", stats.rays.refraction},
                  {"shadow", stats.rays.shadow},
                  {"ambient", stats.rays.ambient}};
  json["seconds"] = {{"parse", stats.seconds.parse},
                     {"build", stats.seconds.build},
                     {"render", stats.seconds.render},
                     {"develop", stats.seconds.develop},
                     {"write", stats.seconds.write}};
  json["scene"] = {{"primitives", stats.scene.primitives},
                   {"instances", stats.scene.instances},
                   {"trees", stats.scene.trees},
                   {"nodes", stats.scene.nodes},
                   {"lights", stats.scene.lights}};
  json["bytes"] = {
      {"vertices", stats.bytes.vertices}, {"normals", stats.bytes.normals}, {"uvs", stats.bytes.uvs},
      {"indices", stats.bytes.indices},   {"shapes", stats.bytes.shapes},   {"placed", stats.bytes.placed},
      {"nodes", stats.bytes.nodes},       {"refs", stats.bytes.refs},       {"film", stats.bytes.film}};
  json["peak_memory_bytes"] = stats.peak_memory_bytes;
  json["samples_per_pixel"] = stats.samples_per_pixel;
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

}  // namespace

ExitCode run(const RenderCommand& command) {
  // Whatever can be known to fail is looked at before the work, not after it.
  for (const std::string& output : command.outputs) check_image_output(output);
  if (!command.stats.empty() && command.stats != "-") check_output(command.stats);

  const Stopwatch total, parsing;
  const ScenePtr scene = load_scene(command.input, {command.set});
  const double parse_seconds = parsing.seconds();
  const std::vector<std::string> outputs =
      command.outputs.empty()
          ? std::vector{default_output(command.input, wants_layers(scene) ? ".exr" : ".png")}
          : command.outputs;
  if (command.outputs.empty()) check_image_output(outputs.front());
  if (wants_layers(scene) && std::none_of(outputs.begin(), outputs.end(),
                                          [](const std::string& output) { return ending(output) == ".exr"; }))
    throw usage_error("layers need an EXR; a PNG holds colours alone", "for example -o layers.exr");
  if (!command.quiet) report(warnings(scene), most_warnings);

  const Interruptible interruptible;
  Progress progress(command.quiet);
  RenderOptions options;
  options.threads = command.threads;
  options.tile_size = command.tile;
  options.isa = command.isa;
  options.progress = [&](double share) {
    progress.update(share);
    return !interrupted();
  };
  RenderResult result = render(scene, options);
  progress.finish();
  if (result.cancelled || interrupted()) throw Failure("interrupted; no file was written");

  const Stopwatch writing;
  for (const std::string& output : outputs)
    write_image(output, result.image, result.metadata, {command.bits, result.write.png_encoded});
  Stats& stats = result.stats;
  stats.seconds.parse = parse_seconds;
  stats.seconds.write = writing.seconds();
  if (command.stats == "-") print(stats_as_json(stats));
  else if (!command.stats.empty()) write_text_file(command.stats, stats_as_json(stats));

  if (!command.quiet) {
    const std::uint64_t rays =
        stats.rays.eye + stats.rays.reflection + stats.rays.refraction + stats.rays.shadow + stats.rays.ambient;
    print_error(fmt::format("{}: {} x {}, {}, {} rays\n", joined(outputs), result.image.width,
                            result.image.height, duration(total.seconds()), rounded(rays)));
  }
  return done;
}

}  // namespace lambent::app
