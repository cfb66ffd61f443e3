#include "scenefile/yaml_text.h"

#include <fmt/ranges.h>

namespace lambent {

std::string yaml_quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F)
      result += fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
    else result += c;
  }
  return result + '"';
}

std::string integrator_text(const Scene& scene) {
  const std::string whitted = settings_text(scene.whitted, Wanted::all);
  switch (scene.integrator) {
    case Integrator::whitted:
      break;
    case Integrator::spectral:
      return fmt::format("{{spectral: {{wavelengths: [{}], {}}}}}",
                         fmt::join(scene.spectral.wavelengths, ", "), whitted);
    case Integrator::path:
      return fmt::format("{{path: {{{}}}}}", settings_text(scene.path, Wanted::all));
    case Integrator::ambient_occlusion:
      return fmt::format("{{ambient_occlusion: {{{}}}}}",
                         settings_text(scene.ambient_occlusion, Wanted::all));
    case Integrator::view: {
      const std::string view = settings_text(scene.view, Wanted::what_differs);
      return fmt::format("{{view: {{show: {}, {}{}{}}}}}", text_of(scene.view.show), view,
                         view.empty() ? "" : ", ", whitted);
    }
  }
  return fmt::format("{{whitted: {{{}}}}}", whitted);
}

std::string light_text(const Light& light, Wanted wanted) {
  return with_light(light.light, [&](const auto& one) {
    return fmt::format("{{name: {}, {}: {{{}}}}}", yaml_quoted(light.name),
                       std::decay_t<decltype(one)>::info.name, settings_text(one, wanted));
  });
}

}  // namespace lambent
