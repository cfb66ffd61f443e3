// Loading: a scene file as it is, a model file by way of the scene that is made for it.

#include <malloc.h>

#include <algorithm>
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
#include "scenefile/yaml_text.h"

namespace lambent {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const std::string& path) { return fs::path(path).parent_path().string(); }

/// A lower-case ending with its dot, or empty.
std::string ending_of(const std::string& path) { return lower_case(fs::path(path).extension().string()); }

/// Whether a background is meant to be an image, not a colour.
bool is_image_name(const std::string& text) {
  const std::string ending = ending_of(text);
  return ending == ".hdr" || ending == ".exr" || ending == ".png" || ending == ".jpg" || ending == ".jpeg";
}

/// A background as a scene file says it.
std::string background_text(const std::string& text) {
  if (is_image_name(text)) return "{file: " + yaml_quoted(text) + "}";
  return !text.empty() && text[0] == '#' ? yaml_quoted(text) : text;
}

ImportOptions import_options(const LoadOptions& options, const std::string& path) {
  ImportOptions import;
  import.time = options.time;
  import.limits = options.limits;
  import.root = folder_of(path).empty() ? "." : folder_of(path);
  return import;
}

/// `name` stands for the text in messages; `path` says where files that it names are looked for, and names
/// the scene.
std::shared_ptr<Scene> read(std::string_view yaml, const std::string& name, const std::string& path,
                            const LoadOptions& options, LoadedModels models = {}) {
  Document document = parse_yaml(yaml, name);
  std::vector<Diagnostic> wrong;
  const auto set = [&](const std::string& key, const std::string& value) {
    try {
      apply_setting(document, key, value);
    } catch (const InputError& error) {
      wrong.insert(wrong.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
  };
  // The caller's image may lie anywhere; the scene's folder is not where its name begins.
  if (!options.background.empty())
    set("background", is_image_name(options.background)
                          ? background_text(fs::absolute(options.background).lexically_normal().string())
                          : options.background);
  // The settings that the file has for it count; without any its defaults do.
  if (!options.integrator.empty()) {
    const Node* given = document.root ? value_of(*document.root, "integrator") : nullptr;
    if (given == nullptr || value_of(*given, options.integrator) == nullptr)
      set("integrator." + options.integrator, "{}");
  }
  for (const auto& [key, value] : options.set) set(key, value);
  auto scene = std::make_shared<Scene>();
  try {
    *scene = read_scene(document, folder_of(path), std::move(models), import_options(options, path));
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

/// Throws where there is no file to read at `path`, or one beyond the limit.
void must_exist(const std::string& path, const Limits& limits) {
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
  } else if (const auto size = fs::file_size(path, error); !error && size > limits.file_bytes) {
    diagnostic.message = "the file is too large: " + std::to_string(size) + " bytes";
    diagnostic.hint =
        "at most " + std::to_string(limits.file_bytes) + " are read; --max-file-bytes sets another limit";
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

bool is_scene_file(const std::string& path) {
  const std::string ending = ending_of(path);
  return ending == ".yaml" || ending == ".yml" || ending == ".json";
}

/// What is chosen for models is no affair of a scene file.
void must_not_choose(const std::string& path, const LoadOptions& options) {
  const auto refuse = [&](const std::string& option, const std::string& hint) {
    Diagnostic diagnostic;
    diagnostic.place.file = path;
    diagnostic.message = option + " is for model files; this is a scene, which says that itself";
    diagnostic.hint = hint;
    throw InputError(diagnostic);
  };
  if (!options.camera.empty()) refuse("--camera", "--set camera.eye='[x, y, z]' sets the scene's camera");
  if (!options.up.empty()) refuse("--up", "--set camera.up='[x, y, z]' sets the scene's camera upright");
  if (!options.ground) refuse("--no-ground", "take the floor out of the scene's objects");
}

/// The choices that `options` make for a model, for a picture of that size.
ModelChoices choices_of(const LoadOptions& options, PictureSize size) {
  ModelChoices choices;
  choices.width = size.width, choices.height = size.height;
  choices.camera = options.camera;
  choices.up = options.up;
  choices.ground = options.ground;
  return choices;
}

}  // namespace

ScenePtr load_scene(const std::string& path, const LoadOptions& options) {
  must_exist(path, options.limits);
  if (is_scene_file(path)) {
    must_not_choose(path, options);
    return read(read_file(path), path, path, options);
  }
  if (!is_model_file(path)) {
    const std::string ending = fs::path(path).extension().string();
    Diagnostic diagnostic;
    diagnostic.place.file = path;
    diagnostic.message = ending.empty() ? "the file's name has no ending that says what it is"
                                        : "'" + ending + "' is no kind of file that Lambent reads";
    diagnostic.hint = "scenes: .yaml, .yml, .json; models: " + model_file_endings();
    throw InputError(diagnostic);
  }
  Model model = import_model(path, import_options(options, path));
  const ModelChoices choices = choices_of(options, size_asked_for(options));
  const ModelScene made = scene_for(model, path, choices);
  std::vector<std::string> cameras;
  for (const NamedCamera& camera : model.cameras) cameras.push_back(camera.name);
  LoadedModels models;
  models.emplace(model_key(folder_of(path), fs::path(path).filename().string()), std::move(model));
  const auto scene = read(made.text, path + " (the scene made for it)", path, options, std::move(models));
  scene->model_cameras = std::move(cameras);
  scene->axis = made.axis;
  return scene;
}

ScenePtr parse_scene(std::string_view yaml, const std::string& name, const LoadOptions& options) {
  must_not_choose(name, options);
  return read(yaml, name, name, options);
}

std::string scene_text_of_model(const std::string& path, const LoadOptions& options) {
  must_exist(path, options.limits);
  ModelChoices choices = choices_of(options, {});
  if (!options.background.empty()) choices.background = background_text(options.background);
  return scene_for(import_model(path, import_options(options, path)), path, choices).text;
}

ScenePtr turned(const ScenePtr& scene, double degrees) {
  if (degrees == 0) return scene;
  auto copy = std::make_shared<Scene>(*scene);
  Camera& camera = copy->camera;
  const Axis axis = scene->axis.value_or(Axis{camera.target, camera.up});
  const Transform turn = rotation(normalize(axis.direction), degrees);
  camera.eye = axis.point + transform_vector(turn, camera.eye - axis.point);
  camera.target = axis.point + transform_vector(turn, camera.target - axis.point);
  camera.up = transform_vector(turn, camera.up);
  return copy;
}

bool is_material_library(const std::string& path) { return ending_of(path) == ".mtl"; }

std::vector<Diagnostic> lint(const std::string& path, const Limits& limits) {
  const std::string ending = ending_of(path);
  if (ending != ".obj" && ending != ".mtl") return {};
  must_exist(path, limits);
  ImportOptions options;
  options.limits = limits;
  return ending == ".obj" ? lint_obj(path, options) : lint_mtl(path, options);
}

const std::vector<Diagnostic>& warnings(const ScenePtr& scene) { return scene->warnings; }

}  // namespace lambent
