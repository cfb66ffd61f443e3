#pragma once
// Directions that lie around others: by lobes, mirrored, refracted.

#include "math/color.h"
#include "math/directions.h"

namespace lambent {
inline namespace LAMBENT_ISA {

inline constexpr double one_over_pi = 0.31830988618379067154;

/// The unit vector with that cosine to axes.z, u of a turn around it.
template <class F> Vec3<F> direction_around(const Axes<F>& axes, const F& cosine, const F& u) {
  const F sine = sqrt(max((F(1) - cosine) * (F(1) + cosine), F(0)));
  const SinCos<F> turn = sincos_degrees(F(360) * u);
  return to_world(axes, {sine * turn.cos, sine * turn.sin, cosine});
}
/// Cosine of a direction with density cosine / pi.
template <class F> F lambert_cosine(const F& v) { return sqrt(F(1) - v); }
/// Cosine c of a direction with density (n + 1) / (2 pi) c^n.
template <class F> F power_cosine(const F& v, const F& n) { return pow(F(1) - v, F(1) / (n + F(1))); }

/// About the half-angle, in radians, of the cone that one of several such directions stands for: its solid
/// angle is 1 / density, but none is wider than one radian, which is Lambert's at its densest.
template <class F> F spread_of(const F& density) { return sqrt(F(1) / max(F(pi) * density, F(1))); }

/// The shading normal, or the geometric one where the ray came from behind the shading normal.
template <class F> Vec3<F> facing_normal(const Vec3<F>& N, const Vec3<F>& G, const Vec3<F>& V) {
  return select(dot(N, V) > F(0), N, G);
}
/// V mirrored about N, or about G where the shading normal would send it into the surface.
template <class F> Vec3<F> mirror_direction(const Vec3<F>& N, const Vec3<F>& G, const Vec3<F>& V) {
  const Vec3<F> mirrored = reflect(V, N);
  return select(dot(mirrored, G) > F(0), mirrored, reflect(V, G));
}

template <class F> struct Refracted {
  Vec3<F> L;         ///< Unit vector; where light passes.
  MaskOf<F> passes;  ///< False: it is reflected totally.
};
/// Snell: sin(theta') = sin(theta) / eta, eta the index beyond the surface over that on V's side. About the
/// shading normal, or about the geometric one where the shading normal would bend the ray back out.
template <class F>
Refracted<F> refract_direction(const Vec3<F>& N, const Vec3<F>& G, const Vec3<F>& V, const F& eta) {
  const F bend = F(1) / eta;
  const auto about = [&](const Vec3<F>& n, MaskOf<F>& possible) {
    const F cosine = dot(n, V), k = F(1) - bend * bend * (F(1) - cosine * cosine);
    possible = k >= F(0);
    return (bend * cosine - sqrt(max(k, F(0)))) * n - bend * V;
  };
  MaskOf<F> by_N, by_G;
  const Vec3<F> along = about(N, by_N), along_G = about(G, by_G);
  const auto through_N = both(by_N, dot(along, G) < F(0));
  const auto through_G = both(by_N, by_G, dot(along_G, G) < F(0));
  const Vec3<F> L = select(through_N, along, along_G);
  const auto passes = either(through_N, through_G);
  return {normalize(select(passes, L, -V)), passes};
}

template <class C> inline constexpr int channels_of = 0;
template <class F, int N> inline constexpr int channels_of<Color<F, N>> = N;

template <class F, int N> F mean(const Color<F, N>& c) {
  F sum = c[0];
  for (int i = 1; i < N; ++i) sum = sum + c[i];
  return F(1.0 / N) * sum;
}
template <class F, int N> F largest(const Color<F, N>& c) {
  F most = c[0];
  for (int i = 1; i < N; ++i) most = max(most, c[i]);
  return most;
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
