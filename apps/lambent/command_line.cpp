// The command line. CLI11 takes it apart and writes the help; what is wrong is said in the program's own
// words.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>

#include "commands.h"
#include "console.h"
#include "files.h"
#include "lambent/lambent.h"
#include "nearest.h"

namespace lambent::app {

namespace {

/// Where the descriptions begin in the help; they stay within 80 columns, which CLI11 leaves to us.
constexpr int help_column = 26;

// ---- values
// -----------------------------------------------------------------------------------------------------------

/// All of `text` as a number; false where it is none.
template <class Number> bool read_number(std::string_view text, Number& number) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end;
}

CLI::Option* add_integer(CLI::App* command, const std::string& name, int& value, int min,
                         const std::string& description) {
  const auto read = [name, &value, min](const std::string& text) {
    if (!read_number(text, value) || value < min)
      throw usage_error(fmt::format("{} wants a whole number, {} or more, not '{}'", name, min, text));
  };
  return command->add_option_function<std::string>(name, read, description)->type_name("N");
}

void add_bits(CLI::App* command, int& bits) {
  const auto read = [&bits](const std::string& text) {
    if (text != "8" && text != "16") throw usage_error(fmt::format("--bits is 8 or 16, not '{}'", text));
    bits = text == "8" ? 8 : 16;
  };
  command->add_option_function<std::string>("--bits", read, "Bits per channel of a PNG, 8 (default) or 16")
      ->type_name("8|16");
}

using Settings = std::vector<std::pair<std::string, std::string>>;

/// "640x480" as the scene file says it: "[640, 480]".
std::string size_as_yaml(const std::string& text) {
  const std::size_t cross = text.find('x');
  int width = 0, height = 0;
  if (cross == std::string::npos || !read_number(std::string_view(text).substr(0, cross), width) ||
      !read_number(std::string_view(text).substr(cross + 1), height) || width < 1 || height < 1)
    throw usage_error(fmt::format("--size wants width x height in pixels, not '{}'", text),
                      "for example --size 1280x720");
  return fmt::format("[{}, {}]", width, height);
}

std::pair<std::string, std::string> split_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw usage_error(fmt::format("--set wants path.to.key=value, not '{}'", text),
                      "for example --set image.samples=16");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

// ---- commands
// ---------------------------------------------------------------------------------------------------------

CLI::App* add_command(CLI::App& program, const std::string& name, const std::string& description,
                      const std::string& examples) {
  CLI::App* command = program.add_subcommand(name, description);
  command->footer("Examples:\n" + examples);
  return command;
}

/// What is said of the scene. The shorthands of --set come before the --set options, so that these have the
/// last word.
struct Shorthands {
  LoadOptions load;
  Settings settings;
  std::vector<std::string> set;
  double time_limit = 0;  ///< Seconds; 0: none.
};

void add_input(CLI::App* command, std::string& input) {
  command
      ->add_option("INPUT", input, "A scene (.yaml, .json) or a model (.obj, .gltf, .glb,\n.ply, .stl, .nff)")
      ->required()
      ->type_name("");
}

void add_samples(CLI::App* command, Shorthands& shorthands) {
  const auto samples = [&](const std::string& text) {
    int number = 0;
    if (!read_number(text, number) || number < 1)
      throw usage_error(fmt::format("--samples wants a whole number, 1 or more, not '{}'", text));
    shorthands.settings.emplace_back("image.samples", text);
  };
  command->add_option_function<std::string>("--samples", samples, "Rays through each pixel")->type_name("N");
}

void add_set(CLI::App* command, Shorthands& shorthands) {
  command
      ->add_option("--set", shorthands.set,
                   "Set anything that the scene file can say:\npath.to.key=value; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_threads(CLI::App* command, int& threads) {
  add_integer(command, "--threads", threads, 0, "Threads to work with (default 0: one per\nprocessor)");
}

void add_quiet(CLI::App* command, bool& quiet) {
  command->add_flag("-q,--quiet", quiet, "Say nothing but errors");
}

LoadOptions options_of(const Shorthands& shorthands) {
  LoadOptions options = shorthands.load;
  options.set = shorthands.settings;
  for (const std::string& setting : shorthands.set) options.set.push_back(split_setting(setting));
  return options;
}

/// "64M" as a number; 0 where it is none, or none that a limit can be.
std::uint64_t limit_of(std::string_view text) {
  double factor = 1;
  if (!text.empty()) {
    constexpr std::string_view suffixes = "kMG";
    const std::size_t suffix = suffixes.find(text.back());
    if (suffix != std::string_view::npos) {
      factor = std::pow(1000.0, double(suffix + 1));
      text.remove_suffix(1);
    }
  }
  double number = 0;
  if (!read_number(text, number) || !(number * factor >= 1) || !(number * factor < 0x1p63)) return 0;
  return std::uint64_t(number * factor);
}

/// What reading the input may do, of every command that reads scenes or models.
void add_reading_options(CLI::App* command, LoadOptions& load) {
  constexpr const char* group = "Reading";
  const auto time = [&load](const std::string& text) {
    double seconds = 0;
    if (!read_number(text, seconds) || !std::isfinite(seconds))
      throw usage_error(fmt::format("--time wants a number of seconds, not '{}'", text));
    load.time = seconds;
  };
  command->add_option_function<std::string>("--time", time, "The pose of an animated model, in seconds")
      ->type_name("T")
      ->group(group);
  command
      ->add_flag("--allow-outside", load.limits.allow_outside,
                 "Let files name others that lie outside of\ntheir own folder")
      ->group(group);
  const auto limit = [&](const std::string& name, std::uint64_t& value, const std::string& description) {
    const auto read = [name, &value](const std::string& text) {
      value = limit_of(text);
      if (value == 0)
        throw usage_error(fmt::format("{} wants a number, 1 or more, not '{}'", name, text),
                          "k, M and G are thousands, millions and thousand millions: 64M");
    };
    command->add_option_function<std::string>(name, read, description)->type_name("N")->group(group);
  };
  limit("--max-pixels", load.limits.pixels,
        "Refuse larger images (default 268M; k, M and G\nare thousands, ...)");
  limit("--max-primitives", load.limits.primitives, "Refuse larger models (default 500M)");
  limit("--max-file-bytes", load.limits.file_bytes, "Refuse larger files (default 8.6G)");
}

/// "0.2", "0.1,0.2,0.3" (linear) or "#203040" as the scene file says it; the name of an image as it is.
std::string background_of(const std::string& text) {
  const std::string end = ending(text);
  if (end == ".hdr" || end == ".exr" || end == ".png" || end == ".jpg" || end == ".jpeg") return text;
  const auto wrong = [&] {
    return usage_error(fmt::format("--background wants a colour or an image, not '{}'", text),
                       "a colour is a number, r,g,b (linear) or '#rrggbb'; an image ends in .hdr, .exr, .png "
                       "or .jpg");
  };
  if (!text.empty() && text[0] == '#') {
    if (text.size() != 7 || text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
      throw wrong();
    return text;
  }
  std::vector<double> values;
  for (std::size_t begin = 0, stop; begin <= text.size(); begin = stop + 1) {
    stop = std::min(text.find(',', begin), text.size());
    double value = 0;
    if (!read_number(std::string_view(text).substr(begin, stop - begin), value) || !(value >= 0) ||
        !std::isfinite(value))
      throw wrong();
    values.push_back(value);
  }
  if (values.size() == 1) return text;
  if (values.size() != 3) throw wrong();
  return fmt::format("[{}, {}, {}]", values[0], values[1], values[2]);
}

/// How a model is shown, of every command that makes a scene of one.
void add_model_options(CLI::App* command, LoadOptions& load) {
  constexpr const char* group = "Models";
  command
      ->add_option(
          "--camera", load.camera,
          "One of the model's cameras, by its name or\nnumber, or a view: three-quarter, front, back,\n"
          "left, right, top")
      ->type_name("NAME")
      ->group(group);
  command->add_option("--up", load.up, "Which axis points up, y or z (default: as the\nformat has it)")
      ->type_name("y|z")
      ->group(group);
  command
      ->add_flag_callback(
          "--no-ground", [&load] { load.ground = false; }, "No floor under the model")
      ->group(group);
  command
      ->add_option_function<std::string>(
          "--background", [&load](const std::string& text) { load.background = background_of(text); },
          "A colour (0.2, r,g,b or '#rrggbb') or an image\n(.hdr, .exr, .png, .jpg); of scenes, too")
      ->type_name("COLOR|FILE")
      ->group(group);
}

/// "0.01", "30s", "256spp": when path tracing ends.
void go_on_until(const std::string& text, Shorthands& shorthands) {
  double number = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string unit(stop, text.data() + text.size());
  const auto set = [&](const char* key, const std::string& value) {
    shorthands.settings.emplace_back(std::string("integrator.path.") + key, value);
  };
  constexpr int most_samples = 1 << 20;
  const double factor = unit == "s" ? 1 : unit == "m" || unit == "min" ? 60 : unit == "h" ? 3600 : 0;
  const bool is_number = error == std::errc() && number > 0 && std::isfinite(number);
  if (is_number && unit.empty() && number <= 1) return set("until", text);
  if (is_number && factor > 0) {
    shorthands.time_limit = number * factor;
    return set("progressive", "true");
  }
  if (is_number && unit == "spp" && number == std::floor(number) && number <= most_samples) {
    set("max_samples", fmt::format("{:.0f}", number));
    return set("progressive", "true");
  }
  throw usage_error(
      fmt::format("--until wants a share of noise, a time or a number of samples, not '{}'", text),
      "for example 0.01 (the noise is 1 %), 30s, 5min, 2h, or 256spp (samples per pixel)");
}

/// What may be said of the scene on the command line, of every command that renders.
void add_scene_options(CLI::App* command, Shorthands& shorthands) {
  const auto shorthand = [&shorthands](const std::string& key, std::string (*as_yaml)(const std::string&)) {
    return [&shorthands, key, as_yaml](const std::string& text) {
      shorthands.settings.emplace_back(key, as_yaml(text));
    };
  };
  command
      ->add_option_function<std::string>("--size", shorthand("image.size", size_as_yaml),
                                         "Width and height in pixels")
      ->type_name("WxH");
  add_samples(command, shorthands);
  command
      ->add_option_function<std::string>(
          "--model", shorthand("illumination.model", [](const std::string& text) { return text; }),
          "Illumination model ('lambent list models')")
      ->type_name("NAME");
  command
      ->add_option("--integrator", shorthands.load.integrator,
                   "Who makes the picture: whitted, path, ...\n('lambent list integrators')")
      ->type_name("NAME");
  command
      ->add_option_function<std::vector<std::string>>(
          "--until",
          [&shorthands](const std::vector<std::string>& limits) {
            for (const std::string& limit : limits) go_on_until(limit, shorthands);
          },
          "Path tracing until the noise is that share of\nthe picture (0.01 is 1 %), for a time (30s, "
          "5min),\n"
          "or to so many samples (256spp); may be repeated:\nwhichever comes first")
      ->type_name("LIMIT")
      ->allow_extra_args(false);
  add_set(command, shorthands);
  add_model_options(command, shorthands.load);
  add_reading_options(command, shorthands.load);
}

CLI::App* add_render(CLI::App& program, RenderCommand& render, Shorthands& shorthands) {
  CLI::App* command =
      add_command(program, "render", "Render a scene or a model to a picture",
                  "  lambent render scene.yaml\n"
                  "  lambent render bunny.obj -o bunny.png -o bunny.exr --size 800x600\n"
                  "  lambent render bunny.obj --turntable 36 -o out/%03d.png\n"
                  "  lambent render scene.yaml --samples 16 --set lights.key.point.intensity=4");
  add_input(command, render.input);
  command
      ->add_option("-o,--output", render.outputs,
                   "Picture to write, .png or .exr; may be repeated\n(default: INPUT's name with .png, or "
                   ".exr for\nlayers, here)")
      ->type_name("FILE")
      ->allow_extra_args(false);
  add_scene_options(command, shorthands);
  add_integer(command, "--turntable", render.turntable, 1,
              "N pictures, the camera going once around;\n-o then has a place for their numbers, from 0:\n"
              "out/%04d.png (default: INPUT's name with\n-%04d.png)");
  const auto view = [&shorthands](const std::string& text) {
    shorthands.settings.emplace_back("integrator.view.show", text);
  };
  command
      ->add_option_function<std::string>("--view", view,
                                         "Not colours, but what rays meet or how many\nthere are: normals, "
                                         "depth, ... ('lambent list\nintegrators view')")
      ->type_name("NAME");
  add_threads(command, render.threads);
  add_integer(command, "--tile", render.tile, 1,
              "Width of the tiles that threads take, in\npixels (default 32)");
  command
      ->add_option("--isa", render.isa,
                   "Instruction set of the kernels: " + fmt::format("{}", fmt::join(available_isas(), ", ")))
      ->type_name("NAME");
  add_bits(command, render.bits);
  const auto layers = [&shorthands](std::int64_t) {
    shorthands.settings.emplace_back("film.layers", "true");
  };
  command->add_flag_function(
      "--layers", layers,
      "Write to the EXR what the colours are made of,\nterm by term and light by light, too");
  command->add_flag(
      "--denoise", render.denoise,
      "Take the noise away, by Open Image Denoise: what\na PNG shows; in an EXR the layer 'denoised'");
  command
      ->add_option("--stats", render.stats,
                   "Write as JSON what went where: rays by kind,\nseconds by stage, bytes by what they "
                   "hold;\n- is standard output")
      ->type_name("FILE");
  add_quiet(command, render.quiet);
  return command;
}

/// "phong,conventional" as its names.
std::vector<std::string> names_in(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t begin = 0, end; begin <= text.size(); begin = end + 1) {
    end = std::min(text.find(',', begin), text.size());
    names.push_back(text.substr(begin, end - begin));
    if (names.back().empty())
      throw usage_error(fmt::format("--models wants names with commas between them, not '{}'", text),
                        "for example --models conventional,phong");
  }
  return names;
}

CLI::App* add_compare(CLI::App& program, CompareCommand& compare, Shorthands& shorthands) {
  CLI::App* command = add_command(program, "compare", "Show a scene under several models, side by side",
                                  "  lambent compare scene.yaml\n"
                                  "  lambent compare scene.yaml --models conventional,phong -o sheet.png\n"
                                  "  lambent compare bunny.obj --difference --size 320x240 --samples 4\n"
                                  "  lambent compare scene.yaml --ladder");
  add_input(command, compare.input);
  command
      ->add_option("-o,--output", compare.outputs,
                   "Sheet to write, .png or .exr; may be repeated\n(default: INPUT's name with -compare.png, "
                   "here)")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      ->add_option_function<std::string>(
          "--models", [&](const std::string& text) { compare.models = names_in(text); },
          "Illumination models, with commas between\nthem (default: all; 'lambent list models')")
      ->type_name("NAMES");
  command
      ->add_option_function<std::string>(
          "--size", [&](const std::string& text) { compare.size = size_as_yaml(text); },
          "Width and height of each picture, in pixels\n(default: the scene's, at most 480 wide)")
      ->type_name("WxH");
  add_samples(command, shorthands);
  add_set(command, shorthands);
  add_model_options(command, shorthands.load);
  add_reading_options(command, shorthands.load);
  add_integer(command, "--columns", compare.columns, 1,
              "Pictures side by side (default: so many that\nthe sheet is near 16:9)");
  command
      ->add_flag("--ladder", compare.ladder,
                 "In place of models, every step from Lambert's\ncosine to path tracing, and what each adds")
      ->excludes(command->get_option("--models"));
  command->add_flag("--difference", compare.difference,
                    "Below each picture, where it is brighter than\nthe first one and where darker; prints a "
                    "table");
  command->add_flag("--own-attenuation", compare.own_attenuation,
                    "Let light fade as each model's equation says,\nnot as the scene does");
  add_threads(command, compare.threads);
  add_quiet(command, compare.quiet);
  return command;
}

CLI::App* add_check(CLI::App& program, CheckCommand& check) {
  CLI::App* command =
      add_command(program, "check", "Say everything that is wrong with scenes or models",
                  "  lambent check scenes/*.yaml\n"
                  "  lambent check model.obj      also what is odd about it and its materials");
  command->add_option("INPUT", check.inputs, "Scenes, models or material libraries")
      ->required()
      ->type_name("");
  add_reading_options(command, check.load);
  return command;
}

CLI::App* add_info(CLI::App& program, InfoCommand& info) {
  CLI::App* command = add_command(program, "info", "Say what is in a scene, a model or a picture",
                                  "  lambent info scene.yaml\n  lambent info bunny.obj\n"
                                  "  lambent info picture.exr --json");
  command
      ->add_option("INPUT", info.input,
                   "A scene, a model, or a picture (.png, .exr,\n.jpg, .hdr, .tga, .bmp)")
      ->required()
      ->type_name("");
  command->add_flag("--json", info.json, "As JSON");
  add_reading_options(command, info.load);
  return command;
}

CLI::App* add_list(CLI::App& program, ListCommand& list) {
  CLI::App* command = add_command(
      program, "list", "List the models, lights, shapes and their parameters",
      "  lambent list\n  lambent list models phong\n  lambent list --schema > lambent.schema.json");
  command->add_option("TOPIC", list.topic, "models, lights, shapes, ...")->type_name("");
  command->add_option("NAME", list.name, "One of the topic")->type_name("");
  command->add_flag("--json", list.json, "As JSON");
  command->add_flag("--schema", list.schema, "The JSON Schema of scene files");
  command->add_flag("--manual", list.manual, "The manual of scene files, as Markdown");
  return command;
}

CLI::App* add_diff(CLI::App& program, DiffCommand& diff) {
  CLI::App* command =
      add_command(program, "diff", "Compare two pictures: exit code 0 if alike, 1 if not",
                  "  lambent diff a.exr b.exr\n  lambent diff a.png b.png -o where.png --tolerance 0.01");
  command->add_option("A", diff.a, "A picture (.png, .exr, .jpg, ...)")->required()->type_name("");
  command->add_option("B", diff.b, "Another of the same size")->required()->type_name("");
  command->add_option("-o,--output", diff.output, "Write |A - B| as a picture")->type_name("FILE");
  const auto tolerance = [&](const std::string& text) {
    if (!read_number(text, diff.tolerance) || !(diff.tolerance >= 0) || !std::isfinite(diff.tolerance))
      throw usage_error(fmt::format("--tolerance wants a number, 0 or more, not '{}'", text));
  };
  command
      ->add_option_function<std::string>("--tolerance", tolerance,
                                         "Largest linear difference that counts as\nalike (default 0)")
      ->type_name("T");
  return command;
}

CLI::App* add_convert(CLI::App& program, ConvertCommand& convert) {
  CLI::App* command = add_command(
      program, "convert", "Make a scene file of a model, a scene for another\nrenderer, or convert a picture",
      "  lambent convert bunny.obj bunny.yaml\n  lambent convert scene.yaml scene.pov\n"
      "  lambent convert picture.exr picture.png --bits 16");
  command
      ->add_option("FROM", convert.from,
                   "A scene, a model, or a picture (.png, .exr,\n.jpg, .hdr, .tga, .bmp)")
      ->required()
      ->type_name("");
  command
      ->add_option(
          "TO", convert.to,
          "A .yaml for a model; a .pov (POV-Ray) or .dat\n(Tachyon) for a scene; else a .png or an .exr")
      ->required()
      ->type_name("");
  command->add_flag("--force", convert.force, "Overwrite a scene file that is there already");
  add_bits(command, convert.bits);
  add_model_options(command, convert.load);
  add_reading_options(command, convert.load);
  return command;
}

CLI::App* add_explain(CLI::App& program, ExplainCommand& explain, Shorthands& shorthands) {
  CLI::App* command = add_command(program, "explain", "Derive one pixel: the equation with its numbers",
                                  "  lambent explain scene.yaml --pixel 320,180\n"
                                  "  lambent explain scene.yaml --pixel 320,180 --model blinn_phong\n"
                                  "  lambent explain scene.yaml --pixel 320,180 --format latex -o pixel.tex");
  add_input(command, explain.input);
  const auto pixel = [&explain](const std::string& text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos || !read_number(std::string_view(text).substr(0, comma), explain.x) ||
        !read_number(std::string_view(text).substr(comma + 1), explain.y))
      throw usage_error(fmt::format("--pixel wants x,y from the top left corner, from 0, not '{}'", text),
                        "for example --pixel 320,180");
  };
  command->add_option_function<std::string>("--pixel", pixel, "Which pixel: from the top left corner, from 0")
      ->required()
      ->type_name("X,Y");
  add_integer(command, "--sample", explain.sample, 0,
              "Which of its samples (default: the nearest to\nits centre; with JSON all)");
  const auto format = [&explain](const std::string& text) {
    static const std::vector<std::string> known{"text", "json", "mathml", "latex"};
    if (std::find(known.begin(), known.end(), text) == known.end())
      throw usage_error(fmt::format("unknown format '{}'", text), [&] {
        const std::string hint = did_you_mean(text, known);
        return hint.empty() ? fmt::format("known are {}", fmt::join(known, ", ")) : hint;
      }());
    explain.format = text;
  };
  command->add_option_function<std::string>("--format", format, "text (default), json, mathml or latex")
      ->type_name("NAME");
  command->add_flag_callback(
      "--json", [&explain] { explain.format = "json"; }, "The same as --format json");
  command->add_flag("--trace", explain.trace, "Every ray that was asked for the pixel, in order");
  command->add_option("-o,--output", explain.output, "Write it to a file")->type_name("FILE");
  add_scene_options(command, shorthands);
  return command;
}

CLI::App* add_relight(CLI::App& program, RelightCommand& relight) {
  CLI::App* command =
      add_command(program, "relight", "Make another picture of layers: other lights",
                  "  lambent render scene.yaml --layers -o layers.exr\n"
                  "  lambent relight layers.exr --light key=0.5 --light 'fill=#ffd0a0' -o out.png");
  command->add_option("INPUT", relight.input, "An EXR that 'lambent render --layers' has made")
      ->required()
      ->type_name("");
  command->add_option("-o,--output", relight.outputs, "Picture to write, .png or .exr; may be repeated")
      ->required()
      ->type_name("FILE")
      ->allow_extra_args(false);
  const auto factors = [&](const char* name, std::vector<std::string>& values, const char* description) {
    command->add_option(name, values, description)->type_name("NAME=FACTOR")->allow_extra_args(false);
  };
  factors("--light", relight.lights, "Multiply a light's colour by a number or a\ncolour; may be repeated");
  factors("--term", relight.terms,
          "Likewise all that comes by one term: ambient,\ndiffuse, specular, emission, background,\n"
          "reflection, refraction");
  factors("--material", relight.materials,
          "Likewise a material's term, as\nNAME.ambient, NAME.diffuse, NAME.specular");
  add_bits(command, relight.bits);
  add_quiet(command, relight.quiet);
  return command;
}

// ---- what is wrong
// ----------------------------------------------------------------------------------------------------

/// A command line that CLI11 refused, in the program's words.
InputError refused(const CLI::App& program, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = program.get_subcommands();
  const CLI::App& command = chosen.empty() ? program : *chosen.front();
  const std::string name = chosen.empty() ? "lambent" : "lambent " + command.get_name();
  const std::string try_help = fmt::format("'{} --help' says how it is used", name);
  const auto hint_or_help = [&](const std::string& hint) { return hint.empty() ? try_help : hint; };

  // What is not known comes first: a misspelt option is often why something else is missing.
  std::string extra;
  for (const std::string& word : program.remaining(true)) {
    if (extra.empty() || (extra[0] != '-' && word.size() > 1 && word[0] == '-')) extra = word;
  }
  if (extra.size() > 1 && extra[0] == '-') {
    const std::string option = extra.substr(0, extra.find('='));
    std::vector<std::string> known;
    for (const CLI::Option* one : command.get_options()) {
      for (const std::string& long_name : one->get_lnames()) known.push_back("--" + long_name);
    }
    return usage_error(fmt::format("unknown option '{}'", option), hint_or_help(did_you_mean(option, known)));
  }
  if (!extra.empty() && chosen.empty()) {
    std::vector<std::string> known;
    for (const CLI::App* one : program.get_subcommands({})) known.push_back(one->get_name());
    std::string hint = did_you_mean(extra, known);
    std::error_code ignored;
    if (hint.empty() && std::filesystem::is_regular_file(extra, ignored))
      hint = fmt::format("did you mean 'lambent render {}'?", extra);
    if (hint.empty()) hint = fmt::format("known are {}", fmt::join(known, ", "));
    return usage_error(fmt::format("unknown command '{}'", extra), hint);
  }
  if (!extra.empty()) return usage_error(fmt::format("'{}' is one too many for '{}'", extra, name), try_help);
  if (dynamic_cast<const CLI::RequiredError*>(&error)) {
    if (chosen.empty()) return usage_error("no command was given", try_help);
    for (const CLI::Option* option : command.get_options()) {
      if (option->get_required() && option->count() == 0)
        return usage_error(fmt::format("{} is missing", option->get_name()), try_help);
    }
  }
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error)) {
    for (const CLI::Option* option : command.get_options()) {
      if (option->get_items_expected_max() == 1 && option->count() > 1)
        return usage_error(fmt::format("{} is given more than once", option->get_name()), try_help);
    }
  }
  return usage_error(error.what(), try_help);
}

}  // namespace

