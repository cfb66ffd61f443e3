#include "integrators/emission_lights.h"

#include <algorithm>
#include <cmath>

#include "integrators/emitters.h"
#include "integrators/light_pattern.h"
#include "integrators/prepare_emitters.h"

namespace lambent {
namespace {

/// Something that shines, and cannot be cut further.
struct Piece {
  Vec3<double> at;      ///< Its middle, or its direction.
  Vec3<double> facing;  ///< The way a flat one shines, of unit length; otherwise zero.
  double power;         ///< By which pieces are weighed: larger than 0.
  std::size_t what;     ///< Which one.
};

/// Some pieces, and how many lights stand for them.
struct Part {
  std::size_t first, end;
  int lights;
};

double power_of(const std::vector<Piece>& pieces, std::size_t first, std::size_t end) {
  double sum = 0;
  for (std::size_t i = first; i < end; ++i) sum += pieces[i].power;
  return sum;
}

/// What a part is cut along: a coordinate of the pieces' middles, or of the ways they face.
double along(const Piece& piece, int axis) {
  const Vec3<double>& v = axis < 3 ? piece.at : piece.facing;
  return axis % 3 == 0 ? v.x : axis % 3 == 1 ? v.y : v.z;
}

/// The coordinate in which the pieces lie farthest apart. Ways that are opposite count as much as the part's
/// diagonal: sides of a box that look away from each other have no light in common.
int longest_axis(const std::vector<Piece>& pieces, const Part& part) {
  double extent[6];
  for (int axis = 0; axis < 6; ++axis) {
    double low = along(pieces[part.first], axis), high = low;
    for (std::size_t i = part.first; i < part.end; ++i) {
      low = std::min(low, along(pieces[i], axis));
      high = std::max(high, along(pieces[i], axis));
    }
    extent[axis] = high - low;
  }
  const double half_diagonal = length(Vec3<double>{extent[0], extent[1], extent[2]}) / 2;
  for (int axis = 3; axis < 6; ++axis) extent[axis] *= half_diagonal;
  return int(std::max_element(extent, extent + 6) - extent);
}

/// Cuts pieces, which are put into another order, into `count` parts, or as many as there are pieces.
/// `whole`: a single piece takes one light only, as more of them would stand in the same place.
std::vector<Part> median_cut(std::vector<Piece>& pieces, int count, bool whole) {
  const auto at_most = [&](int lights, std::size_t first, std::size_t end) {
    return whole && end - first < std::size_t(lights) ? int(end - first) : lights;
  };
  std::vector<Part> done, open;
  if (!pieces.empty()) open.push_back({0, pieces.size(), at_most(count, 0, pieces.size())});
  while (!open.empty()) {
    const Part part = open.back();
    open.pop_back();
    if (part.lights == 1 || part.end - part.first == 1) {
      done.push_back(part);
      continue;
    }
    const int axis = longest_axis(pieces, part);
    const auto begin = pieces.begin();
    std::sort(begin + std::ptrdiff_t(part.first), begin + std::ptrdiff_t(part.end),
              [axis](const Piece& a, const Piece& b) {
                const double x = along(a, axis), y = along(b, axis);
                return x != y ? x < y : a.what < b.what;
              });
    const double power = power_of(pieces, part.first, part.end);
    // Where the power so far is nearest to half of it; both sides have some pieces.
    std::size_t cut = part.first;
    double before = 0;
    while (cut + 1 < part.end && (cut == part.first || before + pieces[cut].power / 2 < power / 2))
      before += pieces[cut++].power;
    const int most = at_most(part.lights - 1, part.first, cut),
              least = part.lights - at_most(part.lights - 1, cut, part.end),
              left = std::clamp(int(std::lround(part.lights * before / power)), least, most);
    open.push_back({cut, part.end, part.lights - left});
    open.push_back({part.first, cut, left});
  }
  return done;
}

Rgb without_nonsense(Rgb color) {
  for (int c = 0; c < color_channels; ++c)
    if (!(color[c] > 0) || !std::isfinite(color[c])) color[c] = 0;
  return color;
}

// ---- surfaces

/// Where the light of a painted primitive is looked up: in so many points.
constexpr int looks = 16;

}  // namespace

class Emission::Surfaces {
 public:
  Surfaces(const Frame& frame, const World& world, int count) : frame_(frame), world_(world) {
    collect();
    parts_ = median_cut(pieces_, count, false);
  }

