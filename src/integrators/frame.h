#pragma once
// What a kernel is given: the scene as plain records, and memory to work in. Plain data: every instruction
// set's kernel and the code that prepares it agree about it.

#include <cstdint>

#include "accel/world.h"
#include "illumination/models.h"

namespace lambent {

struct MaterialRecord {
  Rgb ambient, diffuse, specular, reflect, transmit, emission;
  double shininess, ior;
  double own[max_model_parameters];
  int model;  ///< ModelId, the scene's where the material names none.
  bool emits, reflects, transmits;
};

/// How light fades under a model: the scene's choice, or the model's own.
struct FadingRecord {
  Attenuation attenuation;
  AmbientAttenuation ambient;
};

/// Eye rays start at eye + (x * right + y * up) * spread_of_origins, and go along forward + (x * right + y *
/// up) * spread_of_directions, with x and y in units of half the picture's height, from its centre, x to the
/// right and y upwards.
struct CameraRecord {
  Vec3<double> eye, forward, right, up;  ///< The last three of unit length.
  double spread_of_origins, spread_of_directions;
};

struct RayCounts {
  std::uint64_t eye = 0, eye_hits = 0, reflection = 0, refraction = 0, shadow = 0;
};

struct Frame {
  WorldView world;
  bool any_transmits;
  CameraRecord camera;
  int width, height;            ///< Of the picture, in pixels.
  int film_width, film_height;  ///< Of the film: the picture's, or one more each with Pattern::corners.
  const Vec2<double>* pattern;
  int samples;
  const AnyLight* lights;
  int light_count;
  const MaterialRecord* materials;
  FadingRecord fading[model_count];
  Rgb ambient, background;
  double minimum_distance;
  WhittedSettings whitted;
  float* film;  ///< film_width * film_height colours, row 0 on top.
};

/// A rectangle of the film, its upper ends not included.
struct Tile {
  int x0, y0, x1, y1;
};

/// Columns of equal length that grow together; a struct of arrays says which they are by `columns(f)`.
template <class T> struct Column {
  T* data = nullptr;
  T& operator[](std::size_t i) const { return data[i]; }
};

/// Rays on their way, and what became of them.
struct RayQueue {
  std::uint32_t count = 0, capacity = 0;
  Column<double> ox, oy, oz;              ///< Origin: the surface point itself.
  Column<double> dx, dy, dz;              ///< Unit direction.
  Column<double> R;                       ///< Distance from the eye to the origin, over all bounces.
  Column<float> qx, qy, qz;               ///< Where the query starts: off the surface.
  Column<double> weight[color_channels];  ///< What the ray's colour counts in its sample.
  Column<std::uint32_t> sample;           ///< Which sample of the batch.
  Column<float> t;                        ///< Found: distance,
  Column<std::int32_t> instance, geometry, primitive;  ///< and which primitive; geometry -1: none.

  template <class F> void columns(F f) {
    f(ox), f(oy), f(oz), f(dx), f(dy), f(dz), f(R), f(qx), f(qy), f(qz);
    for (auto& w : weight) f(w);
    f(sample), f(t), f(instance), f(geometry), f(primitive);
  }
};

/// Surface points that rays have hit.
struct HitQueue {
  std::uint32_t count = 0, capacity = 0;
  Column<double> Px, Py, Pz, Nx, Ny, Nz, Vx, Vy, Vz;  ///< N on V's side.
  Column<double> Gx, Gy, Gz;                          ///< Geometric normal, on V's side.
  Column<double> R;                                   ///< Distance from the eye, over all bounces.
  Column<double> sx, sy, sz;                          ///< Where rays start that leave on V's side,
  Column<double> bx, by, bz;                          ///< and those that go through.
  Column<std::uint32_t> ray, material;
  Column<std::uint8_t> outside;  ///< Whether V is on the outside.
  Column<std::uint32_t> order;   ///< The hits' numbers, model by model.

  template <class F> void columns(F f) {
    f(Px), f(Py), f(Pz), f(Nx), f(Ny), f(Nz), f(Vx), f(Vy), f(Vz), f(Gx), f(Gy), f(Gz), f(R), f(sx), f(sy),
        f(sz), f(bx), f(by), f(bz);
    f(ray), f(material), f(outside), f(order);
  }
};

/// How much of each light arrives at each hit; entry light * hits + hit.
struct LightQueue {
  std::uint32_t capacity = 0;
  Column<double>
      passes[color_channels];  ///< 1: nothing in the way, 0: blocked; between: through transmitting surfaces.
  template <class F> void columns(F f) {
    for (auto& p : passes) f(p);
  }
};

/// Sums over samples and pixels.
struct ColorQueue {
  std::uint32_t capacity = 0;
  Column<double> color[color_channels];
  template <class F> void columns(F f) {
    for (auto& c : color) f(c);
  }
};

/// One thread's memory; it grows as needed and is used again from tile to tile. grow() is not a kernel's
/// code, so that no allocation is compiled for an instruction set.
struct Scratch {
  RayQueue rays, next_rays;
  HitQueue hits;
  LightQueue lights;
  ColorQueue samples, pixels;

  Scratch() = default;
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch();
  static void grow(RayQueue& queue, std::uint32_t capacity);
  static void grow(HitQueue& queue, std::uint32_t capacity);
  static void grow(LightQueue& queue, std::uint32_t capacity);
  static void grow(ColorQueue& queue, std::uint32_t capacity);
};

/// The Whitted integrator, compiled for one instruction set.
struct Kernel {
  const char* isa;
  void (*render_tile)(const Frame& frame, const Tile& tile, Scratch& scratch, RayCounts& counts);
};

}  // namespace lambent
