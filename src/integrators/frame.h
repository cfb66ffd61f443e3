#pragma once
// What a kernel is given: the scene as plain records, and memory to work in. Plain data: every instruction
// set's kernel and the code that prepares it agree about it.

#include <cstdint>

#include "accel/world.h"
#include "film/apportion.h"
#include "film/layers.h"
#include "illumination/equation.h"
#include "illumination/metallic_roughness.h"
#include "illumination/models.h"
#include "integrators/texture_lookup.h"

namespace lambent {

/// What Fresnel's equations are asked of.
enum class Boundary : std::uint8_t {
  none,   ///< Nothing: it reflects what it says.
  metal,  ///< Opaque, with a complex index of refraction;
  glass,  ///< or clear.
};

struct MaterialRecord {
  Rgb ambient, diffuse, specular, reflect, transmit, emission;
  double shininess, ior;
  double lobe;  ///< How much wider mirror rays leave than they came, radians.
  double own[max_model_parameters];
  int model;                 ///< ModelId, the scene's where the material names none.
  bool reflects, transmits;  ///< Somewhere, at least.
  bool painted;              ///< It is not the same everywhere: paint.h.
  bool gaps;                 ///< Some rays go on as if it were not there.
  int light;                 ///< Of a light that stands in the world: which; otherwise -1.
  int scatter;               ///< For paths: ScatterKind.
  bool dark_inside;          ///< Its emission is seen from outside alone.
  bool white;                ///< Vertices do not colour it.
  /// With one, `reflect` is a factor on what is reflected, `transmit` on the rest.
  Boundary boundary;
  Rgb eta, k;        ///< The complex index of refraction, for each channel.
  double roughness;  ///< Of metal and glass: alpha is its square.

