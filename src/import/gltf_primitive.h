#pragma once
// The vertices of one primitive of a glTF mesh, morphed and skinned.

#include <array>
#include <optional>
#include <utility>

#include "import/gltf_accessors.h"
#include "math/transform.h"
#include "scene/scene.h"

namespace lambent::gltf {

class PrimitiveReader {
 public:
  /// `joints` may be null. All references must outlive this.
  PrimitiveReader(const Json& root, const Json& primitive, std::string at, const std::vector<double>& weights,
                  const std::vector<Transform>* joints, Buffers& buffers, Remarks& remarks);

  /// The corners in their order: how many, and which vertex each is.
  std::size_t corners() const { return indices_ ? indices_->count() : vertices(); }
  std::uint32_t corner(std::size_t i) const { return indices_ ? indices_->index(i) : std::uint32_t(i); }
  std::size_t vertices() const { return positions_.base->count(); }
  bool is_skinned() const { return !joint_sets_.empty(); }

  /// Everything that a mesh holds of the given vertices, but for its triangles. With `opaque` colours have
  /// no alpha.
  Mesh read(const std::vector<std::uint32_t>& vertices, bool opaque);
  Vec3<double> position(std::uint32_t vertex);
  /// COLOR_0; white where there is none.
  bool has_colors() const { return colors_.base.has_value(); }
  std::array<float, 4> color(std::uint32_t vertex, bool opaque) const;

 private:
  /// An attribute with its morph targets.
  struct Attribute {
    std::optional<Accessor> base;
    std::vector<std::pair<double, Accessor>> targets;
    /// A component of the element, morphed.
    double value(std::size_t element, int component) const;
    Vec3<double> vector(std::size_t element) const {
      return {value(element, 0), value(element, 1), value(element, 2)};
    }
  };
  Attribute attribute(const char* name);
  Transform skin_of(std::uint32_t vertex);
  Vec3<double> placed(std::uint32_t vertex, const Transform& skin);

  const Json& root_;
  const Json& primitive_;
  std::string at_;
  const std::vector<double>& weights_;
  const std::vector<Transform>* joints_;
  Buffers& buffers_;
  Remarks& remarks_;
  Attribute positions_, colors_;
  std::optional<Accessor> indices_;
  std::vector<std::pair<Accessor, Accessor>> joint_sets_;  ///< Joints and weights.
};

}  // namespace lambent::gltf
