#include <algorithm>
#include <filesystem>

#include "import/model.h"
#include "import/text_file.h"

namespace lambent {

namespace {

/// The formats, one line each.
struct Format {
  const char* ending;
  Model (*read)(const std::string& path, const ImportOptions& options);
};
constexpr Format formats[] = {
    {".obj", import_obj}, {".nff", import_nff},   {".ply", import_ply},
    {".stl", import_stl}, {".gltf", import_gltf}, {".glb", import_gltf},
};

const Format* format_of(const std::string& path) {
  const std::string ending = lower_case(std::filesystem::path(path).extension().string());
  const auto found = std::find_if(std::begin(formats), std::end(formats),
                                  [&](const Format& format) { return format.ending == ending; });
  return found == std::end(formats) ? nullptr : found;
}

}  // namespace

Model import_model(const std::string& path, const ImportOptions& options) {
  if (const Format* format = format_of(path)) return format->read(path, options);
  Diagnostic diagnostic;
  diagnostic.place.file = path;
  diagnostic.message = "the ending of '" + path + "' names no model format";
  diagnostic.hint = "known endings: " + model_file_endings();
  throw InputError(std::move(diagnostic));
}

bool is_model_file(const std::string& path) { return format_of(path) != nullptr; }

std::string model_file_endings() {
  std::string text;
  for (const Format& format : formats) text += (text.empty() ? "" : ", ") + std::string(format.ending);
  return text;
}

}  // namespace lambent
