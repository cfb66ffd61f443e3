#pragma once
#include <optional>
#include <string>

#include "explain/derivation.h"
#include "explain/page.h"

namespace lambent {

/// The derivation of one sample, and of the pixel by its samples.
std::string page_of(const Derivation& derivation, int sample, Page& page);

/// docs/explain.schema.json. Without `sample`: all of them.
std::string json_of(const Derivation& derivation, std::optional<int> sample);

}  // namespace lambent
