#include "export/finish.h"

#include <cmath>

#include "scene/uniform_material.h"

namespace lambent {

void Remarks::add(const Place& place, const std::string& rest) {
  Diagnostic diagnostic;
  diagnostic.severity = Severity::warning;
  diagnostic.place = place;
  diagnostic.message = program_ + " " + rest;
  to_.push_back(std::move(diagnostic));
}

namespace {

double own(const Material& material, ModelId model, const std::string& name) {
  for (const ModelParameter& parameter : info(model).parameters)
    if (parameter.name && name == parameter.name) return own_number(material, parameter);
  return 0;
}

}  // namespace

Attenuation fading_of(const Scene& scene) {
  return attenuation_of(scene.illumination, scene.illumination.model);
}

void remark_on_settings(const Scene& scene, Remarks& remarks) {
  const Attenuation fading = fading_of(scene);
  const bool any_near = !scene.lights.empty() && fading.constant == 0;
  if (any_near) remarks.add({}, "has no minimum_distance; light grows without end near a light");
  if (scene.image.samples > 1 || scene.image.adaptive || scene.image.pattern == Pattern::corners ||
      scene.image.filter != Filter::box)
    remarks.add({},
                "is told by its command line how many rays to send through a pixel; the scene's samples are "
                "left out");
  if (scene.camera.aperture > 0) remarks.add({}, "is not told of the lens; everything is in focus");
  if (scene.fog.density > 0) remarks.add({}, "is not told of the fog; the air is clear");
  if (scene.background_image)
    remarks.add({}, "is not given the image around the scene; its factor stands for it");
  if (scene.illumination.occlusion)
    remarks.add({}, "is not told of ambient occlusion; ambient light is everywhere");
  for (const Object& object : scene.objects) {
    if (!object.motion.empty())
      remarks.add(object.place, "is not told of motion; " + called("object", object.name) +
                                    " stands where it is when the shutter opens");
    const Mesh* mesh = std::get_if<Mesh>(&scene.shapes[object.shape].primitives);
    if (mesh && !mesh->colors.empty())
      remarks.add(object.place, "is not given the colours of vertices; " + called("object", object.name) +
                                    " has those of its materials");
  }
  for (const Light& light : scene.lights) {
    const auto* point = std::get_if<PointLight>(&light.light);
    const auto* spot = std::get_if<SpotLight>(&light.light);
    if ((point && point->max_distance > 0) || (spot && spot->max_distance > 0))
      remarks.add(light.place, "has no max_distance; " + called("light", light.name) + " shines everywhere");
  }
}

Finish finish_of(const Scene& scene, const Material& painted, Remarks& remarks) {
  const Material material = uniform_material(seen_head_on(painted));
  if (painted.substance)
    remarks.add(painted.place, "is not given the measured constants of " + called("material", painted.name) +
                                   ": it reflects alike at every angle, as this does head on");
  const ModelId model = model_of(scene, material);
  const std::string who = called("material", material.name);
  const auto remark = [&](const std::string& rest) { remarks.add(material.place, rest); };
  if (!material.maps.empty()) remark("is not given images; " + who + " is written without its maps");
  if (material.alpha == Alpha::mask) remark("is not given cut-outs; " + who + " is there everywhere");
  if (material.one_sided) remark("sees both sides of everything; " + who + " is one-sided here");
  const bool highlight = !is_black(material.specular);
  const std::string model_name = info(model).name;
  const bool ambient_fades = ambient_attenuation_of(scene.illumination, model) != AmbientAttenuation::none;
  const bool fades_alone =
      !(attenuation_of(scene.illumination, model) == fading_of(scene)) && !scene.lights.empty();

  Finish finish;
  finish.constant = material.ambient * scene.illumination.ambient;
  finish.diffuse = material.diffuse;
  finish.reflect = material.reflect;
  finish.transmit = material.transmit;
  finish.ior = material.ior;
  const auto phong = [&] { finish.phong = material.specular, finish.phong_power = material.shininess; };
  const auto blinn = [&] { finish.blinn = material.specular, finish.blinn_power = material.shininess; };
  switch (model) {
    case ModelId::conventional:
    case ModelId::attenuated:
      break;
    case ModelId::phong:
      phong();
      break;
    case ModelId::blinn_phong:
      blinn();
      break;
    case ModelId::blinn_phong_halfway:
      blinn();
      if (highlight) remark("normalises its half-vector; the highlight of " + who + " is brighter than here");
      break;
    case ModelId::mtl: {
      const double illum = own(material, model, "illum");
      if (illum == 0) finish.constant = material.diffuse;
      if (illum == 10) finish.constant = Rgb{};
      if (illum == 0 || illum == 10) finish.diffuse = Rgb{};
      if (illum >= 2 && illum <= 9) blinn();
      if (highlight && (illum == 5 || illum == 7))
        remark("has no Fresnel factor on highlights; that of " + who + " is brighter than here");
      break;
    }
    case ModelId::opengl:
      blinn();
      if (highlight && own(material, model, "local_viewer") == 0)
        remark("sees highlights from the eye; that of " + who +
               " is meant to be seen from infinitely far (local_viewer 0)");
      if (own(material, model, "two_sided") == 0)
        remark("lights the inside as the outside; " + who +
               " is meant to be lit by the outside's normal (two_sided 0)");
      break;
    case ModelId::povray:
      phong();
      finish.blinn = grey(own(material, model, "pov_specular"));
      finish.blinn_power = 1 / own(material, model, "roughness");
      finish.brilliance = own(material, model, "brilliance");
      break;
    case ModelId::tachyon:
      if (own(material, model, "highlight") == 1) phong();
      else blinn();
      finish.fast = own(material, model, "highlight") == 2;
      break;
    default:
      remark("has nothing like the model " + model_name + " of " + who + "; Lambert's cosine stands for it");
      break;
  }
  if (ambient_fades && !is_black(finish.constant))
    remark("knows no ambient term that fades; that of " + who + " stays as it is at a distance of 1");
  if (fades_alone)
    remark("lets a light fade alike for all materials; that under the model of " + who + " is left out");
  finish.constant = finish.constant + material.emission;
  return finish;
}

std::vector<bool> used_materials(const Scene& scene) {
  std::vector<bool> used(scene.materials.size());
  for (const Object& object : scene.objects) {
    const Shape& shape = scene.shapes[object.shape];
    if (shape.material_of_primitive.empty()) used[object.materials[0]] = true;
    for (const std::uint32_t material : shape.material_of_primitive) used[object.materials[material]] = true;
  }
  return used;
}

std::uint32_t material_of(const Shape& shape, const Object& object, std::size_t primitive) {
  if (shape.material_of_primitive.empty()) return object.materials[0];
  return object.materials[shape.material_of_primitive[primitive]];
}

PlacedTriangle placed_triangle(const Mesh& mesh, const Object& object, std::size_t triangle) {
  const Transform& t = object.world_from_object;
  const Transform back = inverse(t);
  const auto& corners = mesh.triangles[triangle];
  PlacedTriangle placed;
  placed.smooth = !mesh.normals.empty();
  for (int k = 0; k < 3; ++k) {
    placed.corner[k] = transform_point(t, cast<double>(mesh.vertices[corners[k]]));
    if (placed.smooth) placed.smooth = !(mesh.normals[corners[k]] == Vec3<float>{});
  }
  const Vec3<double> across = cross(placed.corner[1] - placed.corner[0], placed.corner[2] - placed.corner[0]);
  const double size = length(across);
  for (int k = 0; k < 3; ++k)
    placed.normal[k] = placed.smooth
                           ? normalize(transform_normal(back, cast<double>(mesh.normals[corners[k]])))
                       : size > 0 ? ((determinant(t) < 0 ? -1 : 1) / size) * across
                                  : Vec3<double>{};
  return placed;
}

double strongest(const Rgb& color) {
  double result = 0;
  for (int c = 0; c < color_channels; ++c) result = max(result, color[c]);
  return result;
}

bool is_grey(const Rgb& color) {
  for (int c = 1; c < color_channels; ++c)
    if (color[c] != color[0]) return false;
  return true;
}

std::string called(const char* what, const std::string& name) {
  return name.empty() ? std::string("a ") + what + " without a name" : std::string(what) + " '" + name + "'";
}

std::string in_comment(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = ' ';
  return text;
}

}  // namespace lambent
