// The kernels' parts, one by one: what an illumination model, a power, a ray query takes.
//
//   kernels_bench [--isa NAME] [options of Google Benchmark]
//   kernels_bench [--isa NAME] --count PART STEPS     works off so many steps of one part, for counting
//   instructions kernels_bench [--isa NAME] --list                 the parts and their lanes

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string_view>

#include "compiled_sets.h"
#include "integrators/kernels.h"
#include "lambent/diagnostics.h"
#include "measured.h"
#include "own_queries.h"

LAMBENT_COMPILED_SETS(const bench::MeasuredKernel, bench_measured)

namespace lambent {
namespace bench {
namespace {

/// Something that can be measured: `lanes` numbers or rays for each step.
struct Part {
  std::string name;
  int lanes;
  std::function<void(std::uint64_t steps)> run;
};

/// A hilly ground of 2 * 256 * 256 triangles with a thousand balls above it.
Scene ground_with_balls() {
  constexpr int cells = 256;
  Mesh ground;
  for (int i = 0; i <= cells; ++i)
    for (int j = 0; j <= cells; ++j) {
      const double x = i / 16.0 - 8, y = j / 16.0 - 8;
      ground.vertices.push_back({float(x), float(y), float(0.3 * std::sin(x) * std::cos(1.3 * y))});
    }
  for (unsigned i = 0; i < cells; ++i)
    for (unsigned j = 0; j < cells; ++j) {
      const unsigned a = i * (cells + 1) + j, b = a + cells + 1;
      ground.triangles.push_back({a, b, b + 1});
      ground.triangles.push_back({a, b + 1, a + 1});
    }
  std::vector<Sphere> balls;
  for (int i = 0; i < 1000; ++i) balls.push_back({{i % 40 * 0.4 - 8, i / 40 * 0.64 - 8, 0.6}, 0.15});
  Scene scene;
  scene.materials.emplace_back();
  scene.shapes.push_back({"ground", std::move(ground), {}});
  scene.shapes.push_back({"balls", std::move(balls), {}});
  for (std::uint32_t shape : {0u, 1u}) {
    Object object;
    object.shape = shape;
    object.materials = {0};
    scene.objects.push_back(object);
  }
  return scene;
}

/// Eye rays of a picture of that scene, 256 x 256, row by row; and the ways from its ground to a light.
struct QueryInput {
  Scene scene = ground_with_balls();
  World world = build_world(scene);
  RayList eye, shadow;

  QueryInput() {
    for (int y = 0; y < 256; ++y)
      for (int x = 0; x < 256; ++x) {
        const Vec3<double> d = normalize(Vec3<double>{(x - 128) / 256.0, (y - 128) / 256.0, -1.0});
        eye.add({0, 0, 8, float(d.x), float(d.y), float(d.z), std::numeric_limits<float>::infinity(),
                 RayKind::eye});
        const Vec3<double> from{x / 32.0 - 4, y / 32.0 - 4, 0.31}, way = Vec3<double>{3, 4, 9} - from;
        const Vec3<double> l = normalize(way);
        shadow.add({float(from.x), float(from.y), float(from.z), float(l.x), float(l.y), float(l.z),
                    float(length(way)), RayKind::shadow});
      }
  }
};

constexpr int rays_of_a_step = 256 * 256;
/// Made when it is first asked for, and not while a clock runs.
const QueryInput& query_input() {
  static const QueryInput input;
  return input;
}

/// One step of a query answers all rays of the input.
Part query_part(const std::string& name, std::function<void(const QueryInput&, float* answers)> ask) {
  return {name, rays_of_a_step, [ask = std::move(ask)](std::uint64_t steps) {
            std::vector<float> answers(rays_of_a_step);
            for (std::uint64_t i = 0; i < steps; ++i) ask(query_input(), answers.data());
            benchmark::DoNotOptimize(answers.data());
          }};
}

std::vector<Part> parts_of(const std::string& isa) {
  std::vector<Part> parts;
  const auto& kernel = compiled_for<MeasuredKernel>(isa, LAMBENT_ALL_COMPILED(bench_measured));
  for (int i = 0; i < kernel.count; ++i)
    parts.push_back({kernel.pieces[i].name, kernel.pieces[i].lanes, kernel.pieces[i].run});
  const OwnQueries& own = own_queries(isa);
  for (const bool packets : {false, true})
    parts.push_back(query_part(
        packets ? "closest/packet" : "closest/number", [&own, packets](const QueryInput& input, float* to) {
          own.closest(input.world.view(), input.eye.blocks.data(), input.eye.count, packets, to);
        }));
  parts.push_back(query_part("occluded/packet", [&own](const QueryInput& input, float* to) {
    own.occluded(input.world.view(), input.shadow.blocks.data(), input.shadow.count, to);
  }));
  return parts;
}

void measure(benchmark::State& state, const Part& part) {
  part.run(1);
  // Enough steps at a time that the loop around them does not count.
  const std::uint64_t steps = part.lanes == rays_of_a_step ? 1 : 4096;
  for (auto _ : state) part.run(steps);
  state.counters["per_lane"] =
      benchmark::Counter(double(steps) * part.lanes,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

int run(int argc, char** argv) {
  std::string isa, counted;
  std::uint64_t steps = 0;
  bool list = false;
  std::vector<char*> others{argv[0]};
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--isa" && i + 1 < argc) isa = argv[++i];
    else if (argument == "--list") list = true;
    else if (argument == "--count" && i + 2 < argc)
      counted = argv[i + 1], steps = std::stoull(argv[i + 2]), i += 2;
    else others.push_back(argv[i]);
  }
  const std::string name = choose_kernel(isa).isa;
  const std::vector<Part> parts = parts_of(name);
  if (list)
    for (const Part& part : parts) fmt::print("{} {}\n", part.name, part.lanes);
  if (!counted.empty()) {
    for (const Part& part : parts)
      if (part.name == counted) return part.run(steps), 0;
    throw Failure("there is no part '" + counted + "'; --list names them");
  }
  if (list) return 0;

  int count = int(others.size());
  benchmark::Initialize(&count, others.data());
  if (benchmark::ReportUnrecognizedArguments(count, others.data())) return 2;
  benchmark::AddCustomContext("isa", name);
  for (const Part& part : parts)
    benchmark::RegisterBenchmark(part.name.c_str(), [&part](benchmark::State& state) {
      measure(state, part);
    })->Unit(benchmark::kMicrosecond);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace bench
}  // namespace lambent

int main(int argc, char** argv) {
  try {
    return lambent::bench::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "kernels_bench: {}\n", error.what());
    return 2;
  }
}
