// The ray queries against brute force and against their promises: the same answer whatever the tree and the
// packet, no ray lost between triangles, no ray that hits the surface it leaves.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "accel/surface.h"
#include "accel/traverse.h"
#include "accel/world.h"

namespace lambent {
namespace {

using QueryPack = Pack<float, native_float_lanes>;
constexpr int lanes = lanes_of<QueryPack>;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double number(double from, double to) { return std::uniform_real_distribution<double>(from, to)(engine_); }
  Vec3<double> point(double size) { return {number(-size, size), number(-size, size), number(-size, size)}; }
  Vec3<double> direction() {
    std::normal_distribution<double> d;
    return normalize(Vec3<double>{d(engine_), d(engine_), d(engine_)});
  }

 private:
  std::mt19937 engine_;
};

void add_object(Scene& scene, Primitives primitives, Transform transform = {}) {
  if (scene.materials.empty()) scene.materials.emplace_back();
  scene.objects.push_back({"", {}, std::uint32_t(scene.shapes.size()), {0}, transform});
  scene.shapes.push_back({"", std::move(primitives), {}});
}

Mesh random_triangles(Random& random, int count, double size) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3<double> p = random.point(1);
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(cast<float>(p + random.point(size)));
    mesh.triangles.push_back({3u * i, 3u * i + 1, 3u * i + 2});
  }
  return mesh;
}

/// A sphere of triangles, closed: each edge belongs to two.
Mesh ball(int rings, double radius, const Vec3<double>& center) {
  Mesh mesh;
  const int columns = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < columns; ++j) {
      const auto [s, c] = sincos_degrees(180.0 * i / rings);
      const auto [sj, cj] = sincos_degrees(360.0 * j / columns);
      const Vec3<double> n{s * cj, c, s * sj};
      mesh.vertices.push_back(cast<float>(center + radius * n));
      mesh.normals.push_back(cast<float>(n));
    }
  for (auto& v :
       mesh.vertices) {  // one pole, not `columns` of them, so that the mesh is closed in floats too
    if (&v - mesh.vertices.data() < columns) v = mesh.vertices[0];
    if (&v - mesh.vertices.data() >= rings * columns) v = mesh.vertices[std::size_t(rings) * columns];
  }
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < columns; ++j) {
      const auto a = std::uint32_t(i * columns + j), b = std::uint32_t(i * columns + (j + 1) % columns),
                 c = a + columns, d = b + columns;
      if (i > 0) mesh.triangles.push_back({a, b, c});
      if (i < rings - 1) mesh.triangles.push_back({b, d, c});
    }
  return mesh;
}

/// Some of everything: triangles, spheres, cones, discs, planes; instances, turned, stretched and mirrored.
Scene random_scene(Random& random, double spread) {
  Scene scene;
  const Vec3<double> shift = random.point(spread);
  add_object(scene, random_triangles(random, 200, 0.2), translation(shift));
  std::vector<Sphere> spheres;
  std::vector<Cone> cones;
  std::vector<Disc> discs;
  for (int i = 0; i < 60; ++i) {
    spheres.push_back({shift + random.point(1), random.number(0.01, 0.15)});
    cones.push_back(
        {shift + random.point(1), shift + random.point(1), random.number(0, 0.1), random.number(0.01, 0.1)});
    discs.push_back({shift + random.point(1), random.direction(), random.number(0.01, 0.3)});
  }
  add_object(scene, spheres);
  add_object(scene, cones);
  add_object(scene, discs);
  add_object(scene, std::vector<Plane>{{shift + Vec3<double>{0, -1, 0}, {0.1, 1, 0}}});
  const auto shape = std::uint32_t(scene.shapes.size());
  scene.shapes.push_back({"", ball(8, 0.3, {}), {}});
  for (int i = 0; i < 5; ++i)
    scene.objects.push_back(
        {"",
         {},
         shape,
         {0},
         translation(shift + random.point(1)) * rotation(random.direction(), random.number(0, 360)) *
             scaling({random.number(0.3, 1), random.number(0.3, 1), i % 2 ? -0.7 : 0.7})});
  add_object(scene, std::vector<Sphere>{{{0, 0, 0}, 0.3}},
             translation(shift) * scaling({1, 0.5, 0.2}));  // an ellipsoid
  return scene;
}

