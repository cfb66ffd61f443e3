#include "import/gltf_scene.h"

#include <algorithm>
#include <cmath>

#include "import/text_file.h"

namespace lambent::gltf {

namespace {

constexpr double degrees_per_radian = 180 / pi;

/// The scene's nodes that are seen, parents before their children.
std::vector<std::size_t> nodes_of_scene(const Json& root, Remarks& remarks) {
  const Json &nodes = member(root, "nodes"), &scenes = member(root, "scenes");
  std::vector<std::size_t> ready;
  if (!scenes.is_null()) {
    for (const Json& node : member(scenes[whole(root, "scene", 0)], "nodes"))
      ready.push_back(node.get<std::size_t>());
    if (scenes.size() > 1 && member(root, "scene").is_null())
      remarks.warn("/scenes", "the file does not say which of its " + std::to_string(scenes.size()) +
                                  " scenes to show; it is the first");
  } else {
    std::vector<char> is_child(nodes.size(), 0);
    for (const Json& node : nodes)
      for (const Json& child : member(node, "children")) is_child[child.get<std::size_t>()] = 1;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (is_child[i] == 0) ready.push_back(i);
  }
  std::vector<std::size_t> result;
  std::reverse(ready.begin(), ready.end());
  while (!ready.empty()) {
    const std::size_t node = ready.back();
    ready.pop_back();
    if (!flag(extension(nodes[node], "KHR_node_visibility"), "visible", true)) continue;
    result.push_back(node);
    const Json& children = member(nodes[node], "children");
    for (auto child = children.rbegin(); child != children.rend(); ++child)
      ready.push_back(child->get<std::size_t>());
  }
  return result;
}

class SceneReader {
 public:
  SceneReader(const Json& root, Buffers& buffers, const ImportOptions& options, Materials& materials,
              Remarks& remarks, Model& model)
      : root_(root),
        buffers_(buffers),
        remarks_(remarks),
        model_(model),
        pose_(make_pose(root, buffers, options.time, remarks)),
        meshes_(root, buffers, options, pose_, materials, remarks, model) {}

  void read() {
    const Json& nodes = member(root_, "nodes");
    const std::vector<std::size_t> shown = nodes_of_scene(root_, remarks_);
    for (const std::size_t node : shown)
      if (const Json& mesh = member(nodes[node], "mesh"); !mesh.is_null())
        add_bounds(mesh.get<std::size_t>(), pose_.world_from_node[node]);
    if (nodes.is_null()) return library();
    set_size();
    for (const std::size_t node : shown) objects(node);
    for (const std::size_t node : shown) {
      camera(node);
      light(node);
    }
    if (model_.objects.empty()) {
      model_.shapes.clear();  // shapes without any object would all be shown
      remarks_.warn("", "the scene shows nothing");
    }
  }

 private:
  /// A file without nodes: its meshes as they are.
  void library() {
    const Json& meshes = member(root_, "meshes");
    for (std::size_t i = 0; i < meshes.size(); ++i) add_bounds(i, {});
    set_size();
    for (std::size_t i = 0; i < meshes.size(); ++i)
      for (const Meshes::Part& part : meshes_.of_mesh(i))
        model_.objects.push_back({model_.shapes[part.shape].name, part.shape, {}});
    if (model_.objects.empty()) remarks_.warn("", "the file shows nothing");
    else remarks_.warn("", "the file has no scene; all of its meshes are shown");
  }

  /// By what the accessors of positions say of themselves.
  void add_bounds(std::size_t mesh, const Transform& world_from_object) {
    for (const Json& primitive : root_["meshes"][mesh]["primitives"]) {
      const Json& index = member(primitive["attributes"], "POSITION");
      if (index.is_null()) continue;
      const Json &accessor = root_["accessors"][index.get<std::size_t>()], &low = accessor["min"],
                 &high = accessor["max"];
      double unit = 1;
      if (flag(accessor, "normalized", false)) {
        const int type = int(whole(accessor, "componentType", 5126));
        unit = type == 5120 ? 127 : type == 5121 ? 255 : type == 5122 ? 32767 : 65535;
      }
      for (int corner = 0; corner < 8; ++corner) {
        const auto at = [&](int axis) {
          return (corner >> axis & 1 ? high : low)[std::size_t(axis)].get<double>() / unit;
        };
        bounds_.add(transform_point(world_from_object, {at(0), at(1), at(2)}));
      }
    }
  }

  void set_size() {
    const double diagonal = bounds_.empty() ? 1 : length(bounds_.upper - bounds_.lower);
    meshes_.set_size(std::isfinite(diagonal) ? std::max(diagonal, 1e-3) : 1);
  }

  std::string name_of(std::size_t node) const { return name_in(root_["nodes"][node]); }

  void objects(std::size_t number) {
    const Json& node = root_["nodes"][number];
    if (member(node, "mesh").is_null()) return;
    const Transform& world = pose_.world_from_node[number];
    const double volume = determinant(world);
    const bool flat = volume == 0 || !std::isfinite(1 / volume) || !std::isfinite(volume);
    bool left_out = false;
    // A flat node still shows a mesh whose skin places it.
    if (flat && member(node, "skin").is_null()) left_out = true;
    else
      for (const Meshes::Part& part : meshes_.of_node(number)) {
        if (flat && !part.in_world) {
          left_out = true;
          continue;
        }
        // Many nodes times many parts: an object takes more memory than the bytes that name a node.
        constexpr std::uint64_t harmless = 1 << 16;
        if (model_.objects.size() > harmless && model_.objects.size() > buffers_.total())
          remarks_.fail(std::string("/nodes") / number,
                        "the scene shows more objects than its file has bytes");
        const std::string name = name_of(number);
        model_.objects.push_back({name.empty() ? model_.shapes[part.shape].name : name, part.shape,
                                  part.in_world ? Transform{} : world});
      }
    if (left_out)
      remarks_.warn(std::string("/nodes") / number,
                    "its transform leaves nothing of a volume; what it shows is left out");
  }

