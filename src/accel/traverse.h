#pragma once
// Ray queries: the closest hit, and whether anything stands in the way; for one ray or for a packet.
//
// The answer is a property of the scene and the ray alone, never of the tree, of the order of the visit, or
// of the rays beside it in a packet: of all primitives that the ray meets the nearest wins, and at equal
// distance the one with the lowest number. That holds because no box may be passed over that holds a hit.
// Boxes are tested against a ray whose origin is known only up to a margin of 2^-20 (|o| + extent): sixteen
// times the rounding of the tests of intersect.h, which see coordinates relative to the origin, (|o| +
// extent) at the most, each off by a few units of 2^-24.

#include "accel/intersect.h"

namespace lambent {

/// Which primitive was hit. Numbers are compared in the order instance, geometry, primitive.
template <class I> struct HitIds {
  I instance, geometry, primitive;  ///< instance -1: none, the geometry stands in the world itself.
};

inline namespace LAMBENT_ISA {

template <class F> struct IntOf { using type = std::int32_t; };
template <int W> struct IntOf<Pack<float, W>> { using type = Pack<std::int32_t, W>; };

/// The closest hit so far: t is the ray's far end before there is one; geometry is -1 then.
template <class F> struct Closest {
  using I = typename IntOf<F>::type;
  F t;
  HitIds<I> ids{I(-1), I(-1), I(-1)};
};

/// The ray as the boxes see it.
template <class F> struct BoxRay {
  Vec3<F> o_low, o_high, inverse_d;
  BoxRay(const QueryRay<F>& ray, float extent) {
    const F margin = F(0x1p-20f) * (max_abs(ray.o) + F(extent));
    const Vec3<F> m{margin, margin, margin};
    o_low = ray.o + m;  // lower sides of boxes are seen from here: nearer to them, or further behind
    o_high = ray.o - m;
    inverse_d = {invert(ray.d.x), invert(ray.d.y), invert(ray.d.z)};
  }
  /// 1 / d, but finite: a ray that does not move along an axis is inside the slab (t from -large to large) or
  /// beside it.
  static F invert(F d) {
    const F tiny(1e-30f);
    const F away_from_zero = select(abs(d) < tiny, select(d < F(0.f), -tiny, tiny), d);
    return F(1.f) / away_from_zero;
  }
  MaskOf<F> meets(const BvhNode& node, F t_far) const {
    const Vec3<F> a = multiply(spread<F>(node.lower) - o_low), b = multiply(spread<F>(node.upper) - o_high);
    const F near = max(max(min(a.x, b.x), min(a.y, b.y)), max(min(a.z, b.z), F(0.f)));
    const F far = min(min(max(a.x, b.x), max(a.y, b.y)), min(max(a.z, b.z), t_far));
    return near <= far;
  }
  Vec3<F> multiply(const Vec3<F>& v) const {
    return {v.x * inverse_d.x, v.y * inverse_d.y, v.z * inverse_d.z};
  }
};

/// Visits the leaves of a tree that the rays meet before t_far, roughly near to far; `leaf(ref)` may shorten
/// t_far and clear lanes of `active`.
template <class F, class Leaf>
void traverse(const WorldView& world, const Bvh& bvh, const QueryRay<F>& ray, const F& t_far,
              const MaskOf<F>& active, const Leaf& leaf) {
  if (bvh.empty) return;
  const BoxRay<F> box_ray(ray, bvh.extent);
  // Near children first: judged by one lane, as it is only a matter of speed.
  int leader = 0;
  while (leader + 1 < lanes_of<F> && !lane(active, leader)) ++leader;
  const float dx = lane(ray.d.x, leader), dy = lane(ray.d.y, leader), dz = lane(ray.d.z, leader);

  std::uint32_t stack[128];  // the builder's trees are at most 64 deep
  int size = 0;
  stack[size++] = bvh.root;
  while (size > 0) {
    const BvhNode& node = world.nodes[stack[--size]];
    if (!any(both(active, box_ray.meets(node, t_far)))) continue;
    if (node.count > 0) {
      for (std::uint32_t i = 0; i < node.count; ++i) leaf(world.refs[node.first + i]);
      if (!any(active)) return;
      continue;
    }
    const BvhNode &a = world.nodes[node.first], &b = world.nodes[node.first + 1];
    const float along = dx * ((b.lower.x + b.upper.x) - (a.lower.x + a.upper.x)) +
                        dy * ((b.lower.y + b.upper.y) - (a.lower.y + a.upper.y)) +
                        dz * ((b.lower.z + b.upper.z) - (a.lower.z + a.upper.z));
    const bool a_first = along >= 0;
    stack[size++] = node.first + (a_first ? 1 : 0);
    stack[size++] = node.first + (a_first ? 0 : 1);
  }
}

/// Takes the ray into the space of an instance. In double, so that no more than one rounding is added.
template <class F> QueryRay<F> enter(const Instance& instance, const QueryRay<F>& ray) {
  Vec3<F> local_o, local_d;
  for (int i = 0; i < lanes_of<F>; ++i) {
    const Vec3<double> o =
        transform_point(instance.object_from_world, {lane(ray.o.x, i), lane(ray.o.y, i), lane(ray.o.z, i)});
    const Vec3<double> d =
        transform_vector(instance.object_from_world, {lane(ray.d.x, i), lane(ray.d.y, i), lane(ray.d.z, i)});
    set_lane(local_o.x, i, float(o.x)), set_lane(local_o.y, i, float(o.y)),
        set_lane(local_o.z, i, float(o.z));
    set_lane(local_d.x, i, float(d.x)), set_lane(local_d.y, i, float(d.y)),
        set_lane(local_d.z, i, float(d.z));
  }
  return {local_o, local_d};
}

/// Calls see(instance, ref, ray) for every primitive that may be met, with the ray in the primitive's space.
template <class F, class See>
void visit_primitives(const WorldView& world, const QueryRay<F>& ray, const F& t_far, const MaskOf<F>& active,
                      const See& see) {
  for (std::uint32_t i = 0; i < world.plane_count; ++i) see(-1, world.planes[i], ray);
  traverse(world, world.bvhs[0], ray, t_far, active, [&](const PrimitiveRef& ref) {
    if (ref.geometry != instance_geometry) return see(-1, ref, ray);
    const Instance& instance = world.instances[ref.primitive];
    const QueryRay<F> inside =
        enter(instance, ray);  // t keeps its meaning: the direction is not normalised again
    traverse(world, world.bvhs[instance.bvh], inside, t_far, active,
             [&](const PrimitiveRef& inner) { see(ref.primitive, inner, inside); });
  });
}

/// The closest hit before hit.t, in every active lane.
template <class F>
void find_closest(const WorldView& world, const QueryRay<F>& ray, MaskOf<F> active, Closest<F>& hit) {
  using I = typename Closest<F>::I;
  visit_primitives(
      world, ray, hit.t, active,
      [&](std::int32_t instance, const PrimitiveRef& ref, const QueryRay<F>& local) {
        const Meeting<F> m = meet(world.geometries[ref.geometry], ref.primitive, local);
        const I in(instance), ge(ref.geometry), pr(ref.primitive);
        const MaskOf<F> lower_number =
            either(in < hit.ids.instance,
                   both(in == hit.ids.instance,
                        either(ge < hit.ids.geometry, both(ge == hit.ids.geometry, pr < hit.ids.primitive))));
        const MaskOf<F> better = both(
            active, m.hit, either(m.t < hit.t, both(m.t == hit.t, lower_number, hit.ids.geometry >= I(0))));
        hit.t = select(better, m.t, hit.t);
        hit.ids.instance = select(better, in, hit.ids.instance);
        hit.ids.geometry = select(better, ge, hit.ids.geometry);
        hit.ids.primitive = select(better, pr, hit.ids.primitive);
      });
}

/// The scene's material of a primitive.
inline std::uint32_t material_of(const WorldView& world, std::int32_t instance, std::int32_t geometry,
                                 std::int32_t primitive) {
  const Geometry& g = world.geometries[geometry];
  const std::uint32_t object = instance >= 0 ? world.instances[instance].object : g.object;
  return world.objects[object].materials[g.material_of_primitive ? g.material_of_primitive[primitive] : 0];
}

/// Where something opaque stands in the way before t_far. With `all_opaque`, everything counts as opaque.
template <class F>
MaskOf<F> find_occluded(const WorldView& world, const QueryRay<F>& ray, MaskOf<F> active, F t_far,
                        bool all_opaque) {
  MaskOf<F> occluded(false);
  visit_primitives(world, ray, t_far, active,
                   [&](std::int32_t instance, const PrimitiveRef& ref, const QueryRay<F>& local) {
                     const Meeting<F> m = meet(world.geometries[ref.geometry], ref.primitive, local);
                     const MaskOf<F> blocked = both(active, m.hit, m.t < t_far);
                     if (!any(blocked)) return;
                     if (!all_opaque &&
                         world.material_transmits[material_of(world, instance, ref.geometry, ref.primitive)])
                       return;
                     occluded = either(occluded, blocked);
                     active = both(active, MaskOf<F>(!blocked));
                   });
  return occluded;
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