/// random_scene, ready for rays about `middle`.
struct RandomWorld {
  Random random;
  const Scene scene;
  const World world = build_world(scene);
  const WorldView view = world.view();
  const Vec3<double> middle = std::get<std::vector<Sphere>>(scene.shapes[1].primitives)[0].center;

  RandomWorld(unsigned seed, double spread) : random(seed), scene(random_scene(random, spread)) {}
};

std::uint32_t bits(float a) { return std::bit_cast<std::uint32_t>(a); }

TEST(Queries, TreeAndPacketGiveTheBitsOfBruteForce) {
  for (double spread : {0.0, 30.0, 3000.0}) {
    RandomWorld in(unsigned(spread) + 1, spread);
    auto& [random, scene, world, view, middle] = in;
    // All primitives in one leaf: the same loop, and no box that could be passed over.
    std::vector<BvhNode> leaves;
    std::vector<Bvh> trees;
    for (const Bvh& tree : world.bvhs) {
      std::uint32_t first = UINT32_MAX, last = 0;
      const auto visit = [&](auto&& self, const BvhNode& node) -> void {
        for (std::uint32_t c = 0; c < node.children; ++c) {
          if (node.count[c] == 0) {
            self(self, world.nodes[node.first[c]]);
          } else {
            first = std::min(first, node.first[c]);
            last = std::max(last, node.first[c] + node.count[c]);
          }
        }
      };
      visit(visit, world.nodes[tree.root]);
      BvhNode all{};
      for (int axis = 0; axis < 3; ++axis) all.plane[axis][0] = -1e30f, all.plane[axis + 3][0] = 1e30f;
      all.first[0] = first, all.count[0] = std::uint16_t(last - first), all.kind[0] = LeafKind::mixed;
      all.children = 1;
      trees.push_back(tree);
      trees.back().root = std::uint32_t(leaves.size());
      leaves.push_back(all);
    }
    WorldView brute = view;
    brute.nodes = leaves.data();
    brute.bvhs = trees.data();

    int hits = 0;
    for (int i = 0; i < 1000; ++i) {
      Vec3<QueryPack> packet_o, packet_d;
      Closest<float> expected[lanes], alone[lanes];
      bool expected_blocked[lanes];
      for (int k = 0; k < lanes; ++k) {
        const Vec3<float> o = cast<float>(middle + random.point(2));
        Vec3<float> d = cast<float>(random.direction());
        if (k % 5 == 0) (k % 2 ? d.x : d.y) = 0;  // along the sides of boxes too
        const QueryRay<float> ray(o, d);
        set_lane(packet_o.x, k, o.x), set_lane(packet_o.y, k, o.y), set_lane(packet_o.z, k, o.z);
        set_lane(packet_d.x, k, d.x), set_lane(packet_d.y, k, d.y), set_lane(packet_d.z, k, d.z);
        expected[k].t = alone[k].t = INFINITY;
        find_closest(brute, ray, true, expected[k]);
        find_closest(view, ray, true, alone[k]);
        expected_blocked[k] = find_occluded(brute, ray, true, 1.f, true);
        EXPECT_EQ(expected_blocked[k], find_occluded(view, ray, true, 1.f, true));
      }
      const QueryRay<QueryPack> packet(packet_o, packet_d);
      Closest<QueryPack> together{QueryPack(INFINITY)};
      find_closest(view, packet, MaskOf<QueryPack>(true), together);
      const auto blocked = find_occluded(view, packet, MaskOf<QueryPack>(true), QueryPack(1.f), true);
      for (int k = 0; k < lanes; ++k) {
        hits += expected[k].ids.geometry >= 0;
        for (const Closest<float>& got :
             {alone[k], Closest<float>{lane(together.t, k),
                                       {lane(together.ids.instance, k), lane(together.ids.geometry, k),
                                        lane(together.ids.primitive, k)}}}) {
          ASSERT_EQ(bits(got.t), bits(expected[k].t));
          ASSERT_EQ(got.ids.instance, expected[k].ids.instance);
          ASSERT_EQ(got.ids.geometry, expected[k].ids.geometry);
          ASSERT_EQ(got.ids.primitive, expected[k].ids.primitive);
        }
        ASSERT_EQ(lane(blocked, k), expected_blocked[k]);
      }
    }
    EXPECT_GT(hits, 500);
  }
}

