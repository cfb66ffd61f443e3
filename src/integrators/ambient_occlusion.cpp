#include "integrators/ambient_occlusion.h"

namespace lambent {

Material whitened(const Material& material) {
  Material white;
  white.name = material.name;
  white.place = material.place;
  white.ambient = grey(1.0);
  white.diffuse = Rgb{};
  white.model = ModelId::phong;
  white.one_sided = material.one_sided;
  if (material.alpha == Alpha::mask) {
    white.alpha = material.alpha;
    white.alpha_cutoff = material.alpha_cutoff;
    white.opacity = material.opacity;
  }
  for (const MaterialMap& map : material.maps)
    if (map.slot == MapSlot::normal || map.slot == MapSlot::bump ||
        (map.slot == MapSlot::opacity && material.alpha == Alpha::mask))
      white.maps.push_back(map);
  return white;
}

Illumination even_sky(const AmbientOcclusion& occlusion) {
  Illumination illumination;
  illumination.ambient = grey(1.0);
  illumination.ambient_attenuation = AmbientAttenuation::none;
  illumination.occlusion = occlusion;
  return illumination;
}

void block_all_but_cut_outs(const Scene& scene, World& world) {
  for (std::size_t m = 0; m < scene.materials.size(); ++m)
    if (scene.materials[m].alpha != Alpha::mask) world.material_transmits[m] = false;
  world.any_transmits = false;
  for (const Object& object : scene.objects)
    for (const std::uint32_t m : object.materials) world.any_transmits |= world.material_transmits[m];
}

}  // namespace lambent
