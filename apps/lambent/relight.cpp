#include "lambent/relight.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

#include "commands.h"
#include "console.h"
#include "files.h"

namespace lambent::app {

namespace {

/// "0.5", "0.5,1,1" (linear) or "#ffd0a0" (sRGB).
std::optional<std::array<double, 3>> factor_of(const std::string& text) {
  std::array<double, 3> factor{};
  if (text.size() == 7 && text[0] == '#') {
    for (std::size_t c = 0; c < 3; ++c) {
      int code = 0;
      const char* from = text.data() + 1 + 2 * c;
      if (std::from_chars(from, from + 2, code, 16).ptr != from + 2) return std::nullopt;
      factor[c] = linear_from_srgb(code / 255.0);
    }
    return factor;
  }
  std::size_t count = 0;
  const char *at = text.data(), *end = text.data() + text.size();
  for (; count < 3; ++count) {
    const auto [stop, error] = std::from_chars(at, end, factor[count]);
    if (error != std::errc() || !std::isfinite(factor[count]) || factor[count] < 0) return std::nullopt;
    if (stop == end) {
      ++count;
      break;
    }
    if (*stop != ',') return std::nullopt;
    at = stop + 1;
  }
  if (count == 1) factor[1] = factor[2] = factor[0];
  else if (count != 3) return std::nullopt;
  return factor;
}

std::vector<LayerFactor> factors_of(const char* option, const std::vector<std::string>& texts) {
  std::vector<LayerFactor> factors;
  for (const std::string& text : texts) {
    const std::size_t equals = text.rfind('=');
    const auto factor =
        equals == std::string::npos || equals == 0 ? std::nullopt : factor_of(text.substr(equals + 1));
    if (!factor)
      throw usage_error(fmt::format("{} wants NAME=FACTOR, not '{}'", option, text),
                        "the factor is a number, r,g,b (linear), or #rrggbb (sRGB); none negative");
    factors.emplace_back(text.substr(0, equals), *factor);
  }
  return factors;
}

}  // namespace

ExitCode run(const RelightCommand& command) {
  Relighting relighting;
  relighting.lights = factors_of("--light", command.lights);
  relighting.terms = factors_of("--term", command.terms);
  relighting.materials = factors_of("--material", command.materials);
  for (const std::string& output : command.outputs) check_image_output(output);
  const ReadImage layers = read_image(command.input);
  const Relit relit = relight(layers, relighting);
  Metadata metadata;
  std::string changes;
  for (const auto* list : {&command.lights, &command.terms, &command.materials})
    for (const std::string& one : *list) changes += (changes.empty() ? "" : " ") + one;
  for (const auto& [key, value] : layers.metadata)
    if (key == "lambent:scene" || key == "lambent:settings" || key == "lambent:version")
      metadata.emplace_back(key, value);
  metadata.emplace_back("lambent:relit", changes);
  for (const std::string& output : command.outputs)
    write_image(output, relit.image, metadata, {command.bits, true});
  if (!command.quiet && relit.mixed_pixels > 0)
    print_error(
        fmt::format("{}: the material covers a part of them only, so its factor counts by that part\n",
                    counted(relit.mixed_pixels, "pixel")));
  if (!command.quiet && relit.mirroring_pixels > 0)
    print_error(fmt::format("{}: what mirrors and glass show there keeps the old materials\n",
                            counted(relit.mirroring_pixels, "pixel")));
  return done;
}

}  // namespace lambent::app
