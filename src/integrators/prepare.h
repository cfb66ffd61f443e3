#pragma once
#include <memory>
#include <vector>

#include "integrators/frame.h"

namespace lambent {

/// A frame and what it points at. It refers to the scene, which must outlive it.
struct PreparedFrame {
  Frame frame;
  World world;
  std::vector<Vec2<double>> pattern;
  std::vector<AnyLight> lights;
  std::vector<MaterialRecord> materials;
};

/// Lays a scene out for the kernels; builds its trees.
std::unique_ptr<PreparedFrame> prepare(const Scene& scene);

/// The camera's axes, orthonormal, right-handed: right x up points back at the viewer.
CameraRecord camera_record(const Camera& camera);

}  // namespace lambent
