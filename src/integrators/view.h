#pragma once
// Debug views: pictures of what the eye's rays meet first, or of how many rays were asked.

#include "integrators/frame.h"
#include "scene/scene.h"

namespace lambent {

/// What the colours of a view are made with.
struct ViewRecord {
  View show;
  double distance;  ///< From the eye to the target.
  AnyLight light;   ///< Of View::cosine.
};
ViewRecord view_record(const Scene& scene, const ViewSettings& view);

/// The colour of a sample, for every view but View::rays; black where the ray met nothing.
///   normals     (N + 1) / 2, axis by axis, in the world, N on the eye's side
///   depth       1 / (1 + R / distance): 1 at the eye, 1/2 at the target's distance, 0 far away
///   uv          (u - floor u, v - floor v, 0)
///   primitives, objects, materials   color_of_name, of the number; of primitives that of their object, too
///   cosine      (N.L)+
Rgb view_color(const ViewRecord& view, const FirstHit& hit);

/// A colour for a name: the same name always has the same, others have others, and none is dark.
Rgb color_of_name(const std::string& name);

/// The colour of a pixel that took `rays` rays in a picture whose pixels took `most` at most: log(1 + rays)
/// over log(1 + most), from dark blue by green and yellow to white.
Rgb color_of_ray_count(std::uint64_t rays, std::uint64_t most);

/// The frame that asks for a view no more than it needs: for all but View::rays the eye's rays alone.
Frame frame_for(const Frame& frame, View view);

}  // namespace lambent