  void add_lights(const Frame& frame, EmissionLights& out) const {
    for (const Part& part : parts_) {
      if (part.end - part.first == 1) add_one(frame, shining_[pieces_[part.first].what], part.lights, out);
      else add_many(frame, part, out);
    }
  }

 private:
  struct Shining {
    HitIds<std::int32_t> ids;
    Rgb strength;  ///< Radiance times area, in red, green and blue.
    bool two_sided;
  };

  const Geometry& geometry_of(const HitIds<std::int32_t>& ids) const {
    return world_.geometries[std::size_t(ids.geometry)];
  }
  const Instance* instance_of(const HitIds<std::int32_t>& ids) const {
    return ids.instance >= 0 ? &world_.instances[std::size_t(ids.instance)] : nullptr;
  }
  bool is_ball(const HitIds<std::int32_t>& ids) const {
    return geometry_of(ids).kind == PrimitiveKind::sphere && ids.instance < 0;
  }

  void collect() {
    const std::vector<char> instanced = are_instanced(world_);
    for (std::size_t g = 0; g < world_.geometries.size(); ++g)
      if (!instanced[g]) collect(-1, std::int32_t(g));
    for (std::size_t i = 0; i < world_.instances.size(); ++i)
      collect(std::int32_t(i), world_.instances[i].geometry);
  }

  void collect(std::int32_t instance, std::int32_t geometry) {
    const Geometry& g = world_.geometries[std::size_t(geometry)];
    if (g.kind == PrimitiveKind::plane) return;
    for (std::uint32_t i = 0; i < g.count; ++i) {
      const HitIds<std::int32_t> ids{instance, geometry, std::int32_t(i)};
      const MaterialRecord& m =
          frame_.unpainted[material_of(frame_.world, instance, geometry, ids.primitive)];
      if (m.light >= 0 || is_black(m.emission)) continue;
      add(ids, !m.one_sided, m.painted || g.colors);
    }
  }

  void add(const HitIds<std::int32_t>& ids, bool two_sided, bool is_painted) {
    Rgb strength{};
    Vec3<double> middle{};
    const PrimitiveKind kind = geometry_of(ids).kind;
    const int count = is_painted || kind != PrimitiveKind::triangle ? looks : 1;
    for (int i = 0; i < count; ++i) {
      const PointOn point = point_on(ids, i, count);
      strength = strength + strength_at(ids, point);
      middle = middle + (1.0 / count) * point.Q;
    }
    const double power = mean_of_channels(strength);
    if (!(power > 0) || !std::isfinite(power)) return;
    const bool is_flat = kind == PrimitiveKind::disc || kind == PrimitiveKind::triangle;
    pieces_.push_back({is_ball(ids) ? geometry_of(ids).spheres[ids.primitive].center : middle,
                       is_flat ? point_on(ids, 0, 1).n : Vec3<double>{}, power, shining_.size()});
    shining_.push_back({ids, strength, two_sided});
  }

  struct PointOn {
    Vec3<double> Q, n;
    double area;  ///< That it stands for.
  };
  /// One of `count` points that are spread over a primitive; a triangle's only one is its middle.
  PointOn point_on(const HitIds<std::int32_t>& ids, int number, int count) const {
    const bool is_middle = count == 1 && geometry_of(ids).kind == PrimitiveKind::triangle;
    const Vec2<double> at = is_middle ? Vec2<double>{4.0 / 9, 0.5} : point_of_light(number, count);
    const auto [Q, n] = detail::point_in_world(geometry_of(ids), instance_of(ids), ids.primitive, at.x, at.y);
    if (!(dot(n, n) > 0)) return {Q, n, 0};
    return {Q, n, 1 / (count * detail::density_by_area(frame_, ids, n))};
  }
  /// Radiance times area, in red, green and blue.
  Rgb strength_at(const HitIds<std::int32_t>& ids, const PointOn& point) const {
    return point.area * without_nonsense(detail::emission_at(frame_, ids, point.Q, point.n, -point.n));
  }

