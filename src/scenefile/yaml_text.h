#pragma once
// Settings as one would write them in a scene file: for the scene made of a model, and for a picture's
// metadata.

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

#include "scenefile/format.h"
#include "scenefile/names.h"

namespace lambent {

/// A text in double quotes, whatever is in it.
std::string yaml_quoted(std::string_view text);

/// Any value that a parameter may have.
template <class T> std::string value_text(const T& value) {
  if constexpr (std::is_same_v<T, bool>) return value ? "true" : "false";
  else if constexpr (std::is_same_v<T, int>) return fmt::format("{}", value);
  else if constexpr (std::is_same_v<T, std::string>) return yaml_quoted(value);
  else return text_of(value);
}

enum class Wanted {
  all,           ///< Every parameter, defaults spelt out.
  what_differs,  ///< Those that are required or differ from their defaults.
};

/// "eye: [0, 0, 5], fov: 40": the parameters of S, to stand between braces.
template <class S> std::string settings_text(const S& settings, Wanted wanted) {
  const S defaults;
  std::string result;
  for (const Parameter<S>& parameter : parameters_of<S>) {
    const auto text_in = [&](const S& from) {
      return std::visit([&](auto member) { return value_text(from.*member); }, parameter.member);
    };
    const std::string value = text_in(settings);
    if (wanted == Wanted::what_differs && !parameter.required && value == text_in(defaults)) continue;
    result += fmt::format("{}{}: {}", result.empty() ? "" : ", ", parameter.name, value);
  }
  return result;
}

/// "16", or "{adaptive: {start: 4, max: 256, error: 1}}".
inline std::string samples_text(const ImageSettings& image) {
  if (!image.adaptive) return value_text(image.samples);
  return fmt::format("{{adaptive: {{{}}}}}", settings_text(*image.adaptive, Wanted::all));
}

/// "{whitted: {max_depth: 5, ...}}", or "{view: {show: normals, ...}}": the scene's integrator.
std::string integrator_text(const Scene& scene);

/// "{name: "key", point: {position: [3, 4, 4]}}".
std::string light_text(const Light& light, Wanted wanted);

}  // namespace lambent
