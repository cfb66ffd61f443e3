#include "integrators/prepare.h"

#include <algorithm>
#include <cmath>

#include "film/pattern.h"
#include "illumination/fresnel.h"
#include "integrators/ambient_occlusion.h"
#include "integrators/emission_lights.h"
#include "integrators/light_pattern.h"
#include "integrators/spectral.h"
#include "scattering/surface.h"
#include "scene/uniform_material.h"

namespace lambent {

CameraRecord camera_record(const Camera& camera) {
  const Vec3<double> forward = normalize(camera.target - camera.eye);
  const Vec3<double> right = normalize(cross(forward, camera.up));
  CameraRecord record{
      camera.eye, forward, right, cross(right, forward), 0, 0, camera.aperture / 2, focus_distance(camera)};
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
  record.scatter = int(info(model).half_vector ? ScatterKind::lecture_blinn : ScatterKind::lecture_phong);
  record.reflects = !is_black(material.reflect);
  record.transmits = may_transmit(material);
  if (const auto& m = material.metallic_roughness) {
    record.is_rough = true;
    record.scatter = int(ScatterKind::metallic_roughness);
    record.rough = numbers_of(*m);
    record.reflects = true;
    record.ior = 1;  // thin, as KHR_materials_transmission has it
  }
  if (material.substance) {
    record.scatter =
        int(std::holds_alternative<Metal>(*material.substance) ? ScatterKind::metal : ScatterKind::glass);
    record.roughness = material.roughness;
  }
  record.unlit =
      !record.is_rough && is_black(record.ambient) && is_black(record.diffuse) && is_black(record.specular);
  for (int i = 0; i < max_model_parameters && info(model).parameters[i].name; ++i)
    record.own[i] = own_number(material, info(model).parameters[i]);
  return record;
}

/// What its substance, or else its ior, makes of a material's record.
void set_boundary(const Scene& scene, const Material& material, const Pass* pass, MaterialRecord& record) {
  record.eta = grey(material.metallic_roughness ? material.metallic_roughness->ior : material.ior);
  if (!material.substance) return;
  const auto [eta, k] = index_of(*material.substance, scene, pass);
  record.eta = eta, record.k = k;
  record.boundary = std::holds_alternative<Metal>(*material.substance) ? Boundary::metal : Boundary::glass;
  Rgb head_on;
  for (int c = 0; c < color_channels; ++c) head_on[c] = fresnel_conductor_at_normal(eta[c], k[c]);
  if (record.boundary == Boundary::metal) {
    record.ambient = record.ambient * head_on;
    record.diffuse = record.diffuse * head_on;
  } else {
    record.ior = eta[0];  // the same in all channels, or what stands for them
  }
  if (!info(model_of(scene, material)).measured) record.specular = record.specular * head_on;
}

/// As it is where nothing is painted on it; `before`: as painting begins.
MaterialRecord material_record(const Scene& scene, const Material& material, const Pass* pass,
                               const MaterialRecord& before) {
  Material plain = material;
  if (pass) {
    if (plain.metallic_roughness) {  // in red, green and blue, but for its opacity
      plain.opacity = 1;
      plain = uniform_material(plain);
      plain.opacity = material.opacity;
    }
    plain = material_in_pass(scene, *pass, plain);
  }
  MaterialRecord record = unpainted(scene, uniform_material(plain));
  set_boundary(scene, material, pass, record);
  record.maps = nullptr;  // the copy's
  record.scatter = before.scatter;
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

/// The materials of lights that stand in the world come after the scene's.
void add_light_materials(const Scene& scene, const Pass* pass, const std::vector<StandingLight>& lights,
                         PreparedFrame::Colored& colored) {
  for (const StandingLight& light : lights) {
    MaterialRecord record = unpainted(scene, light.material);
    if (pass)  // its colour may be a spectrum
      record.emission = with_light(colored.lights[light.light], []<class L>(const L& one) -> Rgb {
        if constexpr (HasExtent<L>) return radiance(one);
        else return {};  // which does not stand in the world
      });
    record.light = int(light.light);
    record.dark_inside = !light.two_sided;
    colored.unpainted.push_back(record);
    colored.materials.push_back(record);
  }
}

/// What of the frame has colours: in a pass, or as red, green and blue.
void color(const Scene& scene, const Pass* pass, const PreparedFrame& prepared, Frame& frame,
           PreparedFrame::Colored& colored) {
  const bool is_white = scene.integrator == Integrator::ambient_occlusion;
  if (!is_white)
    for (const Light& light : scene.lights)
      colored.lights.push_back(pass ? light_in_pass(scene, *pass, light) : light.light);
  for (const Material& material : is_white ? prepared.white : scene.materials) {
    // Painting is done in red, green and blue, and its result put into the pass.
    colored.unpainted.push_back(unpainted(scene, material));
    colored.unpainted.back().white = is_white;
    colored.materials.push_back(material_record(scene, material, pass, colored.unpainted.back()));
    set_boundary(scene, material, nullptr, colored.unpainted.back());
    colored.unpainted.back().ior = colored.materials.back().ior;
  }
  if (!is_white) note_vertex_colors(scene, colored.materials);
  add_light_materials(scene, pass, prepared.world.lights, colored);
  frame.lights = colored.lights.data();
  frame.materials = colored.materials.data();
  frame.unpainted = colored.unpainted.data();
  const Illumination& illumination = prepared.illumination;
  frame.ambient = pass ? ambient_in_pass(scene, *pass) : illumination.ambient;
  frame.background = is_white ? grey(1.0) : scene.background;
  if (pass && !scene.background_image) frame.background = in_pass(*pass, scene.background);
  if (!is_white) {
    frame.fog = {pass ? in_pass(*pass, scene.fog.color) : scene.fog.color, scene.fog.density,
                 scene.fog.start};
  }
}

std::uint64_t primitive_count(const Scene& scene) {
  std::uint64_t count = 0;
  for (const Shape& shape : scene.shapes) count += primitive_count(shape);
  return count;
}

/// How many lights stand for surfaces and background that shine. Paths find these by themselves.
struct EmissionCounts {
  int surfaces = 0, background = 0;
};
EmissionCounts emission_counts(const Scene& scene) {
  if (scene.integrator == Integrator::path || scene.integrator == Integrator::ambient_occlusion) return {};
  return {scene.whitted.emission_samples, scene.whitted.background_samples};
}

/// What tells light apart in the layers: the scene's lights, and what else shines, if anybody asks.
int source_count(const Scene& scene, int lights) {
  const EmissionCounts counts = emission_counts(scene);
  if (scene.integrator == Integrator::path || counts.background > 0) return background_source(lights) + 1;
  return counts.surfaces > 0 ? surfaces_source(lights) + 1 : lights;
}

/// The points that the lecture's sum over lights takes: of the scene's lights, then of those that stand for
/// surfaces and background. The frame is complete but for them.
void set_light_points(const Emission& emission, Frame& frame, PreparedFrame::Colored& colored) {
  for (int l = 0; l < frame.light_count; ++l)
    with_light(colored.lights[std::size_t(l)], [&]<class L>(const L& light) {
      const int count = samples_of(light);
      for (int i = 0; i < count; ++i) {
        const Vec2<double> at = point_of_light(i, count);
        colored.light_points.push_back({l, l, at.x, at.y, 1.0 / count, HasExtent<L>});
      }
    });
  const EmissionLights more = emission.lights(frame);
  for (LightPoint point : more.points) {
    point.light += frame.light_count;
    colored.light_points.push_back(point);
  }
  colored.lights.insert(colored.lights.end(), more.lights.begin(), more.lights.end());
  frame.lights = colored.lights.data();
  frame.light_points = colored.light_points.data();
  frame.light_point_count = int(colored.light_points.size());
}

}  // namespace

TreeQuality suitable_quality(std::uint64_t primitives, std::uint64_t samples) {
  // Measured in seconds of one thread: a thorough tree costs 0.6 us more for each primitive. For each sample
  // it saves 0.04 us (a million triangles, two lights) to 0.25 us (gears of glass), 10 to 30 % of the whole.
  // So it pays from somewhere between 2.5 and 15 samples for each primitive on.
  return samples < 2 * primitives ? TreeQuality::quick : TreeQuality::thorough;
}

namespace {

/// Whether the shutter's time is seen slice by slice. A view shows what is there in the middle of it.
bool is_in_slices(const Scene& scene) { return is_moving(scene) && scene.integrator != Integrator::view; }

/// Paths of another seed go through other places of the pixels, so that of many seeds' pictures the mean is
/// right at edges, too.
Vec2<double> shift_of(const Scene& scene) {
  if (scene.integrator != Integrator::path || scene.path.seed == 0) return {};
  const std::uint64_t bits = hashed(std::uint64_t(scene.path.seed));
  return {double(bits >> 32) * 0x1p-32, double(std::uint32_t(bits)) * 0x1p-32};
}

/// Where the samples of each pixel lie.
std::vector<Vec2<double>> pattern_of(const Scene& scene) {
  const ImageSettings& image = scene.image;
  const bool in_slices = is_in_slices(scene);
  if (image.pattern == Pattern::corners) return {{0, 0}};
  if (is_progressive(scene)) {
    int most = std::max(scene.path.max_samples, image.samples);
    if (in_slices) most -= most % std::min(image.samples, image.shutter_slices);  // as many for each
    return progressive_pattern(most, image.samples, image.filter, shift_of(scene));
  }
  if (image.adaptive) return progressive_pattern(image.adaptive->max, image.adaptive->start, image.filter);
  return in_slices ? progressive_pattern(image.samples, image.samples, image.filter, shift_of(scene))
                   : sample_pattern(image.samples, image.filter, shift_of(scene));
}

Shutter shutter_of(const Scene& scene, const std::vector<Vec2<double>>& pattern) {
  return open_shutter(int(pattern.size()), std::min(scene.image.samples, scene.image.shutter_slices));
}

}  // namespace

std::unique_ptr<PreparedFrame> prepare(const Scene& scene, double time) {
  auto prepared = std::make_unique<PreparedFrame>();
  Frame& frame = prepared->frame;

  frame.camera = camera_record(scene.camera);
  const bool is_adaptive = scene.image.is_adaptive();
  frame.width = scene.image.width;
  frame.height = scene.image.height;
  prepared->pattern = pattern_of(scene);
  frame.pattern = prepared->pattern.data();
  frame.samples = int(prepared->pattern.size());
  if (is_in_slices(scene)) {
    prepared->shutter = shutter_of(scene, prepared->pattern);
    frame.order = prepared->shutter.order.data();
  }

  const std::uint64_t slices = std::max<std::size_t>(1, prepared->shutter.slices.size());
  prepared->tree_quality = suitable_quality(
      primitive_count(scene), std::uint64_t(frame.width) * frame.height * frame.samples / slices);
  prepared->world = build_world(scene, prepared->tree_quality, time);
  const bool is_white = scene.integrator == Integrator::ambient_occlusion;
  if (is_white) block_all_but_cut_outs(scene, prepared->world);
  frame.world = prepared->world.view();
  frame.any_transmits = prepared->world.any_transmits;

  prepared->illumination = is_white ? even_sky(scene.ambient_occlusion) : scene.illumination;
  if (is_white)
    for (const Material& material : scene.materials) prepared->white.push_back(whitened(material));
  color(scene, nullptr, *prepared, frame, prepared->colored);
  frame.light_count = int(prepared->colored.lights.size());
  for (const AnyLight& light : prepared->colored.lights)
    frame.lights_have_limits |= with_light(light, [](const auto& one) { return has_limits(one); });
  for (const MaterialRecord& record : prepared->colored.unpainted) {
    frame.any_dark_inside |= record.dark_inside;
    frame.any_gaps |= record.gaps;
    frame.any_masks |= record.alpha == Alpha::mask && record.transmits;
  }
  for (const Texture& texture : scene.textures) prepared->textures.push_back(texture_record(texture));
  frame.textures = prepared->textures.data();
  if (scene.background_image && !is_white) {
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
  frame.layers.fog = frame.fog.density > 0;
  frame.whitted = scene.whitted;
  if (is_white) frame.whitted.max_depth = 1;
  frame.layers.lights = source_count(scene, frame.light_count);
  frame.layers.paths = scene.integrator == Integrator::path;
  if (!frame.layers.paths && frame.whitted.max_depth > 1)  // paths' layers are all by the direct way
    for (const Object& object : scene.objects)
      for (std::uint32_t m : object.materials) {
        // A refracted ray may be reflected totally.
        const MaterialRecord& record = prepared->colored.materials[m];
        frame.layers.refraction |= record.transmits;
        frame.layers.reflection |= record.reflects || record.transmits;
      }
  const Illumination& illumination = prepared->illumination;
  for (int model = 0; model < model_count; ++model)
    frame.fading[model] = {attenuation_of(illumination, ModelId(model)),
                           ambient_attenuation_of(illumination, ModelId(model))};
  if (illumination.occlusion) frame.occlusion = *illumination.occlusion;
  frame.minimum_distance = illumination.minimum_distance;
  const EmissionCounts counts = emission_counts(scene);
  const Emission emission(frame, prepared->world, counts.surfaces, counts.background);
  set_light_points(emission, frame, prepared->colored);
  if (scene.integrator == Integrator::path) {
    frame.tracing = Tracing::path;
    frame.path = scene.path;
    if (scene.illumination.attenuation) frame.path_attenuation = *scene.illumination.attenuation;
    prepared->emitters = prepare_emitters(frame, prepared->world);
    frame.emitters = &prepared->emitters->table;
  }
  if (scene.integrator == Integrator::spectral) {
    frame.layers.wavelengths = int(scene.spectral.wavelengths.size());
    prepared->passes = passes_of(scene);
    prepared->pass_frames.assign(prepared->passes.size(), frame);
    prepared->pass_colored.resize(prepared->passes.size());
    for (std::size_t p = 0; p < prepared->passes.size(); ++p) {
      Frame& of_pass = prepared->pass_frames[p];
      color(scene, &prepared->passes[p], *prepared, of_pass, prepared->pass_colored[p]);
      of_pass.pass = &prepared->passes[p];
      set_light_points(emission, of_pass, prepared->pass_colored[p]);
      prepared->passes[p].frame = &of_pass;
    }
    frame.passes = prepared->passes.data();
    frame.pass_count = int(prepared->passes.size());
  }
  return prepared;
}

Exposure::Exposure(const Scene& scene) : scene_(scene) {
  const std::vector<Vec2<double>> pattern = pattern_of(scene);
  if (is_in_slices(scene)) slices_ = shutter_of(scene, pattern).slices;
  else slices_.push_back({0, int(pattern.size()), 0.5});
}

const PreparedFrame& Exposure::at(int slice) {
  if (!prepared_ || slice != slice_) {
    prepared_.reset();  // before the next takes its memory
    prepared_ = prepare(scene_, slices_[std::size_t(slice)].time);
    slice_ = slice;
  }
  return *prepared_;
}

std::vector<Portion> Exposure::portions() const {
  std::vector<Portion> portions;
  for (const Slice& slice : slices_) portions.push_back({int(portions.size()), slice.first, slice.end});
  return portions;
}

}  // namespace lambent
