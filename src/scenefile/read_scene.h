#pragma once
// From the document to the scene.

#include <map>
#include <string>

#include "import/model.h"
#include "scene/scene.h"
#include "scenefile/document.h"

namespace lambent {

/// Model files that are in memory already, by path as the scene gives it, joined with the scene's folder.
using LoadedModels = std::map<std::string, Model>;

/// `folder`: where files that the scene names are looked for; with import.root (or else in `folder`) they
/// must lie. Throws InputError with everything that is wrong. Textures are loaded, too.
Scene read_scene(const Document& document, const std::string& folder, LoadedModels models = {},
                 const ImportOptions& import = {});

/// The objects of a scene file, as a model.
Model import_scene(const std::string& path, const ImportOptions& import);

/// The key under which a model file stands in LoadedModels.
std::string model_key(const std::string& folder, const std::string& file);

}  // namespace lambent
