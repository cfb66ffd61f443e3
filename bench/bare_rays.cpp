// How much does a picture cost beyond the ray queries that it cannot do without?
//
// The renderer renders the scene once and is listened to; so we know exactly which rays it asks, tile by
// tile. Then, in turn, run by run: the renderer renders the picture (rays, shading, film), Embree answers the
// same rays and stores nothing but distances, in packets of every width, and our own queries do the same.

#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

#include "describe.h"
#include "embree_queries.h"
#include "film/film.h"
#include "integrators/kernels.h"
#include "integrators/prepare.h"
#include "lambent/lambent.h"
#include "own_queries.h"
#include "tiles.h"

namespace lambent::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string scene, only, isa, json;
  std::vector<std::string> set;
  int threads = std::max(1, int(std::thread::hardware_concurrency()));
  int runs = 5;
  bool few = false;
  int tile_size = RenderOptions{}.tile_size;
};

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// What is measured several times.
struct Times {
  std::vector<double> seconds;
  double median() const {
    std::vector<double> sorted = seconds;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t middle = sorted.size() / 2;
    return sorted.size() % 2 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
  }
  double min() const { return *std::min_element(seconds.begin(), seconds.end()); }
  Json json() const {
    return {{"median", median()},
            {"min", min()},
            {"max", *std::max_element(seconds.begin(), seconds.end())},
            {"all", seconds}};
  }
};

// ---- recording

/// What the clock of a frame covers: rays, shading, film, picture.
TileRun render_frame(const Scene& scene, const Frame& frame, const Kernel& kernel, int threads, int tile_size,
                     const std::function<bool(double)>& progress = {}) {
  Film film(scene.image, nullptr, threads);
  const TileRun run = render_tiles(frame, kernel, film, {threads, tile_size, progress});
  const Image image = develop(std::move(film), scene.image);
  if (image.width != scene.image.width) throw Failure("the picture has another size than was asked for");
  return run;
}

/// The renderer asks for one light after the other at each packet of hits. Packets of shadow rays do best
/// where neighbours go to the same light, so the bare queries get them sorted by light, tile by tile.
class Recorder {
 public:
  Recorder(const Frame& frame, RecordedRays& rays)
      : frame_(frame), rays_(rays), shadow_(std::size_t(frame.light_count)) {
    rays_.tiles.emplace_back();
  }
  void add(const AskedRay& ray) {
    if (ray.kind == RayKind::shadow) shadow_[light_of(ray)].push_back(ray);
    else (ray.kind == RayKind::eye ? rays_.tiles.back().eye : rays_.tiles.back().scattered).add(ray);
  }
  void end_tile() {
    for (std::vector<AskedRay>& list : shadow_) {
      for (const AskedRay& ray : list) rays_.tiles.back().shadow.add(ray);
      list.clear();
    }
    rays_.tiles.emplace_back();
  }

 private:
  /// Which light a shadow ray goes to: the one in its direction, or nearest to it, as rays start a little
  /// beside the point that is shaded. The light of the ray before, or one of the next, is it more often than
  /// not.
  std::size_t light_of(const AskedRay& ray) {
    const Vec3<double> o{ray.ox, ray.oy, ray.oz}, d{ray.dx, ray.dy, ray.dz};
    double best = -2;
    std::size_t nearest = light_;
    for (std::size_t tried = 0; tried < shadow_.size() && best < 1 - 1e-6; ++tried) {
      const std::size_t l = (light_ + tried) % shadow_.size();
      with_light(frame_.lights[l], [&](const auto& light) {
        if (const double along = dot(sample(light, o, 0.5, 0.5).L, d); along > best)
          best = along, nearest = l;
      });
    }
    return light_ = nearest;
  }

  const Frame& frame_;
  RecordedRays& rays_;
  std::size_t light_ = 0;
  std::vector<std::vector<AskedRay>> shadow_;  // of the tile at hand, light by light
};

