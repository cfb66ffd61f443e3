// Loading: a scene file as it is, a model file by way of the scene that is made for it.

#include <malloc.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <memory>

#include "import/lint.h"
#include "import/text_file.h"
#include "lambent/lambent.h"
#include "scenefile/autoscene.h"
#include "scenefile/document.h"
#include "scenefile/nearest.h"
#include "scenefile/read_scene.h"

namespace lambent {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const std::string& path) { return fs::path(path).parent_path().string(); }

/// `name` stands for the text in messages; `path` says where files that it names are looked for, and names
/// the scene.
ScenePtr read(std::string_view yaml, const std::string& name, const std::string& path,
              const LoadOptions& options, LoadedModels models = {}) {
  Document document = parse_yaml(yaml, name);
  std::vector<Diagnostic> wrong;
  for (const auto& [key, value] : options.set) {
    try {
      apply_setting(document, key, value);
    } catch (const InputError& error) {
      wrong.insert(wrong.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
  }
  auto scene = std::make_shared<Scene>();
  try {
    *scene = read_scene(document, folder_of(path), std::move(models));
  } catch (const InputError& error) {
    // What the file itself has to complain about comes first.
    wrong.insert(wrong.begin(), error.diagnostics().begin(), error.diagnostics().end());
  }
  if (!wrong.empty()) throw InputError(std::move(wrong));
  scene->name = fs::path(path).filename().string();
  // What reading took lies in holes between what stays; glibc gives such pages back to the system only when
  // asked.
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
  return scene;
}

/// Throws where there is no file to read at `path`.
void must_exist(const std::string& path) {
  std::error_code error;
  const auto status = fs::status(path, error);
  Diagnostic diagnostic;
  diagnostic.place.file = path;
  if (!fs::exists(status)) {
    diagnostic.message =
        "cannot open '" + path + "': " + (error ? error.message() : "No such file or directory");
    diagnostic.hint = suggest_file(path);
  } else if (fs::is_directory(status)) {
    diagnostic.message = "cannot open '" + path + "': it is a folder";
  } else {
    return;
  }
  throw InputError(diagnostic);
}

struct PictureSize {
  int width = 1280, height = 720;
};

/// The size that the settings ask for, so that the automatic camera frames for it. What is wrong with them is
/// said when they are applied to the scene.
PictureSize size_asked_for(const LoadOptions& options) {
  Document document = parse_yaml("lambent: 1", "settings");
  for (const auto& [key, value] : options.set) {
    try {
      if (key.starts_with("image")) apply_setting(document, key, value);
    } catch (const InputError&) {
    }
  }
  PictureSize size;
  const Node* image = value_of(*document.root, "image");
  const Node* sides = image ? value_of(*image, "size") : nullptr;
  if (!sides || sides->kind != Node::Kind::list || sides->children.size() != 2) return size;
  const auto side = [&](int i) {
    const std::string& text = sides->children[std::size_t(i)]->text;
    int number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return std::clamp(number, 1, 65536);
  };
  return {side(0), side(1)};
}

std::string ending_of(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return ending;
}
bool is_scene_file(const std::string& path) {
  const std::string ending = ending_of(path);
  return ending == ".yaml" || ending == ".yml" || ending == ".json";
}

}  // namespace

ScenePtr load_scene(const std::string& path, const LoadOptions& options) {
  must_exist(path);
  if (is_scene_file(path)) return read(read_file(path), path, path, options);
  if (!is_model_file(path)) {
    const std::string ending = fs::path(path).extension().string();
    Diagnostic diagnostic;
    diagnostic.place.file = path;
    diagnostic.message = ending.empty() ? "the file's name has no ending that says what it is"
                                        : "'" + ending + "' is no kind of file that Lambent reads";
    diagnostic.hint = "scenes: .yaml, .yml, .json; models: " + model_file_endings();
    throw InputError(diagnostic);
  }
  Model model = import_model(path);
  const auto [width, height] = size_asked_for(options);
  const std::string text = scene_text(model, path, width, height);
  LoadedModels models;
  models.emplace(model_key(folder_of(path), fs::path(path).filename().string()), std::move(model));
  return read(text, path + " (the scene made for it)", path, options, std::move(models));
}

ScenePtr parse_scene(std::string_view yaml, const std::string& name, const LoadOptions& options) {
  return read(yaml, name, name, options);
}

std::string scene_text_of_model(const std::string& path) {
  must_exist(path);
  return scene_text(import_model(path), path);
}

bool is_material_library(const std::string& path) { return ending_of(path) == ".mtl"; }

std::vector<Diagnostic> lint(const std::string& path, const Limits& limits) {
  const std::string ending = ending_of(path);
  if (ending != ".obj" && ending != ".mtl") return {};
  must_exist(path);
  ImportOptions options;
  options.limits = limits;
  return ending == ".obj" ? lint_obj(path, options) : lint_mtl(path, options);
}

const std::vector<Diagnostic>& warnings(const ScenePtr& scene) { return scene->warnings; }

}  // namespace lambent
