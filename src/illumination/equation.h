#pragma once
// The equation, written once:
//
//   I = Ka Ia / R  +  sum over lights l of  Il / r  [ Kd (N.L)+  +  Ks ((R.V)+)^n ]
//       \_______/                            \____/   \_________________________/
//       ambient                              arriving  the model's two terms
//
// The renderer, the tests and everything that explains a picture call this one function.

#include "illumination/model.h"

namespace lambent {

/// Says which term is being added to the sum, to whoever wants to know. Emission is no term of the equation;
/// it is added to what the equation gives.
enum class Term { ambient, diffuse, specular, emission };

struct NoObserver {
  template <class C> void operator()(Term, int /*light*/, const C&) const {}
};

inline namespace LAMBENT_ISA {

/// The ambient term: Ka Ia, where the model does not say otherwise.
template <class Model, class F, class C> C ambient_term(const Surface<F, C>& s, const C& Ia) {
  if constexpr (requires { Model::ambient(s, Ia); }) return Model::ambient(s, Ia);
  else return s.ka * Ia;
}

/// The colour that the surface point s sends to where the ray came from.
///   Ia        the ambient light, already divided by R where the scene asks for it
///   arriving  l -> Arriving<F, C>: light l at this point, after attenuation and shadow
///   observe   (term, light, colour): called once for each summand, in the order of the sum; not for lights
///   of
///             which nothing arrives
template <class Model, class F, class C, class Lights, class Observer = NoObserver>
C illuminate(const Surface<F, C>& s, const C& Ia, int lights, const Lights& arriving,
             const Observer& observe = {}) {
  C I = ambient_term<Model>(s, Ia);  // Ka Ia
  observe(Term::ambient, -1, I);
  for (int l = 0; l < lights; ++l) {
    const Arriving<F, C> light = arriving(l);
    if (all(is_black(light.I))) continue;  // behind the surface, in shadow or out of reach: nothing to add
    const Terms<C> term = Model::evaluate(s, light);
    observe(Term::diffuse, l, term.diffuse);
    observe(Term::specular, l, term.specular);
    I = I + term.diffuse;
    I = I + term.specular;
  }
  return I;
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
