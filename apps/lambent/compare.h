#pragma once
#include <string>

#include "commands.h"
#include "lambent/lambent.h"

namespace lambent::app {

/// The size of each picture of a sheet, as a scene file says it: what --size says, else the scene's, made
/// smaller where it is wider than two or three pictures on a screen can be.
std::string picture_size(const CompareCommand& command, const SceneSummary& scene);

/// Where a sheet goes that is not told.
std::string sheet_output(const std::string& input, const std::string& suffix);

/// One sheet from Lambert's cosine to the rendering equation, a picture for each step.
ExitCode run_ladder(const CompareCommand& command);

}  // namespace lambent::app
