#include "scene/uniform_material.h"

namespace lambent {

MetallicRoughnessOf<double, Rgb> numbers_of(const MetallicRoughness& m) {
  return {m.base_color, m.metallic,     m.roughness, m.specular,           m.specular_color,
          m.ior,        m.transmission, m.clearcoat, m.clearcoat_roughness};
}

Material uniform_material(const Material& material) {
  Material out = material;
  // What is merely not opaque does not bend light.
  if (is_black(out.transmit)) out.ior = 1;
  if (const auto& m = material.metallic_roughness) {
    const auto lecture = lecture_material(numbers_of(*m));
    out.ambient = lecture.ka, out.diffuse = lecture.kd, out.specular = lecture.ks;
    out.reflect = lecture.reflect, out.transmit = lecture.transmit, out.shininess = lecture.n;
    out.ior = 1;  // thin, as KHR_materials_transmission has it
    out.metallic_roughness.reset();
  }
  if (out.alpha == Alpha::blend && out.opacity < 1) {
    for (Rgb* color : {&out.ambient, &out.diffuse, &out.specular, &out.emission, &out.reflect, &out.transmit})
      *color = out.opacity * *color;
    out.transmit = out.transmit + grey(1 - out.opacity);
    out.opacity = 1;
  }
  return out;
}

Material seen_head_on(const Material& material) {
  if (!material.substance) return material;
  Material out = material;
  Rgb reflected;
  if (const auto* metal = std::get_if<Metal>(&*material.substance)) {
    const RgbConstants rgb = rgb_constants(metal->constants);
    for (int c = 0; c < 3; ++c) reflected[c] = normal_reflectance(rgb.n[c], rgb.k[c]);
    out.ambient = out.ambient * reflected, out.diffuse = out.diffuse * reflected;
  } else {
    out.ior = index_at(std::get<Glass>(*material.substance).index, line_d);
    reflected = grey(normal_reflectance(out.ior, 0));
    out.transmit = out.transmit * (grey(1.0) - reflected);
  }
  out.specular = out.specular * reflected;
  out.reflect = out.reflect * reflected;
  out.substance.reset();
  return out;
}

}  // namespace lambent
