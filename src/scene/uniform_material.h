#pragma once

#include "illumination/metallic_roughness.h"
#include "scene/scene.h"

namespace lambent {

/// What metallic_roughness.h makes the lecture's numbers of.
MetallicRoughnessOf<double, Rgb> numbers_of(const MetallicRoughness& material);

/// The material as it is where nothing is painted on it: a metallic-roughness one in the lecture's numbers
/// (illumination/metallic_roughness.h), and what is not opaque of it in its colours and `transmit`. Its maps
/// are as they were; a mask too, as it is all there or not at all.
Material uniform_material(const Material& material);

/// What a metal or a glass is to those who know neither: what it reflects at normal incidence stands in its
/// colours. Other materials are as they were.
Material seen_head_on(const Material& material);

}  // namespace lambent
