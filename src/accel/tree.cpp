#include "accel/tree.h"

#if LAMBENT_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "lambent/diagnostics.h"

namespace lambent {
namespace {

constexpr unsigned max_leaf_size = 8;

PrimitiveKind kind_of(const PrimitiveRef& ref, const World& world) {
  return ref.geometry == instance_geometry ? PrimitiveKind::instance : world.geometries[ref.geometry].kind;
}

LeafKind kind_of(const PrimitiveRef* refs, std::uint32_t count, const World& world) {
  const PrimitiveKind kind = kind_of(refs[0], world);
  bool one_kind = true, one_geometry = true;
  for (std::uint32_t i = 1; i < count; ++i) {
    one_kind &= kind_of(refs[i], world) == kind;
    one_geometry &= refs[i].geometry == refs[0].geometry;
  }
  if (kind == PrimitiveKind::triangle && one_geometry) return LeafKind::triangles;
  if (kind == PrimitiveKind::sphere && one_kind) return LeafKind::spheres;
  return LeafKind::mixed;
}

void clear(BvhNode& node) {
  node = {};
  for (int i = 0; i < bvh_width; ++i)
    for (int axis = 0; axis < 3; ++axis) node.plane[axis][i] = INFINITY, node.plane[axis + 3][i] = -INFINITY;
}

void set_child(BvhNode& node, std::uint32_t i, const BvhChild& child) {
  node.first[i] = child.first;
  node.count[i] = std::uint16_t(child.count);
  node.kind[i] = child.kind;
}

void set_box(BvhNode& node, std::uint32_t i, const Vec3<float>& lower, const Vec3<float>& upper) {
  node.plane[0][i] = lower.x, node.plane[1][i] = lower.y, node.plane[2][i] = lower.z;
  node.plane[3][i] = upper.x, node.plane[4][i] = upper.y, node.plane[5][i] = upper.z;
}

/// The builder's end of a tree: it calls the functions below from several threads, and whatever they return
/// it hands to set_children later. Nodes and leaves go straight to where they stay, and the primitives' boxes
/// go as the leaves come, so that the two together never take much more memory than the finished tree.
class Growing {
 public:
  Growing(Pages<BoxedPrimitive>& primitives, World& world)
      : world_(world),
        primitives_(primitives),
        done_(std::make_unique<std::atomic<std::uint32_t>[]>(primitives.size() / primitives.step + 1)),
        nodes_(primitives.size()),  // enough: every node has two children at least
        refs_(primitives.size()),
        first_node_(std::uint32_t(world.nodes.size())),
        first_ref_(std::uint32_t(world.refs.size())),
        first_box_(world.geometries.size()) {
    for (std::size_t i = primitives.size(); i-- > 0;)
      if (primitives[i].geometry != instance_geometry) first_box_[primitives[i].geometry] = std::uint32_t(i);
  }

  static void* create_node(RTCThreadLocalAllocator, unsigned count, void* self) {
    return static_cast<Growing*>(self)->add_node(count);
  }
  static void set_children(void* node, void** children, unsigned count, void* self) {
    BvhNode& to = static_cast<Growing*>(self)->node(node);
    for (unsigned i = 0; i < count; ++i) set_child(to, i, child_of(children[i]));
  }
  static void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void* self) {
    BvhNode& to = static_cast<Growing*>(self)->node(node);
    for (unsigned i = 0; i < count; ++i) {
      const RTCBounds& b = *bounds[i];
      set_box(to, i, {b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z});
    }
  }
  static void* create_leaf(RTCThreadLocalAllocator, const RTCBuildPrimitive* primitives, std::size_t count,
                           void* self) {
    return static_cast<Growing*>(self)->add_leaf(primitives, std::uint32_t(count));
  }

  /// Appends nodes and leaves to the world's; returns the top.
  BvhChild finish(void* top) {
    move(nodes_, next_node_, world_.nodes);
    move(refs_, primitives_.size(), world_.refs);
    return child_of(top);
  }

 private:
  template <class T> static void move(Pages<T>& from, std::size_t count, std::vector<T>& to) {
    // Exactly for the first tree, for most scenes have no other; later ones must not copy it each time.
    if (to.size() + count > to.capacity()) to.reserve(std::max(to.size() + count, 2 * to.size()));
    for (std::size_t i = 0; i < count; i += from.step) {
      const std::size_t end = std::min(i + from.step, count);
      to.insert(to.end(), from.data() + i, from.data() + end);
      from.give_back(i, end);
    }
  }

