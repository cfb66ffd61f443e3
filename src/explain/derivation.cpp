#include "explain/derivation.h"

#include <algorithm>

#include "accel/surface.h"
#include "film/film.h"
#include "image/srgb.h"
#include "integrators/paint.h"
#include "integrators/spectral.h"
#include "lambent/image.h"

namespace lambent {
namespace {

/// Notes what a kernel tells in one call.
class Notes {
 public:
  /// `portion`: whose first sample of each pixel is in its turn the derivation's from `first_sample` on.
  Notes(Derivation& derivation, const PreparedFrame& prepared, const Frame& frame, const Portion& portion,
        std::size_t first_sample)
      : to_(derivation),
        materials_(prepared.white.empty() ? derivation.scene->materials : prepared.white),
        frame_(frame),
        portion_(portion),
        first_sample_(first_sample),
        first_ray_(std::uint32_t(derivation.rays.size())) {}

  Witness witness() {
    return {this,
            [](void* self, const SeenRay& seen) { static_cast<Notes*>(self)->ray(seen); },
            [](void* self, const SeenHit& seen) { static_cast<Notes*>(self)->hit(seen); },
            [](void* self, const SeenLight& seen) { static_cast<Notes*>(self)->light(seen); },
            [](void* self, const SeenTerm& seen) { static_cast<Notes*>(self)->term(seen); },
            [](void* self, const SeenFog& seen) { static_cast<Notes*>(self)->fog(seen); },
            [](void* self, const SeenColor& seen) { static_cast<Notes*>(self)->color(seen); },
            [](void* self, const SeenFind& seen) { static_cast<Notes*>(self)->find(seen); },
            [](void* self, const SeenSearch& seen) { static_cast<Notes*>(self)->search(seen); }};
  }
  RayListener listener() {
    return {this,
            [](void* self, const AskedRay& ray) { static_cast<Notes*>(self)->to_.asked.push_back(ray); }};
  }

