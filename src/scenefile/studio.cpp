#include "scenefile/studio.h"

#include <cmath>

#include "math/functions.h"
#include "scene/mip_levels.h"

namespace lambent {
namespace {

/// A soft rectangle of light; degrees.
struct Lamp {
  double longitude, latitude, half_width, half_height, edge;
  Rgb color;
};
// As the key, fill and rim lights, seen from the model; longitude 0 lies behind it.
constexpr Lamp lamps[] = {
    {-135, 40, 20, 15, 7, {3.6, 3.5, 3.3}},
    {130, 22, 13, 22, 9, {0.9, 0.95, 1}},
    {20, 48, 26, 7, 8, {1.6, 1.6, 1.6}},
};

/// How far `x` lies beyond `half` of `center`, going round where it must.
double beyond(double x, double center, double half) {
  double d = abs(x - center);
  if (d > 180) d = 360 - d;
  return max(d - half, 0.0);
}

Rgb radiance(double longitude, double latitude) {
  // The horizon is as dark as the far end of the floor; walls and ceiling are lighter.
  const double height = min(max((latitude - 16) / 60, 0.0), 1.0), dark = 0.02;
  Rgb color = grey(dark + 0.3 * height * height * (3 - 2 * height));
  for (const Lamp& lamp : lamps) {
    const double x = beyond(longitude, lamp.longitude, lamp.half_width) / lamp.edge,
                 y = beyond(latitude, lamp.latitude, lamp.half_height) / lamp.edge;
    color = color + exp2(-(x * x + y * y)) * lamp.color;
  }
  return color;
}

}  // namespace

Texture studio_texture() {
  constexpr int width = 256, height = 128;
  Texture texture;
  texture.source.name = "studio";
  texture.srgb = false;
  texture.channels = 3;
  texture.levels = {{width, height, 0}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Rgb color = radiance(360 * (x + 0.5) / width - 180, 90 - 180 * (y + 0.5) / height);
      for (int c = 0; c < 3; ++c) texture.floats.push_back(float(color[c]));
    }
  build_levels(texture);
  return texture;
}

}  // namespace lambent
