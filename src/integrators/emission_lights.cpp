#include "integrators/emission_lights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "integrators/emitters.h"
#include "integrators/light_pattern.h"

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

/// Cuts pieces, which are put into another order, into `count` parts, or as many as there is power for.
/// `whole`: a single piece takes one light only, as more of them would stand in the same place.
std::vector<Part> median_cut(std::vector<Piece>& pieces, int count, bool whole) {
  std::vector<Part> done, open;
  if (!pieces.empty()) open.push_back({0, pieces.size(), count});
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
    int left = std::clamp(int(std::lround(part.lights * before / power)), 1, part.lights - 1);
    if (whole) {
      const auto most = [](std::size_t n) { return int(std::min<std::size_t>(n, 1 << 20)); };
      left = std::min(left, most(cut - part.first));
      left = std::max(left, std::min(part.lights - most(part.end - cut), most(cut - part.first)));
    }
    int right = part.lights - left;
    if (whole) right = int(std::min<std::size_t>(std::size_t(right), part.end - cut));
    open.push_back({cut, part.end, right});
    open.push_back({part.first, cut, left});
  }
  return done;
}

double mean(const Rgb& color) {
  double sum = 0;
  for (int c = 0; c < color_channels; ++c) sum += color[c];
  return sum / color_channels;
}

Rgb without_nonsense(Rgb color) {
  for (int c = 0; c < color_channels; ++c)
    if (!(color[c] > 0) || !std::isfinite(color[c])) color[c] = 0;
  return color;
}

// ---- surfaces

/// Where the light of a painted primitive is looked up: in so many points.
constexpr int looks = 16;

class Surfaces {
 public:
  Surfaces(const Frame& frame, const World& world) : frame_(frame), world_(world) {}

  EmissionLights lights(int count) {
    collect();
    for (const Part& part : median_cut(pieces_, count, false)) {
      if (part.end - part.first == 1) add_one(shining_[pieces_[part.first].what], part.lights);
      else add_many(part);
    }
    return std::move(out_);
  }

 private:
  struct Shining {
    HitIds<std::int32_t> ids;
    double area;
    Rgb strength;  ///< Radiance times area, in the frame's colours.
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
    std::vector<char> instanced(world_.geometries.size());
    for (const Instance& instance : world_.instances) instanced[std::size_t(instance.geometry)] = 1;
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
    Rgb of_all{};  // red, green and blue: what is cut must not depend on the wavelength
    Vec3<double> middle{};
    double power = 0, area = 0;
    const int count = is_painted || geometry_of(ids).kind != PrimitiveKind::triangle ? looks : 1;
    for (int i = 0; i < count; ++i) {
      const auto [Q, n, part] = point_on(ids, i, count);
      const Rgb rgb = without_nonsense(detail::emission_at(frame_, ids, Q, n, -n));
      of_all = of_all + part * radiance(ids, rgb);
      power += part * mean(rgb);
      area += part;
      middle = middle + (1.0 / count) * Q;
    }
    if (!(power > 0) || !std::isfinite(power)) return;
    const PrimitiveKind kind = geometry_of(ids).kind;
    const bool is_flat = kind == PrimitiveKind::disc || kind == PrimitiveKind::triangle;
    pieces_.push_back({is_ball(ids) ? geometry_of(ids).spheres[ids.primitive].center : middle,
                       is_flat ? point_on(ids, 0, 1).n : Vec3<double>{}, power, shining_.size()});
    shining_.push_back({ids, area, of_all, two_sided});
  }

  /// Emission as the frame has it. Of a pass that is a wavelength in each channel; what is painted is red,
  /// green and blue before.
  Rgb radiance(const HitIds<std::int32_t>& ids, const Rgb& rgb) const {
    if (!frame_.pass) return rgb;
    const std::uint32_t material = material_of(frame_.world, ids.instance, ids.geometry, ids.primitive);
    const MaterialRecord &before = frame_.unpainted[material], &m = frame_.materials[material];
    if (before.painted || geometry_of(ids).colors) return in_pass(*frame_.pass, rgb);
    return mean(before.emission) > 0 ? (mean(rgb) / mean(before.emission)) * m.emission : Rgb{};
  }