 private:
  void ray(const SeenRay& seen) {
    DerivedRay ray;
    ray.seen = seen;
    ray.seen.ray += first_ray_;
    if (seen.parent == no_ray) {
      const std::size_t sample = first_sample_ +
                                 std::size_t(seen.pixel) * std::size_t(portion_.end - portion_.first) +
                                 std::size_t(seen.sample - portion_.first);
      sample_of_.push_back(sample);
      to_.samples[sample].eye_ray = ray.seen.ray;
    } else {
      ray.seen.parent += first_ray_;
      sample_of_.push_back(sample_of_[seen.parent]);
      to_.rays[ray.seen.parent].children.push_back(ray.seen.ray);
    }
    to_.rays.push_back(std::move(ray));
  }
  void hit(const SeenHit& seen) {
    DerivedRay& ray = to_.rays[first_ray_ + seen.ray];
    ray.hits = true;
    ray.hit = seen;
    ray.material =
        seen.material < materials_.size() ? materials_[seen.material] : to_.given_material(seen.material);
    ray.material.ambient = seen.numbers.ambient;
    ray.material.diffuse = seen.numbers.diffuse;
    ray.material.specular = seen.numbers.specular;
    ray.material.shininess = seen.numbers.shininess;
    ray.material.emission = seen.numbers.emission;
    ray.material.reflect = seen.numbers.reflect;
    ray.material.transmit = seen.numbers.transmit;
    ray.material.ior = seen.numbers.ior;
    ray.object = object_of(frame_.world, seen.instance, seen.geometry, seen.primitive);
    // Small shapes of many objects stand together in one geometry: count from the object's first.
    const Geometry& g = frame_.world.geometries[seen.geometry];
    ray.primitive = seen.primitive;
    if (g.object_of_primitive)
      for (ray.primitive = 0; ray.primitive < seen.primitive &&
                              g.object_of_primitive[seen.primitive - ray.primitive - 1] == ray.object;)
        ++ray.primitive;
    ray.lights.resize(std::size_t(frame_.light_point_count));
    for (std::size_t p = 0; p < ray.lights.size(); ++p) {
      const LightPoint& point = frame_.light_points[p];
      DerivedLight& light = ray.lights[p];
      light.point = point;
      light.number =
          p > 0 && ray.lights[p - 1].point.source == point.source ? ray.lights[p - 1].number + 1 : 0;
      with_light(frame_.lights[point.light], [&](const auto& one) {
        light.kind = std::decay_t<decltype(one)>::info.name;
        light.Il = point.share * brightest<double>(one);
      });
    }
  }
  void light(const SeenLight& seen) {
    DerivedRay& ray = to_.rays[first_ray_ + seen.ray];
    DerivedLight& light = ray.lights[std::size_t(seen.point)];
    light.seen = seen;
    light.NL = dot(ray.hit.N, seen.L);
    if (seen.asked) light.obstacles = on_the_way(ray.hit.start, seen.toward, seen.far);
    const bool blocked = !light.obstacles.empty() && light.obstacles.back().blocks;
    light.state = !(light.NL > 0)         ? LightState::behind
                  : is_black(seen.I)      ? LightState::dark
                  : blocked || !seen.open ? LightState::blocked
                                          : LightState::visible;
  }
  void term(const SeenTerm& seen) {
    DerivedRay& ray = to_.rays[first_ray_ + seen.ray];
    switch (seen.term) {
      case Term::ambient:
        ray.ambient = seen.color;
        return;
      case Term::emission:
        ray.emission = seen.color;
        return;
      case Term::diffuse:
        ray.lights[std::size_t(seen.point)].diffuse = seen.color;
        return;
      case Term::specular:
        ray.lights[std::size_t(seen.point)].specular = seen.color;
        return;
    }
  }
  void fog(const SeenFog& seen) {
    DerivedRay& ray = to_.rays[first_ray_ + seen.ray];
    to_.samples[sample_of_[seen.ray]].order.push_back({ray.seen.ray, ray.seen.weight, seen.brings, true});
    ray.fog = seen;
  }
  void color(const SeenColor& seen) {
    to_.rays[first_ray_ + seen.ray].color = seen.color;
    add(seen.ray, seen.color);
  }
  void find(const SeenFind& seen) {
    to_.rays[first_ray_ + seen.ray].find = seen;
    add(seen.ray, seen.brings);
  }
  void search(const SeenSearch& seen) {
    to_.rays[first_ray_ + seen.ray].search = seen;
    if (seen.open) add(seen.ray, seen.brings);
  }
  void add(std::uint32_t ray, const Rgb& color) {
    const DerivedRay& which = to_.rays[first_ray_ + ray];
    to_.samples[sample_of_[ray]].order.push_back(
        {which.seen.ray, which.fog ? which.fog->weight : which.seen.weight, color});
  }

  /// What the shadow ray meets, up to the first thing that blocks it: asked for as `transmittance` in the
  /// kernel does.
  std::vector<Obstacle> on_the_way(const Vec3<double>& start, const Vec3<double>& toward, double far) const {
    std::vector<Obstacle> obstacles;
    QueryRay<float> ray(cast<float>(start), cast<float>(toward));
    const Vec3<double> d = normalize(cast<double>(ray.d));
    double left = float(far), gone = 0;
    while (left > 0) {
      Closest<float> hit{float(left)};
      find_closest(frame_.world, ray, true, hit);
      if (hit.ids.geometry < 0) break;
      const auto& [instance, geometry, primitive] = hit.ids;
      const std::uint32_t material = material_of(frame_.world, instance, geometry, primitive);
      const SurfacePoint<double> s = surface_at(frame_.world, hit.ids, cast<double>(ray.o), d, hit.t);
      const bool see_through = frame_.world.material_transmits[material];
      const Rgb leaves = see_through ? share_through(frame_, hit.ids, material, s, d) : Rgb{};
      const bool blocks = is_black(leaves);
      if (!(leaves == grey(1.0)))  // through a gap
        obstacles.push_back(
            {object_of(frame_.world, instance, geometry, primitive), material, gone + s.t, blocks, leaves});
      if (blocks) break;
      gone += s.t;
      left -= max(s.t, 0.0);
      const double side = dot(s.Ng, d) >= 0 ? 1.0 : -1.0;
      ray.o = cast<float>(s.P + side * s.offset * s.Ng);
    }
    return obstacles;
  }

