#include "integrators/prepare.h"

#include <algorithm>
#include <cmath>

#include "film/pattern.h"
#include "scene/uniform_material.h"

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

/// As painting begins: before opacity, and before a metallic-roughness material becomes the lecture's.
MaterialRecord unpainted(const Scene& scene, const Material& material) {
  const ModelId model = model_of(scene, material);
  MaterialRecord record{};
  record.ambient = material.ambient;
  record.diffuse = material.diffuse;
  record.specular = material.specular;
  record.reflect = material.reflect;
  record.transmit = material.transmit;
  record.emission = material.emission;
  record.shininess = material.shininess;
  // What is merely not opaque does not bend light.
  record.ior = is_black(material.transmit) ? 1.0 : material.ior;
  record.model = int(model);
  record.maps = material.maps.data();
  record.map_count = int(material.maps.size());
  record.opacity = material.opacity;
  record.alpha = material.alpha;
  record.alpha_cutoff = material.alpha_cutoff;
  record.one_sided = material.one_sided;
  record.painted = record.map_count > 0;
  record.gaps = material.one_sided || material.alpha == Alpha::mask;
  record.light = -1;
  record.reflects = !is_black(material.reflect);
  record.transmits = may_transmit(material);
  if (const auto& m = material.metallic_roughness) {
    record.is_rough = true;
    record.rough = numbers_of(*m);
    record.reflects = true;
    record.ior = 1;  // thin, as KHR_materials_transmission has it
  }
  record.unlit =
      !record.is_rough && is_black(record.ambient) && is_black(record.diffuse) && is_black(record.specular);
  for (int i = 0; i < max_model_parameters && info(model).parameters[i].name; ++i)
    record.own[i] = own_number(material, info(model).parameters[i]);
  return record;
}

/// As it is where nothing is painted on it; `before`: as painting begins.
MaterialRecord material_record(const Scene& scene, const Material& material, const MaterialRecord& before) {
  MaterialRecord record = unpainted(scene, uniform_material(material));
  record.maps = nullptr;  // the copy's
  if (before.is_rough) record.lobe = 2 * before.rough.roughness * before.rough.roughness;
  if (before.painted) record.reflects = before.reflects, record.transmits = before.transmits;
  return record;
}

TextureRecord texture_record(const Texture& texture) {
  return {texture.bytes.empty() ? nullptr : texture.bytes.data(),
          texture.floats.empty() ? nullptr : texture.floats.data(),
          texture.decoded.data(),
          texture.levels.data(),
          int(texture.levels.size()),
          texture.channels};
}

/// The materials of lights that stand in the world come after the scene's.
void add_light_materials(const Scene& scene, const std::vector<StandingLight>& lights,
                         PreparedFrame& prepared) {
  for (const StandingLight& light : lights) {
    MaterialRecord record = unpainted(scene, light.material);
    record.light = int(light.light);
    record.dark_inside = !light.two_sided;
    prepared.frame.any_dark_inside |= record.dark_inside;
    prepared.unpainted.push_back(record);
    prepared.materials.push_back(record);
  }
}

/// Vertices may paint what no map does; what they let through, their materials do.
void note_vertex_colors(const Scene& scene, std::vector<MaterialRecord>& records) {
  for (const Object& object : scene.objects) {
    const Mesh* mesh = std::get_if<Mesh>(&scene.shapes[object.shape].primitives);
    if (!mesh || mesh->colors.empty()) continue;
    const bool opaque =
        std::all_of(mesh->colors.begin(), mesh->colors.end(), [](const auto& c) { return c[3] >= 1; });
    for (const std::uint32_t m : object.materials) {
      records[m].transmits |= !opaque;
      records[m].reflects |= records[m].is_rough;
    }
  }
}

std::uint64_t primitive_count(const Scene& scene) {
  std::uint64_t count = 0;
  for (const Shape& shape : scene.shapes) count += primitive_count(shape);
  return count;
}

}  // namespace