  struct PointOn {
    Vec3<double> Q, n;
    double area;  ///< That it stands for.
  };
  /// One of `count` points that are spread over a primitive; a triangle's only one is its middle.
  PointOn point_on(const HitIds<std::int32_t>& ids, int number, int count) const {
    const Geometry& g = geometry_of(ids);
    const Instance* instance = instance_of(ids);
    const Vec2<double> at = point_of_light(number, count);
    if (g.kind == PrimitiveKind::triangle) {
      const auto& [i, j, k] = g.triangles[ids.primitive];
      const double root = std::sqrt(at.x), third = 1.0 / 3;
      const double b0 = count == 1 ? third : 1 - root, b1 = count == 1 ? third : root * (1 - at.y),
                   b2 = count == 1 ? third : root * at.y;
      const Vec3<double> n = detail::double_area(g, instance, ids.primitive);
      const double twice = length(n);
      if (!(twice > 0)) return {{}, {0, 0, 1}, 0};
      const bool flipped = instance ? determinant(instance->world_from_object) < 0 : g.flipped;
      return {b0 * detail::corner_in_world(g, instance, i) + b1 * detail::corner_in_world(g, instance, j) +
                  b2 * detail::corner_in_world(g, instance, k),
              ((flipped ? -1.0 : 1.0) / twice) * n, 0.5 * twice / count};
    }
    const detail::AreaPoint local = detail::point_of_primitive(g, ids.primitive, at.x, at.y);
    PointOn result{local.Q, local.n, 0};
    if (instance) {
      result.Q = transform_point(instance->world_from_object, local.Q);
      result.n = normalize(transform_normal(instance->object_from_world, local.n));
    }
    result.area = 1 / (count * detail::density_by_area(frame_, ids, result.n));
    return result;
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

  void add_one(const Shining& one, int count) {
    if (is_ball(one.ids)) return add_ball(one, one.strength, count);
    for (int i = 0; i < count; ++i) {
      const PointOn point = point_on(one.ids, i, count);
      const Rgb radiance = this->radiance(
          one.ids, without_nonsense(detail::emission_at(frame_, one.ids, point.Q, point.n, -point.n)));
      add_flat(one, point, point.area * radiance);
    }
  }

  /// All of a part's light comes from the primitive whose middle is nearest to its own.
  void add_many(const Part& part) {
    const double power = power_of(pieces_, part.first, part.end);
    Rgb strength{};
    Vec3<double> middle{};
    for (std::size_t i = part.first; i < part.end; ++i) {
      strength = strength + shining_[pieces_[i].what].strength;
      middle = middle + (pieces_[i].power / power) * pieces_[i].at;
    }
    std::size_t nearest = part.first;
    const auto distance = [&](std::size_t i) { return length(pieces_[i].at - middle); };
    for (std::size_t i = part.first + 1; i < part.end; ++i)
      if (distance(i) < distance(nearest)) nearest = i;
    const Shining& one = shining_[pieces_[nearest].what];
    if (is_ball(one.ids)) add_ball(one, strength, 1);
    else add_flat(one, point_near(one.ids, middle), strength);
  }

  void add_ball(const Shining& one, const Rgb& strength, int count) {
    const Sphere& s = geometry_of(one.ids).spheres[one.ids.primitive];
    SphereLight light;
    light.center = s.center, light.radius = s.radius;
    light.color = (1 / (4 * pi)) * strength;
    for (int i = 0; i < count; ++i) {
      const Vec2<double> at = point_of_light(i, count);
      out_.points.push_back(
          {int(out_.lights.size()), surfaces_source(frame_.light_count), at.x, at.y, 1.0 / count, true});
    }
    out_.lights.emplace_back(light);
  }

  /// A light whose middle is the point. Its sides only say how far from the origin the primitive reaches,
  /// which is how exactly its place is known.
  void add_flat(const Shining& one, const PointOn& point, const Rgb& strength) {
    if (is_black(strength)) return;
    const double size = detail::size_around(geometry_of(one.ids), instance_of(one.ids), one.ids.primitive);
    const Axes<double> axes = axes_around(point.n);
    RectangleLight light;
    light.center = point.Q;
    light.u = size * axes.x, light.v = size * axes.y;
    light.color = (1 / pi) * strength;
    light.two_sided = one.two_sided;
    out_.points.push_back({int(out_.lights.size()), surfaces_source(frame_.light_count), 0.5, 0.5, 1, true});
    out_.lights.emplace_back(light);
  }

  const Frame& frame_;
  const World& world_;
  std::vector<Shining> shining_;
  std::vector<Piece> pieces_;
  EmissionLights out_;
};

// ---- the background

/// A cell of the sky.
struct Cell {
  Vec3<double> d;  ///< Its middle.
  double solid_angle;
};

/// By rows of equal steps of latitude, from the zenith on.
std::vector<Cell> cells_of_sky(const EnvironmentRecord& environment, int width, int height) {
  std::vector<Cell> cells;
  for (int y = 0; y < height; ++y) {
    const double top = sincos_degrees(180.0 * y / height).cos,
                 bottom = sincos_degrees(180.0 * (y + 1) / height).cos;
    const auto [across, up] = sincos_degrees(180.0 * (y + 0.5) / height);
    for (int x = 0; x < width; ++x) {
      const auto [sine, cosine] = sincos_degrees(360 * ((x + 0.5) / width - 0.5 - environment.turn));
      const Vec3<double> d{across * sine, up, -across * cosine};
      cells.push_back({environment.z_up ? Vec3<double>{d.x, -d.z, d.y} : d, 2 * pi / width * (top - bottom)});
    }
  }
  return cells;
}

}  // namespace