  // A child in the bits of a pointer, never null: the builder takes that for a failure.
  static_assert(sizeof(void*) == sizeof(std::uint64_t));
  static void* pointer_of(const BvhChild& child) {
    return reinterpret_cast<void*>(std::uint64_t(child.first) << 32 | std::uint64_t(child.count) << 16 |
                                   std::uint64_t(child.kind) << 8 | 1);
  }
  static BvhChild child_of(void* pointer) {
    const auto bits = reinterpret_cast<std::uint64_t>(pointer);
    return {std::uint32_t(bits >> 32), std::uint32_t(bits >> 16 & 0xffff), LeafKind(bits >> 8 & 0xff)};
  }

  BvhNode& node(void* pointer) { return nodes_[child_of(pointer).first - first_node_]; }

  void* add_node(unsigned count) {
    const std::uint32_t index = next_node_++;
    clear(nodes_[index]);
    nodes_[index].children = count;
    return pointer_of({first_node_ + index, 0, LeafKind::mixed});
  }

  void* add_leaf(const RTCBuildPrimitive* given, std::uint32_t count) {
    // The thorough builder sorts the primitives where they are, so that a leaf is a stretch of them; the
    // quick one leaves them where they are and hands out copies.
    const auto* p = reinterpret_cast<const BoxedPrimitive*>(given);
    const bool in_place = !std::less<>()(p, primitives_.begin()) && std::less<>()(p, primitives_.end());
    const std::uint32_t at = in_place ? std::uint32_t(p - primitives_.begin()) : next_copy_.fetch_add(count);
    PrimitiveRef* refs = refs_.data() + at;
    for (std::uint32_t i = 0; i < count; ++i) refs[i] = {p[i].geometry, p[i].primitive};
    for (std::uint32_t i = 0, many = 0; i < count; i += many) {
      const auto block_of = [&](std::uint32_t k) {
        if (in_place) return (at + k) / step;
        const auto [geometry, primitive] = refs[k];
        return geometry == instance_geometry ? no_block
                                             : (first_box_[geometry] + std::uint32_t(primitive)) / step;
      };
      const std::uint32_t block = block_of(i);
      for (many = 1; i + many < count && block_of(i + many) == block;) ++many;
      if (block != no_block) give_back(block, many);
    }
    return pointer_of({first_ref_ + at, count, kind_of(refs, count, world_)});
  }

  /// Once all primitives of a block are in leaves, their boxes have done their work.
  void give_back(std::uint32_t block, std::uint32_t count) {
    if (done_[block].fetch_add(count, std::memory_order_acq_rel) + count == step)
      primitives_.give_back(std::size_t(block) * step, std::size_t(block + 1) * step);
  }

  static constexpr std::uint32_t step = Pages<BoxedPrimitive>::step, no_block = ~0u;