  /// As the frame has it. Of a pass that is a wavelength in each channel; what is painted is red, green and
  /// blue before.
  Rgb in_frame(const Frame& frame, const HitIds<std::int32_t>& ids, const Rgb& strength) const {
    if (!frame.pass) return strength;
    const std::uint32_t material = material_of(frame.world, ids.instance, ids.geometry, ids.primitive);
    const MaterialRecord& before = frame.unpainted[material];
    if (before.painted || geometry_of(ids).colors) return in_pass(*frame.pass, strength);
    return (mean_of_channels(strength) / mean_of_channels(before.emission)) *
           frame.materials[material].emission;
  }

  /// A point of a primitive: of a triangle one that lies near `at`.
  PointOn point_near(const HitIds<std::int32_t>& ids, const Vec3<double>& at) const {
    PointOn point = point_on(ids, 0, 1);
    const Geometry& g = geometry_of(ids);
    if (g.kind != PrimitiveKind::triangle) return point;
    Vec3<double> corner[3];
    for (int i = 0; i < 3; ++i)
      corner[i] = detail::corner_in_world(g, instance_of(ids), g.triangles[ids.primitive][std::size_t(i)]);
    // Its barycentric coordinates, of which none may be less than zero.
    double b[3], sum = 0;
    for (int i = 0; i < 3; ++i) {
      const Vec3<double>&p = corner[(i + 1) % 3], &q = corner[(i + 2) % 3];
      const Vec3<double> inwards = cross(cross(q - p, corner[i] - p), q - p);
      b[i] = max(dot(at - p, inwards) / dot(corner[i] - p, inwards), 0.0);
      sum += b[i];
    }
    if (!(sum > 0) || !std::isfinite(sum)) return point;
    point.Q = (b[0] / sum) * corner[0] + (b[1] / sum) * corner[1] + (b[2] / sum) * corner[2];
    return point;
  }

  void add_one(const Frame& frame, const Shining& one, int count, EmissionLights& out) const {
    if (is_ball(one.ids)) return add_ball(one, in_frame(frame, one.ids, one.strength), count, out);
    for (int i = 0; i < count; ++i) {
      const PointOn point = point_on(one.ids, i, count);
      add_flat(one, point, in_frame(frame, one.ids, strength_at(one.ids, point)), out);
    }
  }

  /// All of a part's light comes from the primitive whose middle is nearest to its own.
  void add_many(const Frame& frame, const Part& part, EmissionLights& out) const {
    const double power = power_of(pieces_, part.first, part.end);
    Rgb strength{};
    Vec3<double> middle{};
    for (std::size_t i = part.first; i < part.end; ++i) {
      const Shining& shining = shining_[pieces_[i].what];
      strength = strength + in_frame(frame, shining.ids, shining.strength);
      middle = middle + (pieces_[i].power / power) * pieces_[i].at;
    }
    std::size_t nearest = part.first;
    const auto distance = [&](std::size_t i) { return length(pieces_[i].at - middle); };
    for (std::size_t i = part.first + 1; i < part.end; ++i)
      if (distance(i) < distance(nearest)) nearest = i;
    const Shining& one = shining_[pieces_[nearest].what];
    if (is_ball(one.ids)) add_ball(one, strength, 1, out);
    else add_flat(one, point_near(one.ids, middle), strength, out);
  }

  void add_ball(const Shining& one, const Rgb& strength, int count, EmissionLights& out) const {
    const Sphere& s = geometry_of(one.ids).spheres[one.ids.primitive];
    SphereLight light;
    light.center = s.center, light.radius = s.radius;
    light.color = (1 / (4 * pi)) * strength;
    for (int i = 0; i < count; ++i) {
      const Vec2<double> at = point_of_light(i, count);
      out.points.push_back(
          {int(out.lights.size()), surfaces_source(frame_.light_count), at.x, at.y, 1.0 / count, true});
    }
    out.lights.emplace_back(light);
  }

  /// A light whose middle is the point. Its sides only say how far from the origin the primitive reaches,
  /// which is how exactly its place is known.
  void add_flat(const Shining& one, const PointOn& point, const Rgb& strength, EmissionLights& out) const {
    if (is_black(strength)) return;
    const double size = detail::size_around(geometry_of(one.ids), instance_of(one.ids), one.ids.primitive);
    const Axes<double> axes = axes_around(point.n);
    RectangleLight light;
    light.center = point.Q;
    light.u = size * axes.x, light.v = size * axes.y;
    light.color = (1 / pi) * strength;
    light.two_sided = one.two_sided;
    out.points.push_back({int(out.lights.size()), surfaces_source(frame_.light_count), 0.5, 0.5, 1, true});
    out.lights.emplace_back(light);
  }

