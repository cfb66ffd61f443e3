#pragma once
// The integrator `ambient_occlusion`: A alone, the share of the sky that each place sees, as a grey picture.
// It is Whitted's picture of the same shapes with all else taken away: white surfaces without lights, the
// sky's even light on them, and nothing that is followed on.

#include "integrators/frame.h"
#include "scene/scene.h"

namespace lambent {

/// A material that is white and opaque, and there where `material` is there: its cut-outs stay, and what
/// tilts the normal.
Material whitened(const Material& material);

/// Ambient light of strength 1 that does not fade, hidden as `occlusion` says.
Illumination even_sky(const AmbientOcclusion& occlusion);

/// What blocks a white scene's rays: everything but cut-outs.
void block_all_but_cut_outs(const Scene& scene, World& world);

}  // namespace lambent