  static bool is_in_reach(const Vec3<double>& p) {
    return max_abs(p) <= largest_coordinate && p.x == p.x && p.y == p.y && p.z == p.z;
  }

  /// The direction in which a node looks, and what is up for it; false where its transform leaves none.
  bool directions(std::size_t number, Vec3<double>& forward, Vec3<double>& up) {
    const Transform& world = pose_.world_from_node[number];
    const double depth = length(world.z), height = length(world.y);
    if (!is_in_reach(world.translation) || !(depth > 0) || !(height > 0) || !std::isfinite(depth) ||
        !std::isfinite(height) || !(length(cross(world.z, world.y)) > 1e-9 * depth * height))
      return false;
    forward = (-1 / depth) * world.z;
    up = (1 / height) * world.y;
    return true;
  }

  void camera(std::size_t number) {
    const Json& index = member(root_["nodes"][number], "camera");
    if (index.is_null()) return;
    const Json& json = root_["cameras"][index.get<std::size_t>()];
    const std::string at = std::string("/cameras") / index.get<std::size_t>();
    NamedCamera result;
    result.name = name_in(json);
    if (result.name.empty()) result.name = name_of(number);
    Camera& camera = result.camera;
    Vec3<double> forward;
    if (!directions(number, forward, camera.up))
      return remarks_.warn(std::string("/nodes") / number,
                           "its transform leaves the camera no place or direction; it is left out");
    camera.eye = pose_.world_from_node[number].translation;
    camera.target = camera.eye + viewing_distance(camera.eye, forward) * forward;
    if (text(json, "type") == "orthographic") {
      camera.projection = Projection::orthographic;
      camera.height = 2 * std::abs(number_of(json["orthographic"], "ymag"));
    } else {
      const double fov = degrees_per_radian * number_of(json["perspective"], "yfov");
      camera.fov = std::clamp(fov, 0.01, 179.0);
      if (camera.fov != fov)
        remarks_.warn(at + "/perspective/yfov", "is beyond what a camera can see; it is brought to " +
                                                    Json(camera.fov).dump() + " degrees");
    }
    model_.cameras.push_back(std::move(result));
  }
  static double number_of(const Json& json, const char* key) { return number(json, key, 1); }

  /// As far as the middle of what is shown, if that lies ahead.
  double viewing_distance(const Vec3<double>& eye, const Vec3<double>& forward) const {
    if (bounds_.empty()) return 1;
    const double radius = 0.5 * length(bounds_.upper - bounds_.lower);
    const double ahead = dot(0.5 * (bounds_.lower + bounds_.upper) - eye, forward);
    const double distance = ahead > 0.1 * radius ? ahead : radius;
    return std::isfinite(distance) && distance > 0 ? distance : 1;
  }

  void light(std::size_t number) {
    const Json& index = member(extension(root_["nodes"][number], "KHR_lights_punctual"), "light");
    if (index.is_null()) return;
    const Json& json = extension(root_, "KHR_lights_punctual")["lights"][index.get<std::size_t>()];
    Light result;
    result.place.file = remarks_.file();
    result.name = name_in(json);
    if (result.name.empty()) result.name = name_of(number);
    if (result.name.empty()) result.name = "light " + std::to_string(model_.lights.size() + 1);
    result.name = light_names_(result.name);
    Rgb color{{1, 1, 1}};
    if (const Json& given = member(json, "color"); !given.is_null())
      for (int i = 0; i < 3; ++i) color[i] = given[std::size_t(i)].get<double>();
    // A white Lambert surface sends back 1/pi of the light that falls on it, and here Il itself.
    const double intensity = gltf::number(json, "intensity", 1) / pi, range = gltf::number(json, "range", 0);
    const Vec3<double> position = pose_.world_from_node[number].translation;
    const std::string type = text(json, "type");
    Vec3<double> forward, up;
    if (type == "point" ? !is_in_reach(position) : !directions(number, forward, up))
      return remarks_.warn(std::string("/nodes") / number,
                           "its transform leaves the light no place or direction; it is left out");
    if (type == "point") {
      PointLight light;
      light.position = position, light.color = color, light.intensity = intensity, light.max_distance = range;
      result.light = light;
    } else if (type == "directional") {
      DirectionalLight light;
      light.direction = forward, light.color = color, light.intensity = intensity;
      result.light = light;
    } else {
      const Json& cone = json["spot"];
      const double outer = gltf::number(cone, "outerConeAngle", pi / 4),
                   inner = gltf::number(cone, "innerConeAngle", 0);
      SpotLight light;
      light.position = position, light.target = position + forward;
      light.color = color, light.intensity = intensity, light.max_distance = range;
      light.angle = std::clamp(2 * degrees_per_radian * outer, 0.01, 180.0);
      light.softness = std::clamp(1 - inner / outer, 0.0, 1.0);
      result.light = light;
    }
    model_.lights.push_back(std::move(result));
  }

  const Json& root_;
  Buffers& buffers_;
  Remarks& remarks_;
  Model& model_;
  Pose pose_;
  Meshes meshes_;
  Bounds bounds_;
  UniqueNames light_names_;
};

}  // namespace

void read_scene(const Json& root, Buffers& buffers, const ImportOptions& options, Materials& materials,
                Remarks& remarks, Model& model) {
  SceneReader(root, buffers, options, materials, remarks, model).read();
}

}  // namespace lambent::gltf