RecordedRays record(const Scene& scene, const Frame& frame, const Kernel& kernel, int tile_size) {
  RecordedRays rays;
  Recorder recorder(frame, rays);
  const RayListener listener{&recorder,
                             [](void* self, const AskedRay& ray) { static_cast<Recorder*>(self)->add(ray); }};
  Frame heard = frame;
  heard.listener = &listener;
  // One thread: it reports progress after each tile.
  render_frame(scene, heard, kernel, 1, tile_size, [&](double) {
    recorder.end_tile();
    return true;
  });
  for (TileRays& tile : rays.tiles)
    for (RayList* list : {&tile.eye, &tile.scattered, &tile.shadow}) {
      list->blocks.shrink_to_fit();
      list->first_answer = rays.answers;
      rays.answers += list->blocks.size() * block_size;
    }
  for (const TileRays& tile : rays.tiles) {
    rays.eye += tile.eye.count;
    rays.scattered += tile.scattered.count;
    rays.shadow += tile.shadow.count;
  }
  return rays;
}

// ---- measuring

/// Calls ask(tile) for every tile; each thread takes the next that is left.
void for_every_tile(const RecordedRays& rays, int threads, const std::function<void(const TileRays&)>& ask) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    flush_denormals();
    for (std::size_t i; (i = next++) < rays.tiles.size();) ask(rays.tiles[i]);
  };
  std::vector<std::jthread> crew;
  for (int i = 0; i < threads; ++i) crew.emplace_back(work);
}

/// One way of answering the recorded rays.
struct Contender {
  Json description;
  bool robust = false, embree = false;
  int width = 0;
  std::function<void(const TileRays&, float*)> ask;
  Times times = {};
};

/// What a list of rays costs that is only read: the same loads and stores as a query, nothing between.
void ask_nothing(const RayList& rays, float* answers) {
  for (std::size_t b = 0; b < rays.blocks.size(); ++b) {
    const RayBlock& r = rays.blocks[b];
    for (int k = 0; k < block_size; ++k)
      answers[b * block_size + k] = r.ox[k] + r.oy[k] + r.oz[k] + r.dx[k] + r.dy[k] + r.dz[k] + r.t_far[k];
  }
}

/// Two lists of answers compared, over the same rays.
struct Agreement {
  std::uint64_t compared = 0, hits_of_lambent = 0, hits_of_embree = 0, other_hit = 0, other_distance = 0;

  void add(const RayList& rays, bool shadow, const Answers& lambent, const Answers& embree) {
    for (std::uint32_t i = 0; i < rays.count; ++i) {
      const float a = lambent[rays.first_answer + i], b = embree[rays.first_answer + i];
      const bool hit_a = shadow ? a < 0 : std::isfinite(a), hit_b = shadow ? b < 0 : std::isfinite(b);
      ++compared;
      hits_of_lambent += hit_a;
      hits_of_embree += hit_b;
      if (hit_a != hit_b) ++other_hit;
      else if (!shadow && hit_a && std::fabs(a - b) > 1e-4f * std::fabs(a)) ++other_distance;
    }
  }
  Json json() const {
    const double n = double(std::max<std::uint64_t>(compared, 1));
    return {{"rays", compared},
            {"hits_lambent", hits_of_lambent},
            {"hits_embree", hits_of_embree},
            {"share_hit_or_not_differs", double(other_hit) / n},
            {"share_distance_differs_by_1e-4", double(other_distance) / n}};
  }
};

// ---- memory

/// Bytes of what the picture needs: the vertices and indices that the scene holds, and what was built on
/// them.
Json sizes_of(const Scene& scene, const PreparedFrame& prepared) {
  Stats stats;
  describe(scene, prepared, stats);
  const auto& b = stats.bytes;
  return {{"vertices", b.vertices + b.normals + b.uvs},
          {"indices", b.indices},
          {"shapes", b.shapes + b.placed},
          {"tree", b.nodes + b.refs}};
}

/// The process' largest memory so far, or since forget_peak(). Linux tells it in /proc.
std::uint64_t peak_memory_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
  return 0;
}
void forget_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

