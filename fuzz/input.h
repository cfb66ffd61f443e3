#pragma once
// What the targets share: input as a file, and what must hold for every model that a reader lets pass.

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "import/model.h"

namespace lambent::fuzz {

/// A broken promise: libFuzzer keeps the input.
inline void check(bool holds, const char* promise) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", promise);
  std::abort();
}

/// Readers take paths: a folder in memory of this process's own, so that files which the input names are
/// looked for where there are none.
class Folder {
 public:
  Folder() {
    std::error_code none;
    const std::filesystem::path memory = "/dev/shm";
    path_ = (std::filesystem::is_directory(memory, none) ? memory : std::filesystem::temp_directory_path()) /
            ("lambent-fuzz-" + std::to_string(::getpid()));
    std::filesystem::create_directory(path_);
  }
  ~Folder() {
    std::error_code none;
    std::filesystem::remove_all(path_, none);
  }
  /// The path of the file with these bytes; the same one each time for one name.
  std::string file(const std::string& name, const std::uint8_t* data, std::size_t size) const {
    const std::string path = (path_ / name).string();
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(data), std::streamsize(size));
    check(bool(file.flush()), "the input can be written to a file");
    return path;
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};
inline const Folder& folder() {
  static const Folder folder;
  return folder;
}

/// Limits in proportion to inputs of some kilobytes.
inline ImportOptions small_options() {
  ImportOptions options;
  options.limits.file_bytes = 1 << 24;
  options.limits.primitives = 1 << 20;
  options.limits.pixels = 1 << 20;
  return options;
}

inline void check(const InputError& error) {
  check(!error.diagnostics().empty(), "an error says something");
  for (const Diagnostic& d : error.diagnostics()) {
    check(!d.message.empty(), "an error has a message");
    to_string(d);
  }
}

inline void check(const Model& model) {
  // A glTF file may hold nothing but cameras, or not even these.
  check(!model.shapes.empty() || !model.warnings.empty(), "a model has a shape, or says why it has none");
  check(!model.materials.empty(), "a model has a material");
  for (const Shape& shape : model.shapes) {
    check(primitive_count(shape) > 0, "a shape has a primitive");
    const auto& of = shape.material_of_primitive;
    check(of.empty() || of.size() == primitive_count(shape), "each primitive has a material, or none has");
    for (const std::uint32_t i : of) check(i < model.materials.size(), "a primitive's material is there");
    const Mesh* const mesh = std::get_if<Mesh>(&shape.primitives);
    if (!mesh) continue;
    const std::size_t n = mesh->vertices.size();
    for (const auto& triangle : mesh->triangles)
      for (const std::uint32_t i : triangle) check(i < n, "a triangle's vertex is there");
    const auto fits = [&](const auto& list) { return list.empty() || list.size() == n; };
    check(fits(mesh->normals) && fits(mesh->uvs) && fits(mesh->uvs2) && fits(mesh->colors) &&
              fits(mesh->tangents),
          "what vertices have, each has");
    for (const auto& v : mesh->vertices)
      check(v.x - v.x == 0 && v.y - v.y == 0 && v.z - v.z == 0, "vertices are finite");
    for (const auto& v : mesh->normals) {
      const float size = dot(v, v);
      check(size == 0 || (size > 0.99f && size < 1.01f), "normals are of length 1 or zero");
    }
  }
  for (const ModelObject& object : model.objects)
    check(object.shape < model.shapes.size(), "an object's shape is there");
  for (const Material& material : model.materials)
    for (const MaterialMap& map : material.maps)
      check(map.map.texture < model.textures.size(), "a map's texture is there");
  for (const Diagnostic& d : model.warnings) to_string(d);
}

/// One input for a reader of models.
inline void run(Model (*reader)(const std::string&, const ImportOptions&), const char* name,
                const std::uint8_t* data, std::size_t size, const ImportOptions& options = small_options()) {
  const std::string path = folder().file(name, data, size);
  try {
    check(reader(path, options));
  } catch (const InputError& error) {
    check(error);
  }
}

}  // namespace lambent::fuzz
