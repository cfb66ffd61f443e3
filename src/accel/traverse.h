#pragma once
// Ray queries: the closest hit, and whether anything stands in the way; for one ray or for a packet.
//
// The answer is a property of the scene and the ray alone, never of the tree, of the order of the visit, or
// of the rays beside it in a packet: of all primitives that the ray meets the nearest wins, and at equal
// distance the one with the lowest number. That holds because no box may be passed over that holds a hit.
// Boxes are tested against a ray whose origin is known only up to a margin of 2^-20 (|o| + extent): sixteen
// times the rounding of the tests of intersect.h, which see coordinates relative to the origin, (|o| +
// extent) at the most, each off by a few units of 2^-24.

#include <utility>

#include "accel/intersect.h"
#include "math/gather.h"

namespace lambent {

/// Which primitive was hit. Numbers are compared in the order instance, geometry, primitive.
template <class I> struct HitIds {
  I instance, geometry, primitive;  ///< instance -1: none, the geometry stands in the world itself.
};

inline namespace LAMBENT_ISA {

/// The closest hit so far: t is the ray's far end before there is one; geometry is -1 then.
template <class F> struct Closest {
  using I = With<F, std::int32_t>;
  F t;
  HitIds<I> ids{I(-1), I(-1), I(-1)};
};

/// How many packets of rays go through a tree together, at most. Sixteen would save time where samples lie
/// close together, and cost some where a ray meets its own triangle.
inline constexpr int beam = 8;

/// The rays as the boxes see them. A box is met between its sides along x, y and z; from a side at p the ray
/// is (p - o) / d away, or p / d - o / d.
template <class F> struct BoxRay {
  Vec3<F> inverse_d;
  F margin;           ///< How far off the origin may be.
  Vec3<F> low, high;  ///< o / d, for lower and upper sides: seen from o moved outwards by the margin.

  BoxRay() = default;
  BoxRay(const QueryRay<F>& ray, float extent) : inverse_d(ray.inverse_d) {
    margin = F(0x1p-20f) * (max_abs(ray.o) + F(extent));
    low = {(ray.o.x + margin) * inverse_d.x, (ray.o.y + margin) * inverse_d.y,
           (ray.o.z + margin) * inverse_d.z};
    high = {(ray.o.x - margin) * inverse_d.x, (ray.o.y - margin) * inverse_d.y,
            (ray.o.z - margin) * inverse_d.z};
  }

  /// Whether the box is met before t_far; `side(row)` is a row of BvhNode::plane.
  template <class Side> MaskOf<F> meets(const Side& side, const F& t_far, F& near) const {
    const F ax = multiply_subtract_roughly(side(0), inverse_d.x, low.x),
            ay = multiply_subtract_roughly(side(1), inverse_d.y, low.y),
            az = multiply_subtract_roughly(side(2), inverse_d.z, low.z),
            bx = multiply_subtract_roughly(side(3), inverse_d.x, high.x),
            by = multiply_subtract_roughly(side(4), inverse_d.y, high.y),
            bz = multiply_subtract_roughly(side(5), inverse_d.z, high.z);
    near = max(max(min(ax, bx), min(ay, by)), max(min(az, bz), F(0.f)));
    return near <= min(min(max(ax, bx), max(ay, by)), min(max(az, bz), t_far));
  }
};

inline constexpr int max_stack = (bvh_width - 1) * max_tree_depth + bvh_width;
using NodeLanes = Pack<float, bvh_width>;

/// One ray, and all boxes of a node at once.
struct RayBeam {
  BoxRay<NodeLanes> ray;
  RayBeam(const QueryRay<float>& one, float extent) : ray(spread_lane<NodeLanes>(one, 0), extent) {}
  explicit RayBeam(const BoxRay<NodeLanes>& one) : ray(one) {}
  std::uint32_t meets(const BvhNode& node, float t_far, NodeLanes& near) const {
    const auto side = [&](int row) { return NodeLanes::load(node.plane[row]); };
    return lane_bits(ray.meets(side, NodeLanes(t_far), near)) & ((1u << node.children) - 1);
  }
};

/// Many rays that go the same way along each axis, as one: 1/d and the origins lie in intervals, and a box
/// that no ray of these intervals meets is met by none. With c a point nearby, a side at p is
///   (p - c) / d - (o - c) / d
/// away: linear in 1/d, so that the ends of the interval bound it.
struct PacketBeam {
  struct Axis {
    int nearer, farther;                               // rows of BvhNode::plane
    NodeLanes inverse_low, inverse_high;               // the interval of 1/d
    NodeLanes near_low, near_high, far_low, far_high;  // what to subtract from p / d at its ends
  } axes[3];

  /// Whether rays lie so close together that a beam of them is not much wider than each: within 5 degrees,
  /// and the origins within a sixteenth of the scene. A matter of speed alone.
  template <class F> static bool suits(const QueryRay<F>* rays, const F* t_far, int count, float extent) {
    const int first = __builtin_ctz(lane_bits(t_far[0] >= F(0.f)) | (1u << (lanes_of<F> - 1)));
    const Vec3<F> o = spread<F>(lane(rays[0].o, first)), d = spread<F>(lane(rays[0].d, first));
    const F limit = F(0.996f * 0.996f) * dot(d, d), reach(extent * extent / 256);
    MaskOf<F> apart(false);
    for (int i = 0; i < count; ++i) {
      const Vec3<F> between = rays[i].o - o;
      const F cosine = dot(rays[i].d, d);
      const MaskOf<F> close = both(cosine > F(0.f), cosine * cosine >= limit * dot(rays[i].d, rays[i].d),
                                   dot(between, between) <= reach);
      apart = either(apart, both(t_far[i] >= F(0.f), MaskOf<F>(!close)));
    }
    return !any(apart);
  }

  /// False where the rays do not all go the same way; then this is no beam.
  template <class F> bool set(const QueryRay<F>* rays, const BoxRay<F>* box_rays, const F* t_far, int count) {
    const F zero(0.f);
    for (int a = 0; a < 3; ++a) {
      const auto of = [a](const auto& v) { return a == 0 ? v.x : a == 1 ? v.y : v.z; };
      const F c(lane(of(rays[0].o), 0));
      const F large(0x1p126f);
      F low = large, high = -large, near = -large, far = large;
      for (int i = 0; i < count; ++i) {
        const F inverse = of(box_rays[i].inverse_d);
        const F o = of(rays[i].o) - c, margin = box_rays[i].margin;
        const F to_low = (o + margin) * inverse, to_high = (o - margin) * inverse;
        const MaskOf<F> active = t_far[i] >= zero;
        low = min(low, select(active, inverse, low));
        high = max(high, select(active, inverse, high));
        near = max(near, select(active, max(to_low, to_high), near));
        far = min(far, select(active, min(to_low, to_high), far));
      }
      const float inverse_low = least(low), inverse_high = greatest(high);
      if (!(inverse_low > 0) && !(inverse_high < 0)) return false;
      Axis& axis = axes[a];
      axis.nearer = inverse_low > 0 ? a : a + 3;
      axis.farther = inverse_low > 0 ? a + 3 : a;
      axis.inverse_low = inverse_low, axis.inverse_high = inverse_high;
      const float at = lane(c, 0), most = greatest(near), fewest = least(far);
      axis.near_low = at * inverse_low + most, axis.near_high = at * inverse_high + most;
      axis.far_low = at * inverse_low + fewest, axis.far_high = at * inverse_high + fewest;
    }
    return true;
  }

  std::uint32_t meets(const BvhNode& node, float t_far, NodeLanes& near) const {
    const auto nearest = [&](const Axis& a) {
      const NodeLanes side = NodeLanes::load(node.plane[a.nearer]);
      return min(multiply_subtract_roughly(side, a.inverse_low, a.near_low),
                 multiply_subtract_roughly(side, a.inverse_high, a.near_high));
    };
    const auto farthest = [&](const Axis& a) {
      const NodeLanes side = NodeLanes::load(node.plane[a.farther]);
      return max(multiply_subtract_roughly(side, a.inverse_low, a.far_low),
                 multiply_subtract_roughly(side, a.inverse_high, a.far_high));
    };
    near = max(max(nearest(axes[0]), nearest(axes[1])), max(nearest(axes[2]), NodeLanes(0.f)));
    const NodeLanes far =
        min(min(farthest(axes[0]), farthest(axes[1])), min(farthest(axes[2]), NodeLanes(t_far)));
    return lane_bits(near <= far) & ((1u << node.children) - 1);
  }
};

/// A node of a tree, or a leaf as a child of its node.
struct TreePlace {
  std::uint32_t node;
  int child;  ///< -1: the node itself.
};
inline TreePlace place_of(std::uint32_t number, const BvhNode& node, int i) {
  return node.count[i] > 0 ? TreePlace{number, i} : TreePlace{node.first[i], -1};
}
inline BvhChild child_of(const BvhNode& node, int i) { return {node.first[i], node.count[i], node.kind[i]}; }

/// The memory of a child that is put off: it is asked soon.
inline void send_for(const WorldView& world, const BvhNode& node, int i) {
  const std::uint32_t first = node.first[i];
  if (node.count[i] > 0) return __builtin_prefetch(world.refs + first);
  __builtin_prefetch(world.nodes + first);
  __builtin_prefetch(&world.nodes[first].first);  // its second half
}

/// Visits the leaves of a tree that a beam meets before t_far, roughly near to far; `leaf(child, node, i)`,
/// child i of that node, may shorten t_far.
template <class Beam, class Leaf>
void traverse(const WorldView& world, const Bvh& bvh, const Beam& beam, float& t_far, const Leaf& leaf) {
  struct Entry {
    float near;
    TreePlace at;
  } stack[max_stack];
  int size = 0;
  TreePlace at{bvh.root, -1};
  for (;;) {
    const BvhNode& node = world.nodes[at.node];
    if (at.child >= 0) {
      leaf(child_of(node, at.child), node, at.child);
    } else {
      NodeLanes near;
      std::uint32_t met = beam.meets(node, t_far, near);
      if (met) {  // On to the nearest; what else is met is put off.
        int nearest = __builtin_ctz(met);
        if (met &= met - 1) {
          float distance[bvh_width];
          near.store(distance);
          for (const int bottom = size; met; met &= met - 1) {
            const int i = __builtin_ctz(met);
            // A jump, and no arithmetic in its place: where it is guessed right the next node comes early.
            const bool is_nearer = distance[i] < distance[nearest];
            const int later = is_nearer ? nearest : i;
            nearest = is_nearer ? i : nearest;
            int place = size++;
            for (; place > bottom && stack[place - 1].near < distance[later]; --place)
              stack[place] = stack[place - 1];
            send_for(world, node, later);
            stack[place] = {distance[later], place_of(at.node, node, later)};
          }
        }
        at = place_of(at.node, node, nearest);
        continue;
      }
    }
    do {
      if (size == 0) return;
      --size;
    } while (!(stack[size].near <= t_far));
    at = stack[size].at;
  }
}

/// The rays of a packet that go different ways, as boxes see them: all together, or one of them alone.
template <class F> struct RaysApart {
  const BoxRay<F>& together;
  float numbers[9][lanes_of<F>];  ///< The same, laid out once: lanes are taken out of it at many nodes.

  explicit RaysApart(const BoxRay<F>& rays) : together(rays) {
    const auto lay_out = [&](const Vec3<F>& v, int first) {
      v.x.store(numbers[first]), v.y.store(numbers[first + 1]), v.z.store(numbers[first + 2]);
    };
    lay_out(rays.inverse_d, 0), lay_out(rays.low, 3), lay_out(rays.high, 6);
  }
  RayBeam alone(int k) const {
    const auto three = [&](int first) {
      return Vec3<NodeLanes>{numbers[first][k], numbers[first + 1][k], numbers[first + 2][k]};
    };
    BoxRay<NodeLanes> ray;
    ray.inverse_d = three(0), ray.low = three(3), ray.high = three(6);
    return RayBeam(ray);
  }
  /// Calls visit(i, near, met) for each child i of a node that some of `lanes` meet before t_far: met are
  /// those that do. Where there is but one, all boxes at once.
  template <class Visit>
  void each_met(const BvhNode& node, std::uint32_t lanes, const F& t_far, const Visit& visit) const {
    if ((lanes & (lanes - 1)) == 0) {
      const int k = __builtin_ctz(lanes);
      NodeLanes near;
      std::uint32_t met = alone(k).meets(node, lane(t_far, k), near);
      float distance[bvh_width];
      near.store(distance);
      for (; met; met &= met - 1) visit(__builtin_ctz(met), F(distance[__builtin_ctz(met)]), lanes);
      return;
    }
    for (int i = 0; i < int(node.children); ++i) {
      F near;
      const MaskOf<F> meets = together.meets([&](int row) { return F(node.plane[row][i]); }, t_far, near);
      if (const std::uint32_t met = lane_bits(meets)) visit(i, select(meets, near, F(__builtin_inff())), met);
    }
  }
};

/// The same for those `lanes` of one packet, whose rays go different ways: `leaf(child, lanes)`, with a bit
/// for each ray that comes to it, may shorten t_far. A ray alone waits at each node for the answer that says
/// where to go on; a packet, even one of rays that soon part, waits once for all of them.
template <class F, class Leaf>
void traverse_apart(const WorldView& world, const Bvh& bvh, const RaysApart<F>& rays, std::uint32_t lanes,
                    const F& t_far, const Leaf& leaf) {
  struct Entry {
    F near;
    TreePlace at;
    std::uint32_t lanes;  // that meet it
  } stack[max_stack];
  int size = 0;
  TreePlace at{bvh.root, -1};
  while (lanes) {
    const BvhNode& node = world.nodes[at.node];
    if (at.child >= 0) {
      leaf(child_of(node, at.child), lanes);
    } else {
      int nearest = -1;
      F least;  // how near it is
      rays.each_met(node, lanes, t_far, [&](int i, F near, std::uint32_t met) {
        if (nearest < 0) {
          nearest = i, least = near, lanes = met;
          return;
        }
        if (any(near < least)) std::swap(near, least), std::swap(i, nearest), std::swap(met, lanes);
        send_for(world, node, i);
        stack[size++] = {near, place_of(at.node, node, i), met};
      });
      if (nearest >= 0) {
        at = place_of(at.node, node, nearest);
        continue;
      }
    }
    for (lanes = 0; lanes == 0 && size > 0;) {
      --size;
      lanes = lane_bits(stack[size].near <= t_far) & stack[size].lanes;
      at = stack[size].at;
    }
  }
}

/// The rays that come to a leaf.
struct Comers {
  std::uint32_t packets;  ///< A bit for each packet of which some ray comes.
  std::uint32_t lanes;    ///< Of a packet that goes by itself, a bit for each ray that comes; else all.
};

/// Sends packets through a tree as one beam. False where they do not lie close together.
template <class F, class Leaf>
bool traverse_together(const WorldView& world, const Bvh& bvh, const QueryRay<F>* rays,
                       const BoxRay<F>* box_rays, const F* t_far, int count, const Leaf& leaf) {
  const auto farthest = [&] {
    F most = t_far[0];
    for (int i = 1; i < count; ++i) most = max(most, t_far[i]);
    return greatest(most);
  };
  float beam_far = farthest();
  if (beam_far < 0) return true;
  PacketBeam beam;
  if (!PacketBeam::suits(rays, t_far, count, bvh.extent) || !beam.set(rays, box_rays, t_far, count))
    return false;
  traverse(world, bvh, beam, beam_far, [&](const BvhChild& child, const BvhNode& node, int c) {
    std::uint32_t packets = 0;
    for (int i = 0; i < count; ++i) {
      F near;
      if (any(box_rays[i].meets([&](int row) { return F(node.plane[row][c]); }, t_far[i], near)))
        packets |= 1u << i;
    }
    if (!packets) return;
    leaf(child, Comers{packets, all_lane_bits<lanes_of<F>>});
    beam_far = farthest();
  });
  return true;
}

/// Sends packets of rays through a tree: `leaf(child, comers)` for each leaf that rays of packet i may meet
/// before t_far[i], which it may shorten. A lane with t_far < 0 does not count.
template <class F, class Leaf>
void traverse_packets(const WorldView& world, const Bvh& bvh, const QueryRay<F>* rays, F* t_far, int count,
                      const Leaf& leaf) {
  if (bvh.empty) return;
  if constexpr (lanes_of<F> == 1) {
    if (t_far[0] < 0) return;
    const auto ask = [&](const BvhChild& child, const BvhNode&, int) { leaf(child, Comers{1, 1}); };
    traverse(world, bvh, RayBeam(rays[0], bvh.extent), t_far[0], ask);
  } else {
    BoxRay<F> box_rays[beam];
    for (int i = 0; i < count; ++i) box_rays[i] = BoxRay<F>(rays[i], bvh.extent);
    if (count > 1 && traverse_together(world, bvh, rays, box_rays, t_far, count, leaf)) return;
    for (int i = 0; i < count; ++i) {
      // Of the packets that enter an instance many pass by it.
      const auto side = [&](int row) {
        const Vec3<float>& corner = row < 3 ? bvh.lower : bvh.upper;
        return F(row % 3 == 0 ? corner.x : row % 3 == 1 ? corner.y : corner.z);
      };
      F near;
      const std::uint32_t inside = lane_bits(box_rays[i].meets(side, t_far[i], near));
      if (inside == 0) continue;
      const auto ask = [&](const BvhChild& child, std::uint32_t lanes) {
        leaf(child, Comers{1u << i, lanes});
      };
      traverse_apart(world, bvh, RaysApart<F>(box_rays[i]), inside, t_far[i], ask);
    }
  }
}

/// Takes the ray into the space of an instance. In double, so that no more than one rounding is added.
template <class F> QueryRay<F> enter(const Instance& instance, const QueryRay<F>& ray) {
  using D = With<F, double>;
  const auto object_from_world =
      gather_transform<D>([&](int) -> const Transform& { return instance.object_from_world; });
  return {number_cast<float>(transform_point(object_from_world, number_cast<double>(ray.o))),
          number_cast<float>(transform_vector(object_from_world, number_cast<double>(ray.d)))};
}

/// Asks a primitive with those packets of rays whose bits are set: see(i, instance, ref, meeting) where some
/// ray of packet i meets it, as meet(ray) says.
template <class F, class Meet, class See>
void ask(const PrimitiveRef& ref, std::int32_t instance, const QueryRay<F>* rays, std::uint32_t packets,
         const Meet& meet, const See& see) {
  for (; packets; packets &= packets - 1) {
    const int i = __builtin_ctz(packets);
    const Meeting<F> m = meet(rays[i]);
    if (any(m.hit)) see(i, instance, ref, m);
  }
}
/// A primitive of any kind.
template <class F, class See>
void ask_primitive(const WorldView& world, const PrimitiveRef& ref, std::int32_t instance,
                   const QueryRay<F>* rays, std::uint32_t packets, const See& see) {
  const Geometry& g = world.geometries[ref.geometry];
  const auto meet_it = [&](const QueryRay<F>& ray) { return meet(g, ref.primitive, ray); };
  ask(ref, instance, rays, packets, meet_it, see);
}

/// Triangles of one geometry: much of the time goes by here.
template <class F, class See>
[[gnu::noinline]] LAMBENT_FLATTEN void ask_triangles(const WorldView& world, const BvhChild& leaf,
                                                     std::int32_t instance, const QueryRay<F>* rays,
                                                     std::uint32_t packets, const See& see) {
  const PrimitiveRef* refs = world.refs + leaf.first;
  const Geometry& g = world.geometries[refs[0].geometry];
  for (std::uint32_t i = 0; i < leaf.count; ++i) {
    const std::uint32_t* v = corners(g, refs[i].primitive);
    const Vec3<F> p0 = spread<F>(g.vertices[v[0]]), p1 = spread<F>(g.vertices[v[1]]),
                  p2 = spread<F>(g.vertices[v[2]]);
    std::uint32_t met = packets;
    if (packets & (packets - 1)) {
      // First which of them may meet it at all: a jump that nobody can guess costs more than to ask twice.
      met = 0;
      for (std::uint32_t left = packets; left; left &= left - 1) {
        const int k = __builtin_ctz(left);
        met |= std::uint32_t(may_meet_triangle(rays[k], p0, p1, p2)) << k;
      }
    }
    const auto meet = [&](const QueryRay<F>& ray) { return meet_triangle(ray, p0, p1, p2); };
    ask(refs[i], instance, rays, met, meet, see);
  }
}

template <class F, class See>
[[gnu::noinline]] LAMBENT_FLATTEN void ask_spheres(const WorldView& world, const BvhChild& leaf,
                                                   std::int32_t instance, const QueryRay<F>* rays,
                                                   std::uint32_t packets, const See& see) {
  for (std::uint32_t i = 0; i < leaf.count; ++i) {
    const LeafSphere& s = world.leaf_spheres[leaf.first + i];
    const Vec3<F> center{F(s.x), F(s.y), F(s.z)};
    const auto meet = [&](const QueryRay<F>& ray) { return meet_sphere(ray, center, F(s.radius)); };
    ask(world.refs[leaf.first + i], instance, rays, packets, meet, see);
  }
}

/// The same for few rays: several primitives at a time, a lane for each, with one ray after the other.
/// load(of_lane) brings the primitives that stand at of_lane(0), of_lane(1) ... in the leaf into lanes,
/// meet(primitives, ray) is where a ray meets them. In lanes that are left over stands the last.
template <int Width, class F, class Load, class Meet, class See>
void ask_side_by_side(const WorldView& world, const BvhChild& leaf, std::int32_t instance,
                      const QueryRay<F>* rays, const Comers& comers, const Load& load, const Meet& meet,
                      const See& see) {
  using Wide = Pack<float, Width>;
  const int i = __builtin_ctz(comers.packets);
  for (std::uint32_t first = 0; first < leaf.count; first += Width) {
    const std::uint32_t last = min(leaf.count - first, std::uint32_t(Width)) - 1;
    const auto primitives = load([&](int k) { return first + min(std::uint32_t(k), last); });
    for (std::uint32_t left = comers.lanes; left; left &= left - 1) {
      const int k = __builtin_ctz(left);
      const Meeting<Wide> m = meet(primitives, spread_lane<Wide>(rays[i], k));
      for (std::uint32_t met = lane_bits(m.hit) & ((2u << last) - 1); met; met &= met - 1) {
        const int n = __builtin_ctz(met);
        const PrimitiveRef& ref = world.refs[leaf.first + first + std::uint32_t(n)];
        if constexpr (lanes_of<F> == 1) see(i, instance, ref, Meeting<F>{lane(m.t, n), true});
        else see(i, instance, ref, Meeting<F>{F(lane(m.t, n)), mask_of_bits<MaskOf<F>>(1u << k)});
      }
    }
  }
}
template <int Width, class F, class See>
[[gnu::noinline]] LAMBENT_FLATTEN void ask_triangles_alone(const WorldView& world, const BvhChild& leaf,
                                                           std::int32_t instance, const QueryRay<F>* rays,
                                                           const Comers& comers, const See& see) {
  using Wide = Pack<float, Width>;
  struct Corners {
    Vec3<Wide> p0, p1, p2;
  };
  const PrimitiveRef* refs = world.refs + leaf.first;
  const Geometry& g = world.geometries[refs[0].geometry];
  const auto load = [&, vertices = g.vertices](const auto& of_lane) -> Corners {
    const std::uint32_t* v[Width];
    for (int k = 0; k < Width; ++k) v[k] = corners(g, refs[of_lane(k)].primitive);
    const auto corner = [&](int c) {
      return gather_points<Wide>([&](int k) -> const Vec3<float>& { return vertices[v[k][c]]; });
    };
    return {corner(0), corner(1), corner(2)};
  };
  const auto meet = [](const Corners& c, const QueryRay<Wide>& ray) {
    return meet_triangle(ray, c.p0, c.p1, c.p2);
  };
  ask_side_by_side<Width>(world, leaf, instance, rays, comers, load, meet, see);
}
template <int Width, class F, class See>
[[gnu::noinline]] LAMBENT_FLATTEN void ask_spheres_alone(const WorldView& world, const BvhChild& leaf,
                                                         std::int32_t instance, const QueryRay<F>* rays,
                                                         const Comers& comers, const See& see) {
  using Wide = Pack<float, Width>;
  struct Spheres {
    Vec3<Wide> center;
    Wide radius;
  };
  const auto load = [&](const auto& of_lane) -> Spheres {
    const auto sphere = [&](int k) -> const LeafSphere& {
      return world.leaf_spheres[leaf.first + of_lane(k)];
    };
    return {gather_points<Wide>(sphere), gather<Wide>([&](int k) { return sphere(k).radius; })};
  };
  const auto meet = [](const Spheres& s, const QueryRay<Wide>& ray) {
    return meet_sphere(ray, s.center, s.radius);
  };
  ask_side_by_side<Width>(world, leaf, instance, rays, comers, load, meet, see);
}

/// Asks the primitives of a leaf of one kind. Where few rays come, triangles with one after the other;
/// spheres only with a ray that has no packet, as they cost a packet little.
template <class F, class See>
void ask_leaf(const WorldView& world, const BvhChild& leaf, std::int32_t instance, const QueryRay<F>* rays,
              const Comers& comers, const See& see) {
  constexpr int wide = native_float_lanes < 8 ? 4 : 8, few = max(1, min(4, lanes_of<F> / 2));
  if (leaf.kind == LeafKind::triangles) {
    if (leaf.count == 1 || __builtin_popcount(comers.lanes) > few)
      ask_triangles(world, leaf, instance, rays, comers.packets, see);
    else if (leaf.count <= 4) ask_triangles_alone<4>(world, leaf, instance, rays, comers, see);
    else ask_triangles_alone<wide>(world, leaf, instance, rays, comers, see);
  } else if constexpr (lanes_of<F> > 1) {
    ask_spheres(world, leaf, instance, rays, comers.packets, see);
  } else {
    if (leaf.count == 1) ask_spheres(world, leaf, instance, rays, comers.packets, see);
    else if (leaf.count <= 4) ask_spheres_alone<4>(world, leaf, instance, rays, comers, see);
    else ask_spheres_alone<wide>(world, leaf, instance, rays, comers, see);
  }
}

/// visit_primitives() for packet i, inside of an instance.
template <class F, class See>
void visit_instance(const WorldView& world, std::int32_t number, int i, const QueryRay<F>* rays, F* t_far,
                    const See& see) {
  const Instance& instance = world.instances[number];
  // t keeps its meaning: the direction is not normalised again.
  const QueryRay<F> inside = enter(instance, rays[i]);
  const auto see_here = [&](int, std::int32_t, const PrimitiveRef& ref, const Meeting<F>& m) {
    see(i, number, ref, m);
  };
  const auto ask_inside = [&](const BvhChild& leaf, const Comers& comers) {
    if (leaf.kind != LeafKind::mixed) return ask_leaf(world, leaf, number, &inside, comers, see_here);
    for (std::uint32_t r = leaf.first; r < leaf.first + leaf.count; ++r)
      ask_primitive(world, world.refs[r], number, &inside, 1, see_here);
  };
  traverse_packets(world, world.bvhs[instance.bvh], &inside, t_far + i, 1, ask_inside);
}

/// Calls see(i, instance, ref, meeting) for every primitive that some ray of packet i meets and that may lie
/// before t_far[i].
template <class F, class See>
void visit_primitives(const WorldView& world, const QueryRay<F>* rays, F* t_far, int count, const See& see) {
  for (std::uint32_t p = 0; p < world.plane_count; ++p)
    ask_primitive(world, world.planes[p], -1, rays, (1u << count) - 1, see);
  const auto ask_here = [&](const BvhChild& leaf, const Comers& comers) {
    if (leaf.kind != LeafKind::mixed) return ask_leaf(world, leaf, -1, rays, comers, see);
    for (std::uint32_t r = leaf.first; r < leaf.first + leaf.count; ++r) {
      const PrimitiveRef& ref = world.refs[r];
      if (ref.geometry == instance_geometry)
        for (std::uint32_t left = comers.packets; left; left &= left - 1)
          visit_instance(world, ref.primitive, __builtin_ctz(left), rays, t_far, see);
      else ask_primitive(world, ref, -1, rays, comers.packets, see);
    }
  };
  traverse_packets(world, world.bvhs[0], rays, t_far, count, ask_here);
}

/// For `count` packets of rays (at most beam) the closest hits before hits[i].t, in every active lane.
template <class F>
void find_closest(const WorldView& world, const QueryRay<F>* rays, const MaskOf<F>* active, int count,
                  Closest<F>* hits) {
  using I = typename Closest<F>::I;
  F t_far[beam];
  for (int i = 0; i < count; ++i) t_far[i] = select(active[i], hits[i].t, F(-1.f));
  visit_primitives(world, rays, t_far, count,
                   [&](int i, std::int32_t instance, const PrimitiveRef& ref, const Meeting<F>& m) {
                     HitIds<I>& ids = hits[i].ids;
                     const I in(instance), ge(ref.geometry), pr(ref.primitive);
                     MaskOf<F> better = both(m.hit, m.t < t_far[i]);
                     const MaskOf<F> equal = both(m.hit, m.t == t_far[i]);
                     if (any(equal)) {
                       const MaskOf<F> lower_number = either(
                           in < ids.instance,
                           both(in == ids.instance,
                                either(ge < ids.geometry, both(ge == ids.geometry, pr < ids.primitive))));
                       better = either(better, both(equal, lower_number, ids.geometry >= I(0)));
                     }
                     t_far[i] = select(better, m.t, t_far[i]);
                     ids.instance = select(better, in, ids.instance);
                     ids.geometry = select(better, ge, ids.geometry);
                     ids.primitive = select(better, pr, ids.primitive);
                   });
  for (int i = 0; i < count; ++i) hits[i].t = select(active[i], t_far[i], hits[i].t);
}
template <class F>
void find_closest(const WorldView& world, const QueryRay<F>& ray, MaskOf<F> active, Closest<F>& hit) {
  find_closest(world, &ray, &active, 1, &hit);
}

/// The scene's material of a primitive.
inline std::uint32_t material_of(const WorldView& world, std::int32_t instance, std::int32_t geometry,
                                 std::int32_t primitive) {
  const Geometry& g = world.geometries[geometry];
  if (g.scene_material) return g.scene_material[primitive];
  const std::uint32_t object = instance >= 0 ? world.instances[instance].object : g.object;
  return world.objects[object].materials[g.material_of_primitive ? g.material_of_primitive[primitive] : 0];
}

/// The scene's object of a primitive.
inline std::uint32_t object_of(const WorldView& world, std::int32_t instance, std::int32_t geometry,
                               std::int32_t primitive) {
  const Geometry& g = world.geometries[geometry];
  if (instance >= 0) return world.instances[instance].object;
  return g.object_of_primitive ? g.object_of_primitive[primitive] : g.object;
}

/// For `count` packets of rays where something opaque stands in the way before t_far. With `all_opaque`,
/// everything counts as opaque. Clears `open` (at first the lanes that ask) where the way is blocked.
template <class F>
void find_open(const WorldView& world, const QueryRay<F>* rays, const F* t_far, int count, bool all_opaque,
               MaskOf<F>* open) {
  F left[beam];
  for (int i = 0; i < count; ++i) left[i] = select(open[i], t_far[i], F(-1.f));
  visit_primitives(world, rays, left, count,
                   [&](int i, std::int32_t instance, const PrimitiveRef& ref, const Meeting<F>& m) {
                     const MaskOf<F> blocked = both(m.hit, m.t < left[i]);
                     if (!any(blocked)) return;
                     if (!all_opaque &&
                         world.material_transmits[material_of(world, instance, ref.geometry, ref.primitive)])
                       return;
                     left[i] = select(blocked, F(-1.f), left[i]);
                   });
  for (int i = 0; i < count; ++i) open[i] = both(open[i], left[i] >= F(0.f));
}
template <class F>
MaskOf<F> find_occluded(const WorldView& world, const QueryRay<F>& ray, MaskOf<F> active, F t_far,
                        bool all_opaque) {
  MaskOf<F> open = active;
  find_open(world, &ray, &t_far, 1, all_opaque, &open);
  return both(active, MaskOf<F>(!open));
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
