#include "integrators/view.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "film/layer_book.h"

namespace lambent {
namespace {

/// A hue all around the circle, at full strength: its largest channel is 1, its least 0.
Rgb pure_hue(double turn) {
  Rgb color;
  for (int c = 0; c < color_channels; ++c) {
    const double at = turn + c / 3.0;
    color[c] = std::clamp(std::fabs((at - std::floor(at)) * 6 - 3) - 1, 0.0, 1.0);
  }
  return color;
}

Rgb mix(const Rgb& a, const Rgb& b, double share) { return (1 - share) * a + share * b; }

double cosine(const AnyLight& light, const FirstHit& hit) {
  const Vec3<double> P{hit.P[0], hit.P[1], hit.P[2]}, N{hit.N[0], hit.N[1], hit.N[2]};
  return with_light(light, [&](const auto& one) { return max(dot(N, sample(one, P, 0.5, 0.5).L), 0.0); });
}

}  // namespace

ViewRecord view_record(const Scene& scene, const ViewSettings& view) {
  ViewRecord record{view.show, length(scene.camera.target - scene.camera.eye), {}};
  for (const Light& light : scene.lights)
    if (light.name == view.light) {
      record.light = light.light;
      break;
    }
  return record;
}

Rgb view_color(const ViewRecord& view, const FirstHit& hit) {
  if (hit.object < 0) return {};
  const auto number = [](std::int32_t n) { return std::to_string(n); };
  switch (view.show) {
    case View::normals:
      return {(hit.N[0] + 1.0) / 2, (hit.N[1] + 1.0) / 2, (hit.N[2] + 1.0) / 2};
    case View::depth:
      return grey(1 / (1 + hit.R / view.distance));
    case View::uv:
      return {hit.uv[0] - std::floor(double(hit.uv[0])), hit.uv[1] - std::floor(double(hit.uv[1])), 0};
    case View::primitives:
      return color_of_name(number(hit.object) + " " + number(hit.primitive));
    case View::objects:
      return color_of_name(number(hit.object));
    case View::materials:
      return color_of_name(number(hit.material));
    case View::cosine:
      return grey(cosine(view.light, hit));
    case View::rays:
      break;  // of a pixel, not of a sample
  }
  return {};
}

Rgb color_of_name(const std::string& name) {
  // Three parts of the hash: 12 bits of hue, 10 each of strength and lightness.
  const std::uint32_t hash = murmur3(name);
  const double turn = (hash & 4095) * 0x1p-12, strength = (hash >> 12 & 1023) * 0x1p-10,
               lightness = (hash >> 22) * 0x1p-10;
  return (0.4 + 0.6 * lightness) * mix(grey(1.0), pure_hue(turn), 0.65 + 0.33 * strength);
}

Rgb color_of_ray_count(std::uint64_t rays, std::uint64_t most) {
  static constexpr Rgb scale[] = {
      {0.004, 0.006, 0.08}, {0.005, 0.06, 0.22}, {0.01, 0.22, 0.20}, {0.05, 0.42, 0.06},
      {0.45, 0.62, 0.03},   {0.95, 0.75, 0.05},  {1, 1, 1}};
  constexpr int steps = int(std::size(scale)) - 1;
  const double at =
      most == 0 ? 0 : steps * std::min(1.0, log2(1.0 + double(rays)) / log2(1.0 + double(most)));
  const int step = std::min(int(at), steps - 1);
  return mix(scale[step], scale[step + 1], at - step);
}

Frame frame_for(const Frame& frame, View view) {
  Frame result = frame;
  if (view == View::rays) return result;
  result.light_count = result.light_point_count = 0;
  result.whitted.max_depth = 1;
  return result;
}

}  // namespace lambent
