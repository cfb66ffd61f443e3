// What is in a scene, for people.

#include <fmt/format.h>

#include "image/file.h"
#include "image/pixels.h"
#include "lambent/lambent.h"
#include "scene/scene.h"
#include "scenefile/format.h"
#include "scenefile/names.h"

namespace lambent {

bool wants_layers(const ScenePtr& scene) { return scene->film.layers; }

namespace {

// Six digits: what people read, not what a program reads back.
std::string plain(double v) { return fmt::format("{:.6g}", v); }
std::string plain(const Vec3<double>& v) { return plain(v.x) + " " + plain(v.y) + " " + plain(v.z); }
std::string plain(const Rgb& v) { return plain(v[0]) + " " + plain(v[1]) + " " + plain(v[2]); }
std::string plain(int v) { return std::to_string(v); }
std::string plain(const std::string& v) { return v; }
std::string plain(bool v) { return v ? "true" : "false"; }

/// "position 3 4 4, intensity 8": what is required, and what is not as it is by default.
template <class S> std::string detail(const S& settings) {
  std::string result;
  const S defaults{};
  for (const Parameter<S>& parameter : parameters_of<S>) {
    std::visit(
        [&](auto member) {
          if (!parameter.required && settings.*member == defaults.*member) return;
          if (!result.empty()) result += ", ";
          result += std::string(parameter.name) + " " + plain(settings.*member);
        },
        parameter.member);
  }
  return result;
}

std::string kind_of(const Shape& shape) {
  struct Kinds {
    std::string operator()(const Mesh&) const { return "mesh"; }
    std::string operator()(const std::vector<Sphere>& s) const {
      return s.size() == 1 ? "sphere" : "spheres";
    }
    std::string operator()(const std::vector<Cone>& s) const { return s.size() == 1 ? "cone" : "cones"; }
    std::string operator()(const std::vector<Disc>& s) const { return s.size() == 1 ? "disc" : "discs"; }
    std::string operator()(const std::vector<Plane>& s) const { return s.size() == 1 ? "plane" : "planes"; }
  };
  return std::visit(Kinds{}, shape.primitives);
}

void count(SceneSummary& summary, const Mesh& mesh) {
  summary.triangles += mesh.triangles.size();
  summary.vertices += mesh.vertices.size();
}
void count(SceneSummary& summary, const std::vector<Sphere>& spheres) { summary.spheres += spheres.size(); }
void count(SceneSummary& summary, const std::vector<Cone>& cones) { summary.cones += cones.size(); }
void count(SceneSummary& summary, const std::vector<Disc>& discs) { summary.discs += discs.size(); }
void count(SceneSummary& summary, const std::vector<Plane>& planes) { summary.planes += planes.size(); }

std::string camera_text(const Camera& camera) {
  const bool flat = camera.projection == Projection::orthographic;
  std::string text =
      fmt::format("{}, {}, from {} to {}", text_of(camera.projection),
                  flat ? "height " + plain(camera.height) : "fov " + plain(camera.fov) + " degrees",
                  plain(camera.eye), plain(camera.target));
  if (camera.aperture > 0)
    text +=
        fmt::format(", aperture {}, in focus {} away", plain(camera.aperture), plain(focus_distance(camera)));
  return text;
}

std::string integrator_summary(const Scene& scene) {
  const WhittedSettings& whitted = scene.whitted;
  const std::string kind = scene.integrator == Integrator::spectral
                               ? fmt::format("spectral, {} wavelengths", scene.spectral.wavelengths.size())
                               : "whitted";
  const std::string tracing = fmt::format("{}, max_depth {}, shadows {}", kind, whitted.max_depth,
                                          !whitted.shadows          ? "off"
                                          : whitted.colored_shadows ? "coloured"
                                                                    : "opaque");
  if (scene.integrator == Integrator::path) return fmt::format("path, max_depth {}", scene.path.max_depth);
  if (scene.integrator == Integrator::ambient_occlusion)
    return fmt::format("ambient_occlusion, {} rays for each sample", scene.ambient_occlusion.rays);
  if (scene.integrator != Integrator::view) return tracing;
  const std::string view = "view of " + text_of(scene.view.show);
  if (scene.view.show == View::cosine) return fmt::format("{}, light '{}'", view, scene.view.light);
  return scene.view.show == View::rays ? view + ": " + tracing : view;
}

/// "metal gold, roughness 0.2, ", or nothing.
std::string substance_text(const Material& material) {
  if (!material.substance) return {};
  const auto* metal = std::get_if<Metal>(&*material.substance);
  const std::string name = metal ? metal->name : std::get<Glass>(*material.substance).name;
  return fmt::format("{} {}, roughness {}, ", metal ? "metal" : "glass", name.empty() ? "of its own" : name,
                     plain(material.roughness));
}

/// Nothing is decoded here, so nothing has to be held back.
Limits unlimited() {
  Limits limits;
  limits.file_bytes = limits.pixels = ~std::uint64_t{0};
  return limits;
}

std::string model_text(const Illumination& illumination) {
  const ModelInfo& model = info(illumination.model);
  return fmt::format("{}, attenuation {}, ambient attenuation {}", model.name,
                     text_of(attenuation_of(illumination, illumination.model)),
                     text_of(ambient_attenuation_of(illumination, illumination.model)));
}

/// What can be said of a texture; its file's header says it, whether or not its pixels have been read.
SceneSummary::Image texture_summary(const Texture& texture) {
  SceneSummary::Image image;
  image.name = texture.source.name;
  image.color = texture.srgb;
  if (!texture.levels.empty()) {
    image.width = texture.levels[0].width, image.height = texture.levels[0].height;
    image.channels = texture.channels;
  }
  if (texture.source.file.empty() && !texture.source.bytes) return image;  // the studio is in no file
  try {
    const std::string in_file = texture.source.file.empty() ? "" : read_bytes(texture.source.file);
    const std::string_view bytes =
        texture.source.bytes ? std::string_view(*texture.source.bytes) : std::string_view(in_file);
    const PixelSize size = pixel_size(bytes, image.name, unlimited());
    image.format = size.format;
    image.width = size.width, image.height = size.height, image.channels = size.channels;
  } catch (const InputError& error) {
    image.problem = error.diagnostics().at(0).message;
  }
  return image;
}

}  // namespace

SceneSummary summarize(const ScenePtr& pointer) {
  const Scene& scene = *pointer;
  SceneSummary summary;
  summary.name = scene.name;
  summary.width = scene.image.width;
  summary.height = scene.image.height;
  const auto& adaptive = scene.image.adaptive;
  summary.samples = !adaptive                              ? scene.image.samples
                    : scene.integrator == Integrator::view ? adaptive->start
                                                           : adaptive->max;
  summary.camera = camera_text(scene.camera);
  summary.model = model_text(scene.illumination);
  summary.integrator = integrator_summary(scene);
  const Bounds box = bounds(scene);
  const double lower[] = {box.lower.x, box.lower.y, box.lower.z},
               upper[] = {box.upper.x, box.upper.y, box.upper.z};
  for (int i = 0; i < 3; ++i) {
    summary.lower[i] = lower[i];
    summary.upper[i] = upper[i];
  }
  for (const Shape& shape : scene.shapes)
    std::visit([&](const auto& primitives) { count(summary, primitives); }, shape.primitives);

  for (const Object& object : scene.objects) {
    const Shape& shape = scene.shapes[object.shape];
    std::string text = shape.name == kind_of(shape) ? "" : shape.name + ", ";
    text += object.materials.size() == 1 ? "material " + scene.materials[object.materials[0]].name
                                         : std::to_string(object.materials.size()) + " materials";
    if (!is_identity(object.world_from_object)) text += ", transformed";
    if (!object.motion.empty()) text += ", moving";
    summary.shown += primitive_count(shape);
    summary.objects.push_back(
        {object.name, kind_of(shape), object.place, primitive_count(shape), std::move(text)});
  }
  for (const Light& light : scene.lights)
    with_light(light.light, [&](const auto& one) {
      summary.lights.push_back({light.name, one.info.name, light.place, 0, detail(one)});
    });
  for (const Material& material : scene.materials) {
    std::string text = substance_text(material) + detail(material);
    for (const auto& [name, value] : material.own)
      text += (text.empty() ? "" : ", ") + name + " " + plain(value);
    summary.materials.push_back(
        {material.name, info(model_of(scene, material)).name, material.place, 0, std::move(text)});
  }
  for (const Texture& texture : scene.textures) summary.textures.push_back(texture_summary(texture));
  summary.cameras = scene.model_cameras;
  return summary;
}

}  // namespace lambent
