#include "embree_queries.h"

#if LAMBENT_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#ifdef __SSE2__
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "lambent/diagnostics.h"

namespace lambent::bench {
namespace {

struct Release {
  void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
  void operator()(RTCScene s) const { rtcReleaseScene(s); }
  void operator()(RTCGeometry g) const { rtcReleaseGeometry(g); }
};
template <class Handle> using Owner = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

// One name for the queries of every width. The two versions of Embree differ in how they are told the flags.
#if LAMBENT_EMBREE_MAJOR >= 4
class Query {
 public:
  explicit Query(bool coherent) {
    rtcInitIntersectArguments(&closest_);
    rtcInitOccludedArguments(&occluded_);
    closest_.flags = occluded_.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  }
  void closest(const int*, RTCScene s, RTCRayHit& r) { rtcIntersect1(s, &r, &closest_); }
  void closest(const int* valid, RTCScene s, RTCRayHit4& r) { rtcIntersect4(valid, s, &r, &closest_); }
  void closest(const int* valid, RTCScene s, RTCRayHit8& r) { rtcIntersect8(valid, s, &r, &closest_); }
  void closest(const int* valid, RTCScene s, RTCRayHit16& r) { rtcIntersect16(valid, s, &r, &closest_); }
  void occluded(const int*, RTCScene s, RTCRay& r) { rtcOccluded1(s, &r, &occluded_); }
  void occluded(const int* valid, RTCScene s, RTCRay4& r) { rtcOccluded4(valid, s, &r, &occluded_); }
  void occluded(const int* valid, RTCScene s, RTCRay8& r) { rtcOccluded8(valid, s, &r, &occluded_); }
  void occluded(const int* valid, RTCScene s, RTCRay16& r) { rtcOccluded16(valid, s, &r, &occluded_); }

