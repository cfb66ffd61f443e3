#pragma once
#include <optional>
#include <string>

#include "explain/derivation.h"
#include "explain/page.h"

namespace lambent {

/// What shines, by film/layers.h' number: the name of a light, "surfaces that shine", "the background".
std::string source_name(const Derivation& derivation, int source);

/// The derivation of one sample, and of the pixel by its samples.
std::string page_of(const Derivation& derivation, int sample, Page& page);

/// docs/explain.schema.json. Without `sample`: all of them.
std::string json_of(const Derivation& derivation, std::optional<int> sample);

}  // namespace lambent
