#pragma once
// The contract of an illumination model.
//
// A model is handed one surface point and one light that reaches it, and returns what that light contributes,
// in two terms. It knows no scene, no shadow, no attenuation and no random number: all that has been decided
// before it is called. A model is a struct with
//
//   static constexpr ModelInfo info          its manual page
//   template <class F, class C>
//   static Terms<C> evaluate(const Surface<F, C>&, const Arriving<F, C>&)
//
// and, where its ambient term is another than Ka Ia,
//
//   template <class F, class C> static C ambient(const Surface<F, C>&, const C& Ia)
//
// F is the number: double, float, a packet of either, a dual number. C is the colour, Color<F, channels>.
// A new model is a new file in models/, a line in models.def, and a test of its own.

#include <cstddef>

#include "illumination/attenuation.h"
#include "math/color.h"
#include "math/functions.h"
#include "math/vec.h"

namespace lambent {

/// A number of its own that a model reads from the material, beside the common ones.
struct ModelParameter {
  const char* name;
  double default_value;
  double min, max;
  const char* unit;
  const char* sentence;
  bool whole = false;  ///< Whether only whole numbers make sense.
};
inline constexpr int max_model_parameters = 4;

/// A model's manual page: what `lambent list` and the manual say, and its defaults.
struct ModelInfo {
  const char* name;
  const char* title;         ///< One line.
  const char* equation;      ///< The contribution of one light, in the letters of docs/lecture.md.
  const char* source;        ///< Where it comes from.
  const char* differs = "";  ///< How its convention differs from the lecture's; one paragraph.
  Attenuation attenuation = attenuation_none;  ///< Of the lights, where the scene does not say.
  AmbientAttenuation ambient_attenuation = AmbientAttenuation::none;  ///< Likewise, of the ambient term.
  bool unfaded_light =
      false;  ///< Whether it reads Arriving::Il and Arriving::faded, which are not made for others.
  bool half_vector =
      false;  ///< Whether its highlight is by N.H; path tracing takes Blinn's lobe then, else Phong's.
  bool measured = false;  ///< Whether it reads Surface::eta and Surface::k, likewise.
  ModelParameter parameters[max_model_parameters] = {};  ///< Ends with the first that has no name.
};

/// One point of a surface, as the eye ray (or a reflected one) found it.
template <class F, class C> struct Surface {
  Vec3<F> N;                    ///< Unit normal, on the side that V is on.
  Vec3<F> V;                    ///< Unit vector from the point to where the ray came from.
  C ka, kd, ks;                 ///< The material's ambient, diffuse and specular coefficients.
  F n;                          ///< Its shininess.
  F own[max_model_parameters];  ///< The model's own parameters, in the order of its table.
  F outside = F(1);             ///< 1 where V is on the outside of the surface, -1 on its inside.
  Vec3<F> to_camera{};  ///< Unit vector against the camera's view: to a viewer infinitely far behind it.
  /// Where the model's info asks: the complex index of refraction eta + i k of what lies behind the surface
  /// over that on V's side, for each channel.
  C eta = grey<F, int(sizeof(C) / sizeof(F))>(F(1.5)), k = grey<F, int(sizeof(C) / sizeof(F))>(F(0));
};

/// One light, as it arrives at that point.
template <class F, class C> struct Arriving {
  Vec3<F> L;       ///< Unit vector from the point to the light.
  C I;             ///< Il after attenuation; black where the light is blocked.
  C Il{};          ///< Where the model's info asks: the light's colour in its brightest direction, and
  F faded = F(1);  ///< what distance and the light's cone leave of it, shadows aside.
};

/// What one light contributes, the cosine included.
template <class C> struct Terms { C diffuse, specular; };

}  // namespace lambent
