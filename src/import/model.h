#pragma once
// What a model file holds, whatever its format: shapes and materials, and sometimes a camera and lights.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lambent {

struct Model {
  std::vector<Shape> shapes;  ///< One or more parts; material_of_primitive indexes `materials` of this model.
  std::vector<Material> materials;  ///< Never empty: a model without materials has one neutral one.
  std::vector<Light> lights;
  std::optional<Camera> camera;
  std::optional<ImageSettings> image;
  std::optional<Rgb> background;
  ModelId illumination = ModelId::phong;  ///< The model that its materials are written for.
  std::vector<Diagnostic> warnings;
};

/// Read a model file; its ending (.obj, .nff) names the format. Throws InputError with the file's name and
/// line.
Model import_model(const std::string& path);

Model import_obj(const std::string& path);
Model import_nff(const std::string& path);

/// Whether import_model knows the ending of `path`.
bool is_model_file(const std::string& path);
/// The endings it knows, for messages: ".obj, .nff".
std::string model_file_endings();

}  // namespace lambent