 private:
  RTCIntersectArguments closest_;
  RTCOccludedArguments occluded_;
};
#else
class Query {
 public:
  explicit Query(bool coherent) {
    rtcInitIntersectContext(&context_);
    context_.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
  void closest(const int*, RTCScene s, RTCRayHit& r) { rtcIntersect1(s, &context_, &r); }
  void closest(const int* valid, RTCScene s, RTCRayHit4& r) { rtcIntersect4(valid, s, &context_, &r); }
  void closest(const int* valid, RTCScene s, RTCRayHit8& r) { rtcIntersect8(valid, s, &context_, &r); }
  void closest(const int* valid, RTCScene s, RTCRayHit16& r) { rtcIntersect16(valid, s, &context_, &r); }
  void occluded(const int*, RTCScene s, RTCRay& r) { rtcOccluded1(s, &context_, &r); }
  void occluded(const int* valid, RTCScene s, RTCRay4& r) { rtcOccluded4(valid, s, &context_, &r); }
  void occluded(const int* valid, RTCScene s, RTCRay8& r) { rtcOccluded8(valid, s, &context_, &r); }
  void occluded(const int* valid, RTCScene s, RTCRay16& r) { rtcOccluded16(valid, s, &context_, &r); }

 private:
  RTCIntersectContext context_;
};
#endif

template <int W> struct Types;
template <> struct Types<1> {
  using Ray = RTCRay;
  using RayHit = RTCRayHit;
};
template <> struct Types<4> {
  using Ray = RTCRay4;
  using RayHit = RTCRayHit4;
};
template <> struct Types<8> {
  using Ray = RTCRay8;
  using RayHit = RTCRayHit8;
};
template <> struct Types<16> {
  using Ray = RTCRay16;
  using RayHit = RTCRayHit16;
};

/// W values of a member of Embree's rays, which is an array in packets and a number in single rays.
template <int W, class T> void fill(T& to, const float* from) { std::memcpy(&to, from, W * sizeof(float)); }
template <int W, class T, class V> void set_all(T& to, V value) {
  if constexpr (W == 1) to = value;
  else
    for (int k = 0; k < W; ++k) to[k] = value;
}

template <int W> void fill_ray(typename Types<W>::Ray& ray, const RayBlock& b, std::uint32_t i) {
  fill<W>(ray.org_x, b.ox + i), fill<W>(ray.org_y, b.oy + i), fill<W>(ray.org_z, b.oz + i);
  fill<W>(ray.dir_x, b.dx + i), fill<W>(ray.dir_y, b.dy + i), fill<W>(ray.dir_z, b.dz + i);
  fill<W>(ray.tfar, b.t_far + i);
  set_all<W>(ray.tnear, 0.f), set_all<W>(ray.time, 0.f);
  set_all<W>(ray.mask, ~0u), set_all<W>(ray.flags, 0u);
}

/// Which lanes of a packet hold rays of the list.
struct Valid {
  alignas(64) int lane[block_size];
  void set(std::uint32_t left) {
    for (std::uint32_t k = 0; k < block_size; ++k) lane[k] = k < left ? -1 : 0;
  }
};

template <int W> void ask_closest(RTCScene scene, const RayList& rays, bool coherent, float* answers) {
  Query query(coherent);
  Valid valid;
  valid.set(W);
  alignas(64) typename Types<W>::RayHit r;
  for (std::uint32_t i = 0; i < rays.count; i += W) {
    if (W > 1 && i + W > rays.count) valid.set(rays.count - i);
    fill_ray<W>(r.ray, rays.blocks[i / block_size], i % block_size);
    set_all<W>(r.hit.geomID, RTC_INVALID_GEOMETRY_ID);
    if constexpr (W == 1) r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    else set_all<W>(r.hit.instID[0], RTC_INVALID_GEOMETRY_ID);
    query.closest(valid.lane, scene, r);
    std::memcpy(answers + i, &r.ray.tfar, W * sizeof(float));
  }
}

template <int W> void ask_occluded(RTCScene scene, const RayList& rays, bool coherent, float* answers) {
  Query query(coherent);
  Valid valid;
  valid.set(W);
  alignas(64) typename Types<W>::Ray r;
  for (std::uint32_t i = 0; i < rays.count; i += W) {
    if (W > 1 && i + W > rays.count) valid.set(rays.count - i);
    fill_ray<W>(r, rays.blocks[i / block_size], i % block_size);
    query.occluded(valid.lane, scene, r);
    std::memcpy(answers + i, &r.tfar, W * sizeof(float));
  }
}

template <int W> void ask_tile(RTCScene scene, const TileRays& rays, const Variant& variant, float* answers) {
  ask_closest<W>(scene, rays.eye, variant.coherent, answers + rays.eye.first_answer);
  if (variant.scattered_in_packets)
    ask_closest<W>(scene, rays.scattered, false, answers + rays.scattered.first_answer);
  else ask_closest<1>(scene, rays.scattered, false, answers + rays.scattered.first_answer);
  ask_occluded<W>(scene, rays.shadow, variant.coherent, answers + rays.shadow.first_answer);
}

/// Two triangles for a plane, out to `reach` from the origin in every direction.
void add_square(RTCGeometry g, const Plane& plane, double reach) {
  const Vec3<double> n = plane.normal, origin_on_plane = dot(plane.point, n) * n;
  const Vec3<double> u =
      normalize(std::fabs(n.x) < 0.5 ? cross(n, Vec3<double>{1, 0, 0}) : cross(n, Vec3<double>{0, 1, 0}));
  const Vec3<double> v = cross(n, u);
  auto* corner =
      static_cast<float*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 4));
  auto* index =
      static_cast<unsigned*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, 2));
  if (!corner || !index) throw std::bad_alloc();
  for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    const Vec3<double> p = origin_on_plane + (a * reach) * u + (b * reach) * v;
    *corner++ = float(p.x), *corner++ = float(p.y), *corner++ = float(p.z);
  }
  for (unsigned i : {0u, 1u, 2u, 0u, 2u, 3u}) *index++ = i;
}

/// Vertices are copied, because Embree reads four bytes beyond the last one; triangles are shared.
void add_mesh(RTCGeometry g, const Geometry& mesh) {
  std::uint32_t vertices = 0;
  for (std::uint32_t i = 0; i < mesh.count; ++i)
    for (std::uint32_t v : mesh.triangles[i]) vertices = std::max(vertices, v + 1);
  void* to = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, vertices);
  if (!to) throw std::bad_alloc();
  std::memcpy(to, mesh.vertices, vertices * std::size_t(12));
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles, 0, 12,
                             mesh.count);
}

