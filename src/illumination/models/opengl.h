#pragma once
// opengl: the lighting of OpenGL's fixed function, at each point instead of at each vertex.

#include "illumination/halfway.h"
#include "illumination/model.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// With two_sided 0 the normal is the outside's, wherever V is.
struct OpenGl {
  static constexpr ModelInfo info{
      .name = "opengl",
      .title = "OpenGL's fixed-function lighting, at every point",
      .equation = "att Il [ Kd (N.L)+ + Ks ((N.H)+)^n ],  H = (L + E) / |L + E|",
      .source = "Segal and Akeley, The OpenGL Graphics System, version 2.1, section 2.14.1, 2006",
      .differs =
          "Light fades with 1/(kc + kl r + kq r^2), which is 1 by default; give an attenuation {constant, "
          "linear, "
          "quadratic} to set it. The ambient term does not fade; OpenGL's own default for Ia is 0.2, the "
          "scene's is as "
          "the scene says. The highlight is Blinn's, but E is V only with local_viewer 1: by default it is "
          "the direction "
          "against the camera's view, the same at every point. With two_sided 0 the normal is the outside's "
          "even where "
          "the inside is seen: there a light on the viewer's side gives nothing, and one on the other side "
          "is hidden by "
          "the surface itself, where OpenGL, which knows no shadows, would show it. A light's own ambient "
          "colour is 0 "
          "here, and nothing is clamped to [0, 1]. Every point is lit, where OpenGL lights vertices and "
          "blends between "
          "them.",
      .half_vector = true,
      .parameters = {{"local_viewer", 0, 0, 1, "",
                      "1: the highlight is seen from the eye; 0: from infinitely far.", true},
                     {"two_sided", 0, 0, 1, "",
                      "1: the inside is lit as the outside; 0: by the outside's normal.", true}},
  };
  template <class F, class C> static Terms<C> evaluate(const Surface<F, C>& s, const Arriving<F, C>& light) {
    const auto local = s.own[0] > F(0), two_sided = s.own[1] > F(0);
    const Vec3<F> N = select(two_sided, F(1), s.outside) * s.N;
    const Vec3<F> E = select(local, s.V, s.to_camera);
    const F nl = dot(N, light.L);
    const F highlight = pow(max(cosine_to_halfway(N, light.L, E), F(0)), s.n);
    return {max(nl, F(0)) * (s.kd * light.I), select(nl > F(0), highlight, F(0)) * (s.ks * light.I)};
  }
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