TEST(Queries, ABeamOfPacketsGivesTheBitsOfEachRay) {
  // Rays that lie close together go through the tree as one; some that do not are among them.
  for (double spread : {0.0, 30.0, 3000.0}) {
    RandomWorld in(unsigned(spread) + 5, spread);
    auto& [random, scene, world, view, middle] = in;
    int hits = 0, blocked_rays = 0;
    for (int i = 0; i < 1500; ++i) {
      constexpr int most = beam;
      const int count = 1 + i % most;
      const double width = std::pow(10, random.number(-4, 0)), reach = random.number(0, 0.1);
      const Vec3<double> eye = middle + random.point(2);
      Vec3<double> ahead = random.direction();
      if (i % 4 == 0) (i % 8 ? ahead.x : ahead.y) = 0;  // along the sides of boxes
      Vec3<float> o[most * lanes], d[most * lanes];
      for (int k = 0; k < count * lanes; ++k) {
        o[k] = cast<float>(eye + reach * width * random.point(1));
        d[k] = cast<float>(normalize(ahead + width * random.point(0.3)));
      }
      QueryRay<QueryPack> rays[most];
      MaskOf<QueryPack> active[most], open[most];
      Closest<QueryPack> closest[most];
      QueryPack t_far[most];
      for (int p = 0; p < count; ++p) {
        const auto vectors = [&](const Vec3<float>* v) {
          return gather_points<QueryPack>([&](int k) -> const Vec3<float>& { return v[p * lanes + k]; });
        };
        rays[p] = QueryRay<QueryPack>(vectors(o), vectors(d));
        active[p] = gather<QueryPack>([&](int) { return float(random.number(-1, 9)); }) > QueryPack(0.f);
        open[p] = active[p];
        closest[p] = {QueryPack(INFINITY)};
        t_far[p] = QueryPack(1.5f);
      }
      find_closest(view, rays, active, count, closest);
      find_open(view, rays, t_far, count, true, open);
      for (int k = 0; k < count * lanes; ++k) {
        const int p = k / lanes, l = k % lanes;
        if (!lane(active[p], l)) {
          EXPECT_EQ(lane(closest[p].ids.geometry, l), -1);
          EXPECT_FALSE(lane(open[p], l));
          continue;
        }
        const QueryRay<float> ray(o[k], d[k]);
        Closest<float> alone{INFINITY};
        find_closest(view, ray, true, alone);
        ASSERT_EQ(bits(lane(closest[p].t, l)), bits(alone.t));
        ASSERT_EQ(lane(closest[p].ids.instance, l), alone.ids.instance);
        ASSERT_EQ(lane(closest[p].ids.geometry, l), alone.ids.geometry);
        ASSERT_EQ(lane(closest[p].ids.primitive, l), alone.ids.primitive);
        const bool blocked = find_occluded(view, ray, true, 1.5f, true);
        ASSERT_EQ(lane(open[p], l), !blocked);
        hits += alone.ids.geometry >= 0, blocked_rays += blocked;
      }
    }
    EXPECT_GT(hits, 5000);
    EXPECT_GT(blocked_rays, 5000);
  }
}

