#pragma once
#include <memory>
#include <vector>

#include "integrators/emitters.h"

namespace lambent {

/// A table of emitters, and what it points at.
struct PreparedEmitters {
  EmitterTable table;
  std::vector<Emitter> emitters;
  std::vector<LightNode> nodes;
  std::vector<EmitterRoot> roots;
  std::vector<std::int64_t> first_of_instance, first_of_geometry;
  std::vector<std::int32_t> emitter_of, emitter_of_light;
  std::vector<double> rows, columns;
};

/// All that shines in a frame, which must be complete otherwise; `world` is the frame's.
std::unique_ptr<PreparedEmitters> prepare_emitters(const Frame& frame, const World& world);

// For all that is laid out of what shines:

/// Over the channels.
double mean_of_channels(const Rgb& color);
/// For each geometry whether instances show it; otherwise it stands in the world by itself.
std::vector<char> are_instanced(const World& world);
/// The finest level of detail that has not more than so many texels, or the coarsest.
int finest_level(const TextureRecord& texture, std::int64_t most);

}  // namespace lambent
