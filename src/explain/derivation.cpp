#include "explain/derivation.h"

#include <algorithm>

#include "accel/surface.h"
#include "film/film.h"
#include "image/srgb.h"
#include "integrators/paint.h"
#include "lambent/image.h"

namespace lambent {
namespace {

/// Notes what a kernel tells in one call.
class Notes {
 public:
  /// `pass`: whose first sample of each pixel is in its turn the derivation's from `first_sample` on.
  Notes(Derivation& derivation, const PreparedFrame& prepared, const Pass& pass, std::size_t first_sample)
      : to_(derivation),
        materials_(prepared.white.empty() ? derivation.scene->materials : prepared.white),
        frame_(prepared.frame),
        pass_(pass),
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
                                 std::size_t(seen.pixel) * std::size_t(pass_.end - pass_.first) +
                                 std::size_t(seen.sample - pass_.first);
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
    for (std::size_t p = 0; p < ray.lights.size(); ++p) ray.lights[p].point = frame_.light_points[p];
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
  const Pass& pass_;
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

Derivation derive(std::shared_ptr<const Scene> scene, Exposure& exposure, const Kernel& kernel, int x, int y,
                  const std::vector<Pass>& passes) {
  Derivation result;
  const bool corners = scene->image.pattern == Pattern::corners;
  result.scene = std::move(scene);
  result.standing_lights = standing_lights(*result.scene);
  result.x = x, result.y = y;

  // With Pattern::corners the samples are four pixels of the film, of one sample each.
  std::vector<Pixel> pixels{{x, y}};
  if (corners) pixels = {{x, y}, {x + 1, y}, {x, y + 1}, {x + 1, y + 1}};
  double nearest = 0;
  std::vector<double> sums(pixels.size() * color_channels);
  Scratch scratch;
  RayCounts counts;
  int samples = 0;  // of each pixel
  for (const Pass& pass : passes) {
    const PreparedFrame& prepared = exposure.at(pass.slice);
    result.illumination = prepared.illumination;
    result.background = prepared.frame.background;
    const std::size_t first_sample = result.samples.size();
    for (const Pixel& pixel : pixels)
      for (int s = pass.first; s < pass.end; ++s) {
        const Vec2<double>& at = prepared.frame.pattern[prepared.frame.order ? prepared.frame.order[s] : s];
        DerivedSample sample;
        sample.x = pixel.x + at.x, sample.y = pixel.y + at.y;
        sample.time = exposure.slices()[std::size_t(pass.slice)].time;
        const double dx = sample.x - x - 0.5, dy = sample.y - y - 0.5, distance = dx * dx + dy * dy;
        if (result.samples.empty() || distance < nearest)
          nearest = distance, result.central = int(result.samples.size());
        result.samples.push_back(sample);
      }
    samples += pass.end - pass.first;

    Frame frame = prepared.frame;
    Notes notes(result, prepared, pass, first_sample);
    const Witness witness = notes.witness();
    const RayListener listener = notes.listener();
    frame.witness = &witness;
    frame.listener = &listener;
    kernel.render(frame,
                  {pixels.data(), std::uint32_t(pixels.size()), pass.first, pass.end, sums.data(), nullptr},
                  scratch, counts);
  }

  for (DerivedSample& sample : result.samples) {
    for (const DerivedSummand& summand : sample.order)
      for (int c = 0; c < color_channels; ++c) sample.color[c] += summand.weight[c] * summand.color[c];
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
  return result;
}

}  // namespace lambent
