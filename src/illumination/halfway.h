#pragma once
// The half-vector of light and eye, which several conventions measure their highlight by.

#include "math/vec.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// N.H with H = (L + V) / |L + V|; 0 where L = -V, which leaves no halfway.
template <class F> F cosine_to_halfway(const Vec3<F>& N, const Vec3<F>& L, const Vec3<F>& V) {
  const Vec3<F> sum = L + V;
  const F square = dot(sum, sum);
  return select(square > F(0), dot(N, sum) / sqrt(square), F(0));
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
