#pragma once
// The scene: plain structs with indices. Everything that makes a picture, and nothing about how it is made.
//
// Lengths are in scene units, angles in degrees, colours linear RGB. Right-handed coordinates. Each struct of
// settings has its table of parameters beside it: the file format, its schema and the manual are made from
// these tables.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "illumination/models.h"
#include "lambent/diagnostics.h"
#include "lights/lights.h"
#include "math/transform.h"
#include "parameters/parameter.h"
#include "scene/texture.h"
#include "spectra/optical.h"

namespace lambent {

enum class Projection { perspective, orthographic };

struct Camera {
  Projection projection = Projection::perspective;
  Vec3<double> eye{0, 0, 5};
  Vec3<double> target{0, 0, 0};
  Vec3<double> up{0, 1, 0};
  double fov = 40;
  double height = 2;
  double aperture = 0;
  double focus_distance = 0;
};
template <>
inline constexpr Parameter<Camera> parameters_of<Camera>[] = {
    {"eye", &Camera::eye, {}, "scene units", "Where the camera stands.", true, Kind::point},
    {"target",
     &Camera::target,
     {},
     "scene units",
     "The point in the middle of the picture.",
     true,
     Kind::point},
    {"up",
     &Camera::up,
     {},
     "",
     "The direction that is up in the picture; not along the way to the target.",
     false,
     Kind::direction},
    {"fov", &Camera::fov, {0.01, 179}, "degrees", "Vertical field of view of a perspective camera."},
    {"height", &Camera::height, positive, "scene units", "Height of what an orthographic camera sees."},
    {"aperture", &Camera::aperture, at_least_zero, "scene units",
     "Diameter of the lens: what is not in focus is blurred, the more, the larger it is. 0 is a pinhole, "
     "which "
     "shows everything sharp."},
    {"focus_distance", &Camera::focus_distance, at_least_zero, "scene units",
     "How far in front of the lens, along the way to the target, things are sharp; 0: as far as the target."},
};

/// Where the camera is in focus: the distance of that plane from the eye.
double focus_distance(const Camera& camera);

/// Where the samples of a pixel lie.
enum class Pattern {
  stratified,  ///< `samples` points in each pixel, spread evenly, the same in every pixel; one sample is the
               ///< centre.
  corners,     ///< One ray through each corner of the pixels, a pixel is the mean of its four (the SPD
               ///< benchmark's rule).
};
enum class Filter { box, tent };
/// What a PNG holds.
enum class Encoding {
  srgb,  ///< sRGB-encoded values, as screens expect.
  none,  ///< The linear values as they are: the pictures of the 1980s, whose colours were meant so.
};

/// Samples where the picture needs them: `start` for every pixel, then four times as many, and again, up to
/// `max`, for those that differ so much in themselves or from their neighbours that they may be off by
/// `error`.
struct AdaptiveSamples {
  int start = 4, max = 256;
  double error = 1;
};
template <>
inline constexpr Parameter<AdaptiveSamples> parameters_of<AdaptiveSamples>[] = {
    {"start", &AdaptiveSamples::start, {4, 65536}, "", "Samples of every pixel."},
    {"max", &AdaptiveSamples::max, {4, 65536}, "", "Samples of the most difficult pixels; at least `start`."},
    {"error",
     &AdaptiveSamples::error,
     {0, 255},
     "steps of 8 bits",
     "How far a pixel may be from what `max` samples give; 0 lets no difference pass."},
};

struct ImageSettings {
  int width = 1280, height = 720;
  int samples = 1;
  std::optional<AdaptiveSamples> adaptive;  ///< In place of `samples`.
  /// Where something moves: at how many moments, at most, it is looked at while the shutter is open.
  int shutter_slices = 16;
  bool is_adaptive() const { return adaptive && pattern != Pattern::corners; }
  Pattern pattern = Pattern::stratified;
  Filter filter = Filter::box;
  Encoding encoding = Encoding::srgb;
};
inline constexpr Range sample_range{1, 65536}, slice_range{1, 4096};

/// What is kept of a picture beside its colours.
struct FilmSettings {
  bool layers = false;
};
template <>
inline constexpr Parameter<FilmSettings> parameters_of<FilmSettings>[] = {
    {"layers",
     &FilmSettings::layers,
     {},
     "",
     "Whether an EXR also holds what the colours are made of: ambient, emission and background, and for each "
     "light "
     "its diffuse and its specular part, directly and by reflection and refraction, which add up to the "
     "colours "
     "exactly; and depth, normals, albedo and who is where. See layers.md."},
};

/// How much of the ambient light reaches a point: the share of the directions around it, each as much as its
/// cosine with N counts, in which nothing stands within `distance`.
struct AmbientOcclusion {
  int rays = 1;
  double distance = 1e10;
};
template <>
inline constexpr Parameter<AmbientOcclusion> parameters_of<AmbientOcclusion>[] = {
    {"rays",
     &AmbientOcclusion::rays,
     {1, 4096},
     "",
     "Directions that each sample looks in; a pixel's samples look in different ones."},
    {"distance", &AmbientOcclusion::distance, positive, "scene units",
     "What stands farther away hides nothing."},
};

/// What lies between the eye and all that it sees, thicker with every step: of a colour there remains the
/// share exp(-density t) after the way t, and the rest is the fog's.
struct Fog {
  Rgb color{0.5, 0.5, 0.5};
  double density = 0;
  double start = 0;
};
template <>
inline constexpr Parameter<Fog> parameters_of<Fog>[] = {
    {"color", &Fog::color, at_least_zero, "", "Its colour, which is all that is seen far away."},
    {"density", &Fog::density, at_least_zero, "1 / scene units",
     "How fast it hides things: after 1 / density 37 % of a colour are left. 0 is no fog.", true},
    {"start", &Fog::start, at_least_zero, "scene units",
     "It begins where rays have come so far from the eye, over all bounces."},
};

/// The choices of the lecture that hold for the whole scene.
struct Illumination {
  ModelId model = ModelId::phong;
  Rgb ambient{1, 1, 1};                                   ///< Ia.
  std::map<std::string, Spectrum> spectra = {};           ///< Of colours that are given as spectra.
  std::optional<Attenuation> attenuation;                 ///< Unset: the model's own.
  std::optional<AmbientAttenuation> ambient_attenuation;  ///< Likewise.
  double minimum_distance = 1e-3;
  std::optional<AmbientOcclusion> occlusion;
};
template <>
inline constexpr Parameter<Illumination> parameters_of<Illumination>[] = {
    {"ambient", &Illumination::ambient, at_least_zero, "", "The ambient light Ia."},
    {"minimum_distance", &Illumination::minimum_distance, positive, "scene units",
     "r and R count as at least this, so that 1/r stays finite."},
};

struct WhittedSettings {
  int max_depth = 5;
  bool shadows = true;
  bool colored_shadows = true;
  bool trace_black_rays = false;
  int emission_samples = 0, background_samples = 0;
};
template <>
inline constexpr Parameter<WhittedSettings> parameters_of<WhittedSettings>[] = {
    {"max_depth",
     &WhittedSettings::max_depth,
     {1, 64},
     "",
     "How often a ray may be followed on; the ray from the eye is 1."},
    {"shadows", &WhittedSettings::shadows, {}, "", "Whether objects block light."},
    {"colored_shadows",
     &WhittedSettings::colored_shadows,
     {},
     "",
     "Whether a transmitting surface lets light through, straight on, times its transmit; if not, it blocks "
     "as any other."},
    {"trace_black_rays",
     &WhittedSettings::trace_black_rays,
     {},
     "",
     "Whether mirror rays are thrown from every reflecting or transmitting surface though their colour "
     "counts nothing, as the SPD benchmark counts rays."},
    {"emission_samples",
     &WhittedSettings::emission_samples,
     {0, 4096},
     "",
     "How many lights stand for all surfaces that have `emission`, planes excepted: they light others then. "
     "0: "
     "they only shine themselves. `path` does without."},
    {"background_samples",
     &WhittedSettings::background_samples,
     {0, 4096},
     "",
     "How many directional lights stand for the background, a colour or a picture. 0: it lights nothing. "
     "`path` does without."},
};

/// Path tracing: the rendering equation. `image.samples` paths for each pixel.
struct PathSettings {
  int max_depth = 64;
  int roulette_depth = 5;
  double clamp = 0;
  double until = 0;
  bool progressive = false;
  int max_samples = 65536;
  int seed = 0;
};
template <>
inline constexpr Parameter<PathSettings> parameters_of<PathSettings>[] = {
    {"max_depth",
     &PathSettings::max_depth,
     {1, 1024},
     "",
     "How many rays a path may have, one after the other; the ray from the eye is 1. With 1 surfaces are lit "
     "by "
     "lights alone, not by each other."},
    {"roulette_depth",
     &PathSettings::roulette_depth,
     {1, 1024},
     "",
     "From this ray on a path may end by chance, the sooner, the less it still counts (Russian roulette); "
     "the "
     "picture is right all the same."},
    {"clamp", &PathSettings::clamp, at_least_zero, "",
     "The most that indirect light may add to a sample, against bright specks; 0 is no limit. With a limit "
     "the "
     "picture is darker than right."},
    {"until", &PathSettings::until, zero_to_one, "",
     "Go on, `image.samples` at first, until the noise is no more than this share of the picture's mean "
     "luminance (one standard deviation, root mean square over the pixels); 0: no such limit."},
    {"progressive",
     &PathSettings::progressive,
     {},
     "",
     "Go on, `image.samples` at first, to `max_samples`, or as long as `lambent render --until 30s` says. "
     "`until` is so anyway."},
    {"max_samples",
     &PathSettings::max_samples,
     {1, 1 << 20},
     "",
     "With `until` or `progressive`: the most samples of a pixel, whatever noise is left."},
    {"seed",
     &PathSettings::seed,
     {0, 1e9},
     "",
     "Another number makes another picture of the same: other noise, and other places in the pixels."},
};

/// Wavelengths in the place of red, green and blue; rays are followed as WhittedSettings say.
inline constexpr int usual_wavelengths = 12, most_wavelengths = 360;
struct SpectralSettings {
  std::vector<double> wavelengths = even_wavelengths(usual_wavelengths);  ///< In nm, growing.
};

/// What a debug view makes a colour of: something about what the eye's ray meets first, or how many rays were
/// asked. The formulas are in integrators/view.h.
enum class View { normals, depth, uv, primitives, objects, materials, rays, cosine };
struct ViewSettings {
  View show = View::normals;
  std::string light;  ///< Of View::cosine: the name of one of the scene's. Otherwise empty, or of no effect.
};
template <>
inline constexpr Parameter<ViewSettings> parameters_of<ViewSettings>[] = {
    {"light",
     &ViewSettings::light,
     {},
     "",
     "The name of the light whose N.L `cosine` shows; the scene's only light where not given."},
};

/// The material of glTF 2.0 and of most programs that model: not a rung of the lecture, but brought to its
/// Ka, Kd, Ks, n by illumination/metallic_roughness.h.
struct MetallicRoughness {
  Rgb base_color{1, 1, 1};
  double metallic = 1, roughness = 1;
  double specular = 1;          ///< Factor on the reflection of what is no metal; KHR_materials_specular.
  Rgb specular_color{1, 1, 1};  ///< Likewise.
  double ior = 1.5;             ///< Likewise: reflection ((ior - 1) / (ior + 1))^2; KHR_materials_ior.
  double transmission = 0;      ///< Share of the light that is not reflected which goes through.
  double clearcoat = 0, clearcoat_roughness = 0;
};

template <>
inline constexpr Parameter<MetallicRoughness> parameters_of<MetallicRoughness>[] = {
    {"base_color", &MetallicRoughness::base_color, zero_to_one, "",
     "The color of a metal's reflection, or of what is scattered by everything else."},
    {"metallic", &MetallicRoughness::metallic, zero_to_one, "", "1 for metals, 0 for everything else."},
    {"roughness", &MetallicRoughness::roughness, zero_to_one, "", "0 for a mirror, 1 for chalk."},
    {"specular", &MetallicRoughness::specular, zero_to_one, "",
     "Factor on what reflects without being a metal."},
    {"specular_color", &MetallicRoughness::specular_color, at_least_zero, "", "Likewise, by channel."},
    {"ior",
     &MetallicRoughness::ior,
     {1, 100},
     "",
     "Index of refraction; it says how much reflects. Light goes through unbent."},
    {"transmission", &MetallicRoughness::transmission, zero_to_one, "",
     "Share of the light that is not reflected which goes through."},
    {"clearcoat", &MetallicRoughness::clearcoat, zero_to_one, "", "Strength of a layer of varnish."},
    {"clearcoat_roughness", &MetallicRoughness::clearcoat_roughness, zero_to_one, "", "Its own roughness."},
};

/// What a surface is made of, where that has been measured: Fresnel's equations say how much it reflects.
struct Metal {
  std::string name;  ///< Empty: its constants are the scene's own.
  MetalConstants constants;
};
struct Glass {
  std::string name;  ///< Likewise.
  GlassIndex index;
};
using Substance = std::variant<Metal, Glass>;

/// What becomes of a surface's opacity.
enum class Alpha : std::uint8_t {
  blend,  ///< What is not opaque shows what lies behind, straight on.
  mask,   ///< There where the opacity is `alpha_cutoff` or more, and not there elsewhere.
};

struct Material {
  std::string name;
  Place place;  ///< Where it was written.
  Rgb ambient{0.1, 0.1, 0.1};
  Rgb diffuse{0.8, 0.8, 0.8};
  Rgb specular{0, 0, 0};
  double shininess = 32;
  Rgb reflect{0, 0, 0};
  Rgb transmit{0, 0, 0};
  double ior = 1.5;
  Rgb emission{0, 0, 0};
  /// How much of the surface is there: the share `opacity` of its colour, and the rest of what lies behind
  /// it.
  double opacity = 1;
  Alpha alpha = Alpha::blend;
  double alpha_cutoff = 0.5;
  bool one_sided = false;  ///< Rays that come from inside do not see it. It casts shadows all the same.
  /// In place of ambient, diffuse, specular, shininess, reflect, transmit and ior.
  std::optional<MetallicRoughness> metallic_roughness;
  /// Its ior is the substance's then; ambient and diffuse are factors on what a metal reflects at normal
  /// incidence, reflect and, in wavelength_specular, specular on what is reflected at the angle at hand, and
  /// transmit on the rest.
  std::optional<Substance> substance;
  double roughness = 0;                          ///< Of the substance.
  std::vector<MaterialMap> maps;                 ///< Any number; of those of one slot, all multiply.
  std::optional<ModelId> model;                  ///< Unset: the scene's.
  std::map<std::string, double> own;             ///< The models' own parameters that the file gives, by name.
  std::map<std::string, Spectrum> spectra = {};  ///< Of colours that are given as spectra, by parameter.
};
/// Whether light can go through it somewhere: by `transmit`, by what is not opaque of it, or through gaps.
bool may_transmit(const Material& material);
template <>
inline constexpr Parameter<Material> parameters_of<Material>[] = {
    {"ambient", &Material::ambient, at_least_zero, "",
     "Ka, what the surface sends back of the ambient light; the lecture's getambient()."},
    {"diffuse", &Material::diffuse, at_least_zero, "",
     "Kd, the share of light scattered alike in all directions; getdiffuse()."},
    {"specular", &Material::specular, at_least_zero, "", "Ks, the strength of the highlight; getspecular()."},
    {"shininess",
     &Material::shininess,
     {0, 1e6},
     "",
     "n, the highlight's power: the larger, the smaller the highlight."},
    {"reflect", &Material::reflect, at_least_zero, "",
     "Factor on the colour that comes along the mirror ray."},
    {"transmit", &Material::transmit, at_least_zero, "",
     "Factor on the colour that comes along the refracted ray."},
    {"ior",
     &Material::ior,
     {0.01, 100},
     "",
     "Index of refraction of what lies behind the surface; 1 does not bend."},
    {"emission", &Material::emission, at_least_zero, "",
     "Light of its own, added to everything; it lights no other surface."},
    {"opacity", &Material::opacity, zero_to_one, "",
     "How much of the surface is there: this share of its colour is seen, and the rest of what lies behind, "
     "straight on."},
    {"alpha_cutoff", &Material::alpha_cutoff, zero_to_one, "",
     "With `alpha: mask`: where the opacity is less, there is no surface."},
    {"one_sided",
     &Material::one_sided,
     {},
     "",
     "Whether rays that come from inside do not see it. It casts shadows all the same."},
};

// ---- shapes: arrays of primitives of one kind

struct Sphere {
  Vec3<double> center{0, 0, 0};
  double radius = 1;
};
template <>
inline constexpr Parameter<Sphere> parameters_of<Sphere>[] = {
    {"center", &Sphere::center, {}, "scene units", "The centre.", true, Kind::point},
    {"radius", &Sphere::radius, positive, "scene units", "The radius.", true},
};

struct Plane {
  Vec3<double> point{0, 0, 0};
  Vec3<double> normal{0, 1, 0};
};
template <>
inline constexpr Parameter<Plane> parameters_of<Plane>[] = {
    {"point",
     &Plane::point,
     {},
     "scene units",
     "Any point of the plane; of a bounded one, its middle.",
     true,
     Kind::point},
    {"normal", &Plane::normal, {}, "", "The direction it faces; of any length.", true, Kind::direction},
};

struct Disc {
  Vec3<double> center{0, 0, 0};
  Vec3<double> normal{0, 1, 0};
  double radius = 1;
};
template <>
inline constexpr Parameter<Disc> parameters_of<Disc>[] = {
    {"center", &Disc::center, {}, "scene units", "The centre.", true, Kind::point},
    {"normal", &Disc::normal, {}, "", "The direction it faces; of any length.", true, Kind::direction},
    {"radius", &Disc::radius, positive, "scene units", "The radius.", true},
};

/// A cone's side between two circles; a cylinder has two equal radii. Open at both ends (caps are discs of
/// their own).
struct Cone {
  Vec3<double> from{0, 0, 0};
  Vec3<double> to{0, 1, 0};
  double radius_from = 1, radius_to = 0;
};
template <>
inline constexpr Parameter<Cone> parameters_of<Cone>[] = {
    {"from", &Cone::from, {}, "scene units", "Centre of one end.", true, Kind::point},
    {"to", &Cone::to, {}, "scene units", "Centre of the other end.", true, Kind::point},
    {"radius_from", &Cone::radius_from, at_least_zero, "scene units", "Radius at `from`.", true},
    {"radius_to", &Cone::radius_to, at_least_zero, "scene units", "Radius at `to`.", true},
};

/// A triangle mesh. Faces are counter-clockwise seen from outside. All but vertices and triangles may be
/// empty; otherwise they hold one for each vertex.
struct Mesh {
  std::vector<Vec3<float>> vertices;
  std::vector<Vec3<float>> normals;  ///< Unit length (or zero: then the face's own normal is taken).
  std::vector<Vec2<float>> uvs;      ///< v upwards; see TextureMap.
  std::vector<Vec2<float>> uvs2;     ///< A second set, for maps with uv_set 1.
  /// Linear R, G, B, and opacity: factors on the material's ambient and diffuse colour (or its base colour)
  /// and on its opacity.
  std::vector<std::array<float, 4>> colors;
  /// x, y, z: a unit vector along growing u. w, 1 or -1: w * cross(normal, tangent) points along growing v,
  /// to the image's upper edge. For normal maps; made of the triangle's texture coordinates where empty.
  std::vector<std::array<float, 4>> tangents;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

using Primitives =
    std::variant<Mesh, std::vector<Sphere>, std::vector<Cone>, std::vector<Disc>, std::vector<Plane>>;

/// Primitives of one kind, in coordinates of their own; any number of objects may show them.
struct Shape {
  std::string name;  ///< "sphere", "balls.nff", ...: for people.
  Primitives primitives;
  /// Which of the object's materials each primitive has: an index into Object::materials. Empty: all the
  /// first.
  std::vector<std::uint32_t> material_of_primitive;
};
std::size_t primitive_count(const Shape& shape);

/// A step of an object's motion in the world: a turn about an axis through `center`, or a way.
struct MotionStep {
  Vec3<double> axis{0, 1, 0}, center{0, 0, 0};  ///< The axis is of unit length.
  double degrees = 0;
  Vec3<double> translate{0, 0, 0};
};

/// A shape placed in the world.
struct Object {
  std::string name;
  Place place;
  std::uint32_t shape = 0;               ///< Index into Scene::shapes.
  std::vector<std::uint32_t> materials;  ///< Indices into Scene::materials; one at least.
  Transform world_from_object;           ///< When the shutter opens.
  /// What happens to it until the shutter closes: each step at its own constant speed, all at once, applied
  /// in this order. Empty: it stands still.
  std::vector<MotionStep> motion = {};
};
/// Where it is at a time of the shutter's, 0 when that opens, 1 when it closes.
Transform placed_at(const Object& object, double time);

/// A light of the scene: which it is, and what people call it.
struct Light {
  std::string name;
  Place place;
  AnyLight light;
  std::map<std::string, Spectrum> spectra = {};  ///< Of colours that are given as spectra, by parameter.
};

/// What a turntable turns about.
struct Axis {
  Vec3<double> point{0, 0, 0}, direction{0, 1, 0};
};

/// Who makes the picture of the scene.
enum class Integrator { whitted, spectral, path, ambient_occlusion, view };

struct Scene {
  std::string name;  ///< The input's file name, without its folder.
  Camera camera;
  ImageSettings image;
  FilmSettings film;
  Illumination illumination;
  Integrator integrator = Integrator::whitted;
  // The settings of each.
  WhittedSettings whitted;  ///< With a view: the rays that View::rays counts; with `spectral` its rays.
  SpectralSettings spectral;
  ViewSettings view;
  PathSettings path;
  AmbientOcclusion ambient_occlusion;  ///< Of the integrator; that of the ambient term is in `illumination`.
  Fog fog;                             ///< With the density 0: none.
  Rgb background{0, 0, 0};             ///< What rays see that meet nothing; with an image a factor on it.
  /// An index into `textures`: the picture around the scene by longitude and latitude, its middle along -z.
  std::optional<std::uint32_t> background_image;
  double background_turn = 0;    ///< Degrees about the vertical, counter-clockwise from above.
  bool background_z_up = false;  ///< Its vertical is z, and its middle along +y; else y, and -z.
  std::vector<Light> lights;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Shape> shapes;
  std::vector<Object> objects;
  std::vector<Diagnostic> warnings;

