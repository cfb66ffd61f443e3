#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "compare.h"
#include "console.h"
#include "files.h"
#include "interrupt.h"
#include "lambent/explain.h"
#include "lambent/lambent.h"
#include "lambent/sheet.h"
#include "nearest.h"
#include "progress.h"

namespace lambent::app {

namespace {

/// Pictures of a size that was not asked for are at most this wide: two or three of them fit a screen.
constexpr int widest_picture = 480;
constexpr std::size_t most_warnings = 20;

// ---- which models
// -----------------------------------------------------------------------------------------------------

const std::vector<Entry>& all_models() {
  for (const Topic& topic : catalogue())
    if (topic.name == "models") return topic.entries;
  throw Failure("the catalogue lists no models");
}

/// What the catalogue says of the models named; of all of them where none is.
std::vector<Entry> models_named(const std::vector<std::string>& names) {
  if (names.empty()) return all_models();
  std::vector<std::string> known;
  for (const Entry& entry : all_models()) known.push_back(entry.name);
  std::vector<Entry> models;
  for (const std::string& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      const std::string hint = did_you_mean(name, known);
      throw usage_error(fmt::format("unknown model '{}'", name),
                        hint.empty() ? fmt::format("known are {}", fmt::join(known, ", ")) : hint);
    }
    if (std::count(names.begin(), names.end(), name) > 1)
      throw usage_error(fmt::format("the model '{}' is named twice", name));
    models.push_back(all_models()[std::size_t(found - known.begin())]);
  }
  return models;
}

// ---- what is rendered
// -------------------------------------------------------------------------------------------------

/// Everything that makes the picture of `model`, in the order in which it is set.
LoadOptions options_for(const CompareCommand& command, const Entry& model, const std::string& size) {
  LoadOptions options = command.load;
  auto& settings = options.set;
  settings.emplace_back("image.size", size);
  settings.emplace_back("illumination.model", model.name);
  if (command.own_attenuation) {
    settings.emplace_back("illumination.attenuation", model.attenuation);
    settings.emplace_back("illumination.ambient_attenuation", model.ambient_attenuation);
  }
  return options;
}

/// The materials that name another model than the scene's keep it, and so look alike in all pictures.
void warn_of_materials(const SceneSummary& scene, const std::string& model) {
  std::vector<std::string> names;
  for (const SceneSummary::Item& material : scene.materials)
    if (material.kind != model) names.push_back(fmt::format("'{}'", material.name));
  if (names.empty()) return;
  constexpr std::size_t most_names = 5;
  const std::size_t shown = std::min(most_names, names.size());
  Diagnostic warning;
  warning.severity = Severity::warning;
  warning.place.file = scene.name;
  warning.message =
      fmt::format("{} a model of {} own and {} it in every picture: {}{}",
                  names.size() == 1 ? "a material names" : fmt::format("{} materials name", names.size()),
                  names.size() == 1 ? "its" : "their", names.size() == 1 ? "keeps" : "keep",
                  fmt::join(names.begin(), names.begin() + std::ptrdiff_t(shown), ", "),
                  shown < names.size() ? ", ..." : "");
  report(warning);
}

/// The picture of one model, and what is to be said of it.
struct Rendered {
  Entry model;
  RenderResult result;
  std::string fading;  ///< How light fades in this scene, where that is not the model's own; else empty.
};

/// "attenuation 1/r, ambient attenuation none", where the scene says so and the model on its own does not.
std::string fading_of(const SceneSummary& scene, const Entry& model) {
  const std::string own = fmt::format("{}, attenuation {}, ambient attenuation {}", model.name,
                                      model.attenuation, model.ambient_attenuation);
  return scene.model == own ? "" : scene.model.substr(std::min(scene.model.size(), model.name.size() + 2));
}

// ---- the sheet
// --------------------------------------------------------------------------------------------------------

/// "+0.25": a number with its sign, for people.
std::string with_sign(double value) { return fmt::format("{:+.3g}", value); }

/// The same with the minus sign of print, for a picture.
std::string in_print(std::string text) {
  if (text.starts_with('-')) text.replace(0, 1, "\u2212");
  return text;
}

SheetCell cell_of(const Rendered& one) {
  SheetCell cell;
  cell.picture = one.result.image;
  cell.title = one.model.name;
  cell.subtitle = one.model.equation;
  if (!one.fading.empty()) cell.subtitle += "\nin this scene: " + one.fading;
  return cell;
}

SheetCell cell_of(const SignedDifference& difference, const std::string& model, const std::string& first,
                  double limit, bool encoded) {
  SheetCell cell;
  cell.picture = difference_picture(difference.values, limit, encoded);
  cell.title = fmt::format("{} \u2212 {}", model, first);
  cell.subtitle = difference.largest == 0
                      ? "no difference"
                      : fmt::format("largest {} at {},{}", in_print(with_sign(difference.largest)),
                                    difference.x, difference.y);
  return cell;
}

SheetCell cell_of_scale(double limit, const std::string& first) {
  SheetCell cell;
  cell.color_bar = limit;
  cell.title = "difference of luminance";
  cell.subtitle = fmt::format("orange: brighter than {}, blue: darker", first);
  return cell;
}

/// "1280 × 720 pixels, 16 samples per pixel".
std::string details_of(const SceneSummary& scene, const std::vector<Rendered>& pictures) {
  bool fewer = false;  // adaptive samples: the scene's number is the most that a pixel may get
  for (const Rendered& one : pictures) fewer = fewer || one.result.stats.samples_per_pixel < scene.samples;
  return fmt::format("{} \u00d7 {} pixels, {}{} per pixel", scene.width, scene.height, fewer ? "up to " : "",
                     counted(std::size_t(scene.samples), "sample"));
}

// ---- the table
// --------------------------------------------------------------------------------------------------------

/// `word` as a shell takes it for one word.
std::string in_shell(const std::string& word) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./:,=@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// The options, but for --set, that `load` comes of.
std::string words_for(const LoadOptions& load) {
  const LoadOptions usual;
  std::string words;
  const auto add = [&](const std::string& option, const std::string& value) {
    words += " " + option + " " + in_shell(value);
  };
  if (!load.camera.empty()) add("--camera", load.camera);
  if (!load.up.empty()) add("--up", load.up);
  if (!load.ground) words += " --no-ground";
  if (!load.background.empty()) {
    std::string value = load.background;  // a list in a scene file, r,g,b here
    if (value[0] == '[')
      value.erase(
          std::remove_if(value.begin(), value.end(), [](char c) { return c == '[' || c == ']' || c == ' '; }),
          value.end());
    add("--background", value);
  }
  if (load.time) add("--time", fmt::format("{}", *load.time));
  if (load.limits.allow_outside) words += " --allow-outside";
  const auto add_limit = [&](const std::string& option, std::uint64_t value, std::uint64_t default_value) {
    if (value != default_value) add(option, std::to_string(value));
  };
  add_limit("--max-pixels", load.limits.pixels, usual.limits.pixels);
  add_limit("--max-primitives", load.limits.primitives, usual.limits.primitives);
  add_limit("--max-file-bytes", load.limits.file_bytes, usual.limits.file_bytes);
  return words;
}

/// The command that takes one pixel of one of the pictures apart: all that was set is set again.
std::string explain_command(const CompareCommand& command, const Rendered& one, const Image& picture, int x,
                            int y) {
  std::string line =
      fmt::format("lambent explain {} --pixel {},{} --model {} --size {}x{}", in_shell(command.input), x, y,
                  one.model.name, picture.width, picture.height);
  const auto add = [&](const std::string& key, const std::string& value) {
    line += " --set " + in_shell(key + "=" + value);
  };
  line += words_for(command.load);
  for (const auto& [key, value] : command.load.set) {
    if (key != "image.size") add(key, value);
    // --set comes after --model and --size: what replaces all around them would undo them.
    if (key == "image") add("image.size", fmt::format("[{}, {}]", picture.width, picture.height));
    if (key == "illumination") add("illumination.model", one.model.name);
  }
  if (command.own_attenuation) {
    add("illumination.attenuation", one.model.attenuation);
    add("illumination.ambient_attenuation", one.model.ambient_attenuation);
  }
  return line;
}

std::string table_of(const CompareCommand& command, const std::vector<Rendered>& pictures,
                     const std::vector<SignedDifference>& differences) {
  std::size_t widest = 5;
  for (const Rendered& one : pictures) widest = std::max(widest, one.model.name.size());
  std::string text = fmt::format("Difference of luminance, model less {}:\n{:<{}}  {:>9}  {:<9}  {:>9}\n",
                                 pictures[0].model.name, "model", widest, "largest", "at pixel", "mean");
  for (std::size_t i = 0; i < differences.size(); ++i) {
    const Rendered& one = pictures[i + 1];
    const SignedDifference& difference = differences[i];
    if (difference.largest == 0) {
      text += fmt::format("{:<{}}  {:>9}  {:<9}  {:>9}\n", one.model.name, widest, "0", "-", "0");
      continue;
    }
    text +=
        fmt::format("{:<{}}  {:>9}  {:<9}  {:>9}\n", one.model.name, widest, with_sign(difference.largest),
                    fmt::format("{},{}", difference.x, difference.y), with_sign(difference.mean));
    text += "    " + explain_command(command, one, one.result.image, difference.x, difference.y) + "\n";
  }
  return text;
}

/// The pixel of the largest difference of all, derived under both equations.
std::string derivation_of_largest(const CompareCommand& command, const std::vector<Rendered>& pictures,
                                  const std::vector<SignedDifference>& differences, const std::string& size) {
  std::size_t most = 0;
  for (std::size_t i = 1; i < differences.size(); ++i)
    if (std::abs(differences[i].largest) > std::abs(differences[most].largest)) most = i;
  const SignedDifference& at = differences[most];
  if (at.largest == 0) return "";
  std::string text;
  for (const std::size_t i : {std::size_t(0), most + 1}) {
    const Entry& model = pictures[i].model;
    const ScenePtr scene = load_scene(command.input, options_for(command, model, size));
    text += fmt::format("\n---- {} at {},{}\n\n", model.name, at.x, at.y);
    text += explanation(explain(scene, at.x, at.y));
  }
  return text;
}

}  // namespace