  World& world_;
  Pages<BoxedPrimitive>& primitives_;
  std::unique_ptr<std::atomic<std::uint32_t>[]> done_;  ///< Of each block, how many are in leaves.
  Pages<BvhNode> nodes_;
  Pages<PrimitiveRef> refs_;
  std::uint32_t first_node_, first_ref_;  ///< Where this tree begins in the world's.
  std::vector<std::uint32_t> first_box_;  ///< Of each geometry, before the builder sorts them.
  std::atomic<std::uint32_t> next_node_{0}, next_copy_{0};
};

/// One node with a leaf for each: the builder and its threads would take longer than the picture.
std::uint32_t add_small_tree(Pages<BoxedPrimitive>& primitives, World& world) {
  BvhNode node;
  clear(node);
  for (const BoxedPrimitive& p : primitives) {
    const PrimitiveRef ref{p.geometry, p.primitive};
    set_child(node, node.children, {std::uint32_t(world.refs.size()), 1, kind_of(&ref, 1, world)});
    set_box(node, node.children++, p.lower, p.upper);
    world.refs.push_back(ref);
  }
  world.nodes.push_back(node);
  return std::uint32_t(world.nodes.size() - 1);
}

/// Whether nearly all are triangles and spheres, which cost a leaf little. Measured on triangles: leaves of
/// four and more make a tree a third as large, built in two thirds of the time and as fast to query; quickly
/// built ones of six are faster to query than smaller ones, too. Cones and discs want leaves of their own.
bool are_cheap(Pages<BoxedPrimitive>& primitives, const World& world) {
  const auto cheap = std::count_if(primitives.begin(), primitives.end(), [&](const BoxedPrimitive& p) {
    const PrimitiveKind kind = kind_of({p.geometry, p.primitive}, world);
    return kind == PrimitiveKind::triangle || kind == PrimitiveKind::sphere;
  });
  return std::size_t(cheap) > primitives.size() / 10 * 9;
}

std::uint32_t add_large_tree(Pages<BoxedPrimitive>& primitives, TreeQuality quality, const Bvh& all,
                             World& world) {
  struct Release {
    void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
    void operator()(RTCBVH b) const { rtcReleaseBVH(b); }
  };
  std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release> device(rtcNewDevice(nullptr));
  if (!device) throw Failure("the tree builder could not be started");
  std::unique_ptr<std::remove_pointer_t<RTCBVH>, Release> builder(rtcNewBVH(device.get()));

  static_assert(sizeof(RTCBuildPrimitive) == sizeof(BoxedPrimitive) &&
                offsetof(RTCBuildPrimitive, geomID) == offsetof(BoxedPrimitive, geometry) &&
                offsetof(RTCBuildPrimitive, upper_x) == offsetof(BoxedPrimitive, upper) &&
                offsetof(RTCBuildPrimitive, primID) == offsetof(BoxedPrimitive, primitive));
  Growing growing(primitives, world);
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.byteSize = sizeof(arguments);
  const bool quick = quality == TreeQuality::quick, cheap = are_cheap(primitives, world);
  arguments.buildQuality = quick ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
  arguments.maxBranchingFactor = bvh_width;
  arguments.maxDepth = max_tree_depth;
  arguments.minLeafSize = quick && cheap ? 6 : 1;
  arguments.maxLeafSize = max_leaf_size;
  arguments.sahBlockSize = cheap ? 4 : 1;
  arguments.bvh = builder.get();
  arguments.primitives = reinterpret_cast<RTCBuildPrimitive*>(primitives.data());
  arguments.primitiveCount = primitives.size();
  arguments.primitiveArrayCapacity = primitives.size();
  arguments.createNode = Growing::create_node;
  arguments.setNodeChildren = Growing::set_children;
  arguments.setNodeBounds = Growing::set_bounds;
  arguments.createLeaf = Growing::create_leaf;
  arguments.userPtr = &growing;
  void* top = rtcBuildBVH(&arguments);
  if (!top)
    throw Failure("the tree could not be built: error " +
                  std::to_string(int(rtcGetDeviceError(device.get()))) + " of the builder");
  const BvhChild root = growing.finish(top);
  if (root.count == 0) return root.first;
  BvhNode node;  // all in one leaf: give it a node
  clear(node);
  node.children = 1;
  set_child(node, 0, root);
  set_box(node, 0, all.lower, all.upper);
  world.nodes.push_back(node);
  return std::uint32_t(world.nodes.size() - 1);
}

}  // namespace

Bvh build_tree(Pages<BoxedPrimitive> primitives, TreeQuality quality, World& world) {
  Bvh bvh{0, 0, primitives.empty(), {}, {}};
  if (primitives.empty()) return bvh;

  bvh.lower = primitives[0].lower, bvh.upper = primitives[0].upper;
  for (const BoxedPrimitive& p : primitives) {
    bvh.lower = {std::fmin(bvh.lower.x, p.lower.x), std::fmin(bvh.lower.y, p.lower.y),
                 std::fmin(bvh.lower.z, p.lower.z)};
    bvh.upper = {std::fmax(bvh.upper.x, p.upper.x), std::fmax(bvh.upper.y, p.upper.y),
                 std::fmax(bvh.upper.z, p.upper.z)};
  }
  bvh.extent = std::fmax(max_abs(bvh.lower), max_abs(bvh.upper));
  bvh.root = primitives.size() <= bvh_width ? add_small_tree(primitives, world)
                                            : add_large_tree(primitives, quality, bvh, world);
  return bvh;
}

}  // namespace lambent
