#pragma once
// What a model file holds, whatever its format: shapes and materials, and sometimes a camera and lights.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lambent/limits.h"
#include "scene/scene.h"

namespace lambent {

/// A shape of a model where the model has it; a shape may stand in several places.
struct ModelObject {
  std::string name;
  std::uint32_t shape = 0;  ///< Index into Model::shapes.
  Transform world_from_object;
  /// What Shape::material_of_primitive counts: indices into Model::materials. Empty: all of these.
  std::vector<std::uint32_t> materials{};
};

struct NamedCamera {
  std::string name;  ///< May be empty.
  Camera camera;
};

struct Model {
  std::vector<Shape> shapes;  ///< Parts; a glTF may have none. material_of_primitive indexes `materials`.
  /// Where they stand. Empty: each shape once, as it is.
  std::vector<ModelObject> objects;
  std::vector<Texture> textures;    ///< Not loaded yet.
  std::vector<Material> materials;  ///< Never empty: a model without materials has one neutral one.
  std::vector<Light> lights;
  std::vector<NamedCamera> cameras;  ///< The first is the file's own view.
  std::optional<ImageSettings> image;
  std::optional<Rgb> background;
  ModelId illumination = ModelId::phong;  ///< The model that its materials are written for.
  /// Whether its lights are meant by the rules of the Standard Procedural Databases: they do not fade.
  bool spd_rules = false;
  bool z_up = false;  ///< Whether z is up, as far as the format lets one guess; else y.
  std::vector<Diagnostic> warnings;
};

struct ImportOptions {
  /// Seconds: the pose of what is animated. Unset: the pose in which the file has it at rest.
  std::optional<double> time = {};
  Limits limits = {};  ///< What is beyond is refused.
  /// The folder that files which the model names must lie in, or below. Empty: the model's own.
  std::string root = {};
};

/// Read a model file; its ending (.obj, .nff, .ply, .stl, .gltf, .glb) names the format. Throws InputError
/// with the file's name and line.
Model import_model(const std::string& path, const ImportOptions& options = {});

Model import_obj(const std::string& path, const ImportOptions& options = {});
Model import_nff(const std::string& path, const ImportOptions& options = {});
Model import_ply(const std::string& path, const ImportOptions& options = {});
Model import_stl(const std::string& path, const ImportOptions& options = {});
Model import_gltf(const std::string& path, const ImportOptions& options = {});

/// Whether import_model knows the ending of `path`.
bool is_model_file(const std::string& path);
/// The endings it knows, for messages: ".obj, .nff, .ply, .stl, .gltf, .glb".
std::string model_file_endings();

}  // namespace lambent
