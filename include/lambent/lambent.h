#pragma once
// Lambent's public API: load a scene or a model, render it, write the picture. See examples/00_minimal.cpp.
//
// Nothing here prints, exits or aborts. Bad input throws InputError (what, where, and the nearest remedy);
// work that cannot be done throws Failure.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lambent/diagnostics.h"
#include "lambent/image.h"
#include "lambent/limits.h"

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
  std::vector<std::pair<std::string, std::string>> set = {};
  /// Who makes the picture, in place of the scene's: "whitted", "path", ...; with the scene's settings for
  /// it, where it has some. Empty: the scene's.
  std::string integrator = {};
  Limits limits = {};  ///< What reading may cost. Files may be named in the input's own folder and below.
  std::optional<double> time = {};  ///< Seconds: the pose of animated models. Unset: as their files stand.
  /// In place of the background: a colour as scene files say it ("0.2", "[0.1, 0.2, 0.3]", "#203040"), or the
  /// path of an image (.hdr, .exr, .png, .jpg). Empty: none.
  std::string background = {};

  // Of model files alone; a scene file says these itself, and is refused with any of them.

  /// One of the file's cameras, by its name or its number from 1; or a view of our own that has the whole
  /// model in the picture: "three-quarter", "front", "back", "left", "right", "top". Empty: the file's first
  /// camera, else three-quarter.
  std::string camera = {};
  std::string up = {};  ///< Which axis points up, "y" or "z". Empty: as the format lets one guess.
  bool ground = true;   ///< Whether a model that is shown by a view of our own stands on a floor.
};

/// Load a scene file (.yaml, .yml, .json) or a model file, for which camera and lights are chosen to suit it.
/// Throws InputError with everything that is wrong.
ScenePtr load_scene(const std::string& path, const LoadOptions& options = {});

/// The same from text. `name` stands for the file in messages; files that the scene names are looked for
/// beside it.
ScenePtr parse_scene(std::string_view yaml, const std::string& name = "scene",
                     const LoadOptions& options = {});

/// The scene file that load_scene makes of a model file, as YAML text: a start for a scene of one's own. It
/// names the model as if it stood beside it, and an image as `options.background` does; `options.set` does
/// not count.
std::string scene_text_of_model(const std::string& path, const LoadOptions& options = {});

/// The same scene, its camera gone so many degrees round a turntable: counter-clockwise as seen from above,
/// about the camera's `up` through its target, or, where load_scene has made the scene for a model, about the
/// model's own vertical through the middle of its bounds. Lights stay. By 0 degrees it is the scene itself.
ScenePtr turned(const ScenePtr& scene, double degrees);

/// Other renderers whose files we write.
enum class ExportFormat {
  povray,   ///< POV-Ray 3.7, .pov
  tachyon,  ///< Tachyon 0.99, .dat
};
/// The scene as another renderer's text, so that it makes the same picture; instances are written out. What
/// it cannot say is said in `remarks`, to which they are added.
std::string export_scene(const ScenePtr& scene, ExportFormat format, std::vector<Diagnostic>& remarks);

/// What was odd about the input, without being wrong.
const std::vector<Diagnostic>& warnings(const ScenePtr& scene);

/// Everything that is odd about an OBJ file and its libraries, or about a material library (.mtl), whether it
/// matters to the picture or not: what `warnings` has of them, and faces, normals, materials and images that
/// come to nothing or contradict each other. Of each kind a few, and how many there are more. Nothing for
/// files of other kinds. Throws InputError with everything that is wrong.
std::vector<Diagnostic> lint(const std::string& path, const Limits& limits = {});

/// Whether the ending of `path` is that of material libraries, which are no scenes but can be looked through.
bool is_material_library(const std::string& path);

/// Whether the scene asks for layers, which only an EXR can hold.
bool wants_layers(const ScenePtr& scene);

/// What is in a scene.
struct SceneSummary {
  struct Item {
    std::string name, kind;
    Place place;                   ///< Where it is written; line 0 if nowhere.
    std::uint64_t primitives = 0;  ///< Objects: how many primitives. Otherwise 0.
    std::string detail;            ///< "key", "value" pairs for people: "diffuse 0.8 0.1 0.1, shininess 32".
  };
  struct Image {
    std::string name;           ///< Its file, or "image 2 of helmet.glb".
    std::string format;         ///< "PNG"; empty where it cannot be read.
    int width = 0, height = 0;  ///< Pixels.
    int channels = 0;           ///< 1 grey, 2 grey and alpha, 3 R G B, 4 R G B alpha.
    bool color = false;         ///< Whether its numbers are sRGB-encoded colours; if not, they are data.
    std::string problem;        ///< Why it cannot be read, or empty.
  };
  std::string name;
  int width = 0, height = 0;
  int samples = 0;                        ///< Of each pixel; with adaptive samples the most that one may get.
  std::string camera, model, integrator;  ///< For people.
  double lower[3] = {0, 0, 0},
         upper[3] = {0, 0,
                     0};  ///< Bounds in the world, infinite planes aside; lower > upper where there are none.
  std::uint64_t triangles = 0, vertices = 0, spheres = 0, cones = 0, discs = 0,
                planes = 0;  ///< Stored once each, however many objects show them.
  std::uint64_t shown = 0;   ///< Primitives of all objects: what is shown twice counts twice.
  std::vector<Item> objects, lights, materials;
  std::vector<Image> textures;
  std::vector<std::string> cameras;  ///< Of a model file: the names of those it brings, some perhaps empty.
};
SceneSummary summarize(const ScenePtr& scene);