  const Frame& frame_;
  const World& world_;
  std::vector<Shining> shining_;
  std::vector<Piece> pieces_;
  std::vector<Part> parts_;
};

// ---- the background

class Emission::Sky {
 public:
  Sky(const Frame& frame, int count) : has_picture_(frame.environment.texture.levels) {
    // Of a picture the finest level of detail that has not more cells than these: it is the mean of the finer
    // ones, so a sun that is smaller than a cell keeps its power.
    constexpr int most_cells = 1 << 17;
    const TextureRecord& texture = frame.environment.texture;
    Texture::Level level{128, 64, 0};
    if (has_picture_) level = texture.levels[finest_level(texture, most_cells)];
    for (int y = 0; y < level.height; ++y) {
      const double solid_angle =
          detail::solid_angle_of_cell(detail::band_of_row(y, level.height), level.width);
      const auto [across, up] = sincos_degrees(180.0 * (y + 0.5) / level.height);
      for (int x = 0; x < level.width; ++x) {
        Rgb color = frame.background;
        if (has_picture_) {
          const Texel texel = detail::texel_at(texture, level, x, y);
          for (int c = 0; c < color_channels; ++c) color[c] *= texel.c[c];
        }
        const Rgb irradiance = solid_angle * without_nonsense(color);
        const double brightness = mean_of_channels(irradiance);
        if (!(brightness > 0) || !std::isfinite(brightness)) continue;
        // An even sky is cut in the same way whatever its colour.
        const double power = has_picture_ ? brightness : solid_angle;
        pieces_.push_back(
            {detail::direction_in_picture(frame.environment, (x + 0.5) / level.width, up, across),
             {},
             power,
             irradiances_.size()});
        irradiances_.push_back(irradiance);
        solid_angles_.push_back(solid_angle);
      }
    }
    parts_ = median_cut(pieces_, count, true);
  }

  void add_lights(const Frame& frame, EmissionLights& out) const {
    for (const Part& part : parts_) {
      Vec3<double> middle{};
      Rgb irradiance{};
      double solid_angle = 0;
      for (std::size_t i = part.first; i < part.end; ++i) {
        middle = middle + pieces_[i].power * pieces_[i].at;
        irradiance = irradiance + irradiances_[pieces_[i].what];
        solid_angle += solid_angles_[pieces_[i].what];
      }
      // A pass has the background's colour in its wavelengths; a picture's are made of red, green and blue.
      if (frame.pass)
        irradiance = has_picture_ ? in_pass(*frame.pass, irradiance) : solid_angle * frame.background;
      // The whole sky as one light, evenly bright, comes from nowhere.
      if (!(length(middle) > 1e-9 * power_of(pieces_, part.first, part.end))) middle = {0, 1, 0};
      DirectionalLight light;
      light.direction = -normalize(middle);
      light.color = (1 / pi) * irradiance;
      out.points.push_back(
          {int(out.lights.size()), background_source(frame.light_count), 0.5, 0.5, 1, false});
      out.lights.emplace_back(light);
    }
  }

 private:
  bool has_picture_;
  std::vector<Piece> pieces_;
  std::vector<Part> parts_;
  std::vector<Rgb> irradiances_;  ///< Of the pieces: radiance times solid angle, in red, green and blue.
  std::vector<double> solid_angles_;
};

Emission::Emission(const Frame& frame, const World& world, int surfaces, int background) {
  if (surfaces > 0) surfaces_ = std::make_unique<Surfaces>(frame, world, surfaces);
  if (background > 0) sky_ = std::make_unique<Sky>(frame, background);
}
Emission::~Emission() = default;

EmissionLights Emission::lights(const Frame& frame) const {
  EmissionLights out;
  if (surfaces_) surfaces_->add_lights(frame, out);
  if (sky_) sky_->add_lights(frame, out);
  return out;
}

}  // namespace lambent
