#pragma once
// What the renderer told about one pixel, in order.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "integrators/kernels.h"
#include "integrators/prepare.h"
#include "scene/standing_lights.h"

namespace lambent {

/// Something on the way to a light.
struct Obstacle {
  std::uint32_t object, material;
  double distance;  ///< From where the shadow ray began.
  bool blocks;      ///< False: it lets light through, times
  Rgb leaves;       ///< this.
};

/// Why a light does not shine on a surface, the first that holds; or that it does.
enum class LightState {
  out_of_reach,  ///< The renderer has not looked at it.
  behind,        ///< N.L <= 0
  dark,          ///< It sends nothing this way.
  blocked,
  visible,
};

/// A light, or one of its points.
struct DerivedLight {
  LightPoint point{};
  const char* kind = "";  ///< What sort of light it is.
  int number = 0;         ///< Among those of its source, from 0 on.
  Rgb Il{};               ///< Of the point where it shines brightest, unfaded.
  LightState state = LightState::out_of_reach;
  SeenLight seen{};
  double NL = 0;
  std::vector<Obstacle> obstacles;  ///< Up to the first that blocks.
  Rgb diffuse{}, specular{};
};

struct DerivedRay {
  SeenRay seen{};
  bool hits = false;
  SeenHit hit{};
  Material material;  ///< With the numbers that it has at this point.
  std::uint32_t object = 0;
  std::int32_t primitive = 0;  ///< Within its shape.
  std::optional<SeenFog> fog;
  Rgb ambient{}, emission{};
  std::vector<DerivedLight> lights;  ///< One for each point of the scene's lights.
  Rgb color{};                       ///< What it adds, before its weight.
  std::vector<std::uint32_t> children;
  // Of paths:
  std::optional<SeenFind> find;
  std::optional<SeenSearch> search;
};

/// What is added to a sample: the ray's weight times a colour. Where there is fog on the way the ray counts
/// once for that, and then for less.
struct DerivedSummand {
  std::uint32_t ray;
  Rgb weight, color;
  bool is_fog = false;
};

/// Where a sample's first ray goes through the lens.
struct DerivedLens {
  Vec2<double> at;     ///< From its centre, to the right and up, in scene units.
  Vec3<double> focus;  ///< The point of the plane in focus that it goes through.
};

/// A sample: its first ray, and what is added, in order.
struct DerivedSample {
  double x = 0, y = 0;  ///< In pixels from the picture's top left corner.
  double time = 0;      ///< Of the shutter's; where something moves.
  std::uint32_t eye_ray = 0;
  std::vector<DerivedSummand> order;
  Rgb color{};  ///< Their sum.
};

struct Derivation {
  std::shared_ptr<const Scene> scene;
  std::vector<StandingLight> standing_lights;
  Illumination illumination;  ///< The scene's, or what its integrator puts in its place; so is
  Rgb background;
  int x, y;
  std::vector<DerivedRay> rays;  ///< By their number.
  std::vector<DerivedSample> samples;
  int central = 0;
  Rgb sum{};                            ///< Of the samples' colours, in their order.
  float pixel[color_channels] = {};     ///< The mean, as the film keeps it.
  float rendered[color_channels] = {};  ///< The same from the renderer's own sum.
  std::vector<AskedRay> asked;

  /// Of a picture that is made of wavelengths: a derivation for each pass, with a wavelength in each channel
  /// of its colours. Samples, sum and pixel are in linear sRGB then, and there are no rays but theirs.
  std::vector<Derivation> passes;
  Pass pass{};                      ///< Of one of these: what its channels add to linear sRGB,
  std::vector<double> wavelengths;  ///< and which they are, in nm.

  const Material& material_of(const DerivedRay& ray) const { return ray.material; }
  ModelId model_of(const DerivedRay& ray) const {
    return material_of(ray).model.value_or(illumination.model);
  }
  /// Where an object was written, or a light that stands in the world; and the material that it was given.
  const Place& place_of_object(std::uint32_t object) const;
  const Material& given_material(std::uint32_t material) const;
  /// Of a camera that has a lens.
  std::optional<DerivedLens> lens_of(const DerivedSample& sample) const;
  /// Whether the terms are the rendered pixel, in every bit.
  bool adds_up() const;
  /// A channel of the pixel in an 8-bit PNG.
  int code(int channel) const;
};

/// Renders pixel x, y once more, and notes what is told. `portions`: which samples it gets.
Derivation derive(std::shared_ptr<const Scene> scene, Exposure& exposure, const Kernel& kernel, int x, int y,
                  const std::vector<Portion>& portions);

}  // namespace lambent