// ---- the two modes

/// How far the planes of Embree's world must extend: a hundred times as far as anything else lies.
double reach_of(const Scene& scene) {
  const Bounds box = bounds(scene);
  double reach = max_abs(scene.camera.eye);
  if (!box.empty()) reach = std::max({reach, max_abs(box.lower), max_abs(box.upper)});
  return 100 * std::max(reach, 1.0);
}

Json measure_memory(const Scene& scene, const Options& options) {
  auto prepared = prepare(scene);
  Json json{{"scene", options.scene}, {"only", options.only}};
  json["bytes"] = sizes_of(scene, *prepared);
  if (options.only == "lambent") {
    render_frame(scene, prepared->frame, choose_kernel(options.isa), options.threads, options.tile_size);
  } else {
    // Of our world Embree needs the primitives only.
    prepared->world.nodes = {};
    prepared->world.refs = {};
    prepared->world.leaf_spheres = {};
    forget_peak();
    const EmbreeWorld world(prepared->world, true, reach_of(scene));
    json["peak_memory_bytes"] = peak_memory_bytes();
    return json;
  }
  json["peak_memory_bytes"] = peak_memory_bytes();
  return json;
}

std::vector<Contender> contenders(const EmbreeWorld& fast, const EmbreeWorld& robust, const OwnQueries& own,
                                  const WorldView& world, bool any_scattered, bool few) {
  std::vector<Contender> all;
  for (const bool is_robust : {true, false})
    for (const int width : {1, 4, 8, 16})
      for (const bool coherent : {true, false})
        for (const bool scattered_in_packets : {false, true}) {
          if (few && (width < 8 || !coherent)) continue;
          if (scattered_in_packets && (width == 1 || !any_scattered)) continue;
          const Variant variant{width, coherent, scattered_in_packets};
          const EmbreeWorld& embree = is_robust ? robust : fast;
          Json description{{"width", width}, {"robust", is_robust}, {"coherent", coherent}};
          description["scattered"] = scattered_in_packets ? "packets" : "single";
          all.push_back(
              {description, is_robust, true, width,
               [&embree, variant](const TileRays& rays, float* to) { embree.ask(rays, variant, to); }});
        }
  all.push_back(
      {Json{{"queries", "lambent"}, {"isa", own.isa}}, true, false, 0,
       [&own, world](const TileRays& rays, float* to) {
         own.closest(world, rays.eye.blocks.data(), rays.eye.count, true, to + rays.eye.first_answer);
         own.closest(world, rays.scattered.blocks.data(), rays.scattered.count, false,
                     to + rays.scattered.first_answer);
         own.occluded(world, rays.shadow.blocks.data(), rays.shadow.count, to + rays.shadow.first_answer);
       }});
  all.push_back({Json{{"queries", "none"}}, false, false, 0, [](const TileRays& rays, float* to) {
                   ask_nothing(rays.eye, to + rays.eye.first_answer);
                   ask_nothing(rays.scattered, to + rays.scattered.first_answer);
                   ask_nothing(rays.shadow, to + rays.shadow.first_answer);
                 }});
  return all;
}

const Contender* fastest(const std::vector<Contender>& all, bool robust) {
  const Contender* best = nullptr;
  for (const Contender& c : all)
    if (c.embree && c.robust == robust && (!best || c.times.median() < best->times.median())) best = &c;
  return best;
}

Json described(const Contender& c) {
  Json json = c.description;
  json["seconds"] = c.times.json();
  return json;
}