// ---- pictures
// --------------------------------------------------------------------------------------------------------

struct Stats {
  /// Rays by kind. refraction counts totally reflected ones too: the refracted ray was asked for (as the
  /// SPD's tables count).
  struct {
    std::uint64_t eye = 0, eye_hits = 0, reflection = 0, refraction = 0, shadow = 0, ambient = 0;
  } rays;
  /// By stage. render() fills build, render and develop; who loads the scene, denoises the picture and writes
  /// it knows the others.
  struct {
    double parse = 0;    ///< Read the scene and its models.
    double build = 0;    ///< Take it into the world; build the trees.
    double render = 0;   ///< From the first ray to the last.
    double develop = 0;  ///< Make the picture of the film.
    double denoise = 0;  ///< Take its noise away.
    double write = 0;    ///< Encode the picture and write it.
  } seconds;
  /// What the frame consists of.
  struct {
    std::uint64_t primitives = 0;  ///< In the world's trees, or beside them (infinite planes).
    std::uint64_t instances = 0;   ///< Objects that stand in the world by reference to a shape with a tree.
    std::uint64_t trees = 0, nodes = 0;
    std::uint64_t lights = 0;
  } scene;
  /// Memory by what it holds, while rays are traced.
  struct {
    /// Of meshes, as they are stored; uvs with colours and tangents.
    std::uint64_t vertices = 0, normals = 0, uvs = 0, indices = 0;
    std::uint64_t shapes = 0;    ///< Spheres, cones, discs and planes, as they are stored.
    std::uint64_t placed = 0;    ///< Copies of all these, taken into the world.
    std::uint64_t nodes = 0;     ///< The trees' nodes,
    std::uint64_t refs = 0;      ///< and what their leaves hold.
    std::uint64_t textures = 0;  ///< With their levels of detail.
    std::uint64_t film = 0;
  } bytes;
  std::uint64_t peak_memory_bytes = 0;  ///< Of the whole process so far.
  double samples_per_pixel = 0;         ///< On average.
  /// Of path tracing: about how far pixels are from what endlessly many samples would give: the standard
  /// deviation, root mean square over the pixels, as a share of the picture's mean luminance. Otherwise 0.
  double noise = 0;
  std::string tree_quality;  ///< "quick" or "thorough": whichever brings the picture sooner.
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
  /// Of pictures whose samples go on (`path` with `until` or `progressive`): seconds, from the first ray on,
  /// after which none is begun any more; 0: no limit. How many samples there are then is a matter of the
  /// machine; that many, and no limit, are the same picture: Stats::samples_per_pixel as `max_samples`.
  double time_limit = 0;
  /// Whether the result has guides for a denoiser (lambent/denoise.h). The picture does not depend on it.
  bool guides = false;
};

struct RenderResult {
  Image image;  ///< R, G, B, linear; and the layers where the scene's film.layers says so (docs/layers.md).
                ///< Incomplete where `cancelled`.
  /// Where RenderOptions::guides asks for them: albedo.R, .G, .B (Kd) and N.X, .Y, .Z (the normal in the
  /// world, on the eye's side) of what each pixel's samples met first, the mean over these. Otherwise empty.
  Image guides;
  Metadata metadata;   ///< The settings that made it; nothing that changes from run to run.
  WriteOptions write;  ///< How the scene wants it written.
  Stats stats;
  bool cancelled = false;
};

/// The picture is a function of the scene alone: the same bits for any number of threads, tile size and
/// instruction set. Throws InputError for an unknown `isa` or one that this machine lacks, where the guides
/// of a view are asked for, which has no noise, and for a limit in time where samples do not go on.
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
  std::string differs;                        ///< Of a model: how its convention differs from the lecture's.
  std::vector<ParameterInfo> parameters;
  std::string attenuation,
      ambient_attenuation;  ///< Of models: how light fades where the scene does not say. Otherwise empty.
};
struct Topic {
  std::string name;  ///< "models", "lights", "shapes", "materials", "camera", "image", "film",
                     ///< "illumination", "integrators".
  std::string title;
  std::vector<Entry> entries;
};
const std::vector<Topic>& catalogue();

/// The JSON Schema (draft-07) of scene files, as text.
std::string scene_schema();
/// docs/scene-format.md, made from the same tables.
std::string scene_manual();

}  // namespace lambent
