#pragma once
#include <memory>
#include <vector>

#include "film/shutter.h"
#include "integrators/prepare_emitters.h"

namespace lambent {

/// A frame and what it points at. It refers to the scene, which must outlive it.
struct PreparedFrame {
  /// What of a frame has colours.
  struct Colored {
    std::vector<AnyLight> lights;
    std::vector<LightPoint> light_points;
    std::vector<MaterialRecord> materials, unpainted;
  };
  Frame frame;
  World world;
  TreeQuality tree_quality = TreeQuality::thorough;
  std::vector<Vec2<double>> pattern;
  Shutter shutter;  ///< Where something moves; otherwise without slices.
  Colored colored;
  Illumination illumination;    ///< The scene's, or what the integrator puts in its place.
  std::vector<Material> white;  ///< What it puts in the place of the scene's materials; or empty.
  std::vector<TextureRecord> textures;
  std::unique_ptr<PreparedEmitters> emitters;  ///< Of paths.
  /// Of a scene with `spectral`: frame.passes, and what they point at.
  std::vector<Pass> passes;
  std::vector<Frame> pass_frames;
  std::vector<Colored> pass_colored;
};

/// Lays a scene out for the kernels; builds its trees. `time`: of the shutter's, from 0 to 1, where something
/// moves.
std::unique_ptr<PreparedFrame> prepare(const Scene& scene, double time = 0.5);

/// Samples that are taken one after the other: of a slice, from `first` up to `end` in the frame's order.
struct Portion {
  int slice, first, end;
};

/// The frames of a picture: one, or where something moves one for each slice of the shutter's time. They are
/// alike but for the world. One is kept at a time, and made when it is asked for.
class Exposure {
 public:
  /// The scene must outlive it.
  explicit Exposure(const Scene& scene);
  /// Valid until another one is asked for.
  const PreparedFrame& at(int slice);
  const std::vector<Slice>& slices() const { return slices_; }
  /// All samples, slice by slice.
  std::vector<Portion> portions() const;

 private:
  const Scene& scene_;
  std::vector<Slice> slices_;
  int slice_ = 0;
  std::unique_ptr<PreparedFrame> prepared_;
};

/// The trees that bring a picture of so many samples to its end soonest.
TreeQuality suitable_quality(std::uint64_t primitives, std::uint64_t samples);

/// The camera's axes, orthonormal, right-handed: right x up points back at the viewer.
CameraRecord camera_record(const Camera& camera);

}  // namespace lambent
