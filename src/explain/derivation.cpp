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

/// Notes what a kernel tells.
class Notes {
 public:
  Notes(Derivation& derivation, const Frame& frame) : to_(derivation), frame_(frame) {}

  Witness witness() {
    return {this,
            [](void* self, const SeenRay& seen) { static_cast<Notes*>(self)->ray(seen); },
            [](void* self, const SeenHit& seen) { static_cast<Notes*>(self)->hit(seen); },
            [](void* self, const SeenLight& seen) { static_cast<Notes*>(self)->light(seen); },
            [](void* self, const SeenTerm& seen) { static_cast<Notes*>(self)->term(seen); },
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
    to_.rays.push_back(ray);
    sample_of_.push_back(seen.parent == no_ray ? std::size_t(seen.pixel) + std::size_t(seen.sample)
                                               : sample_of_[seen.parent]);
    if (seen.parent != no_ray) to_.rays[seen.parent].children.push_back(seen.ray);
    else to_.samples[sample_of_.back()].eye_ray = seen.ray;
  }
  void hit(const SeenHit& seen) {
    DerivedRay& ray = to_.rays[seen.ray];
    ray.hits = true;
    ray.hit = seen;
    ray.material = to_.scene->materials[seen.material];
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
    ray.lights.resize(std::size_t(frame_.light_count));
  }
  void light(const SeenLight& seen) {
    DerivedRay& ray = to_.rays[seen.ray];
    DerivedLight& light = ray.lights[std::size_t(seen.light)];
    light.seen = seen;
    light.NL = dot(ray.hit.N, seen.L);
    if (seen.asked) light.obstacles = on_the_way(ray.hit.start, seen.L, seen.r);
    const bool blocked = !light.obstacles.empty() && light.obstacles.back().blocks;
    light.state = !(light.NL > 0)         ? LightState::behind
                  : is_black(seen.I)      ? LightState::dark
                  : blocked || !seen.open ? LightState::blocked
                                          : LightState::visible;
  }
  void term(const SeenTerm& seen) {
    DerivedRay& ray = to_.rays[seen.ray];
    switch (seen.term) {
      case Term::ambient:
        ray.ambient = seen.color;
        return;
      case Term::emission:
        ray.emission = seen.color;
        return;
      case Term::diffuse:
        ray.lights[std::size_t(seen.light)].diffuse = seen.color;
        return;
      case Term::specular:
        ray.lights[std::size_t(seen.light)].specular = seen.color;
        return;
    }
  }
  void color(const SeenColor& seen) {
    to_.rays[seen.ray].color = seen.color;
    add(seen.ray, seen.color);
  }
  void find(const SeenFind& seen) {
    to_.rays[seen.ray].find = seen;
    add(seen.ray, seen.brings);
  }
  void search(const SeenSearch& seen) {
    to_.rays[seen.ray].search = seen;
    if (seen.open) add(seen.ray, seen.brings);
  }
  void add(std::uint32_t ray, const Rgb& color) {
    to_.samples[sample_of_[ray]].order.push_back({ray, color});
  }

  /// What the shadow ray meets, up to the first thing that blocks it: asked for as `transmittance` in the
  /// kernel does.
  std::vector<Obstacle> on_the_way(const Vec3<double>& start, const Vec3<double>& L, double r) const {
    std::vector<Obstacle> obstacles;
    QueryRay<float> ray(cast<float>(start), cast<float>(L));
    const Vec3<double> d = normalize(cast<double>(ray.d));
    double left = float(r), gone = 0;
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
  const Frame& frame_;
  std::vector<std::size_t> sample_of_;
};

}  // namespace

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

/// Where the samples lie.
Derivation begun(std::shared_ptr<const Scene> scene, const Frame& frame, int x, int y, int samples) {
  Derivation result;
  result.scene = std::move(scene);
  result.x = x, result.y = y;
  double nearest = 0;
  for (const Pixel& pixel : pixels_of(*result.scene, x, y))
    for (int s = 0; s < samples; ++s) {
      DerivedSample sample;
      sample.x = pixel.x + frame.pattern[s].x;
      sample.y = pixel.y + frame.pattern[s].y;
      const double dx = sample.x - x - 0.5, dy = sample.y - y - 0.5, distance = dx * dx + dy * dy;
      if (result.samples.empty() || distance < nearest)
        nearest = distance, result.central = int(result.samples.size());
      result.samples.push_back(sample);
    }
  return result;
}

/// Adds the samples up, renders the pixel, and develops both.
void finish(Derivation& result, const Frame& frame, const Kernel& kernel, int samples) {
  const bool corners = result.scene->image.pattern == Pattern::corners;
  const std::vector<Pixel> pixels = pixels_of(*result.scene, result.x, result.y);
  std::vector<double> sums(pixels.size() * color_channels);
  Scratch scratch;
  RayCounts counts;
  kernel.render(frame, {pixels.data(), std::uint32_t(pixels.size()), 0, samples, sums.data(), nullptr},
                scratch, counts);
  for (DerivedSample& sample : result.samples) {
    for (const DerivedSummand& summand : sample.order)
      for (int c = 0; c < color_channels; ++c)
        sample.color[c] += result.rays[summand.ray].seen.weight[c] * summand.color[c];
    for (const Derivation& pass : result.passes)
      sample.color = sample.color +
                     from_pass(pass.pass, pass.samples[std::size_t(&sample - result.samples.data())].color);
    result.sum = result.sum + sample.color;
  }
  // Developed as a picture of this pixel alone.
  ImageSettings alone = result.scene->image;
  alone.width = alone.height = 1;
  const auto developed = [&](const auto& sum_of, float* to) {
    Film film(alone);
    for (std::size_t p = 0; p < pixels.size(); ++p)
      for (int c = 0; c < color_channels; ++c)
        film.values[p * color_channels + std::size_t(c)] = float(sum_of(p, c) / samples);
    std::ranges::copy(develop(std::move(film), alone).data, to);
  };
  developed([&](std::size_t p, int c) { return corners ? result.samples[p].color[c] : result.sum[c]; },
            result.pixel);
  developed([&](std::size_t p, int c) { return sums[p * color_channels + std::size_t(c)]; }, result.rendered);
}

Derivation derive_from(std::shared_ptr<const Scene> scene, Frame frame, const Kernel& kernel, int x, int y,
                       int samples) {
  Derivation result = begun(std::move(scene), frame, x, y, samples);
  Notes notes(result, frame);
  const Witness witness = notes.witness();
  const RayListener listener = notes.listener();
  frame.witness = &witness;
  frame.listener = &listener;
  finish(result, frame, kernel, samples);
  return result;
}

}  // namespace

Derivation derive(std::shared_ptr<const Scene> scene, const PreparedFrame& prepared, const Kernel& kernel,
                  int x, int y, int samples) {
  if (prepared.passes.empty()) return derive_from(std::move(scene), prepared.frame, kernel, x, y, samples);
  Derivation result = begun(scene, prepared.frame, x, y, samples);
  const Scene lean = without_shapes(*scene);
  for (const Pass& pass : prepared.passes) {
    Derivation& of_pass = result.passes.emplace_back(
        derive_from(scene_in_pass(lean, pass), *pass.frame, kernel, x, y, samples));
    of_pass.pass = pass;
    of_pass.pass.frame = nullptr;  // which does not live as long
    const auto first = scene->spectral.wavelengths.begin() + pass.first;
    of_pass.wavelengths.assign(first, first + pass.count);
    result.asked.insert(result.asked.end(), of_pass.asked.begin(), of_pass.asked.end());
  }
  finish(result, prepared.frame, kernel, samples);
  return result;
}

}  // namespace lambent
