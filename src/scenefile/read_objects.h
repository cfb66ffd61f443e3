#pragma once
// The objects of a scene file: shapes, their materials and transforms.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenefile/read_scene.h"
#include "scenefile/reader.h"

namespace lambent {

/// Reads objects one after the other; shared model files are loaded and stored once.
class ObjectReader {
 public:
  /// The scene's lights and materials have been read already.
  ObjectReader(Reader& reader, Scene& scene, std::string folder, LoadedModels models,
               const ImportOptions& import);

  void object(const Value& value, const std::string& default_name);

 private:
  /// Where a model file went: its shapes, and its materials as the scene has them.
  struct Placed {
    bool good = false;
    std::vector<ModelObject> objects;  ///< Their shapes are the scene's.
    std::vector<std::uint32_t> materials;
  };

  bool shape(const Section& section, const Value& value, Object& object);
  bool mesh(const Values& values, const Section& section, Object& object);
  bool scene(const Values& values);
  bool inline_mesh(const Values& values, const Section& section);
  const Placed* model(const Value& file, bool is_scene = false);
  std::optional<std::uint32_t> material(const Value& value);
  std::uint32_t default_material();
  void add_shape(std::string name, Primitives primitives);
  bool has_room(const Object& object, const Value& value);

  Reader& reader_;
  Scene& scene_;
  std::string folder_;
  ImportOptions import_;
  LoadedModels loaded_;
  std::map<std::string, Placed> placed_;          // by model_key
  std::map<std::string, std::uint32_t> by_name_;  // the scene's own materials
  std::optional<std::uint32_t> default_material_;
  std::vector<ModelObject> placed_shapes_;  // of the object at hand
  const Placed* file_ = nullptr;            // likewise, if it is a model file
  std::size_t inline_materials_ = 0;
  std::size_t compared_ = 0;  // names, to find out what misspelled ones mean
  std::uint64_t stored_ = 0;  // primitives of the files' shapes
  std::uint64_t shown_ = 0;   // what all objects count for
  bool full_ = false;         // that there are too many has been said
};

/// The transform of `value`: one step or a list of steps. False if something was wrong.
bool read_transform(Reader& reader, const Value& value, Transform& out);

/// A motion: one step or a list of steps, added to `out`. False if something was wrong.
bool read_motion(Reader& reader, const Value& value, std::vector<MotionStep>& out);

/// Files that a scene names: where they are looked for, and what of them may be read.
struct Files {
  std::string folder;
  ImportOptions import;
  /// The path of a file that is there and may be read; otherwise what is wrong is said.
  std::optional<std::string> find(Reader& reader, const Value& name) const;
};

/// An image that the scene file names: its index in the scene's textures.
std::optional<std::uint32_t> read_image_file(Reader& reader, const Value& file, bool srgb, const Files& files,
                                             std::vector<Texture>& textures);

/// One entry of `materials`, or one written out in an object. Its maps' images are added to `textures`.
bool read_material(Reader& reader, const Value& value, const std::vector<Field>& fields,
                   const std::string& what, const Illumination& illumination, const Files& files,
                   std::vector<Texture>& textures, Material& out);

}  // namespace lambent
