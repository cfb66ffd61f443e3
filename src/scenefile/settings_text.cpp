#include "scenefile/settings_text.h"

#include <fmt/format.h>

#include "lambent/lambent.h"
#include "scenefile/names.h"

namespace lambent {
namespace {

std::string text(double value) { return fmt::format("{}", value); }
std::string text(int value) { return fmt::format("{}", value); }
std::string text(bool value) { return value ? "true" : "false"; }
std::string text(const Rgb& c) { return fmt::format("[{}, {}, {}]", c[0], c[1], c[2]); }
std::string text(const Vec3<double>& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

/// "name: value, name: value" of everything in S's table.
template <class S> std::string settings(const S& s) {
  std::string result;
  for (const Parameter<S>& parameter : parameters_of<S>) {
    const auto value = std::visit([&](auto member) { return text(s.*member); }, parameter.member);
    result += fmt::format("{}{}: {}", result.empty() ? "" : ", ", parameter.name, value);
  }
  return result;
}

std::string settings(const Light& light) {
  std::string result;
#define LAMBENT_LIGHT(kind, Struct)                      \
  if (const auto* l = std::get_if<Struct>(&light.light)) \
    result = fmt::format("{}: {{{}}}", #kind, settings(*l));
#include "lights/lights.def"
#undef LAMBENT_LIGHT
  return result;
}

}  // namespace

Metadata settings_metadata(const Scene& scene) {
  const Illumination& i = scene.illumination;
  const ModelInfo& model = info(i.model);
  std::string s;
  s += fmt::format("camera: {{projection: {}, {}}}\n", text_of(scene.camera.projection),
                   settings(scene.camera));
  s += fmt::format("image: {{size: [{}, {}], {}, pattern: {}, filter: {}, encoding: {}}}\n",
                   scene.image.width, scene.image.height, settings(scene.image), text_of(scene.image.pattern),
                   text_of(scene.image.filter), text_of(scene.image.encoding));
  s += fmt::format("illumination: {{model: {}, attenuation: {}, ambient_attenuation: {}, {}}}\n", model.name,
                   text_of(i.attenuation.value_or(model.attenuation)),
                   text_of(i.ambient_attenuation.value_or(model.ambient_attenuation)), settings(i));
  s += fmt::format("integrator: {{whitted: {{{}}}}}\n", settings(scene.whitted));
  s += fmt::format("background: {}\n", text(scene.background));
  if (!scene.lights.empty()) s += "lights:\n";
  for (const Light& light : scene.lights)
    s += fmt::format("  - {{name: \"{}\", {}}}\n", light.name, settings(light));
  return {{"lambent:version", version()}, {"lambent:scene", scene.name}, {"lambent:settings", s}};
}

}  // namespace lambent
