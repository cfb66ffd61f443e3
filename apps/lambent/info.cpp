#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "console.h"
#include "files.h"
#include "lambent/lambent.h"

namespace lambent::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_items = 20;
constexpr int label_width = 12;
constexpr std::size_t widest_name = 40;

std::string dumped(const Json& json) {
  // Names come from files in any encoding; what is not UTF-8 is replaced rather than refused.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// "  label       text", the text wrapped behind the label.
std::string line(std::string_view label, std::string_view text, int width) {
  const std::string lines = wrapped(text, width, 2 + label_width);
  return lines.empty() ? fmt::format("  {}\n", label)
                       : fmt::format("  {:<{}}{}", label, label_width, lines.substr(2 + label_width));
}

bool has_bounds(const SceneSummary& summary) { return summary.lower[0] <= summary.upper[0]; }

// ---- scenes and models
// ------------------------------------------------------------------------------------------------

Json items_as_json(const std::vector<SceneSummary::Item>& items, bool with_primitives) {
  Json json = Json::array();
  for (const SceneSummary::Item& item : items) {
    Json one = {{"name", item.name}, {"kind", item.kind}};
    if (with_primitives) one["primitives"] = item.primitives;
    one["detail"] = item.detail;
    one["place"] = item.place.line > 0 ? Json(to_string(item.place)) : Json(nullptr);
    json.push_back(std::move(one));
  }
  return json;
}

Json textures_as_json(const std::vector<SceneSummary::Image>& textures) {
  Json json = Json::array();
  for (const SceneSummary::Image& texture : textures)
    json.push_back({{"name", texture.name},
                    {"format", texture.format.empty() ? Json(nullptr) : Json(texture.format)},
                    {"width", texture.width},
                    {"height", texture.height},
                    {"channels", texture.channels},
                    {"color", texture.color},
                    {"problem", texture.problem.empty() ? Json(nullptr) : Json(texture.problem)}});
  return json;
}

Json diagnostics_as_json(const std::vector<Diagnostic>& diagnostics) {
  Json json = Json::array();
  for (const Diagnostic& one : diagnostics)
    json.push_back({{"place", to_string(one.place)}, {"message", one.message}, {"hint", one.hint}});
  return json;
}

std::string scene_as_json(const SceneSummary& summary, const std::vector<Diagnostic>& odd) {
  Json json;
  json["name"] = summary.name;
  json["camera"] = summary.camera;
  json["cameras"] = summary.cameras;
  json["image"] = {{"width", summary.width}, {"height", summary.height}, {"samples", summary.samples}};
  json["model"] = summary.model;
  json["integrator"] = summary.integrator;
  json["bounds"] =
      has_bounds(summary) ? Json{{"lower", summary.lower}, {"upper", summary.upper}} : Json(nullptr);
  json["stored"] = {{"triangles", summary.triangles}, {"vertices", summary.vertices},
                    {"spheres", summary.spheres},     {"cones", summary.cones},
                    {"discs", summary.discs},         {"planes", summary.planes}};
  json["shown"] = summary.shown;
  json["objects"] = items_as_json(summary.objects, true);
  json["lights"] = items_as_json(summary.lights, false);
  json["materials"] = items_as_json(summary.materials, false);
  json["textures"] = textures_as_json(summary.textures);
  json["warnings"] = diagnostics_as_json(odd);
  return dumped(json);
}

std::string items_as_text(std::string_view title, const std::vector<SceneSummary::Item>& items, int width) {
  std::string text = line(title, std::to_string(items.size()), width);
  const std::size_t shown = std::min(most_items, items.size());
  std::size_t name_width = 0;
  for (std::size_t i = 0; i < shown; ++i)
    name_width = std::max(name_width, std::min(widest_name, items[i].name.size()));
  for (std::size_t i = 0; i < shown; ++i) {
    const SceneSummary::Item& item = items[i];
    std::string rest = item.kind;
    if (item.primitives > 0)
      rest += fmt::format("{}{}", rest.empty() ? "" : ", ", counted(item.primitives, "primitive"));
    if (!item.detail.empty()) rest += (rest.empty() ? "" : ", ") + item.detail;
    const int indent = 6 + int(name_width);
    std::string lines = wrapped(rest, width, indent);
    if (lines.empty()) lines.push_back('\n');
    // The first line's indent holds the name; a longer name gets a line of its own.
    if (item.name.size() > name_width) text += fmt::format("    {}\n{}", item.name, lines);
    else
      text += fmt::format("    {:<{}}{}", item.name, name_width,
                          lines.size() > 1 ? lines.substr(4 + name_width) : lines);
  }
  if (shown < items.size())
    text += fmt::format("    ... and {} more; --json lists them all\n", items.size() - shown);
  return text;
}

/// Textures as the items that the others are.
std::vector<SceneSummary::Item> texture_items(const std::vector<SceneSummary::Image>& textures) {
  std::vector<SceneSummary::Item> items;
  for (const SceneSummary::Image& texture : textures) {
    SceneSummary::Item& item = items.emplace_back();
    item.name = texture.name;
    item.kind = texture.format;
    if (texture.width > 0)
      item.detail =
          fmt::format("{} x {}, {}, {}", texture.width, texture.height,
                      counted(std::size_t(texture.channels), "channel"), texture.color ? "colour" : "data");
    if (!texture.problem.empty()) item.detail += (item.detail.empty() ? "" : ", ") + texture.problem;
  }
  return items;
}

std::string warnings_as_text(const std::vector<Diagnostic>& odd, int width) {
  if (odd.empty()) return "";
  std::string text = line("warnings", std::to_string(odd.size()), width);
  const std::size_t shown = std::min(most_items, odd.size());
  for (std::size_t i = 0; i < shown; ++i) {
    const std::string place = to_string(odd[i].place);
    text += wrapped((place.empty() ? "" : place + ": ") + odd[i].message, width, 4);
  }
  if (shown < odd.size())
    text += fmt::format("    ... and {} more; --json lists them all\n", odd.size() - shown);
  return text;
}

std::string scene_as_text(const SceneSummary& summary, const std::vector<Diagnostic>& odd, int width) {
  std::string text = summary.name + "\n";
  text += line("camera", summary.camera, width);
  if (!summary.cameras.empty()) {
    std::string names;
    const std::size_t shown = std::min(most_items, summary.cameras.size());
    for (std::size_t i = 0; i < shown; ++i)
      names += fmt::format("{}{}{}", i == 0 ? "" : ", ", i + 1,
                           summary.cameras[i].empty() ? "" : " '" + summary.cameras[i] + "'");
    if (shown < summary.cameras.size()) names += fmt::format(" and {} more", summary.cameras.size() - shown);
    text += line("cameras", "of the model: " + names, width);
  }
  text += line("image",
               fmt::format("{} x {}, {} per pixel", summary.width, summary.height,
                           counted(std::size_t(summary.samples), "sample")),
               width);
  text += line("model", summary.model, width);
  text += line("integrator", summary.integrator, width);
  const double* l = summary.lower;
  const double* u = summary.upper;
  text += line("bounds",
               has_bounds(summary) ? fmt::format("({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})", l[0],
                                                 l[1], l[2], u[0], u[1], u[2])
                                   : "none",
               width);
  std::string stored;
  const auto add = [&](std::uint64_t count, const char* noun) {
    if (count > 0) stored += (stored.empty() ? "" : ", ") + counted(count, noun);
  };
  add(summary.triangles, "triangle");
  if (summary.triangles > 0) stored += fmt::format(" on {} vertices", summary.vertices);
  add(summary.spheres, "sphere");
  add(summary.cones, "cone");
  add(summary.discs, "disc");
  add(summary.planes, "plane");
  text += line("stored", stored.empty() ? "nothing" : stored, width);
  text += line("shown", counted(summary.shown, "primitive"), width);
  text += items_as_text("objects", summary.objects, width);
  text += items_as_text("lights", summary.lights, width);
  text += items_as_text("materials", summary.materials, width);
  if (!summary.textures.empty()) text += items_as_text("textures", texture_items(summary.textures), width);
  text += warnings_as_text(odd, width);
  return text;
}

// ---- pictures
// ---------------------------------------------------------------------------------------------------------

struct ChannelRange {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
  double mean = 0;
  std::size_t not_finite = 0;
};

ChannelRange range_of(const Image& image, std::size_t channel) {
  ChannelRange range;
  std::size_t count = 0;
  for (std::size_t i = channel; i < image.data.size(); i += image.channels.size()) {
    const double value = image.data[i];
    if (!std::isfinite(value)) {
      ++range.not_finite;
      continue;
    }
    range.min = std::min(range.min, value);
    range.max = std::max(range.max, value);
    range.mean += value;
    ++count;
  }
  if (count > 0) range.mean /= double(count);
  return range;
}

std::string image_as_json(const std::string& path, const ReadImage& read) {
  Json json;
  json["file"] = path;
  json["format"] = read.format;
  json["width"] = read.image.width;
  json["height"] = read.image.height;
  json["channels"] = Json::array();
  for (std::size_t c = 0; c < read.image.channels.size(); ++c) {
    const ChannelRange range = range_of(read.image, c);
    json["channels"].push_back({{"name", read.image.channels[c]},
                                {"min", range.min},
                                {"max", range.max},
                                {"mean", range.mean},
                                {"not_finite", range.not_finite}});
  }
  json["metadata"] = Json::object();
  for (const auto& [key, value] : read.metadata) json["metadata"][key] = value;
  return dumped(json);
}

/// `text` without newlines at its end, its second and later lines after `indent` spaces.
std::string with_lines_indented(std::string_view text, int indent) {
  while (!text.empty() && text.back() == '\n') text.remove_suffix(1);
  std::string result;
  for (const char c : text) {
    result += c;
    if (c == '\n') result.append(std::size_t(indent), ' ');
  }
  return result;
}

std::string image_as_text(const std::string& path, const ReadImage& read, int width) {
  std::string text = path + "\n";
  text += line("size", fmt::format("{} x {}", read.image.width, read.image.height), width);
  text += line("format", read.format, width);
  text += line("channels", fmt::format("{}, linear values:", read.image.channels.size()), width);
  for (std::size_t c = 0; c < read.image.channels.size(); ++c) {
    const ChannelRange range = range_of(read.image, c);
    text += fmt::format("    {}: ", read.image.channels[c]);
    if (range.min <= range.max)
      text += fmt::format("{:.6g} to {:.6g}, mean {:.6g}", range.min, range.max, range.mean);
    else text += "no finite value";
    if (range.not_finite > 0) text += fmt::format(", {} not finite", range.not_finite);
    text += "\n";
  }
  text += line("metadata", read.metadata.empty() ? "none" : "", width);
  for (const auto& [key, value] : read.metadata) {
    text += fmt::format("    {}: {}\n", key, with_lines_indented(value, 6));
  }
  return text;
}

}  // namespace

ExitCode run(const InfoCommand& command) {
  if (is_readable_picture(command.input)) {
    const ReadImage read = read_image(command.input, command.load.limits);
    print(command.json ? image_as_json(command.input, read)
                       : harmless(image_as_text(command.input, read, columns(1))));
  } else {
    LoadOptions options = command.load;
    // Of a model one wants to know how large it is itself.
    const std::string end = ending(command.input);
    options.ground = end == ".yaml" || end == ".yml" || end == ".json";
    const ScenePtr scene = load_scene(command.input, options);
    const SceneSummary summary = summarize(scene);
    print(command.json ? scene_as_json(summary, warnings(scene))
                       : harmless(scene_as_text(summary, warnings(scene), columns(1))));
  }
  return done;
}

}  // namespace lambent::app
