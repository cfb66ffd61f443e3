#pragma once
// The equation's terms at one hit as formulas, made by the model itself.

#include "explain/derivation.h"
#include "explain/math_text.h"

namespace lambent {

struct LightFormulas {
  MathTerm arriving;  ///< I: Il, faded, and what is left of it on the way.
  MathTerm diffuse, specular;
  std::vector<Formulas::Definition> definitions;  ///< Vectors that the model made: R, H.
};

/// Ka Ia / R, with its numbers.
MathTerm ambient_formula(const Derivation& derivation, const DerivedRay& ray);
/// What a light, or one of its points, brings at this hit. The values are those of the renderer in every bit.
LightFormulas light_formulas(const Derivation& derivation, const DerivedRay& ray, const DerivedLight& light);

}  // namespace lambent
