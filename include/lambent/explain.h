#pragma once
// One pixel's reasons: every ray, every light, every term of the equation with its numbers, and how they add
// up.
//
// The numbers are those that the renderer made: it is asked for the pixel once more, and tells.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lambent/lambent.h"

namespace lambent {

struct Derivation;  // opaque here
using DerivationPtr = std::shared_ptr<const Derivation>;

struct ExplainOptions {
  std::string isa;  ///< As in RenderOptions; the numbers do not depend on it.
  int threads =
      0;  ///< Likewise; only where adaptive samples have to be taken to know how many this pixel gets.
};

/// Derives pixel x, y, counted from the top left corner, from 0. Throws InputError where the picture has no
/// such pixel.
DerivationPtr explain(const ScenePtr& scene, int x, int y, const ExplainOptions& options = {});

/// How many samples the pixel has, and which is nearest its centre.
int sample_count(const DerivationPtr& derivation);
int central_sample(const DerivationPtr& derivation);

/// The pixel's colour as the sum of its terms, added up anew in the renderer's order: what the EXR's R, G, B
/// hold.
std::vector<float> pixel_of(const DerivationPtr& derivation);
/// Whether that is what the renderer got, in every bit. It always is; if not, Lambent is at fault.
bool adds_up(const DerivationPtr& derivation);

enum class ExplainFormat {
  text,    ///< For a terminal of 80 columns.
  json,    ///< docs/explain.schema.json; all samples unless one is asked for.
  mathml,  ///< An HTML page with MathML in it.
  latex,   ///< A LaTeX document for amsmath.
};
struct ExplainText {
  ExplainFormat format = ExplainFormat::text;
  std::optional<int> sample;  ///< Unset: the central one; in JSON all.
  bool color = false;         ///< Text: with a terminal's colours.
};
/// Throws InputError where there is no such sample.
std::string explanation(const DerivationPtr& derivation, const ExplainText& options = {});

/// Every ray that was asked for the pixel, in order, one a line: its kind, where it starts, where it goes,
/// how far a shadow ray looks.
std::string ray_trace(const DerivationPtr& derivation);

}  // namespace lambent
