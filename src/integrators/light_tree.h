#pragma once
// Choosing one of many lights by what it may bring: a tree over the lights, each node with a bound of where
// they are, where they shine and how much (Conty Estevez and Kulla, Importance sampling of many lights with
// adaptive tree splitting, Proc. ACM Computer Graphics and Interactive Techniques 1(2), 2018).
//
// At a point P with the normal N a node's importance is
//
//   intensity * cos theta' * cos i' * fading(d)
//
// where d is the distance of the node's centre, theta the angle at which its lights leave towards P and i the
// angle to N, each less (theta', i') by what the lights may deviate: the angle under which the node is seen
// from P, and for theta the spread of the lights' axes. It is zero only where none of the lights can bring
// anything. Near or in a node d is at least half the radius of the ball around it: over a ball the mean of
// 1 / d^2, seen from its middle, is 3 / radius^2.

#include <cstdint>

#include "illumination/attenuation.h"
#include "math/functions.h"
#include "math/vec.h"

namespace lambent {

/// Some lights, or one: a leaf.
struct LightNode {
  float center[3], half[3];  ///< A box around them: its middle, and half its sides.
  float axis[3];             ///< They face about there,
  float cos_spread;          ///< within this angle of the axis, -1: anywhere;
  float cos_reach;           ///< and shine up to that angle from where they face.
  float intensity;       ///< The sum over them of radiance times area, on the axis: a point light's pi Il.
  std::int32_t child;    ///< The first of two that stand side by side; -1: a leaf.
  std::int32_t emitter;  ///< Of a leaf.
  bool two_sided;        ///< Whether some shine backwards as they do forwards.
};
static_assert(sizeof(LightNode) == 60);

/// The most levels of a tree: a leaf's path is one bit for each.
inline constexpr int max_light_depth = 64;

inline namespace LAMBENT_ISA {

namespace detail {

/// By how much a node's numbers, which are floats, may be off: ten times float's rounding.
inline constexpr double light_margin = 10 * 0x1p-24;

inline double sine_of(double cosine) { return sqrt(max(1 - cosine * cosine, 0.0)); }
/// The cosine of a - b, or 1 where that is negative; a and b by their cosines.
inline double cosine_of_difference(double a, double b) {
  return a > b ? 1.0 : a * b + sine_of(a) * sine_of(b);
}

}  // namespace detail

/// Zero: none of its lights lights P. N zero: light counts from wherever it comes.
///   fading   how their light fades; below `minimum` it fades no more
inline double importance(const LightNode& node, const Vec3<double>& P, const Vec3<double>& N,
                         const Attenuation& fading, double minimum) {
  const Vec3<double> way = Vec3<double>{node.center[0], node.center[1], node.center[2]} - P;
  const Vec3<double> half{node.half[0], node.half[1], node.half[2]};
  const double d = length(way), radius = length(half);
  const bool around = !(d > radius);  // P lies within
  const Vec3<double> w = d > 0 ? way / d : Vec3<double>{};
  const double sine = around ? 0.0 : radius / d, cosine = around ? -1.0 : sqrt(1 - sine * sine);
  double leaving = -dot(w, Vec3<double>{node.axis[0], node.axis[1], node.axis[2]});
  if (node.two_sided) leaving = abs(leaving);
  leaving = detail::cosine_of_difference(detail::cosine_of_difference(leaving, node.cos_spread), cosine);
  if (leaving < node.cos_reach - detail::light_margin) return 0;
  double meeting = 1;
  if (dot(N, N) > 0) {
    // The corner of the box that lies highest over the surface.
    if (!(dot(N, way) + abs(N.x) * half.x + abs(N.y) * half.y + abs(N.z) * half.z > 0)) return 0;
    meeting = detail::cosine_of_difference(dot(N, w), cosine);
    if (!(meeting > 0)) return 0;
  }
  return node.intensity * max(leaving, detail::light_margin) * meeting *
         attenuate(fading, max(d, 0.5 * radius), minimum);
}

/// One light of a tree, and with which probability it has been chosen; -1: none lights P.
struct PickedLight {
  std::int32_t emitter;
  double probability;
};

namespace detail {

inline constexpr double below_one = 0x1.fffffffffffffp-1;

/// The probability with which the first child of a node is taken; negative: neither lights P.
inline double first_share(const LightNode* nodes, const LightNode& node, const Vec3<double>& P,
                          const Vec3<double>& N, const Attenuation& fading, double minimum) {
  const double a = importance(nodes[node.child], P, N, fading, minimum),
               b = importance(nodes[node.child + 1], P, N, fading, minimum);
  return a + b > 0 ? a / (a + b) : -1;
}

}  // namespace detail

/// Chooses by `pick` in [0, 1).
inline PickedLight pick_light(const LightNode* nodes, std::int32_t root, const Vec3<double>& P,
                              const Vec3<double>& N, const Attenuation& fading, double minimum, double pick) {
  double probability = 1;
  const LightNode* node = &nodes[root];
  while (node->child >= 0) {
    const double first = detail::first_share(nodes, *node, P, N, fading, minimum);
    if (first < 0) return {-1, 0};
    if (pick < first) {
      pick = min(pick / first, detail::below_one);
      probability *= first;
      node = &nodes[node->child];
    } else {
      pick = min((pick - first) / (1 - first), detail::below_one);
      probability *= 1 - first;
      node = &nodes[node->child + 1];
    }
  }
  return {node->emitter, probability};
}

/// The probability with which pick_light chooses the leaf that lies along `path` from the root: its bits, the
/// lowest first, say where the second child is taken.
inline double pick_probability(const LightNode* nodes, std::int32_t root, std::uint64_t path,
                               const Vec3<double>& P, const Vec3<double>& N, const Attenuation& fading,
                               double minimum) {
  double probability = 1;
  const LightNode* node = &nodes[root];
  for (; node->child >= 0 && probability > 0; path >>= 1) {
    const double first = detail::first_share(nodes, *node, P, N, fading, minimum);
    if (first < 0) return 0;
    probability *= path & 1 ? 1 - first : first;
    node = &nodes[node->child + int(path & 1)];
  }
  return probability;
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
