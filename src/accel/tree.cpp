#include "accel/tree.h"

#if LAMBENT_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cmath>
#include <memory>
#include <string>

#include "lambent/diagnostics.h"

namespace lambent {
namespace {

// The tree as the builder hands it out, node by node, from several threads; its memory is the builder's.
struct Node {
  virtual ~Node() = default;
};
struct Inner final : Node {
  Node* children[2] = {};
  RTCBounds bounds[2];
};
struct Leaf final : Node {
  std::uint32_t count = 0;
  PrimitiveRef refs[1];  // `count` of them, in memory reserved for that many
};

constexpr unsigned max_leaf_size = 8;

template <class T> T* make_node(RTCThreadLocalAllocator allocator, std::size_t extra = 0) {
  return new (rtcThreadLocalAlloc(allocator, sizeof(T) + extra, 16)) T;
}

void* create_inner(RTCThreadLocalAllocator allocator, unsigned, void*) {
  return static_cast<Node*>(make_node<Inner>(allocator));
}
void set_children(void* node, void** children, unsigned count, void*) {
  for (unsigned i = 0; i < count; ++i)
    static_cast<Inner*>(static_cast<Node*>(node))->children[i] = static_cast<Node*>(children[i]);
}
void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
  for (unsigned i = 0; i < count; ++i) static_cast<Inner*>(static_cast<Node*>(node))->bounds[i] = *bounds[i];
}
void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count,
                  void*) {
  Leaf* leaf = make_node<Leaf>(allocator, (count - 1) * sizeof(PrimitiveRef));
  leaf->count = std::uint32_t(count);
  for (std::size_t i = 0; i < count; ++i)
    leaf->refs[i] = {std::int32_t(primitives[i].geomID), std::int32_t(primitives[i].primID)};
  return static_cast<Node*>(leaf);
}

void flatten(const Node* node, std::uint32_t slot, std::vector<BvhNode>& nodes,
             std::vector<PrimitiveRef>& refs) {
  if (const auto* leaf = dynamic_cast<const Leaf*>(node)) {
    nodes[slot].first = std::uint32_t(refs.size());
    nodes[slot].count = leaf->count;
    for (std::uint32_t i = 0; i < leaf->count; ++i) refs.push_back((&leaf->refs[0])[i]);
    return;
  }
  const auto* inner = static_cast<const Inner*>(node);
  const auto first = std::uint32_t(nodes.size());
  nodes[slot].first = first;
  nodes[slot].count = 0;
  for (const RTCBounds& b : inner->bounds)
    nodes.push_back({{b.lower_x, b.lower_y, b.lower_z}, 0, {b.upper_x, b.upper_y, b.upper_z}, 0});
  for (std::uint32_t i = 0; i < 2; ++i) flatten(inner->children[i], first + i, nodes, refs);
}

}  // namespace

Bvh build_tree(std::vector<BoxedPrimitive> primitives, std::vector<BvhNode>& nodes,
               std::vector<PrimitiveRef>& refs) {
  Bvh bvh{std::uint32_t(nodes.size()), 0, primitives.empty()};
  if (primitives.empty()) return bvh;

  BvhNode root{primitives[0].lower, 0, primitives[0].upper, 0};
  static_assert(sizeof(RTCBuildPrimitive) == 32 && sizeof(BoxedPrimitive) == 32);
  struct alignas(32) Aligned {
    RTCBuildPrimitive primitive;
  };
  std::vector<Aligned> build(primitives.size());
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const BoxedPrimitive& p = primitives[i];
    build[i].primitive = {p.lower.x, p.lower.y, p.lower.z, unsigned(p.ref.geometry),
                          p.upper.x, p.upper.y, p.upper.z, unsigned(p.ref.primitive)};
    root.lower = {std::fmin(root.lower.x, p.lower.x), std::fmin(root.lower.y, p.lower.y),
                  std::fmin(root.lower.z, p.lower.z)};
    root.upper = {std::fmax(root.upper.x, p.upper.x), std::fmax(root.upper.y, p.upper.y),
                  std::fmax(root.upper.z, p.upper.z)};
  }
  primitives = {};
  bvh.extent = std::fmax(max_abs(root.lower), max_abs(root.upper));

  struct Release {
    void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
    void operator()(RTCBVH b) const { rtcReleaseBVH(b); }
  };
  std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release> device(rtcNewDevice(nullptr));
  if (!device) throw Failure("the tree builder could not be started");
  std::unique_ptr<std::remove_pointer_t<RTCBVH>, Release> builder(rtcNewBVH(device.get()));

  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.byteSize = sizeof(arguments);
  arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
  arguments.maxBranchingFactor = 2;
  arguments.maxDepth = 60;  // the traversal's stack holds that and more
  arguments.minLeafSize = 1;
  arguments.maxLeafSize = max_leaf_size;
  arguments.bvh = builder.get();
  arguments.primitives = &build.data()->primitive;
  arguments.primitiveCount = build.size();
  arguments.primitiveArrayCapacity = build.size();
  arguments.createNode = create_inner;
  arguments.setNodeChildren = set_children;
  arguments.setNodeBounds = set_bounds;
  arguments.createLeaf = create_leaf;
  const auto* top = static_cast<const Node*>(rtcBuildBVH(&arguments));
  if (!top)
    throw Failure("the tree could not be built: error " +
                  std::to_string(int(rtcGetDeviceError(device.get()))) + " of the builder");

  nodes.push_back(root);
  refs.reserve(refs.size() + build.size());
  flatten(top, bvh.root, nodes, refs);
  return bvh;
}

}  // namespace lambent