/// All spheres of a world as one geometry: Embree packs only those of one geometry into a leaf's block.
void add_spheres(RTCGeometry g, const World& world, std::uint32_t count) {
  auto* to = static_cast<float*>(
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, count));
  if (!to) throw std::bad_alloc();
  for (const Geometry& from : world.geometries) {
    if (from.kind != PrimitiveKind::sphere) continue;
    for (std::uint32_t i = 0; i < from.count; ++i) {
      const Sphere& s = from.spheres[i];
      for (double x : {s.center.x, s.center.y, s.center.z, s.radius}) *to++ = float(x);
    }
  }
}

}  // namespace

struct EmbreeWorld::Parts {
  Owner<RTCDevice> device{rtcNewDevice(nullptr)};
  Owner<RTCScene> scene;

  void attach(RTCGeometryType type, const auto& fill_buffers) {
    const Owner<RTCGeometry> g(rtcNewGeometry(device.get(), type));
    fill_buffers(g.get());
    rtcCommitGeometry(g.get());
    rtcAttachGeometry(scene.get(), g.get());
  }
};

EmbreeWorld::EmbreeWorld(const World& world, bool robust, double reach) : parts_(std::make_unique<Parts>()) {
  if (!parts_->device) throw Failure("Embree could not be started");
  parts_->scene.reset(rtcNewScene(parts_->device.get()));
  if (robust) rtcSetSceneFlags(parts_->scene.get(), RTC_SCENE_FLAG_ROBUST);
  if (!world.instances.empty())
    throw Failure("the scene shows one shape several times; bare_rays knows no instances");
  std::uint32_t spheres = 0;
  for (const Geometry& g : world.geometries) {
    switch (g.kind) {
      case PrimitiveKind::triangle:
        parts_->attach(RTC_GEOMETRY_TYPE_TRIANGLE, [&](RTCGeometry to) { add_mesh(to, g); });
        break;
      case PrimitiveKind::sphere:
        spheres += g.count;
        break;
      case PrimitiveKind::plane:
        for (std::uint32_t i = 0; i < g.count; ++i)
          parts_->attach(RTC_GEOMETRY_TYPE_TRIANGLE,
                         [&](RTCGeometry to) { add_square(to, g.planes[i], reach); });
        break;
      default:
        throw Failure("the scene has cones, cylinders or discs; Embree has no primitive that is the same");
    }
  }
  if (spheres > 0)
    parts_->attach(RTC_GEOMETRY_TYPE_SPHERE_POINT, [&](RTCGeometry to) { add_spheres(to, world, spheres); });
  rtcCommitScene(parts_->scene.get());
  if (const RTCError error = rtcGetDeviceError(parts_->device.get()); error != RTC_ERROR_NONE)
    throw Failure("Embree could not build its tree: error " + std::to_string(int(error)));
}

EmbreeWorld::~EmbreeWorld() = default;
EmbreeWorld::EmbreeWorld(EmbreeWorld&&) noexcept = default;

void EmbreeWorld::ask(const TileRays& rays, const Variant& variant, float* answers) const {
  switch (variant.width) {
    case 1:
      return ask_tile<1>(parts_->scene.get(), rays, variant, answers);
    case 4:
      return ask_tile<4>(parts_->scene.get(), rays, variant, answers);
    case 8:
      return ask_tile<8>(parts_->scene.get(), rays, variant, answers);
    case 16:
      return ask_tile<16>(parts_->scene.get(), rays, variant, answers);
    default:
      throw Failure("packets are 1, 4, 8 or 16 rays wide");
  }
}

std::string EmbreeWorld::version() { return RTC_VERSION_STRING; }

int EmbreeWorld::widest_native_packet() {
  const Owner<RTCDevice> device(rtcNewDevice(nullptr));
  if (!device) throw Failure("Embree could not be started");
  for (const auto& [width, property] : {std::pair{16, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED},
                                        std::pair{8, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED},
                                        std::pair{4, RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED}})
    if (rtcGetDeviceProperty(device.get(), property)) return width;
  return 1;
}

void flush_denormals() {
#ifdef __SSE2__
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
  _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
#endif
}

}  // namespace lambent::bench