  // For paint.h:
  const MaterialMap* maps;
  int map_count;
  double opacity, alpha_cutoff;
  Alpha alpha;
  bool one_sided, is_rough, unlit;
  MetallicRoughnessOf<double, Rgb> rough;
};

/// The picture around the scene, by longitude and latitude; its texture has no levels where there is none.
struct EnvironmentRecord {
  TextureRecord texture{};
  double turn = 0;    ///< About the vertical, in turns.
  bool z_up = false;  ///< Otherwise y is up.
};

/// The scene's fog; density 0: none.
struct FogRecord {
  Rgb color;
  double density = 0, start = 0;
};

/// How light fades under a model: the scene's choice, or the model's own.
struct FadingRecord {
  Attenuation attenuation;
  AmbientAttenuation ambient;
};

/// Eye rays start at eye + (x * right + y * up) * spread_of_origins, and go along forward + (x * right + y *
/// up) * spread_of_directions, with x and y in units of half the picture's height, from its centre, x to the
/// right and y upwards. With a lens they start at a point of it instead, a disc around that place across
/// `forward`, and go through the point where the ray from its centre meets the plane in focus.
struct CameraRecord {
  Vec3<double> eye, forward, right, up;  ///< The last three of unit length.
  double spread_of_origins, spread_of_directions;
  double lens_radius = 0;  ///< 0: a pinhole.
  double focus = 1;        ///< How far before the lens that plane lies.
};

struct RayCounts {
  std::uint64_t eye = 0, eye_hits = 0, reflection = 0, refraction = 0, shadow = 0, ambient = 0;
};

/// A query, as it was asked.
enum class RayKind : std::uint32_t { eye, scattered, shadow };
struct AskedRay {
  float ox, oy, oz, dx, dy, dz;
  float t_far;  ///< Shadow rays: the way to the light, or as far as ambient light is looked for. Otherwise
                ///< infinity.
  RayKind kind;
};
/// Whoever wants to know which queries a picture asks, in the order in which they are asked. Called by every
/// thread that renders.
struct RayListener {
  void* self;
  void (*asked)(void* self, const AskedRay& ray);
};

/// What a kernel tells of its work to whoever wants to explain a picture: every ray, what it met, each light
/// there, each summand of the equation, and each colour as it is added to its sample. Rays have numbers, from
/// 0 on in each call of a kernel.
struct SeenRay {
  std::uint32_t ray, parent;  ///< The parent of a ray from the eye: no_ray.
  Way way;                    ///< How it left its parent; direct: from the eye.
  bool total;           ///< A mirror ray that takes the refracted one's share with it: total reflection.
  std::uint32_t pixel;  ///< Of the task; and
  int sample;           ///< which of the pattern's samples.
  Vec3<double> o, d;
  Rgb factor;  ///< What the surface gives it: reflect or transmit. White for rays from the eye.
  Rgb weight;  ///< What its colour counts in its sample: the factors on the way.
  // Of paths, whose factor is f |N.L| over the density of the choice:
  double density = 0;   ///< Per solid angle; 0 where there was but one direction.
  double survival = 1;  ///< The chance with which the path went on; the weight is the larger for it.
};
inline constexpr std::uint32_t no_ray = ~std::uint32_t{0};
/// The material as the equation took it.
struct SeenMaterial {
  Rgb ambient, diffuse, specular, emission, reflect, transmit;
  double shininess, ior;
  Boundary boundary;
  Rgb eta, k;
};
struct SeenHit {
  std::uint32_t ray;
  std::int32_t instance, geometry, primitive;
  std::uint32_t material;
  Vec3<double> P, N, G, V;
  Vec3<double> start;  ///< Where its shadow rays begin.
  double t, R;         ///< The ray's length, and the way from the eye.
  bool outside;        ///< Whether the ray came from outside.
  Rgb Ia;              ///< The ambient light, faded, as much as reaches the point.
  double open;         ///< The share of it that does.
  SeenMaterial numbers;
};
struct SeenLight {
  std::uint32_t ray;
  int point;   ///< Index into Frame::light_points.
  bool open;   ///< False: behind the surface, dark this way, or blocked.
  bool asked;  ///< Whether a shadow ray was thrown.
  Vec3<double> L;
  double r;
  Rgb I;                ///< Il, before attenuation; as much as the point counts.
  double faded;         ///< The attenuation.
  Rgb share;            ///< What transmitting surfaces leave of it.
  Rgb arriving;         ///< All of these multiplied: what the model is handed.
  Vec3<double> toward;  ///< The shadow ray goes along this unit vector,
  double far;           ///< and ends there.
};
struct SeenTerm {
  std::uint32_t ray;
  Term term;
  int point;  ///< Index into Frame::light_points; -1: of no light.
  Rgb color;
};
/// Fog on a ray's way, told before what the ray brings.
struct SeenFog {
  std::uint32_t ray;
  double way;    ///< In the fog; infinite where the ray meets nothing.
  double share;  ///< What is left of a colour after that way.
  Rgb brings;    ///< The fog's own: the rest of its colour.
  Rgb weight;    ///< What the ray's colour counts in its sample from now on.
};
struct SeenColor {
  std::uint32_t ray;
  Rgb color;  ///< Of the ray, before its weight; of a ray that met nothing the background.
};
/// Of paths: light that one has come upon.
struct SeenFind {
  std::uint32_t ray;
  int source;  ///< film/layers.h
  Rgb radiance;
  double searched;  ///< The density with which light that is looked for would have found it.
  double weight;    ///< By that, and by the ray's own density.
  Rgb brings;       ///< To the sample, times the ray's weight.
};
/// Of paths: light that was looked for.
struct SeenSearch {
  std::uint32_t ray;
  int source;
  Vec3<double> L;
  double r;
  Rgb arriving;      ///< Radiance over density; of a light without extent pi Il / r^2 over the chance of its
                     ///< choice.
  double density;    ///< Per solid angle, the choice of the light included; 0: a light without extent.
  Rgb scattered;     ///< f |N.L|
  double followed;   ///< The density with which the path would have gone on that way.
  double weight;     ///< By these two.
  bool asked, open;  ///< Whether a shadow ray was thrown, and whether it got through.
  double share;      ///< What surfaces leave that are not wholly there.
  Rgb brings;        ///< To the sample, times the ray's weight.
};
struct Witness {
  void* self;
  void (*ray)(void* self, const SeenRay&);
  void (*hit)(void* self, const SeenHit&);
  void (*light)(void* self, const SeenLight&);
  void (*term)(void* self, const SeenTerm&);
  void (*fog)(void* self, const SeenFog&);
  void (*color)(void* self, const SeenColor&);
  void (*find)(void* self, const SeenFind&);
  void (*search)(void* self, const SeenSearch&);
};

/// A point of a light, as the lecture's sum over lights sees it: lights without extent have one.
struct LightPoint {
  std::int32_t light;   ///< Index into Frame::lights.
  std::int32_t source;  ///< What it belongs to (film/layers.h): one of the scene's lights, the same number;
                        ///< or what it stands for: surfaces that shine, or the background.
  double u, v;          ///< Which of its points.
  double share;         ///< How much it counts: 1 / how many there are.
  bool extended;        ///< Whether the light has extent.
};

struct EmitterTable;

/// How rays are followed: which kernel renders the frame.
enum class Tracing { whitted, path };
inline constexpr int tracing_count = 2;

struct Frame;

/// One go over the samples of a picture that is made of wavelengths: its frame's colours are one wavelength
/// in each channel. Light of three goes together; where glass sends each its own way, of one, in all
/// channels.
struct Pass {
  const Frame* frame;
  int first, count;             ///< Of the picture's wavelengths.
  Rgb weights[color_channels];  ///< What each of `count` channels adds to linear sRGB.
  Rgb basis[color_channels];  ///< What of red, green and blue there is in each channel (spectra/spectrum.h).
};

inline namespace LAMBENT_ISA {

/// Linear sRGB as a pass has it; the same as upsample() of spectra/spectrum.h.
inline Rgb in_pass(const Pass& pass, const Rgb& color) {
  Rgb result;
  for (int c = 0; c < color_channels; ++c)
    result[c] =
        color[2] + pass.basis[c][0] * (color[0] - color[2]) + pass.basis[c][1] * (color[1] - color[2]);
  return result;
}
/// What a colour of a pass adds to linear sRGB.
inline Rgb from_pass(const Pass& pass, const Rgb& color) {
  Rgb sum = color[0] * pass.weights[0];
  for (int i = 1; i < pass.count; ++i) sum = sum + color[i] * pass.weights[i];
  return sum;
}

}  // namespace LAMBENT_ISA

struct Frame {
  Tracing tracing = Tracing::whitted;
  WorldView world;
  const RayListener* listener = nullptr;  ///< Null: nobody.
  const Witness* witness = nullptr;       ///< Likewise.
  LayerPlan layers;
  bool any_transmits;
  CameraRecord camera;
  int width, height;            ///< Of the picture, in pixels.
  const Vec2<double>* pattern;  ///< Where a pixel's `samples` lie, from its upper left corner.
  int samples;
  const int* order =
      nullptr;             ///< Null: they are taken as they come. Otherwise in this order (film/shutter.h).
  const AnyLight* lights;  ///< The scene's, then those that stand for what else shines.
  int light_count;         ///< The scene's.
  const LightPoint* light_points;  ///< Source by source.
  int light_point_count;
  bool lights_have_limits = false;  ///< Whether there are some that do not reach everywhere.
  const MaterialRecord* materials;
  const MaterialRecord* unpainted;  ///< Likewise, as painting begins: before opacity and conversions.
  const TextureRecord* textures;
  EnvironmentRecord environment;
  /// Whether rays carry how wide they are: there are textures. Eye rays begin with these.
  bool cones = false;
  double eye_width = 0, eye_spread = 0;
  bool any_gaps = false;         ///< Whether a material has gaps,
  bool any_masks = false;        ///< and light goes through them.
  bool any_dark_inside = false;  ///< Whether a material is.
  FadingRecord fading[model_count];
  Rgb ambient, background;
  FogRecord fog;
  AmbientOcclusion occlusion{0, 0};  ///< With no rays: nothing is hidden.
  double minimum_distance;
  WhittedSettings whitted;
  PathSettings path;
  Attenuation path_attenuation{0, 0, 1};   ///< Of lights without extent, for paths.
  const EmitterTable* emitters = nullptr;  ///< Likewise for paths: emitters.h.
  /// Of a picture that is made of wavelengths: its passes, in order.
  const Pass* passes = nullptr;
  int pass_count = 0;
  const Pass* pass = nullptr;  ///< Of a pass's frame: the pass.
};

struct Pixel {
  std::int32_t x, y;
};

/// Some pixels of the film, and which of their samples to take: in the frame's order those from
/// `first_sample` up to `end_sample`, that one not included.
struct PixelTask {
  const Pixel* pixels;
  std::uint32_t count;
  int first_sample, end_sample;
  double* sums;  ///< color_channels for each pixel: the samples' colours are added to it, in their order.
  float*
      least_and_greatest;  ///< Null, or for each pixel the least of each channel so far, then the greatest.
  /// Null, or frame.layers.columns() columns, each with a number for each pixel, likewise;
  /// `layer_sums_stride` numbers from one column to the next.
  double* layer_sums = nullptr;
  std::size_t layer_sums_stride = 0;
  FirstHit* first_hits = nullptr;  ///< Null, or for each pixel one for each of the samples asked for.
  double* squares = nullptr;       ///< Null, or for each pixel the sum of the squares of samples' luminance.
};

/// Columns of equal length that grow together; a struct of arrays says which they are by `columns(f)`. They
/// may be read and written a packet beyond their length.
template <class T> struct Column {
  T* data = nullptr;
  T& operator[](std::size_t i) const { return data[i]; }
};

/// Rays on their way, and what became of them.
struct RayQueue {
  std::uint32_t count = 0, capacity = 0;
  Column<double> ox, oy, oz;              ///< Origin: the surface point itself, lifted.
  Column<double> dx, dy, dz;              ///< Unit direction.
  Column<double> R;                       ///< Distance from the eye to the origin, over all bounces.
  Column<float> qx, qy, qz;               ///< Where the query starts: off the surface.
  Column<double> weight[color_channels];  ///< What the ray's colour counts in its sample.
  Column<std::uint32_t> sample;           ///< Which sample of the batch.
  Column<Way> way;                        ///< How light came that goes along it. Set where somebody looks,
  Column<std::uint32_t> number;           ///< as is the ray's number.
  Column<double> width, spread;           ///< With frame.cones: how wide it is, and how much wider it gets.
  // Of paths: where light was last looked for, and with which density the ray leaves that place; 0: no light
  // sample could have found what it meets.
  Column<double> from_x, from_y, from_z, from_nx, from_ny, from_nz, density;
  Column<float> t;                                     ///< Found: distance,
  Column<std::int32_t> instance, geometry, primitive;  ///< and which primitive; geometry -1: none.
  Column<std::uint32_t> material;                      ///< Of that primitive,
  Column<std::uint8_t> group;                          ///< and what it goes together with.
  Column<std::uint32_t> order;                         ///< The rays that hit something, group by group.

