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

}  // namespace lambent
