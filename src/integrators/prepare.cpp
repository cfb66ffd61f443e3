#include "integrators/prepare.h"

#include "film/pattern.h"

namespace lambent {

CameraRecord camera_record(const Camera& camera) {
  const Vec3<double> forward = normalize(camera.target - camera.eye);
  const Vec3<double> right = normalize(cross(forward, camera.up));
  CameraRecord record{camera.eye, forward, right, cross(right, forward), 0, 0};
  if (camera.projection == Projection::orthographic) {
    record.spread_of_origins = camera.height / 2;
  } else {
    const auto [sine, cosine] = sincos_degrees(camera.fov / 2);
    record.spread_of_directions = sine / cosine;
  }
  return record;
}

namespace {

MaterialRecord material_record(const Scene& scene, const Material& material) {
  const ModelId model = model_of(scene, material);
  MaterialRecord record{.ambient = material.ambient,
                        .diffuse = material.diffuse,
                        .specular = material.specular,
                        .reflect = material.reflect,
                        .transmit = material.transmit,
                        .emission = material.emission,
                        .shininess = material.shininess,
                        .ior = material.ior,
                        .own = {},
                        .model = int(model),
                        .emits = !is_black(material.emission),
                        .reflects = !is_black(material.reflect),
                        .transmits = !is_black(material.transmit)};
  for (int i = 0; i < max_model_parameters && info(model).parameters[i].name; ++i)
    record.own[i] = own_number(material, info(model).parameters[i]);
  return record;
}

std::uint64_t primitive_count(const Scene& scene) {
  std::uint64_t count = 0;
  for (const Shape& shape : scene.shapes) count += primitive_count(shape);
  return count;
}

}  // namespace

TreeQuality suitable_quality(std::uint64_t primitives, std::uint64_t samples) {
  // Measured in seconds of one thread: a thorough tree costs 0.6 us more for each primitive. For each sample
  // it saves 0.04 us (a million triangles, two lights) to 0.25 us (gears of glass), 10 to 30 % of the whole.
  // So it pays from somewhere between 2.5 and 15 samples for each primitive on.
  return samples < 2 * primitives ? TreeQuality::quick : TreeQuality::thorough;
}

std::unique_ptr<PreparedFrame> prepare(const Scene& scene) {
  auto prepared = std::make_unique<PreparedFrame>();
  Frame& frame = prepared->frame;

  frame.camera = camera_record(scene.camera);
  const bool corners = scene.image.pattern == Pattern::corners;
  frame.width = scene.image.width;
  frame.height = scene.image.height;
  prepared->pattern =
      corners ? std::vector<Vec2<double>>{{0, 0}}
      : scene.image.adaptive
          ? progressive_pattern(scene.image.adaptive->max, scene.image.adaptive->start, scene.image.filter)
          : sample_pattern(scene.image.samples, scene.image.filter);
  frame.pattern = prepared->pattern.data();
  frame.samples = int(prepared->pattern.size());

  prepared->tree_quality =
      suitable_quality(primitive_count(scene), std::uint64_t(frame.width) * frame.height * frame.samples);
  prepared->world = build_world(scene, prepared->tree_quality);
  frame.world = prepared->world.view();
  frame.any_transmits = prepared->world.any_transmits;

  for (const Light& light : scene.lights) prepared->lights.push_back(light.light);
  frame.lights = prepared->lights.data();
  frame.light_count = int(prepared->lights.size());
  for (const AnyLight& light : prepared->lights)
    frame.lights_have_limits |= with_light(light, [](const auto& one) { return has_limits(one); });
  for (const Material& material : scene.materials)
    prepared->materials.push_back(material_record(scene, material));
  frame.materials = prepared->materials.data();
  frame.layers.lights = frame.light_count;
  if (scene.whitted.max_depth > 1)
    for (const Object& object : scene.objects)
      for (std::uint32_t m : object.materials) {
        // A refracted ray may be reflected totally.
        frame.layers.refraction |= prepared->materials[m].transmits;
        frame.layers.reflection |= prepared->materials[m].reflects || prepared->materials[m].transmits;
      }
  for (int model = 0; model < model_count; ++model)
    frame.fading[model] = {attenuation_of(scene.illumination, ModelId(model)),
                           ambient_attenuation_of(scene.illumination, ModelId(model))};
  frame.ambient = scene.illumination.ambient;
  frame.minimum_distance = scene.illumination.minimum_distance;
  frame.background = scene.background;
  frame.whitted = scene.whitted;
  return prepared;
}

}  // namespace lambent
