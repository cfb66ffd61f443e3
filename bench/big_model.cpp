// What a big model costs before the first ray: reading an OBJ file against tinyobjloader's own parse, and
// building the tree against Embree's own build over the same triangles. All in one run, in turn, so that the
// ratios hold though the machine is not always equally fast.

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "embree_queries.h"
#include "import/model.h"
#include "integrators/prepare.h"
#include "lambent/lambent.h"

namespace lambent::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string file, json;
  int runs = 5;
};

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::size_t triangles_of(const Model& model) {
  std::size_t count = 0;
  for (const Shape& shape : model.shapes) count += primitive_count(shape);
  return count;
}

/// How many triangles tinyobjloader finds; polygons cut into triangles, as we do.
std::size_t read_with_tinyobj(const std::string& path) {
  tinyobj::ObjReaderConfig config;
  config.triangulate = true;
  tinyobj::ObjReader reader;
  if (!reader.ParseFromFile(path, config)) throw Failure("tinyobjloader: " + reader.Error());
  std::size_t count = 0;
  for (const tinyobj::shape_t& shape : reader.GetShapes()) count += shape.mesh.num_face_vertices.size();
  return count;
}

int run(const Options& options) {
  Json runs = Json::array();
  std::size_t triangles = 0;
  for (int i = 0; i < options.runs; ++i) {
    std::size_t ours = 0, theirs = 0;
    Json one;
    one["lambent_parse"] = seconds_of([&] { ours = triangles_of(import_model(options.file)); });
    one["tinyobj_parse"] = seconds_of([&] { theirs = read_with_tinyobj(options.file); });
    if (ours != theirs)
      throw Failure(fmt::format("Lambent finds {} triangles, tinyobjloader {}", ours, theirs));
    triangles = ours;
    runs.push_back(std::move(one));
  }

  // The model alone: the scene that is made for a model has a floor that Embree has no primitive for.
  const std::filesystem::path path(options.file);
  const ScenePtr scene = parse_scene(
      fmt::format(
          "lambent: 1\ncamera: {{eye: [0, 2, 4], target: [0, 0, 0]}}\n"
          "lights: [{{point: {{position: [3, 4, 4], intensity: 5}}}}]\nobjects: [{{mesh: {{file: {}}}}}]\n",
          path.filename().string()),
      (path.parent_path() / "big.yaml").string());
  const Bounds box = bounds(*scene);
  const double reach = 100 * std::max({max_abs(scene->camera.eye), max_abs(box.lower), max_abs(box.upper)});
  for (Json& one : runs) {
    std::unique_ptr<PreparedFrame> prepared;
    std::unique_ptr<EmbreeWorld> embree;
    one["lambent_build"] = seconds_of([&] { prepared = prepare(*scene); });
    one["embree_build"] =
        seconds_of([&] { embree = std::make_unique<EmbreeWorld>(prepared->world, true, reach); });
  }

  const Json json{{"file", options.file}, {"triangles", triangles}, {"runs", runs}};
  if (!options.json.empty()) {
    std::ofstream file(options.json);
    file << json.dump(1) << '\n';
    if (!file.flush()) throw Failure("cannot write " + options.json);
  }
  fmt::print("{}: {} triangles\n", options.file, triangles);
  for (const Json& one : runs)
    fmt::print("  parse: Lambent {:.3f} s, tinyobjloader {:.3f} s; tree: Lambent {:.3f} s, Embree {:.3f} s\n",
               one["lambent_parse"].get<double>(), one["tinyobj_parse"].get<double>(),
               one["lambent_build"].get<double>(), one["embree_build"].get<double>());
  return 0;
}

}  // namespace
}  // namespace lambent::bench

int main(int argc, char** argv) {
  lambent::bench::Options options;
  CLI::App app(
      "Measures reading a big OBJ file against tinyobjloader, and building its tree against Embree.");
  app.add_option("file", options.file, "OBJ file")->required();
  app.add_option("--runs", options.runs, "How often each is measured, in turn")->check(CLI::Range(1, 1000));
  app.add_option("--json", options.json, "Write everything to this file, too");
  CLI11_PARSE(app, argc, argv);
  try {
    return lambent::bench::run(options);
  } catch (const lambent::InputError& error) {
    for (const auto& diagnostic : error.diagnostics())
      fmt::print(stderr, "{}\n", lambent::to_string(diagnostic));
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "big_model: {}\n", error.what());
    return 1;
  }
}
