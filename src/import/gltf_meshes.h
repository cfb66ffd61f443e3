#pragma once
// Meshes of glTF: attributes, morph targets, skins, and what each mode of primitives becomes.

#include <map>
#include <tuple>

#include "import/gltf_materials.h"
#include "import/gltf_pose.h"
#include "import/gltf_primitive.h"

namespace lambent::gltf {

class Meshes {
 public:
  Meshes(const Json& root, Buffers& buffers, const ImportOptions& options, const Pose& pose,
         Materials& materials, Remarks& remarks, Model& model)
      : root_(root),
        buffers_(buffers),
        options_(options),
        pose_(pose),
        materials_(materials),
        remarks_(remarks),
        model_(model) {}

  /// The radii of what has no extent of its own, points and lines: shares of the diagonal of the box around
  /// everything that is shown. `diagonal` is in the units of the world.
  void set_size(double diagonal) { diagonal_ = diagonal; }

  /// The shapes of what a node shows, as indices into the model's: one for each primitive. Nodes that show
  /// the same in the same pose share them. `skinned` says for each whether it stands in the world already.
  struct Part {
    std::uint32_t shape;
    bool in_world;
  };
  const std::vector<Part>& of_node(std::size_t node);
  /// Of a mesh that no node shows.
  const std::vector<Part>& of_mesh(std::size_t mesh);

 private:
  static constexpr std::size_t none = ~std::size_t{0};
  /// Mesh, skin, and weights where they are not the mesh's own.
  using Key = std::tuple<std::size_t, std::size_t, std::vector<double>>;

  const std::vector<Part>& parts(std::size_t mesh, std::size_t skin, const std::vector<double>& weights,
                                 double scale);
  std::vector<double> own_weights(const Json& mesh) const;
  /// Whether the file leaves open where bytes of a primitive come from.
  bool is_open(const Json& primitive) const;
  Shape read(PrimitiveReader& reader, int mode, std::uint32_t material, double unit);
  const std::vector<Transform>& joints(std::size_t skin);
  void count_primitives(std::uint64_t more, const std::string& at);

  const Json& root_;
  Buffers& buffers_;
  const ImportOptions& options_;
  const Pose& pose_;
  Materials& materials_;
  Remarks& remarks_;
  Model& model_;
  double diagonal_ = 1;
  std::map<Key, std::vector<Part>> parts_;
  std::map<std::size_t, std::vector<Transform>> joints_;  ///< By skin: world from what the mesh is given in.
  std::uint64_t primitives_ = 0;
  std::vector<std::uint32_t> place_of_vertex_;  ///< Kept for its memory.
};

}  // namespace lambent::gltf
