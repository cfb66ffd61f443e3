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
  std::vector<LightPoint> light_points;
  std::vector<MaterialRecord> materials, unpainted;
  std::vector<TextureRecord> textures;
};

/// Lays a scene out for the kernels; builds its trees.
std::unique_ptr<PreparedFrame> prepare(const Scene& scene);

/// Point `number` of the pattern in which `count` points lie on a light. Each has one of `count` columns and
/// one of `count` rows of equal width for itself, and they lie alike about the centre; k x k points also have
/// a cell each of a grid of k x k (Kensler, Correlated multi-jittered sampling, Pixar technical memo 13-01,
/// 2013, without the jitter). So edges of shadows at any angle have as many steps as there are points.
Vec2<double> point_of_light(int number, int count);

/// The trees that bring a picture of so many samples to its end soonest.
TreeQuality suitable_quality(std::uint64_t primitives, std::uint64_t samples);

/// The camera's axes, orthonormal, right-handed: right x up points back at the viewer.
CameraRecord camera_record(const Camera& camera);

}  // namespace lambent
