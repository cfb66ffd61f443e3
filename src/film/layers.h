#pragma once
// What a picture's colour is made of: (way x term x light), each a layer.
//
// The way is how light came from the surface that it lit to the eye: directly, or by the mirror ray or the
// refracted ray that left the surface which the eye sees, and whatever followed. On each way there are the
// ambient term, emission and background, then for each light the diffuse and the specular term, and the fog
// on the way, if there is some. Every summand of the picture belongs to exactly one layer.

#include <cstdint>

#include "math/color.h"

namespace lambent {

enum class Way : std::uint8_t { direct, reflection, refraction };

/// What shines beside the scene's lights comes after them: the surfaces that shine, then the background.
constexpr int surfaces_source(int lights) { return lights; }
constexpr int background_source(int lights) { return lights + 1; }

/// How layers are numbered.
struct LayerPlan {
  enum : int { ambient, emission, background, first_light };

  int lights = 0;  ///< And what else lights the scene.
  /// Paths tell apart whether a light's light came to the surface that the eye sees directly or by way of
  /// others. In place of its two terms they have these two layers, all by the direct way; `emission` and
  /// `background` are what the eye sees shine.
  bool paths = false;
  bool reflection = false, refraction = false;  ///< Whether anything may come on these ways.
  bool fog = false;
  int wavelengths = 0;  ///< Of a picture that is made of them: each is kept, too.

  int ways() const { return 1 + reflection + refraction; }
  int per_way() const { return first_light + 2 * lights + fog; }
  int fog_layer() const { return first_light + 2 * lights; }  ///< Of a way; if there is fog.
  int count() const { return ways() * per_way(); }
  /// The numbers of a pixel: each layer's channels, then the wavelengths.
  int columns() const { return count() * color_channels + wavelengths; }
  /// The number of a way's first layer; the way must be there.
  int first_of(Way way) const {
    return way == Way::direct ? 0 : way == Way::refraction && reflection ? 2 * per_way() : per_way();
  }
  Way way_of(int layer) const {
    const int number = layer / per_way();
    return number == 0 ? Way::direct : number == 1 && reflection ? Way::reflection : Way::refraction;
  }
  static int diffuse(int light) { return first_light + 2 * light; }
  static int specular(int light) { return first_light + 2 * light + 1; }
  static int direct(int source) { return diffuse(source); }
  static int indirect(int source) { return specular(source); }
};

/// What an eye ray met first.
struct FirstHit {
  std::int32_t object = -1;  ///< Index into the scene's objects; -1: nothing.
  std::int32_t material = -1;
  std::int32_t primitive = -1;  ///< Within its shape.
  float R = 0;                  ///< Distance from the eye.
  float P[3] = {}, N[3] = {};   ///< In the world; N on the eye's side.
  float albedo[3] = {};         ///< Kd.
  float uv[2] = {};             ///< Of meshes that have them.
};

}  // namespace lambent