Vec2<double> point_of_light(int number, int count) {
  const int side = int(std::lround(std::sqrt(double(count))));
  int row = 0;
  if (side * side == count) {
    row = number % side * side + (side - 1 - number / side);
  } else {
    // The rows in the order of the fractional parts of 1/2 + i / golden ratio, i counted from the middle.
    const auto place = [count](int i) {
      const double at = 0.5 + (i - 0.5 * (count - 1)) * 0.6180339887498949;
      return at - std::floor(at);
    };
    for (int i = 0; i < count; ++i) row += place(i) < place(number);
  }
  return {(number + 0.5) / count, (row + 0.5) / count};
}

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
  const bool is_adaptive = scene.image.is_adaptive();
  const bool corners = scene.image.pattern == Pattern::corners;
  frame.width = scene.image.width;
  frame.height = scene.image.height;
  prepared->pattern =
      corners                 ? std::vector<Vec2<double>>{{0, 0}}
      : is_progressive(scene) ? progressive_pattern(std::max(scene.path.max_samples, scene.image.samples),
                                                    scene.image.samples, scene.image.filter)
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
  for (int l = 0; l < frame.light_count; ++l)
    with_light(frame.lights[l], [&]<class L>(const L& light) {
      const int count = samples_of(light);
      for (int i = 0; i < count; ++i) {
        const Vec2<double> at = point_of_light(i, count);
        prepared->light_points.push_back({l, at.x, at.y, 1.0 / count, HasExtent<L>});
      }
    });
  frame.light_points = prepared->light_points.data();
  frame.light_point_count = int(prepared->light_points.size());
  for (const AnyLight& light : prepared->lights)
    frame.lights_have_limits |= with_light(light, [](const auto& one) { return has_limits(one); });
  for (const Material& material : scene.materials) {
    prepared->unpainted.push_back(unpainted(scene, material));
    prepared->materials.push_back(material_record(scene, material, prepared->unpainted.back()));
  }
  note_vertex_colors(scene, prepared->materials);
  add_light_materials(scene, prepared->world.lights, *prepared);
  frame.materials = prepared->materials.data();
  frame.unpainted = prepared->unpainted.data();
  for (const MaterialRecord& record : prepared->unpainted) {
    frame.any_gaps |= record.gaps;
    frame.any_masks |= record.alpha == Alpha::mask && record.transmits;
  }
  for (const Texture& texture : scene.textures) prepared->textures.push_back(texture_record(texture));
  frame.textures = prepared->textures.data();
  if (scene.background_image) {
    frame.environment.texture = prepared->textures[*scene.background_image];
    frame.environment.turn = scene.background_turn / 360;
    frame.environment.z_up = scene.background_z_up;
  }
  frame.cones = !scene.textures.empty();
  // A pixel's samples share its width.
  const int sharing = is_adaptive             ? scene.image.adaptive->start
                      : is_progressive(scene) ? scene.image.samples
                                              : frame.samples;
  const double share = 1 / std::sqrt(double(sharing));
  frame.eye_width = share * 2 * frame.camera.spread_of_origins / frame.height;
  frame.eye_spread = share * 2 * frame.camera.spread_of_directions / frame.height;
  frame.layers.lights = frame.light_count;
  if (scene.integrator == Integrator::path) {
    frame.layers.lights = path_source_count(frame.light_count);
  } else if (scene.whitted.max_depth > 1)
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
  if (scene.illumination.occlusion) frame.occlusion = *scene.illumination.occlusion;
  frame.minimum_distance = scene.illumination.minimum_distance;
  frame.background = scene.background;
  frame.whitted = scene.whitted;
  if (scene.integrator == Integrator::path) {
    frame.tracing = Tracing::path;
    frame.path = scene.path;
    if (scene.illumination.attenuation) frame.path_attenuation = *scene.illumination.attenuation;
  }
  return prepared;
}

}  // namespace lambent
