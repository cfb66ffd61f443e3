#pragma once
// What parse_scene has to say about a text.

#include <string>
#include <vector>

#include "lambent/lambent.h"

namespace lambent::test {

/// The errors, or none if the text is a scene.
inline std::vector<Diagnostic> errors_of(const std::string& text, const LoadOptions& options = {},
                                         const std::string& name = "scene.yaml") {
  try {
    parse_scene(text, name, options);
  } catch (const InputError& error) {
    return error.diagnostics();
  }
  return {};
}

/// All of them as people see them.
inline std::string report(const std::string& text, const LoadOptions& options = {}) {
  std::string result;
  for (const Diagnostic& diagnostic : errors_of(text, options)) result += to_string(diagnostic) + "\n";
  return result;
}

/// The smallest scene there is; two lines.
inline const std::string head = "lambent: 1\ncamera: {eye: [0, 0, 5], target: [0, 0, 0]}\n";

}  // namespace lambent::test