TEST(Queries, OnlyATriangleThatNoRayMeetsIsPassedOver) {
  Random random(11);
  int hits = 0, passed_over = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3<float> o = cast<float>(random.point(3));
    Vec3<float> p[3];
    for (Vec3<float>& corner : p) corner = cast<float>(random.point(1));
    // Towards somewhere in the triangle's plane, now and then towards one of its corners.
    const double a = i % 7 ? random.number(-0.5, 1.5) : 1, b = i % 7 ? random.number(-0.5, 1.5) : 0;
    const Vec3<double> c = cast<double>(p[2]),
                       at = a * cast<double>(p[0]) + b * cast<double>(p[1]) + (1 - a - b) * c;
    const QueryRay<float> ray(o, cast<float>(normalize(at - cast<double>(o))));
    const bool may = may_meet_triangle(ray, p[0], p[1], p[2]), hit = meet_triangle(ray, p[0], p[1], p[2]).hit;
    EXPECT_TRUE(may || !hit);
    hits += hit, passed_over += !may;
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(passed_over, 1000);
}

TEST(Queries, NoRayIsLostBetweenTheTrianglesOfAClosedMesh) {
  // From inside a closed mesh every ray must hit, through vertices and along edges above all.
  for (const Vec3<double>& center : {Vec3<double>{}, Vec3<double>{100, -50, 7}}) {
    Scene scene;
    add_object(scene, ball(40, 1, center));
    const World world = build_world(scene);
    const Mesh& mesh = std::get<Mesh>(scene.shapes[0].primitives);
    Random random(9);
    long lost = 0, rays = 0;
    const auto shoot = [&](const Vec3<double>& o, const Vec3<double>& target) {
      Closest<float> hit{INFINITY};
      find_closest(world.view(), QueryRay<float>{cast<float>(o), cast<float>(normalize(target - o))}, true,
                   hit);
      lost += hit.ids.geometry < 0;
      ++rays;
    };
    for (int repeat = 0; repeat < 3; ++repeat) {
      const Vec3<double> o = center + random.point(0.4);
      for (const auto& triangle : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
          const auto a = cast<double>(mesh.vertices[triangle[k]]),
                     b = cast<double>(mesh.vertices[triangle[(k + 1) % 3]]);
          shoot(o, a);
          shoot(o, a + random.number(0, 1) * (b - a));
        }
    }
    EXPECT_EQ(lost, 0) << "of " << rays;
  }
}

TEST(Queries, NoRayIsLostInAGrid) {
  // A flat grid, rays straight down onto its vertices and edges.
  const int n = 300;
  Scene scene;
  Mesh mesh;
  Random random(3);
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x)
      mesh.vertices.push_back({x / float(n), y / float(n), float(0.02 * random.number(-1, 1))});
  for (std::uint32_t y = 0; y < n; ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  const auto vertices = mesh.vertices;
  add_object(scene, std::move(mesh));
  const World world = build_world(scene);
  long lost = 0;
  for (int y = 1; y < n; ++y)
    for (int x = 1; x < n; ++x) {
      const auto& v = vertices[std::size_t(y) * (n + 1) + x];
      for (const Vec3<float>& o : {Vec3<float>{v.x, v.y, 1}, Vec3<float>{(x + 0.5f) / n, v.y, 1},
                                   Vec3<float>{v.x, (y + 0.3f) / n, 1}}) {
        Closest<float> hit{INFINITY};
        find_closest(world.view(), QueryRay<float>{o, {0, 0, -1}}, true, hit);
        lost += hit.ids.geometry < 0;
      }
    }
  EXPECT_EQ(lost, 0);
}