  // Of a scene that was made for a model file.
  std::vector<std::string> model_cameras;  ///< The names of the cameras that it brings.
  std::optional<Axis> axis;                ///< The model's vertical. Unset: the camera's, through its target.
};

/// Whether something moves while the shutter is open.
bool is_moving(const Scene& scene);

/// Whether samples are taken in passes, until the noise is low enough, the time is spent or there are enough.
inline bool is_progressive(const Scene& scene) {
  return scene.integrator == Integrator::path && (scene.path.until > 0 || scene.path.progressive);
}

/// The model by which a material is lit, a number that it gives that model, and how light fades under a
/// model: what is written, or else what holds where nothing is.
ModelId model_of(const Scene& scene, const Material& material);
double own_number(const Material& material, const ModelParameter& parameter);
Attenuation attenuation_of(const Illumination& illumination, ModelId model);
AmbientAttenuation ambient_attenuation_of(const Illumination& illumination, ModelId model);

/// The smallest box around something; empty where lower > upper.
struct Bounds {
  Vec3<double> lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};
  bool empty() const { return lower.x > upper.x; }
  void add(const Vec3<double>& p);
};
/// Of everything in the scene that is bounded, in the world. Infinite planes do not count.
Bounds bounds(const Scene& scene);
Bounds bounds(const Shape& shape, const Transform& world_from_object = {});

/// Largest absolute coordinate that the ray queries are made for: their products of three coordinates stay
/// finite in float up to here.
inline constexpr double largest_coordinate = 1e10;

/// What the reader of one file cannot see: coordinates out of reach once placed in the world, indices that
/// point nowhere. Empty: all is well.
std::vector<Diagnostic> validate(const Scene& scene);

}  // namespace lambent