Json measure_time(const Scene& scene, const Options& options) {
  const Kernel& kernel = choose_kernel(options.isa);
  std::unique_ptr<PreparedFrame> prepared;
  const double build = seconds_of([&] { prepared = prepare(scene); });
  if (prepared->frame.any_transmits && prepared->frame.whitted.colored_shadows)
    throw Failure(
        "shadow rays through transmitting surfaces ask more than one query; "
        "add --set integrator.whitted.colored_shadows=false");

  const double reach = reach_of(scene);
  std::unique_ptr<EmbreeWorld> fast, robust;
  const double embree_build =
      seconds_of([&] { robust = std::make_unique<EmbreeWorld>(prepared->world, true, reach); });
  fast = std::make_unique<EmbreeWorld>(prepared->world, false, reach);

  const RecordedRays rays = record(scene, prepared->frame, kernel, options.tile_size);
  const OwnQueries& own = own_queries(kernel.isa);
  std::vector<Contender> all =
      contenders(*fast, *robust, own, prepared->frame.world, rays.scattered > 0, options.few);

  Answers answers(rays.answers), answers_of_lambent(rays.answers);
  const auto run = [&](const Contender& c, Answers& to) {
    for_every_tile(rays, options.threads, [&](const TileRays& tile) { c.ask(tile, to.data()); });
  };
  Times lambent;
  TileRun rendered;
  constexpr double hopeless = 1.4;  // after two runs, what is so much slower than the fastest is let go
  for (int i = 0; i < options.runs; ++i) {
    lambent.seconds.push_back(seconds_of([&] {
      rendered = render_frame(scene, prepared->frame, kernel, options.threads, options.tile_size);
    }));
    std::vector<Contender*> still;
    for (Contender& c : all)
      if (i < 2 || !c.embree || c.times.min() < hopeless * fastest(all, c.robust)->times.min())
        still.push_back(&c);
    for (Contender* c : still) c->times.seconds.push_back(seconds_of([&] { run(*c, answers); }));
  }

  const Contender &best_robust = *fastest(all, true), &best = *fastest(all, false);
  run(best_robust, answers);
  for (const Contender& c : all)
    if (c.description.contains("isa")) run(c, answers_of_lambent);
  Agreement closest, shadow;
  for (const TileRays& tile : rays.tiles) {
    closest.add(tile.eye, false, answers_of_lambent, answers);
    closest.add(tile.scattered, false, answers_of_lambent, answers);
    shadow.add(tile.shadow, true, answers_of_lambent, answers);
  }

  Json json{
      {"scene", options.scene}, {"threads", options.threads}, {"isa", kernel.isa}, {"runs", options.runs}};
  json["pixels"] = std::int64_t(prepared->frame.width) * prepared->frame.height;
  json["samples"] = prepared->frame.samples;
  json["rays"] = {{"eye", rays.eye},
                  {"eye_hits", rendered.counts.eye_hits},
                  {"scattered", rays.scattered},
                  {"shadow", rays.shadow}};
  json["bytes"] = sizes_of(scene, *prepared);
  json["lambent"] = {{"build_seconds", build}, {"seconds", lambent.json()}};
  json["embree"] = {{"version", EmbreeWorld::version()},
                    {"build_seconds", embree_build},
                    {"native_packets_up_to", EmbreeWorld::widest_native_packet()}};
  for (const Contender& c : all) {
    if (c.embree) json["embree"]["variants"].push_back(described(c));
    else if (c.description.contains("isa")) json["own_queries"] = described(c);
    else json["reading_only"] = described(c);
  }
  json["bare_robust"] = described(best_robust);
  json["bare"] = described(best);
  json["ratio_to_bare_robust"] = lambent.median() / best_robust.times.median();
  json["ratio_to_bare"] = lambent.median() / best.times.median();
  json["agreement"] = {{"closest", closest.json()}, {"shadow", shadow.json()}};
  return json;
}

// ---- for people