/// Rays that leave surface points of every kind, on both sides and near the horizon too, must not hit the
/// primitive they leave.
TEST(Queries, NoRayHitsThePrimitiveItLeaves) {
  for (double spread : {0.0, 10.0, 1000.0, 1e6}) {
    RandomWorld in(unsigned(spread) + 20, spread);
    auto& [random, scene, world, view, middle] = in;
    long self_hits = 0, leaves = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec3<double> o = middle + random.point(2), d = random.direction();
      Closest<float> hit{INFINITY};
      find_closest(view, QueryRay<float>{cast<float>(o), cast<float>(d)}, true, hit);
      if (hit.ids.geometry < 0) continue;
      const SurfacePoint<double> s = surface_at(view, hit.ids, o, d, hit.t);
      const PrimitiveKind kind = view.geometries[hit.ids.geometry].kind;
      for (double side : {1.0, -1.0}) {
        const Vec3<double> n = side * s.Ng;
        const Vec3<double> tangent = normalize(cross(n, random.direction()));
        const Vec3<double> ways[] = {n, normalize(n + random.direction()), normalize(tangent + 1e-3 * n),
                                     normalize(tangent + 1e-6 * n)};
        for (const Vec3<double>& way : ways) {
          if (dot(way, n) <= 0) continue;
          ++leaves;
          const QueryRay<float> leaving{cast<float>(s.P + s.offset * n), cast<float>(way)};
          Closest<float> again{INFINITY};
          find_closest(view, leaving, true, again);
          const bool same = again.ids.instance == hit.ids.instance &&
                            again.ids.geometry == hit.ids.geometry &&
                            again.ids.primitive == hit.ids.primitive;
          // From inside a sphere or a cone the far side is a true hit: only a hit where the ray starts is a
          // false one.
          const bool curved = kind == PrimitiveKind::sphere || kind == PrimitiveKind::cone;
          self_hits += same && (!curved || side > 0);
        }
      }
    }
    EXPECT_EQ(self_hits, 0) << "of " << leaves << " at " << spread;
    EXPECT_GT(leaves, 50000);
  }
}

TEST(Queries, NoRayHitsAFlatPrimitiveThroughTheOrigin) {
  // Where a coordinate of the surface is 0 the rounding of float gives no offset, and P's own in double
  // decides.
  for (const Vec3<double>& normal : {Vec3<double>{0, 1, 0}, Vec3<double>{1, 0, 0},
                                     normalize(Vec3<double>{1, -1, 0}), normalize(Vec3<double>{1, 2, 3})}) {
    Scene scene;
    add_object(scene, std::vector<Plane>{{{0, 0, 0}, normal}});
    add_object(scene, std::vector<Disc>{{{0, 0, 0}, normal, 50}});
    const Vec3<double> a = normalize(cross(normal, Vec3<double>{0.3, 0.2, 0.9})), b = cross(normal, a);
    Mesh mesh;
    mesh.vertices = {cast<float>(-1000.0 * a), cast<float>(1000.0 * a - 500.0 * b),
                     cast<float>(500.0 * a + 1000.0 * b)};
    mesh.triangles = {{0, 1, 2}};
    add_object(scene, mesh);
    const World world = build_world(scene);
    Random random(31);
    for (int geometry = 0; geometry < 3; ++geometry) {
      long self_hits = 0;
      for (int i = 0; i < 20000; ++i) {
        const Vec3<double> o = random.number(0.5, 9) * normal + random.point(0.1),
                           target = std::pow(10, random.number(-9, 1)) *
                                    (random.number(-1, 1) * a + random.number(-1, 1) * b);
        const Vec3<double> d = normalize(target - o);
        const SurfacePoint<double> s = surface_at(world.view(), {-1, geometry, 0}, o, d, length(target - o));
        const double side = dot(s.Ng, d) < 0 ? 1 : -1;
        const Vec3<double> way = normalize(side * s.Ng + 0.999 * random.direction());
        const Meeting<float> again =
            meet(world.geometries[geometry], 0,
                 QueryRay<float>{cast<float>(s.P + side * s.offset * s.Ng), cast<float>(way)});
        self_hits += again.hit;
      }
      EXPECT_EQ(self_hits, 0) << "geometry " << geometry;
    }
  }
}

TEST(Queries, EqualDistanceGoesToTheLowestNumber) {
  Scene scene;
  add_object(scene, std::vector<Disc>{
                        {{0, 0, 0}, {0, 0, 1}, 1}, {{0, 0, 0}, {0, 0, 1}, 2}, {{0, 0, 0}, {0, 0, 1}, 3}});
  const World world = build_world(scene);
  for (double x : {0.5, 1.5, 2.5}) {
    Closest<float> hit{INFINITY};
    find_closest(world.view(), QueryRay<float>{{float(x), 0, 5}, {0, 0, -1}}, true, hit);
    EXPECT_EQ(hit.ids.primitive, int(x));
  }
}

