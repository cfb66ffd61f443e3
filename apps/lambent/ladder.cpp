// `lambent compare --ladder`: the same scene on every rung from Lambert's cosine to the rendering equation.

#include <fmt/format.h>

#include <chrono>

#include "compare.h"
#include "console.h"
#include "files.h"
#include "interrupt.h"
#include "lambent/sheet.h"
#include "progress.h"

namespace lambent::app {

namespace {

/// A rung: what it is called, what it adds, and what is set for it.
struct Rung {
  const char* title;
  const char* adds;
  const char* integrator;
  std::vector<std::pair<std::string, std::string>> settings;
};

const std::vector<Rung>& rungs() {
  const std::string model = "illumination.model", depth = "integrator.whitted.max_depth",
                    hidden = "illumination.ambient_occlusion";
  static const std::vector<Rung> all{
      {"conventional",
       "Ka Ia + sum Il Kd (N.L)+\nLambert's cosine",
       "whitted",
       {{model, "conventional"}, {depth, "1"}}},
      {"attenuated", "Il becomes Il / r^2\nlights fade", "whitted", {{model, "attenuated"}, {depth, "1"}}},
      {"phong",
       "+ Il / r Ks ((R.V)+)^n,  Ia / R\nthe highlight; the lecture's way to fade",
       "whitted",
       {{model, "phong"}, {depth, "1"}}},
      {"blinn_phong",
       "(R.V)^n becomes (N.H)^n\nBlinn's half-vector",
       "whitted",
       {{model, "blinn_phong"}, {depth, "1"}}},
      {"mirror and glass",
       "+ reflect * (mirror ray) + transmit * (refracted ray)\nwhat a local model leaves out",
       "whitted",
       {{model, "blinn_phong"}}},
      {"ambient light, hidden",
       "Ia becomes A Ia, A the share of the sky that is seen",
       "whitted",
       {{model, "blinn_phong"}, {hidden, "{rays: 4}"}}},
      {"wavelengths",
       "Il, Ka, Kd, Ks, reflect: functions of lambda\na ray for every wavelength, as the lecture asks",
       "spectral",
       {{model, "blinn_phong"}, {hidden, "{rays: 4}"}}},
      {"path, one surface",
       "Le + integral of f Le |N.L| dL\nlights with extent; no ambient term",
       "path",
       {{model, "blinn_phong"}, {"integrator.path.max_depth", "1"}}},
      {"path",
       "Le + integral of f L |N.L| dL\nlight by way of all surfaces: the rendering equation",
       "path",
       {{model, "blinn_phong"}}},
  };
  return all;
}

}  // namespace

ExitCode run_ladder(const CompareCommand& command) {
  const std::vector<std::string> outputs =
      command.outputs.empty() ? std::vector{sheet_output(command.input, "-ladder.png")} : command.outputs;
  for (const std::string& output : outputs) check_image_output(output);
  const auto start = std::chrono::steady_clock::now();
  const ScenePtr scene = load_scene(command.input, command.load);
  const SceneSummary summary = summarize(scene);
  if (!command.quiet) report(warnings(scene), 20);

  const Interruptible interruptible;
  Progress progress(command.quiet);
  std::vector<SheetCell> cells;
  Metadata metadata;
  SceneSummary shown;
  bool encoded = true;
  for (const Rung& rung : rungs()) {
    LoadOptions load = command.load;
    load.integrator = rung.integrator;
    load.set.emplace_back("image.size", picture_size(command, summary));
    load.set.insert(load.set.end(), rung.settings.begin(), rung.settings.end());
    const ScenePtr step = load_scene(command.input, load);
    shown = summarize(step);
    RenderOptions options;
    options.threads = command.threads;
    options.progress = [&](double share) {
      progress.update((double(cells.size()) + share) / double(rungs().size()));
      return !interrupted();
    };
    RenderResult result = render(step, options);
    if (result.cancelled || interrupted()) throw Failure("interrupted; no file was written");
    encoded = result.write.png_encoded;
    if (cells.empty()) metadata = result.metadata;
    SheetCell cell;
    cell.picture = std::move(result.image);
    cell.title = fmt::format("{}  {}", cells.size() + 1, rung.title);
    cell.subtitle = rung.adds;
    cells.push_back(std::move(cell));
  }
  progress.finish();

  SheetOptions options;
  options.title = shown.name;
  options.subtitle = fmt::format("from Lambert's cosine to the rendering equation; {} \u00d7 {} pixels",
                                 shown.width, shown.height);
  options.columns = command.columns;
  options.encoded = encoded;
  const Sheet sheet = make_sheet(cells, options);
  for (const std::string& output : outputs)
    write_image(output, sheet.image, metadata, {8, encoded, command.threads});
  if (!command.quiet) {
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    print_error(fmt::format("{}: {} x {}, {} of {} x {}, {}\n", fmt::join(outputs, ", "), sheet.image.width,
                            sheet.image.height, counted(cells.size(), "picture"), shown.width, shown.height,
                            duration(seconds.count())));
  }
  return done;
}

}  // namespace lambent::app