  Derivation& to_;
  const std::vector<Material>& materials_;
  const Frame& frame_;
  const Portion& portion_;
  std::size_t first_sample_;
  std::uint32_t first_ray_;  ///< Of the derivation's: rays are numbered anew in each call.
  std::vector<std::size_t> sample_of_;
};

}  // namespace

const Place& Derivation::place_of_object(std::uint32_t object) const {
  const std::size_t count = scene->objects.size();
  return object < count ? scene->objects[object].place : standing_lights[object - count].material.place;
}
const Material& Derivation::given_material(std::uint32_t material) const {
  const std::size_t count = scene->materials.size();
  return material < count ? scene->materials[material] : standing_lights[material - count].material;
}
std::optional<DerivedLens> Derivation::lens_of(const DerivedSample& sample) const {
  const CameraRecord camera = camera_record(scene->camera);
  if (!(camera.lens_radius > 0)) return {};
  const SeenRay& ray = rays[sample.eye_ray].seen;
  const Vec3<double> focus = ray.o + (camera.focus / dot(ray.d, camera.forward)) * ray.d;
  const bool flat = scene->camera.projection == Projection::orthographic;
  const Vec3<double> off_centre = ray.o - (flat ? focus - camera.focus * camera.forward : camera.eye);
  return DerivedLens{{dot(off_centre, camera.right), dot(off_centre, camera.up)}, focus};
}

bool Derivation::adds_up() const { return std::equal(pixel, pixel + color_channels, rendered); }

int Derivation::code(int channel) const {
  const double linear = pixel[channel];
  return quantize(scene->image.encoding == Encoding::srgb ? srgb_from_linear(linear) : linear, 255);
}

namespace {

/// The scene with a wavelength in each channel of its colours, without what takes much room and says nothing
/// about light.
std::shared_ptr<const Scene> scene_in_pass(const Scene& lean, const Pass& pass) {
  auto scene = std::make_shared<Scene>(lean);
  for (Light& light : scene->lights) light.light = light_in_pass(lean, pass, light);
  for (Material& material : scene->materials)
    if (!material.metallic_roughness) material = material_in_pass(lean, pass, material);
  scene->illumination.ambient = ambient_in_pass(lean, pass);
  scene->background = in_pass(pass, lean.background);
  return scene;
}
Scene without_shapes(const Scene& scene) {
  Scene lean = scene;
  for (Shape& shape : lean.shapes) shape.primitives = {};
  for (Texture& texture : lean.textures) texture = {};
  return lean;
}

/// With Pattern::corners the samples are four pixels of the film, of one sample each.
std::vector<Pixel> pixels_of(const Scene& scene, int x, int y) {
  if (scene.image.pattern != Pattern::corners) return {{x, y}};
  return {{x, y}, {x + 1, y}, {x, y + 1}, {x + 1, y + 1}};
}

constexpr int no_pass = -1;

/// A pixel rendered once more: where its samples lie, and their sums; what is told of them, unless the
/// picture is made of several passes.
struct Rendered {
  Derivation derivation;
  std::vector<double> sums;
  int samples = 0;  ///< Of each pixel.
};
/// `pass`: which of the frame's is looked at, or no_pass.
Rendered render_pixel(std::shared_ptr<const Scene> scene, Exposure& exposure, const Kernel& kernel, int x,
                      int y, const std::vector<Portion>& portions, int pass) {
  Rendered rendered;
  Derivation& result = rendered.derivation;
  result.scene = std::move(scene);
  result.standing_lights = standing_lights(*result.scene);
  result.x = x, result.y = y;
  const std::vector<Pixel> pixels = pixels_of(*result.scene, x, y);
  rendered.sums.resize(pixels.size() * color_channels);
  double nearest = 0;
  Scratch scratch;
  RayCounts counts;
  for (const Portion& portion : portions) {
    const PreparedFrame& prepared = exposure.at(portion.slice);
    Frame frame = pass == no_pass ? prepared.frame : prepared.pass_frames[std::size_t(pass)];
    result.illumination = pass == no_pass ? prepared.illumination : result.scene->illumination;
    result.background = frame.background;
    const std::size_t first_sample = result.samples.size();
    for (const Pixel& pixel : pixels)
      for (int s = portion.first; s < portion.end; ++s) {
        const Vec2<double>& at = frame.pattern[frame.order ? frame.order[s] : s];
        DerivedSample sample;
        sample.x = pixel.x + at.x, sample.y = pixel.y + at.y;
        sample.time = exposure.slices()[std::size_t(portion.slice)].time;
        const double dx = sample.x - x - 0.5, dy = sample.y - y - 0.5, distance = dx * dx + dy * dy;
        if (result.samples.empty() || distance < nearest)
          nearest = distance, result.central = int(result.samples.size());
        result.samples.push_back(sample);
      }
    rendered.samples += portion.end - portion.first;

    Notes notes(result, prepared, frame, portion, first_sample);
    const Witness witness = notes.witness();
    const RayListener listener = notes.listener();
    if (frame.pass_count == 0) frame.witness = &witness, frame.listener = &listener;
    kernel.render(frame,
                  {pixels.data(), std::uint32_t(pixels.size()), portion.first, portion.end,
                   rendered.sums.data(), nullptr},
                  scratch, counts);
  }
  return rendered;
}

/// Adds the samples up, and develops both sums as a picture of this pixel alone.
Derivation finished(Rendered rendered) {
  Derivation& result = rendered.derivation;
  const bool corners = result.scene->image.pattern == Pattern::corners;
  for (DerivedSample& sample : result.samples) {
    for (const DerivedSummand& summand : sample.order)
      for (int c = 0; c < color_channels; ++c) sample.color[c] += summand.weight[c] * summand.color[c];
    for (const Derivation& pass : result.passes)
      sample.color = sample.color +
                     from_pass(pass.pass, pass.samples[std::size_t(&sample - result.samples.data())].color);
    result.sum = result.sum + sample.color;
  }
  ImageSettings alone = result.scene->image;
  alone.width = alone.height = 1;
  const auto developed = [&](const auto& sum_of, float* to) {
    Film film(alone);
    for (std::size_t p = 0; p < rendered.sums.size() / color_channels; ++p)
      for (int c = 0; c < color_channels; ++c)
        film.values[p * color_channels + std::size_t(c)] = float(sum_of(p, c) / rendered.samples);
    std::ranges::copy(develop(std::move(film), alone).data, to);
  };
  developed([&](std::size_t p, int c) { return corners ? result.samples[p].color[c] : result.sum[c]; },
            result.pixel);
  developed([&](std::size_t p, int c) { return rendered.sums[p * color_channels + std::size_t(c)]; },
            result.rendered);
  return std::move(result);
}

}  // namespace

Derivation derive(std::shared_ptr<const Scene> scene, Exposure& exposure, const Kernel& kernel, int x, int y,
                  const std::vector<Portion>& portions) {
  Rendered whole = render_pixel(scene, exposure, kernel, x, y, portions, no_pass);
  const std::vector<Pass> passes = exposure.at(portions[0].slice).passes;
  const Scene lean = passes.empty() ? Scene{} : without_shapes(*scene);
  for (std::size_t p = 0; p < passes.size(); ++p) {
    Derivation& of_pass = whole.derivation.passes.emplace_back(
        finished(render_pixel(scene_in_pass(lean, passes[p]), exposure, kernel, x, y, portions, int(p))));
    of_pass.pass = passes[p];
    of_pass.pass.frame = nullptr;  // which does not live as long
    const auto first = scene->spectral.wavelengths.begin() + passes[p].first;
    of_pass.wavelengths.assign(first, first + passes[p].count);
    whole.derivation.asked.insert(whole.derivation.asked.end(), of_pass.asked.begin(), of_pass.asked.end());
  }
  return finished(std::move(whole));
}

}  // namespace lambent
