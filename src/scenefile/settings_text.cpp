#include "scenefile/settings_text.h"

#include <fmt/format.h>

#include "lambent/lambent.h"
#include "scenefile/yaml_text.h"

namespace lambent {

Metadata settings_metadata(const Scene& scene) {
  const Illumination& i = scene.illumination;
  const ModelInfo& model = info(i.model);
  std::string s;
  s += fmt::format("camera: {{projection: {}, {}}}\n", text_of(scene.camera.projection),
                   settings_text(scene.camera, Wanted::all));
  s += fmt::format("image: {{size: [{}, {}], samples: {}{}, pattern: {}, filter: {}, encoding: {}}}\n",
                   scene.image.width, scene.image.height, samples_text(scene.image),
                   is_moving(scene) ? fmt::format(", shutter_slices: {}", scene.image.shutter_slices) : "",
                   text_of(scene.image.pattern), text_of(scene.image.filter), text_of(scene.image.encoding));
  s += fmt::format("illumination: {{model: {}, attenuation: {}, ambient_attenuation: {}, {}}}\n", model.name,
                   text_of(attenuation_of(i, i.model)), text_of(ambient_attenuation_of(i, i.model)),
                   settings_text(i, Wanted::all));
  s += fmt::format("integrator: {}\n", integrator_text(scene));
  s += fmt::format("background: {}\n", text_of(scene.background));
  if (scene.fog.density > 0) s += fmt::format("fog: {{{}}}\n", settings_text(scene.fog, Wanted::all));
  if (!scene.lights.empty()) s += "lights:\n";
  for (const Light& light : scene.lights) s += fmt::format("  - {}\n", light_text(light, Wanted::all));
  return {{"lambent:version", version()}, {"lambent:scene", scene.name}, {"lambent:settings", s}};
}

}  // namespace lambent
