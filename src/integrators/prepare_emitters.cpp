#include "integrators/prepare_emitters.h"

#include <algorithm>
#include <cmath>

#include "integrators/build_light_tree.h"

namespace lambent {
namespace {

/// Emitters that lie somewhere and are not more than so many stand by themselves: each is then weighed as
/// what it is, not as a part of a group.
constexpr std::size_t few = 8;
/// The most cells that a picture around the scene is chosen from; of one with more texels a coarser level of
/// detail is taken.
constexpr std::int64_t most_cells = 1 << 21;

class Collector {
 public:
  Collector(const Frame& frame, const World& world)
      : frame_(frame), world_(world), out_(std::make_unique<PreparedEmitters>()) {}

  std::unique_ptr<PreparedEmitters> collect() {
    for (int l = 0; l < frame_.light_count; ++l) {
      out_->emitter_of_light.push_back(-1);
      with_light(frame_.lights[l], [&](const auto& light) { add_light(light, l); });
    }
    add_surfaces();
    root_the_bounded();
    add_background();
    out_->table = {out_->emitters.data(),
                   out_->nodes.data(),
                   out_->roots.data(),
                   int(out_->roots.size()),
                   out_->first_of_instance.data(),
                   out_->first_of_geometry.data(),
                   out_->emitter_of.data(),
                   out_->emitter_of_light.data(),
                   background_,
                   only_light(),
                   environment_};
    return std::move(out_);
  }

 private:
  std::int32_t add(EmitterKind kind, std::int32_t light, const HitIds<std::int32_t>& ids) {
    out_->emitters.push_back({kind, light, ids.instance, ids.geometry, ids.primitive, -1, 0});
    return std::int32_t(out_->emitters.size()) - 1;
  }

  /// Where nothing else shines, and its choice is certain.
  std::int32_t only_light() const {
    if (out_->emitters.size() != 1 || out_->roots[0].node < 0) return -1;
    const Emitter& e = out_->emitters[0];
    if (e.kind != EmitterKind::light) return -1;
    const bool has_extent =
        with_light(frame_.lights[e.light], []<class L>(const L&) { return HasExtent<L>; });
    return has_extent ? e.light : -1;
  }

  void add_unbounded(std::int32_t emitter, double irradiance, const Vec3<double>& L) {
    out_->emitters[std::size_t(emitter)].root = std::int32_t(out_->roots.size());
    out_->roots.push_back({-1, emitter, {}, irradiance, L});
  }

  // ---- the scene's lights

  template <class L> void add_light(const L& light, int number) {
    const double intensity = pi * mean_of_channels(emitted<double>(light.color, light.intensity));
    if (!(intensity > 0)) return;
    const std::int32_t emitter = add(EmitterKind::light, number, {-1, -1, -1});
    out_->emitter_of_light[std::size_t(number)] = emitter;
    LightBounds bounds;
    bounds.emitter = emitter;
    bounds.intensity = intensity;
    if constexpr (HasExtent<L>) {
      const LightBody body = body_of(light);
      if (body.kind == LightBody::Kind::sphere) add_ball(bounds.box, body.center, body.radius);
      else if (body.kind == LightBody::Kind::disc)
        add_disc(bounds.box, body.center, body.normal, body.radius);
      else
        for (const double u : {-0.5, 0.5})
          for (const double v : {-0.5, 0.5}) bounds.box.add(body.center + u * body.u + v * body.v);
      if (body.kind != LightBody::Kind::sphere) face(bounds, body.normal, body.two_sided);
      physical_.push_back(bounds);
    } else {
      const Beam beam = beam_of(light);
      if (beam.infinite) return add_unbounded(emitter, intensity, -beam.axis);
      bounds.box.add(beam.position);
      if (beam.half_angle < 180) {
        bounds.axis = beam.axis;
        bounds.spread = beam.half_angle / 360;
        bounds.reach = 0;
      }
      (frame_.path_attenuation == attenuation_1_over_r2 ? physical_ : fading_).push_back(bounds);
    }
  }

  static void add_ball(Bounds& box, const Vec3<double>& center, double radius) {
    const Vec3<double> r{radius, radius, radius};
    box.add(center - r), box.add(center + r);
  }
  static void add_disc(Bounds& box, const Vec3<double>& center, const Vec3<double>& normal, double radius) {
    const auto reach = [&](double a) { return radius * sqrt(max(1 - a * a, 0.0)); };
    const Vec3<double> r{reach(normal.x), reach(normal.y), reach(normal.z)};
    box.add(center - r), box.add(center + r);
  }
  static void face(LightBounds& bounds, const Vec3<double>& normal, bool two_sided) {
    bounds.axis = normal;
    bounds.spread = 0;
    bounds.two_sided = two_sided;
  }

