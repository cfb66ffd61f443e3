#pragma once
// Materials, textures, images and samplers of glTF.

#include <map>
#include <utility>

#include "import/gltf_accessors.h"
#include "import/unique_names.h"

namespace lambent::gltf {

/// What meshes must know of a material.
struct MaterialTraits {
  bool opaque = true;  ///< Alpha counts nothing.
  bool unlit = false;
  int normal_uvs = -1;  ///< The set of texture coordinates of its normal map; -1: it has none.
};

class Materials {
 public:
  Materials(const Json& root, Buffers& buffers, const ImportOptions& options, Remarks& remarks, Model& model)
      : root_(root), buffers_(buffers), options_(options), remarks_(remarks), model_(model) {}

  /// Puts all of the file's materials, in their order, and the textures that they use into the model.
  void read();
  /// The index in the model of a primitive's material; where it has none, the specification's default.
  std::uint32_t of(const Json& primitive);
  const MaterialTraits& traits(std::uint32_t material) const { return traits_[material]; }
  /// The same material in another colour, for what can have no colours of its own: its base colour (and, if
  /// alpha counts, its opacity) times `color`.
  std::uint32_t tinted(std::uint32_t material, const std::array<float, 4>& color);

 private:
  void add(const Json& json, const std::string& at);
  void metallic_roughness(const Json& json, const std::string& at, Material& material);
  void specular_glossiness(const Json& json, const std::string& at, Material& material);
  void extensions(const Json& json, const std::string& at, Material& material);
  void base_color(const Json& factor, const Json& texture, const std::string& at,
                  const std::string& alpha_mode, Material& material);
  /// Adds a map, if there is such a texture and its image.
  TextureMap* map(Material& material, MapSlot slot, const Json& info, const std::string& at, bool srgb,
                  int channel = -1);
  std::optional<std::uint32_t> texture(const Json& json, const std::string& at, bool srgb);
  const std::optional<ImageSource>& image(std::size_t number);

  const Json& root_;
  Buffers& buffers_;
  const ImportOptions& options_;
  Remarks& remarks_;
  Model& model_;
  std::vector<MaterialTraits> traits_;
  std::optional<std::uint32_t> default_;
  UniqueNames names_;
  std::map<std::pair<std::uint32_t, std::array<float, 4>>, std::uint32_t> tinted_;
  std::map<std::size_t, std::optional<ImageSource>> images_;
  std::uint64_t image_bytes_ = 0;                                   ///< Copied out of buffers.
  std::map<std::pair<std::size_t, bool>, std::uint32_t> textures_;  ///< By image and encoding.
};

}  // namespace lambent::gltf
