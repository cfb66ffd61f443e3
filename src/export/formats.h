#pragma once
// Our scene in the words of other renderers: one file per format.
//
// Each writes what the other program can say in such a way that it makes the same picture, and remarks on
// what it cannot: nothing is dropped in silence.

#include <string>
#include <vector>

#include "lambent/diagnostics.h"
#include "scene/scene.h"

namespace lambent {

/// For POV-Ray 3.7.
std::string povray_text(const Scene& scene, std::vector<Diagnostic>& remarks);
/// For Tachyon 0.99.
std::string tachyon_text(const Scene& scene, std::vector<Diagnostic>& remarks);

}  // namespace lambent