TEST(Surface, PointAndNormalAreExact) {
  Scene scene;
  add_object(scene, std::vector<Sphere>{{{1, 2, 3}, 0.5}});
  add_object(scene, std::vector<Sphere>{{{0, 0, 0}, 1}},
             translation({10, 0, 0}) * scaling({1, 2, 1}));  // x^2 + (y/2)^2 + z^2 = 1
  add_object(scene, std::vector<Cone>{{{20, 0, 0}, {20, 2, 0}, 1, 0}});
  const World world = build_world(scene);
  const auto look = [&](const Vec3<double>& o, const Vec3<double>& d) {
    Closest<float> hit{INFINITY};
    find_closest(world.view(), QueryRay<float>{cast<float>(o), cast<float>(d)}, true, hit);
    EXPECT_GE(hit.ids.geometry, 0);
    return surface_at(world.view(), hit.ids, o, d, hit.t);
  };
  const Vec3<double> d{0, 0, -1};
  const auto sphere = look({1.3, 2, 9}, d);
  EXPECT_NEAR(sphere.P.z, 3 + std::sqrt(0.25 - 0.09), 1e-15);  // z = cz + sqrt(r^2 - dx^2)
  EXPECT_NEAR(sphere.N.x, 0.3 / 0.5, 1e-15);
  const auto ellipsoid = look({10, 1, 9}, d);
  EXPECT_NEAR(ellipsoid.P.z, std::sqrt(1 - 0.25), 1e-15);
  // gradient (0, 2y/4, 2z) at (0, 1, sqrt(3)/2)
  EXPECT_NEAR(length(ellipsoid.N - normalize(Vec3<double>{0, 0.5, std::sqrt(3.0)})), 0, 1e-15);
  const auto cone = look({20, 1, 9}, d);
  EXPECT_NEAR(cone.P.z, 0.5, 1e-15);                                           // radius 1 - y/2
  EXPECT_NEAR(length(cone.N - normalize(Vec3<double>{0, 0.5, 1})), 0, 1e-15);  // slope 1/2
}

TEST(Surface, AStretchedMeshIsTheSameShownOnceOrTwice) {
  // Shown once a mesh is taken into the world, shown twice it is placed by instances: one surface, two ways.
  Random random(77);
  const Transform stretch = rotation({0, 0, 1}, 30) * scaling({1, 5, -0.7});
  for (const bool clockwise : {false, true}) {
    Mesh mesh = ball(8, 0.5, {});
    if (clockwise)
      for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    Scene once, twice;
    add_object(once, mesh, stretch);
    add_object(twice, mesh, stretch);
    twice.objects.push_back({"", {}, 0, {0}, translation({100, 0, 0})});
    const World world_once = build_world(once), world_twice = build_world(twice);
    ASSERT_EQ(world_once.instances.size(), 0u);
    ASSERT_EQ(world_twice.instances.size(), 2u);
    int hits = 0, lifted = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vec3<double> o = 4.0 * random.direction(), d = normalize(random.point(0.4) - o);
      const auto look = [&](const World& world) {
        Closest<float> hit{INFINITY};
        find_closest(world.view(), QueryRay<float>{cast<float>(o), cast<float>(d)}, true, hit);
        return hit;
      };
      const auto a = look(world_once), b = look(world_twice);
      if (a.ids.geometry < 0 || a.ids.primitive != b.ids.primitive) continue;
      const auto sa = surface_at(world_once.view(), a.ids, o, d, a.t),
                 sb = surface_at(world_twice.view(), b.ids, o, d, b.t);
      EXPECT_NEAR(length(sa.N - sb.N), 0, 2e-5);  // the corners' normals are floats in the world or before it
      EXPECT_NEAR(length(sa.lift - sb.lift), 0, 2e-5);
      EXPECT_GE(dot(sb.N, sb.Ng), 0);
      ++hits;
      lifted += length(sb.lift) > 1e-3;
    }
    EXPECT_GT(hits, 300);
    EXPECT_GT(lifted, 100);  // on the side that the ray comes from, whichever way the mesh is wound
  }
}

}  // namespace
}  // namespace lambent