void print_table(const Json& json) {
  const auto line = [](const std::string& what, const Json& seconds) {
    fmt::print("  {:<52} {:8.4f} s   {:.4f} to {:.4f}, {} runs\n", what, seconds["median"].get<double>(),
               seconds["min"].get<double>(), seconds["max"].get<double>(), seconds["all"].size());
  };
  const Json& rays = json["rays"];
  fmt::print("{}: {} eye, {} scattered, {} shadow rays; {} threads, {}\n", json["scene"].get<std::string>(),
             rays["eye"].get<std::uint64_t>(), rays["scattered"].get<std::uint64_t>(),
             rays["shadow"].get<std::uint64_t>(), json["threads"].get<int>(), json["isa"].get<std::string>());
  line("Lambent, the whole frame", json["lambent"]["seconds"]);
  line("Lambent's queries alone", json["own_queries"]["seconds"]);
  line("reading the rays alone", json["reading_only"]["seconds"]);
  for (const Json& v : json["embree"]["variants"])
    line(fmt::format("Embree, {:2} wide{}{}{}", v["width"].get<int>(),
                     v["robust"].get<bool>() ? ", robust" : "", v["coherent"].get<bool>() ? ", coherent" : "",
                     v["scattered"] == "packets" ? ", scattered in packets" : ""),
         v["seconds"]);
  fmt::print("  frame / fastest robust Embree {:.3f}, / fastest Embree {:.3f}\n",
             json["ratio_to_bare_robust"].get<double>(), json["ratio_to_bare"].get<double>());
  for (const char* kind : {"closest", "shadow"}) {
    const Json& a = json["agreement"][kind];
    fmt::print(
        "  {}: hits {} and {} of {}; share of rays that differ in hit or not {:.2g}, in distance {:.2g}\n",
        kind, a["hits_lambent"].get<std::uint64_t>(), a["hits_embree"].get<std::uint64_t>(),
        a["rays"].get<std::uint64_t>(), a["share_hit_or_not_differs"].get<double>(),
        a["share_distance_differs_by_1e-4"].get<double>());
  }
  fmt::print("  building: Lambent {:.3f} s, Embree {:.3f} s\n",
             json["lambent"]["build_seconds"].get<double>(), json["embree"]["build_seconds"].get<double>());
}

int run(const Options& options) {
  LoadOptions load;
  for (const std::string& setting : options.set) {
    const auto equals = setting.find('=');
    if (equals == std::string::npos) throw Failure("--set wants path.to.key=value, not '" + setting + "'");
    load.set.emplace_back(setting.substr(0, equals), setting.substr(equals + 1));
  }
  const ScenePtr scene = load_scene(options.scene, load);
  const Json json = options.only.empty() ? measure_time(*scene, options) : measure_memory(*scene, options);
  if (!options.json.empty()) {
    std::ofstream file(options.json);
    file << json.dump(1) << '\n';
    if (!file.flush()) throw Failure("cannot write " + options.json);
  }
  if (options.only.empty()) print_table(json);
  else fmt::print("{}\n", json.dump(1));
  return 0;
}

}  // namespace
}  // namespace lambent::bench

int main(int argc, char** argv) {
  lambent::bench::Options options;
  CLI::App app("Measures the renderer against the bare queries of the same rays.");
  app.add_option("scene", options.scene, "Scene or model file")->required();
  app.add_option("--set", options.set, "path.to.key=value, as in lambent render");
  app.add_option("--runs", options.runs, "How often each is measured, in turn")->check(CLI::Range(1, 1000));
  app.add_flag("--few", options.few, "Only the variants of Embree that tend to win: 8 and 16 wide, coherent");
  app.add_option("--threads", options.threads, "Threads")->check(CLI::Range(1, 1024));
  app.add_option("--tile", options.tile_size, "Tile size in pixels")->check(CLI::Range(1, 65536));
  app.add_option("--isa", options.isa, "Instruction set of the renderer's kernels; the best if not given");
  app.add_option("--only", options.only, "Measure the memory of this side alone")
      ->check(CLI::IsMember({"lambent", "embree"}));
  app.add_option("--json", options.json, "Write everything to this file, too");
  CLI11_PARSE(app, argc, argv);
  try {
    return lambent::bench::run(options);
  } catch (const lambent::InputError& error) {
    for (const auto& diagnostic : error.diagnostics())
      fmt::print(stderr, "{}\n", lambent::to_string(diagnostic));
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "bare_rays: {}\n", error.what());
    return 1;
  }
}