  template <class F> void columns(F f) {
    f(ox), f(oy), f(oz), f(dx), f(dy), f(dz), f(R), f(qx), f(qy), f(qz);
    for (auto& w : weight) f(w);
    f(from_x), f(from_y), f(from_z), f(from_nx), f(from_ny), f(from_nz), f(density);
    f(sample), f(way), f(number), f(width), f(spread), f(t), f(instance), f(geometry), f(primitive),
        f(material), f(group), f(order);
  }
};

/// The colours of a batch of samples.
struct ColorQueue {
  std::uint32_t capacity = 0;
  Column<double> color[color_channels];
  template <class F> void columns(F f) {
    for (auto& c : color) f(c);
  }
};

/// One thread's memory; it grows as needed and is used again from task to task of one frame. grow() is not a
/// kernel's code, so that no allocation is compiled for an instruction set.
struct Scratch {
  RayQueue rays, next_rays;
  ColorQueue samples;
  Column<double> layers;  ///< Layer by layer, channel by channel, a batch of samples.
  std::uint32_t layer_columns = 0;
  Column<double> totals;  ///< Of several passes: colours, then layers, likewise.
  std::uint32_t total_columns = 0;
  Column<std::uint32_t> reaching;  ///< The points of lights that may reach some of the hits at hand.
  Column<std::uint32_t>
      open;  ///< For each of these and each packet of a block a bit for each lane that it reaches.

  Scratch() = default;
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch();
  static void grow(RayQueue& queue, std::uint32_t capacity);
  static void grow(ColorQueue& queue, std::uint32_t capacity);
  static void grow(Column<std::uint32_t>& column, std::uint32_t capacity);
  static void grow(Column<double>& column, std::uint32_t capacity);
};

/// An integrator's kernel: renders the task's pixels.
using RenderPixels = void(const Frame& frame, const PixelTask& task, Scratch& scratch, RayCounts& counts);

/// The kernels, compiled for one instruction set.
struct Kernel {
  const char* isa;
  RenderPixels* of[tracing_count];  ///< By Tracing.
  ApportionLayers* apportion_layers;
  void render(const Frame& frame, const PixelTask& task, Scratch& scratch, RayCounts& counts) const {
    of[int(frame.tracing)](frame, task, scratch, counts);
  }
};

}  // namespace lambent