  // ---- surfaces

  void add_surfaces() {
    const std::vector<char> instanced = are_instanced(world_);
    for (std::size_t g = 0; g < world_.geometries.size(); ++g)
      out_->first_of_geometry.push_back(instanced[g] ? -1 : add_geometry(-1, std::int32_t(g)));
    for (std::size_t i = 0; i < world_.instances.size(); ++i)
      out_->first_of_instance.push_back(add_geometry(std::int32_t(i), world_.instances[i].geometry));
  }

  /// Where its primitives' emitters begin in emitter_of; -1: it has none.
  std::int64_t add_geometry(std::int32_t instance, std::int32_t geometry) {
    const Geometry& g = world_.geometries[std::size_t(geometry)];
    if (g.kind == PrimitiveKind::plane) return -1;  // infinite: it cannot be chosen from evenly
    std::int64_t first = -1;
    for (std::uint32_t i = 0; i < g.count; ++i) {
      const HitIds<std::int32_t> ids{instance, geometry, std::int32_t(i)};
      const std::uint32_t material = material_of(frame_.world, instance, geometry, ids.primitive);
      const double radiance = mean_emission(material);
      if (!(radiance > 0)) continue;
      const LightBounds bounds = bounds_of(ids, radiance, !frame_.unpainted[material].one_sided);
      if (!(bounds.intensity > 0)) continue;
      if (first < 0) {
        first = std::int64_t(out_->emitter_of.size());
        out_->emitter_of.resize(out_->emitter_of.size() + g.count, -1);
      }
      const std::int32_t emitter = add(EmitterKind::surface, -1, ids);
      out_->emitter_of[std::size_t(first) + i] = emitter;
      physical_.push_back(bounds);
      physical_.back().emitter = emitter;
    }
    return first;
  }

  /// The mean over the channels, and about that over the maps: their last level of detail.
  double mean_emission(std::uint32_t material) const {
    const MaterialRecord& m = frame_.unpainted[material];
    if (m.light >= 0) return 0;  // is a light already
    Rgb emission = m.emission;
    for (int i = 0; i < m.map_count && !is_black(emission); ++i) {
      if (m.maps[i].slot != MapSlot::emission) continue;
      const TextureMap& map = m.maps[i].map;
      const TextureRecord& texture = frame_.textures[map.texture];
      const Texel texel = detail::texel_at(texture, texture.levels[texture.level_count - 1], 0, 0);
      for (int c = 0; c < color_channels; ++c)
        emission[c] *= std::max(map.offset + map.gain * texel.c[c], 0.0);
    }
    return mean_of_channels(emission);
  }

  LightBounds bounds_of(const HitIds<std::int32_t>& ids, double radiance, bool two_sided) const {
    const Geometry& g = world_.geometries[std::size_t(ids.geometry)];
    const Instance* instance = ids.instance >= 0 ? &world_.instances[std::size_t(ids.instance)] : nullptr;
    LightBounds bounds;
    bounds.two_sided = two_sided;
    if (g.kind == PrimitiveKind::triangle) {
      for (const std::uint32_t corner : g.triangles[ids.primitive])
        bounds.box.add(detail::corner_in_world(g, instance, corner));
      const Vec3<double> n = detail::outward_double_area(g, instance, ids.primitive);
      const double twice = length(n);
      if (!(twice > 0)) return bounds;
      face(bounds, n / twice, two_sided);
      bounds.intensity = 0.5 * twice * radiance;
      return bounds;
    }
    Bounds box;
    double area = 0;  // the largest that it shows
    if (g.kind == PrimitiveKind::sphere) {
      const Sphere& s = g.spheres[ids.primitive];
      add_ball(box, s.center, s.radius);
      area = pi * s.radius * s.radius;
    } else if (g.kind == PrimitiveKind::disc) {
      const Disc& d = g.discs[ids.primitive];
      add_disc(box, d.center, d.normal, d.radius);
      area = pi * d.radius * d.radius;
      face(bounds, instance ? normalize(transform_normal(instance->object_from_world, d.normal)) : d.normal,
           two_sided);
    } else {
      const PlacedCone& c = g.cones[ids.primitive];
      const double top = c.radius + c.slope * c.height;
      add_disc(box, c.base, c.axis, c.radius);
      add_disc(box, c.base + c.height * c.axis, c.axis, top);
      area = (c.radius + top) * c.height;
    }
    if (!instance) {
      bounds.box = box;
    } else {
      const Transform& t = instance->world_from_object;
      for (int corner = 0; corner < 8; ++corner)
        bounds.box.add(transform_point(
            t, {corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                corner & 4 ? box.upper.z : box.lower.z}));
      const double stretch = std::max({dot(t.x, t.x), dot(t.y, t.y), dot(t.z, t.z)});
      area *= stretch;
    }
    bounds.intensity = area * radiance;
    return bounds;
  }

