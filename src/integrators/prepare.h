#pragma once
#include <memory>
#include <vector>

#include "integrators/frame.h"

namespace lambent {

/// A frame and what it points at. It refers to the scene, which must outlive it.
struct PreparedFrame {
  Frame frame;
  World world;
  TreeQuality tree_quality = TreeQuality::thorough;
  std::vector<Vec2<double>> pattern;
  std::vector<AnyLight> lights;
  Illumination illumination;          ///< The scene's, or what the integrator puts in its place.
  std::vector<Material> white;        ///< What it puts in the place of the scene's materials; or empty.
  std::vector<MaterialRecord> materials, unpainted;
  std::vector<TextureRecord> textures;
};

/// Lays a scene out for the kernels; builds its trees.
std::unique_ptr<PreparedFrame> prepare(const Scene& scene);

/// The trees that bring a picture of so many samples to its end soonest.
TreeQuality suitable_quality(std::uint64_t primitives, std::uint64_t samples);

/// The camera's axes, orthonormal, right-handed: right x up points back at the viewer.
CameraRecord camera_record(const Camera& camera);

}  // namespace lambent