EmissionLights lights_of_surfaces(const Frame& frame, const World& world, int count) {
  return Surfaces(frame, world).lights(count);
}

EmissionLights lights_of_background(const Frame& frame, int count) {
  // Of a picture the finest level of detail that has not more cells than these: it is the mean of the finer
  // ones, so a sun that is smaller than a cell keeps its power.
  constexpr int most_cells = 1 << 17;
  int width = 128, height = 64;
  const TextureRecord& texture = frame.environment.texture;
  int number = 0;
  if (texture.levels) {
    const auto cells = [&](int i) {
      return std::int64_t(texture.levels[i].width) * texture.levels[i].height;
    };
    while (number + 1 < texture.level_count && cells(number) > most_cells) ++number;
    width = texture.levels[number].width, height = texture.levels[number].height;
  }
  // Cells in red, green and blue: what is cut must not depend on the wavelength.
  const std::vector<Cell> cells = cells_of_sky(frame.environment, width, height);
  std::vector<Rgb> colors;
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    Rgb color = frame.background;
    double power = texture.levels ? 0 : cells[i].solid_angle;
    if (texture.levels) {
      const Texel texel = detail::texel_at(texture, texture.levels[number], int(i) % width, int(i) / width);
      for (int c = 0; c < color_channels; ++c) color[c] *= texel.c[c];
      color = without_nonsense(color);
      power = cells[i].solid_angle * mean(color);
      if (frame.pass) color = in_pass(*frame.pass, color);
    }
    colors.push_back(color);
    if (power > 0 && std::isfinite(power)) pieces.push_back({cells[i].d, {}, power, i});
  }
  EmissionLights out;
  if (!texture.levels && is_black(frame.background)) return out;
  for (const Part& part : median_cut(pieces, count, true)) {
    Vec3<double> middle{};
    Rgb irradiance{};
    for (std::size_t i = part.first; i < part.end; ++i) {
      middle = middle + pieces[i].power * pieces[i].at;
      irradiance = irradiance + cells[pieces[i].what].solid_angle * colors[pieces[i].what];
    }
    // The whole sky as one light, evenly bright, comes from nowhere.
    if (!(length(middle) > 1e-9 * power_of(pieces, part.first, part.end))) middle = {0, 1, 0};
    DirectionalLight light;
    light.direction = -normalize(middle);
    light.color = (1 / pi) * irradiance;
    out.points.push_back({int(out.lights.size()), background_source(frame.light_count), 0.5, 0.5, 1, false});
    out.lights.emplace_back(light);
  }
  return out;
}

}  // namespace lambent
