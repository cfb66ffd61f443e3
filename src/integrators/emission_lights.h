#pragma once
// Surfaces and a background that shine, as the lecture's sum over lights takes them: a fixed number of lights
// that stand for them, the same for every surface point, so that pictures stay free of noise.
//
// What shines is cut in two again and again, where it extends farthest, in space or in the ways that it
// faces, and so that half of its power lies on either side, until there are as many parts as lights (Debevec,
// A median cut algorithm for light probe sampling, SIGGRAPH 2005 posters). Each part becomes one light with
// all of its power:
//
//   of a surface   a point of it near the part's middle, that shines as a small flat light does:
//                  Il = Le A / pi times the cosine at the light. Spheres are sphere lights: Il = Le R^2.
//                  A single primitive with more than one part takes the points of an area light's pattern.
//   of the sky     a directional light along the part's mean direction: Il = (sum of L dw) / pi
//
// With many lights the sum nears the integrals over area and solid angle that paths estimate.

#include <memory>
#include <vector>

#include "integrators/frame.h"

namespace lambent {

struct EmissionLights {
  std::vector<AnyLight> lights;
  std::vector<LightPoint> points;  ///< Their `light` counts from the first of `lights`.
};

/// What shines in a frame, cut into parts. How it is cut does not depend on the wavelength, so it is done
/// once for all passes of a picture.
class Emission {
 public:
  /// `world` is the frame's; the frame has its materials, textures and environment, counts its lights, and is
  /// of no pass. Both must outlive this.
  ///   surfaces    how many lights stand for the surfaces that have emission, planes excepted: those are
  ///               infinite
  ///   background  and how many for the background, a colour or a picture. 0: none.
  Emission(const Frame& frame, const World& world, int surfaces, int background);
  ~Emission();
  Emission(const Emission&) = delete;
  Emission& operator=(const Emission&) = delete;

  /// The lights of both, the surfaces' first, in the colours of `frame`: the same, or that of one of its
  /// passes.
  EmissionLights lights(const Frame& frame) const;

 private:
  class Surfaces;
  class Sky;
  std::unique_ptr<Surfaces> surfaces_;  ///< Null: nobody asks for them; likewise
  std::unique_ptr<Sky> sky_;
};

}  // namespace lambent