  // ---- trees

  void root_the_bounded() {
    const bool by_themselves = physical_.size() + fading_.size() <= few;
    root(physical_, attenuation_1_over_r2, by_themselves);
    root(fading_, frame_.path_attenuation, by_themselves);
  }
  void root(std::vector<LightBounds>& lights, const Attenuation& fading, bool by_themselves) {
    if (lights.empty()) return;
    if (by_themselves) {
      for (const LightBounds& light : lights) add_tree({light}, fading);
    } else {
      add_tree(std::move(lights), fading);
    }
  }
  void add_tree(std::vector<LightBounds> lights, const Attenuation& fading) {
    const auto root = std::int32_t(out_->roots.size());
    out_->roots.push_back({std::int32_t(out_->nodes.size()), -1, fading, 0, {}});
    std::vector<LightPath> paths;
    build_light_tree(std::move(lights), out_->nodes, paths);
    for (const LightPath& path : paths) {
      Emitter& emitter = out_->emitters[std::size_t(path.emitter)];
      emitter.root = root, emitter.path = path.path;
    }
  }

  // ---- the background

  void add_background() {
    double irradiance = pi * mean_of_channels(frame_.background);
    if (frame_.environment.texture.levels) irradiance = pi * choose_from_picture();
    if (!(irradiance > 0)) return;
    background_ = add(EmitterKind::background, -1, {-1, -1, -1});
    add_unbounded(background_, irradiance, {});
  }

  /// Lays out the tables; the mean radiance over all directions.
  double choose_from_picture() {
    const TextureRecord& texture = frame_.environment.texture;
    const int number = finest_level(texture, most_cells);
    const Texture::Level& level = texture.levels[number];
    const int width = level.width, height = level.height;

    std::vector<double> brightness(std::size_t(width) * std::size_t(height));
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const Texel texel = detail::texel_at(texture, level, x, y);
        Rgb color;
        for (int c = 0; c < color_channels; ++c) color[c] = frame_.background[c] * texel.c[c];
        const double value = mean_of_channels(color);
        brightness[std::size_t(y) * std::size_t(width) + std::size_t(x)] =
            value > 0 && std::isfinite(value) ? value : 0;
      }
    const auto at = [&](int x, int y) {
      return brightness[std::size_t(std::clamp(y, 0, height - 1)) * std::size_t(width) +
                        std::size_t((x + width) % width)];
    };
    // The mean over a cell of what is linear between the middles of the texels: 1/8, 3/4 and 1/8 of three in
    // a line. Zero only where it is black from end to end.
    const auto across = [&](int x, int y) { return 0.125 * (at(x - 1, y) + at(x + 1, y)) + 0.75 * at(x, y); };
    out_->rows.push_back(0);
    double sum = 0;
    for (int y = 0; y < height; ++y) {
      const auto [top, bottom] = detail::band_of_row(y, height);
      double in_row = 0;
      out_->columns.push_back(0);
      for (int x = 0; x < width; ++x) {
        in_row += 0.125 * (across(x, y - 1) + across(x, y + 1)) + 0.75 * across(x, y);
        out_->columns.push_back(in_row);
      }
      sum += in_row * (top - bottom);
      out_->rows.push_back(sum);
    }
    environment_ = {width, height, out_->rows.data(), out_->columns.data()};
    return sum / (2.0 * width);  // the bands' heights add up to 2
  }

  const Frame& frame_;
  const World& world_;
  std::unique_ptr<PreparedEmitters> out_;
  std::vector<LightBounds> physical_, fading_;  ///< That lie somewhere: by 1/r^2, and as the scene says.
  std::int32_t background_ = -1;
  EnvironmentChoice environment_;
};

}  // namespace

double mean_of_channels(const Rgb& color) {
  double sum = 0;
  for (int c = 0; c < color_channels; ++c) sum += color[c];
  return sum / color_channels;
}

std::vector<char> are_instanced(const World& world) {
  std::vector<char> instanced(world.geometries.size());
  for (const Instance& instance : world.instances) instanced[std::size_t(instance.geometry)] = 1;
  return instanced;
}

int finest_level(const TextureRecord& texture, std::int64_t most) {
  int number = 0;
  const auto cells = [&](int i) { return std::int64_t(texture.levels[i].width) * texture.levels[i].height; };
  while (number + 1 < texture.level_count && cells(number) > most) ++number;
  return number;
}

std::unique_ptr<PreparedEmitters> prepare_emitters(const Frame& frame, const World& world) {
  return Collector(frame, world).collect();
}

}  // namespace lambent
