#pragma once
// A picture of wavelengths: the passes that it is made in, and the scene as each of them has it.

#include <vector>

#include "integrators/frame.h"

namespace lambent {

/// The passes of a scene with `spectral`, their frames not yet set: of three wavelengths each, or of one
/// where there is glass that sends each its own way.
std::vector<Pass> passes_of(const Scene& scene);

/// What is in a scene's colours, with a wavelength in each channel. Colours that are given as spectra are
/// what they are there; all others are made spectra of (spectra/spectrum.h).
Rgb in_pass(const Scene& scene, const Pass& pass, const Spectrum& spectrum);
AnyLight light_in_pass(const Scene& scene, const Pass& pass, const Light& light);
/// Of a material that is no metallic-roughness one.
Material material_in_pass(const Scene& scene, const Pass& pass, const Material& material);
/// Ia.
Rgb ambient_in_pass(const Scene& scene, const Pass& pass);

/// The index of refraction of a metal or a glass in the three channels of a pass, or, without one, as good as
/// three colours can have it.
struct ChannelIndex {
  Rgb eta, k;
};
ChannelIndex index_of(const Substance& substance, const Scene& scene, const Pass* pass);

}  // namespace lambent
