#pragma once
// What several tests of light are held against.

#include <cmath>
#include <random>
#include <vector>

#include "scene/mip_levels.h"
#include "scene/scene.h"

namespace lambent::test {

/// Lambert's formula of a polygon's irradiance, radiance 1: half the sum over its edges of the angle under
/// which each is seen times N . (unit normal of the plane through P and the edge). All of it lies above the
/// horizon.
inline double polygon_irradiance(const Vec3<double>& P, const Vec3<double>& N,
                                 const std::vector<Vec3<double>>& corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3<double> a = normalize(corners[i] - P), b = normalize(corners[(i + 1) % corners.size()] - P);
    sum += std::acos(dot(a, b)) * dot(normalize(cross(a, b)), N);
  }
  return std::fabs(sum) / 2;
}

/// Puts a picture around a scene, of three channels, each from `color` of its column and row.
template <class Function> void surround(Scene& scene, int width, int height, const Function& color) {
  Texture texture;
  texture.channels = 3;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Rgb here = color(x, y);
      for (int c = 0; c < 3; ++c) texture.floats.push_back(float(here[c]));
    }
  texture.levels = {{width, height, 0}};
  scene.textures.push_back(texture);
  build_levels(scene.textures.back());
  scene.background_image = std::uint32_t(scene.textures.size() - 1);
}

/// Likewise of texels of very different brightness, half of them black, turned and coloured.
inline void surround_by_specks(Scene& scene, int width, int height, float bright_ones, bool z_up,
                               double turn) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> u(0, 1);
  surround(scene, width, height, [&](int, int) {
    const float bright = u(random) < bright_ones ? 20 * u(random) : u(random) < 0.5f ? 0 : u(random);
    return Rgb{bright * (1 - 0.3f * 0), bright * (1 - 0.3f * 1), bright * (1 - 0.3f * 2)};
  });
  scene.background = {0.5, 1, 1};
  scene.background_turn = turn;
  scene.background_z_up = z_up;
}

}  // namespace lambent::test
