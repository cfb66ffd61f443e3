#pragma once
// How surfaces scatter light: the choice of the kind. surface.h has the contract, and one file each the
// kinds.
//
// A kind's class answers several questions about one point with what it worked out once; the functions below
// answer a single one.

#include "scattering/glass.h"
#include "scattering/lecture.h"
#include "scattering/metal.h"
#include "scattering/metallic_roughness.h"
#include "scattering/surface.h"

namespace lambent {
inline namespace LAMBENT_ISA {

template <ScatterKind kind, class F, class C> struct ScatteringOfKind;
template <class F, class C> struct ScatteringOfKind<ScatterKind::lecture_phong, F, C> {
  using type = LectureScattering<LectureLobe::phong, F, C>;
};
template <class F, class C> struct ScatteringOfKind<ScatterKind::lecture_blinn, F, C> {
  using type = LectureScattering<LectureLobe::blinn_phong, F, C>;
};
template <class F, class C> struct ScatteringOfKind<ScatterKind::metallic_roughness, F, C> {
  using type = MetallicRoughnessScattering<F, C>;
};
template <class F, class C> struct ScatteringOfKind<ScatterKind::metal, F, C> {
  using type = MetalScattering<F, C>;
};
template <class F, class C> struct ScatteringOfKind<ScatterKind::glass, F, C> {
  using type = GlassScattering<F, C>;
};
/// A surface point ready to answer. It refers to the ScatterSurface, which must outlive it.
template <ScatterKind kind, class F, class C> using Scattering = typename ScatteringOfKind<kind, F, C>::type;

template <ScatterKind kind, class F, class C>
Evaluated<F, C> evaluate(const ScatterSurface<F, C>& s, const Vec3<F>& L) {
  return Scattering<kind, F, C>(s).evaluate(L);
}
template <ScatterKind kind, class F, class C>
Scattered<F, C> scatter(const ScatterSurface<F, C>& s, const F& u, const F& v, const F& w) {
  return Scattering<kind, F, C>(s).scatter(u, v, w);
}
/// About what share of light from everywhere leaves along V: what a denoiser wants for albedo. 0 to 1.
template <ScatterKind kind, class F, class C> C albedo_for_denoiser(const ScatterSurface<F, C>& s) {
  return Scattering<kind, F, C>(s).albedo();
}
/// Where light samples are useless: evaluate() is black for every direction.
template <ScatterKind kind, class F, class C> MaskOf<F> only_perfect(const ScatterSurface<F, C>& s) {
  return Scattering<kind, F, C>(s).only_perfect();
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