std::string sheet_output(const std::string& input, const std::string& suffix) {
  return std::filesystem::path(input).stem().string() + suffix;
}

std::string picture_size(const CompareCommand& command, const SceneSummary& scene) {
  if (!command.size.empty()) return command.size;
  const int width = std::min(scene.width, widest_picture);
  const long height = std::lround(double(scene.height) * width / scene.width);
  return fmt::format("[{}, {}]", width, std::max(1l, height));
}

ExitCode run(const CompareCommand& command) {
  if (command.ladder) return run_ladder(command);
  // Whatever can be known to fail is looked at before the work, not after it.
  const std::vector<Entry> models = models_named(command.models);
  if (command.difference && models.size() < 2)
    throw usage_error("--difference wants two models or more", "for example --models conventional,phong");
  for (const auto& [key, value] : command.load.set)
    if (key == "illumination.model")
      throw usage_error(
          "--set illumination.model says what --models varies",
          fmt::format("for a picture of one model: 'lambent render {} --model {}'", command.input, value));
  const std::vector<std::string> outputs =
      command.outputs.empty() ? std::vector{sheet_output(command.input, "-compare.png")} : command.outputs;
  for (const std::string& output : outputs) check_image_output(output);

  const auto start = std::chrono::steady_clock::now();
  std::string size;
  {
    const ScenePtr scene = load_scene(command.input, command.load);
    const SceneSummary summary = summarize(scene);
    if (summary.integrator.starts_with("view"))
      throw usage_error(
          fmt::format("'{}' shows a {}, which no model changes", command.input, summary.integrator),
          "--set 'integrator={whitted: {}}' shows its colours");
    size = picture_size(command, summary);
    if (!command.quiet) {
      report(warnings(scene), most_warnings);
      warn_of_materials(summary, summary.model.substr(0, summary.model.find(',')));
    }
  }

  const Interruptible interruptible;
  Progress progress(command.quiet);
  std::vector<Rendered> pictures;
  SceneSummary shown;
  for (const Entry& model : models) {
    const ScenePtr scene = load_scene(command.input, options_for(command, model, size));
    shown = summarize(scene);
    RenderOptions options;
    options.threads = command.threads;
    options.progress = [&](double share) {
      progress.update((double(pictures.size()) + share) / double(models.size()));
      return !interrupted();
    };
    pictures.push_back({model, render(scene, options), fading_of(shown, model)});
    if (pictures.back().result.cancelled || interrupted()) throw Failure("interrupted; no file was written");
  }
  progress.finish();

  const RenderResult& first = pictures.front().result;
  const bool encoded = first.write.png_encoded;
  std::vector<SignedDifference> differences;
  double largest = 0;
  if (command.difference)
    for (std::size_t i = 1; i < pictures.size(); ++i) {
      differences.push_back(signed_difference(pictures[i].result.image, first.image));
      for (const float value : differences.back().values.data)
        if (std::isfinite(value)) largest = std::max(largest, std::abs(double(value)));
    }
  const double limit = color_bar_limit(largest);

  std::vector<SheetCell> cells;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    cells.push_back(cell_of(pictures[i]));
    if (!command.difference) continue;
    const std::string& name = models[0].name;
    cells.push_back(i == 0 ? cell_of_scale(limit, name)
                           : cell_of(differences[i - 1], models[i].name, name, limit, encoded));
  }
  SheetOptions options;
  options.title = shown.name;
  options.subtitle = details_of(shown, pictures);
  options.columns = command.columns;
  options.stack = command.difference ? 2 : 1;
  options.encoded = encoded;
  const Sheet sheet = make_sheet(cells, options);

  // The settings of the first picture: those of the others differ from them in the model alone.
  Metadata metadata = first.metadata;
  std::vector<std::string> names;
  for (const Entry& model : models) names.push_back(model.name);
  metadata.emplace_back("lambent:models", fmt::format("{}", fmt::join(names, ", ")));
  for (const std::string& output : outputs)
    write_image(output, sheet.image, metadata, {8, encoded, command.threads});

  if (command.difference)
    print(table_of(command, pictures, differences) +
          derivation_of_largest(command, pictures, differences, size));
  if (!command.quiet) {
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    print_error(fmt::format("{}: {} x {}, {} of {} x {}, {}\n", fmt::join(outputs, ", "), sheet.image.width,
                            sheet.image.height, counted(pictures.size(), "picture"), shown.width,
                            shown.height, duration(seconds.count())));
  }
  return done;
}

}  // namespace lambent::app
