#pragma once
#include <memory>
#include <vector>

#include "integrators/frame.h"

namespace lambent {

/// A frame and what it points at. It refers to the scene, which must outlive it.
struct PreparedFrame {
  /// What of a frame has colours.
  struct Colored {
    std::vector<AnyLight> lights;
    std::vector<MaterialRecord> materials, unpainted;
  };
  Frame frame;
  World world;
  TreeQuality tree_quality = TreeQuality::thorough;
  std::vector<Vec2<double>> pattern;
  Colored colored;
  std::vector<TextureRecord> textures;
  /// Of a scene with `spectral`: frame.passes, and what they point at.
  std::vector<Pass> passes;
  std::vector<Frame> pass_frames;
  std::vector<Colored> pass_colored;
};

/// Lays a scene out for the kernels; builds its trees.
std::unique_ptr<PreparedFrame> prepare(const Scene& scene);

/// The trees that bring a picture of so many samples to its end soonest.
TreeQuality suitable_quality(std::uint64_t primitives, std::uint64_t samples);

/// The camera's axes, orthonormal, right-handed: right x up points back at the viewer.
CameraRecord camera_record(const Camera& camera);

}  // namespace lambent