Command parse_command_line(int argc, const char* const* argv) {
  RenderCommand render;
  CompareCommand compare;
  Shorthands shorthands;
  CheckCommand check;
  InfoCommand info;
  ListCommand list;
  DiffCommand diff;
  ConvertCommand convert;
  ExplainCommand explain;
  RelightCommand relight;

  CLI::App program("Lambent renders scenes and models with the classical lighting equation.", "lambent");
  program.set_version_flag("--version", fmt::format("lambent {}", version()), "Print the version");
  program.set_help_flag("-h,--help", "Print this help");
  program.get_formatter()->column_width(help_column);
  program.get_formatter()->label("SUBCOMMAND", "COMMAND");
  program.get_formatter()->label("Subcommands", "Commands");
  program.get_formatter()->label("Positionals", "Arguments");
  program.get_formatter()->label("REQUIRED", "");
  program.require_subcommand(1);
  program.footer(
      "Examples:\n"
      "  lambent render bunny.obj              a picture of a model, lit and framed\n"
      "  lambent convert bunny.obj mine.yaml   a scene file to start from\n"
      "  lambent render mine.yaml -o mine.png --samples 16\n"
      "  lambent explain mine.yaml --pixel 320,180   why that pixel looks so\n"
      "  lambent list models                   the equations there are\n"
      "'lambent COMMAND --help' says more about one command.\n"
      "Exit codes: 0 done, 1 failed, 2 bad input or usage.");
  const CLI::App* is_render = add_render(program, render, shorthands);
  const CLI::App* is_compare = add_compare(program, compare, shorthands);
  const CLI::App* is_check = add_check(program, check);
  const CLI::App* is_info = add_info(program, info);
  const CLI::App* is_list = add_list(program, list);
  const CLI::App* is_diff = add_diff(program, diff);
  const CLI::App* is_convert = add_convert(program, convert);
  const CLI::App* is_explain = add_explain(program, explain, shorthands);
  add_relight(program, relight);

  try {
    program.parse(argc, argv);
  } catch (const CLI::CallForVersion& call) {
    return ShowText{fmt::format("{}\n", call.what())};
  } catch (const CLI::CallForHelp&) {
    return ShowText{program.help()};
  } catch (const CLI::ParseError& error) {
    if (argc < 2) print_error(program.help() + "\n");
    throw refused(program, error);
  }

  if (*is_render) {
    render.load = options_of(shorthands);
    render.time_limit = shorthands.time_limit;
    return render;
  }
  if (*is_explain) {
    if (shorthands.time_limit > 0)
      throw usage_error(
          "a time is no limit for 'explain': which samples a pixel has then is chance",
          "'lambent render --stats -' tells how many they were; then --until 256spp, for example");
    explain.load = options_of(shorthands);
    return explain;
  }
  if (*is_compare) {
    compare.load = options_of(shorthands);
    return compare;
  }
  if (*is_check) return check;
  if (*is_info) return info;
  if (*is_list) {
    if (list.json + list.schema + list.manual > 1)
      throw usage_error("--json, --schema and --manual exclude each other");
    return list;
  }
  if (*is_diff) return diff;
  if (*is_convert) return convert;
  return relight;
}

}  // namespace lambent::app
