#pragma once
// Lambent's public API: load a scene or a model, render it, write the picture. See examples/00_minimal.cpp.
//
// Nothing here prints, exits or aborts. Bad input throws InputError (what, where, and the nearest remedy);
// work that cannot be done throws Failure.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lambent/diagnostics.h"
#include "lambent/image.h"

namespace lambent {

/// "0.1.0".
const char* version();

// ---- scenes
// ----------------------------------------------------------------------------------------------------------

struct Scene;  // opaque here
/// A loaded scene. It does not change any more and may be rendered by several threads at once.
using ScenePtr = std::shared_ptr<const Scene>;

struct LoadOptions {
  /// Values that replace or add to what the file says, applied in order: {"image.samples", "16"},
  /// {"lights.key.point.intensity", "4"}. Steps of a path are keys; in a list, an element's name or its index
  /// from 0. The value is YAML.
  std::vector<std::pair<std::string, std::string>> set;
};

/// Load a scene file (.yaml, .yml, .json) or a model file (.obj, .nff), for which camera and lights are
/// chosen to suit it. Throws InputError with everything that is wrong.
ScenePtr load_scene(const std::string& path, const LoadOptions& options = {});

/// The same from text. `name` stands for the file in messages; files that the scene names are looked for
/// beside it.
ScenePtr parse_scene(std::string_view yaml, const std::string& name = "scene",
                     const LoadOptions& options = {});

/// The scene file that load_scene makes of a model file, as YAML text: a start for a scene of one's own.
std::string scene_text_of_model(const std::string& path);

/// What was odd about the input, without being wrong.
const std::vector<Diagnostic>& warnings(const ScenePtr& scene);

/// What is in a scene.
struct SceneSummary {
  struct Item {
    std::string name, kind;
    Place place;                   ///< Where it is written; line 0 if nowhere.
    std::uint64_t primitives = 0;  ///< Objects: how many primitives. Otherwise 0.
    std::string detail;            ///< "key", "value" pairs for people: "diffuse 0.8 0.1 0.1, shininess 32".
  };
  std::string name;
  int width = 0, height = 0;
  int samples = 0;  ///< Of each pixel; with adaptive samples the most that one may get.
  std::string camera, model, integrator;  ///< For people.
  double lower[3] = {0, 0, 0},
         upper[3] = {0, 0,
                     0};  ///< Bounds in the world, infinite planes aside; lower > upper where there are none.
  std::uint64_t triangles = 0, vertices = 0, spheres = 0, cones = 0, discs = 0,
                planes = 0;  ///< Stored once each, however many objects show them.
  std::vector<Item> objects, lights, materials;
};
SceneSummary summarize(const ScenePtr& scene);

// ---- pictures
// --------------------------------------------------------------------------------------------------------

struct Stats {
  /// Rays by kind. refraction counts totally reflected ones too: the refracted ray was asked for (as the
  /// SPD's tables count).
  struct {
    std::uint64_t eye = 0, eye_hits = 0, reflection = 0, refraction = 0, shadow = 0;
  } rays;
  struct {
    double parse = 0, build = 0, render = 0, write = 0;
  } seconds;
  std::uint64_t peak_memory_bytes = 0;
  int threads = 0;
  std::string isa;
};

struct RenderOptions {
  int threads = 0;     ///< 0: as many as there are processors. The picture does not depend on it.
  int tile_size = 32;  ///< Pixels; the picture does not depend on it.
  std::string isa;  ///< "baseline", "avx2", "avx512": the instruction set of the kernels; empty: the best one
                    ///< here. Likewise.
  /// Called now and then, from one thread at a time, with the share that is done, 0 to 1; false stops the
  /// work.
  std::function<bool(double)> progress;
};

struct RenderResult {
  Image image;         ///< R, G, B, linear. Incomplete where `cancelled`.
  Metadata metadata;   ///< The settings that made it; nothing that changes from run to run.
  WriteOptions write;  ///< How the scene wants it written.
  Stats stats;
  bool cancelled = false;
};

/// The picture is a function of the scene alone: the same bits for any number of threads, tile size and
/// instruction set. Throws InputError for an unknown `isa` or one that this machine lacks.
RenderResult render(const ScenePtr& scene, const RenderOptions& options = {});

/// The instruction sets that `isa` accepts on this machine, the best first.
std::vector<std::string> available_isas();

// ---- what there is: for `lambent list`, the manual, the schema
// ---------------------------------------------------------------

struct ParameterInfo {
  std::string name;
  std::string type;  ///< "number", "integer", "boolean", "color", "point", "direction", "choice", ...
  std::string unit;  ///< Or empty.
  std::string default_value;  ///< As one would write it; empty where `required`.
  std::string range;          ///< "0 to 1", "at least 0", a list of choices, or empty.
  std::string sentence;
  bool required = false;
};
struct Entry {
  std::string name, title, equation, source;  ///< equation and source may be empty.
  std::vector<ParameterInfo> parameters;
};
struct Topic {
  std::string
      name;  ///< "models", "lights", "shapes", "materials", "camera", "image", "illumination", "integrators".
  std::string title;
  std::vector<Entry> entries;
};
const std::vector<Topic>& catalogue();

/// The JSON Schema (draft-07) of scene files, as text.
std::string scene_schema();
/// docs/scene-format.md, made from the same tables.
std::string scene_manual();

}  // namespace lambent
