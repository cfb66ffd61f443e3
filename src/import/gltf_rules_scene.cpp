#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "import/gltf_rules.h"
#include "import/text_file.h"

namespace lambent::gltf {

namespace {

/// The formats that an attribute may have: "VEC3 of FLOAT", as name_of_format() says them, between commas;
/// and further ones with KHR_mesh_quantization.
struct Formats {
  const char* plain;
  const char* quantized;
};
#define LAMBENT_UNORM(vec) vec " of normalized UNSIGNED_BYTE," vec " of normalized UNSIGNED_SHORT"
#define LAMBENT_SNORM(vec) vec " of normalized BYTE," vec " of normalized SHORT"
#define LAMBENT_INTEGERS(vec) \
  vec " of BYTE," vec " of UNSIGNED_BYTE," vec " of SHORT," vec " of UNSIGNED_SHORT"
constexpr Formats position_formats{
    "VEC3 of FLOAT", LAMBENT_UNORM("VEC3") "," LAMBENT_SNORM("VEC3") "," LAMBENT_INTEGERS("VEC3")};
constexpr Formats normal_formats{"VEC3 of FLOAT", LAMBENT_SNORM("VEC3")};
constexpr Formats tangent_formats{"VEC4 of FLOAT", LAMBENT_SNORM("VEC4")};
constexpr Formats uv_formats{"VEC2 of FLOAT," LAMBENT_UNORM("VEC2"),
                             LAMBENT_SNORM("VEC2") "," LAMBENT_INTEGERS("VEC2")};
constexpr Formats color_formats{
    "VEC3 of FLOAT,VEC4 of FLOAT," LAMBENT_UNORM("VEC3") "," LAMBENT_UNORM("VEC4"), ""};
constexpr Formats joint_formats{"VEC4 of UNSIGNED_BYTE,VEC4 of UNSIGNED_SHORT", ""};
constexpr Formats weight_formats{"VEC4 of FLOAT," LAMBENT_UNORM("VEC4"), ""};
constexpr Formats index_formats{"SCALAR of UNSIGNED_BYTE,SCALAR of UNSIGNED_SHORT,SCALAR of UNSIGNED_INT",
                                ""};
constexpr Formats matrix_formats{"MAT4 of FLOAT", ""};
constexpr Formats time_formats{"SCALAR of FLOAT", ""};
constexpr Formats vector_formats{"VEC3 of FLOAT", ""};
constexpr Formats rotation_formats{"VEC4 of FLOAT," LAMBENT_UNORM("VEC4") "," LAMBENT_SNORM("VEC4"), ""};
constexpr Formats scalar_formats{"SCALAR of FLOAT," LAMBENT_UNORM("SCALAR") "," LAMBENT_SNORM("SCALAR"), ""};
#undef LAMBENT_UNORM
#undef LAMBENT_SNORM
#undef LAMBENT_INTEGERS

bool is_listed(const char* formats, const std::string& format) {
  return ("," + std::string(formats) + ",").find("," + format + ",") != std::string::npos;
}

/// "TEXCOORD" of TEXCOORD_3, whose number is then 3; the whole name where it has none.
std::string without_number(const std::string& name, int& number) {
  const std::size_t line = name.rfind('_');
  number = -1;
  if (line == std::string::npos || line + 1 == name.size() || line + 4 < name.size()) return name;
  if (!std::all_of(name.begin() + std::ptrdiff_t(line) + 1, name.end(),
                   [](char c) { return c >= '0' && c <= '9'; }))
    return name;
  number = std::stoi(name.substr(line + 1));
  return name.substr(0, line);
}

const Formats* formats_of(const std::string& attribute, bool of_target) {
  int number = -1;
  const std::string name = without_number(attribute, number);
  if (number < 0)
    return name == "POSITION"  ? &position_formats
           : name == "NORMAL"  ? &normal_formats
           : name == "TANGENT" ? (of_target ? &normal_formats : &tangent_formats)
                               : nullptr;
  if (name == "TEXCOORD") return &uv_formats;
  if (name == "COLOR") return &color_formats;
  if (of_target) return nullptr;
  return name == "JOINTS" ? &joint_formats : name == "WEIGHTS" ? &weight_formats : nullptr;
}

class SceneRules {
 public:
  SceneRules(const Json& root, Remarks& remarks)
      : root_(root), remarks_(remarks), quantized_(is_used(root, "KHR_mesh_quantization")) {}

  void check() {
    const auto each = [&](const char* list, auto what) {
      const Json& all = member(root_, list);
      for (std::size_t i = 0; i < all.size(); ++i) what(all[i], ("/" + std::string(list)) / i);
    };
    each("meshes", [&](const Json& json, const std::string& at) { mesh(json, at); });
    tree();
    each("nodes", [&](const Json& json, const std::string& at) { node(json, at); });
    each("scenes", [&](const Json& json, const std::string& at) { scene(json, at); });
    remarks_.throw_errors();
    each("skins", [&](const Json& json, const std::string& at) { skin(json, at); });
    each("animations", [&](const Json& json, const std::string& at) { animation(json, at); });
  }

 private:
  const Json& accessor(const Json& index) const { return root_["accessors"][index.get<std::size_t>()]; }
  static std::uint64_t count(const Json& accessor) { return whole(accessor, "count", 0); }
  const Json& view_of(const Json& accessor) const {
    static const Json nothing;
    const Json& view = member(accessor, "bufferView");
    return view.is_null() ? nothing : root_["bufferViews"][view.get<std::size_t>()];
  }
  void format(const Json& accessor, const Formats& formats, const std::string& at) {
    const std::string is = name_of_format(accessor);
    if (is_listed(formats.plain, is) || (quantized_ && is_listed(formats.quantized, is))) return;
    std::string hint(formats.plain);
    for (std::size_t comma; (comma = hint.find(',')) != std::string::npos;) hint.replace(comma, 1, "; ");
    remarks_.error(at, "its accessor must not be " + is, "one of: " + hint);
  }
  void no_stride(const Json& accessor, const std::string& at) {
    if (!member(view_of(accessor), "byteStride").is_null())
      remarks_.error(at, "the bufferView of its accessor must have no byteStride");
  }
  /// A bufferView holds vertices or indices, not both.
  void use(const Json& accessor, int target, const std::string& at) {
    const Json& view = member(accessor, "bufferView");
    if (view.is_null()) return;
    const auto [before, is_new] = use_of_view_.try_emplace(
        view.get<std::size_t>(), int(whole(view_of(accessor), "target", std::uint64_t(target))));
    if (before->second != target)
      remarks_.error(at,
                     "its bufferView is meant for " + std::string(target == 34962 ? "indices" : "vertices"));
  }

  void mesh(const Json& json, const std::string& at) {
    const Json& primitives = json["primitives"];
    const std::size_t targets = member(primitives[0], "targets").size();
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      const std::string place = at / std::string_view("primitives") / i;
      primitive(primitives[i], place);
      if (member(primitives[i], "targets").size() != targets)
        remarks_.error(place, "all primitives of a mesh must have the same number of morph targets");
    }
    weights(json, targets, at);
  }
  void weights(const Json& json, std::size_t targets, const std::string& at) {
    if (const Json& weights = member(json, "weights"); !weights.is_null() && weights.size() != targets)
      remarks_.error(at + "/weights", "has " + std::to_string(weights.size()) + " elements for " +
                                          std::to_string(targets) + " morph targets");
  }

  void primitive(const Json& json, const std::string& at) {
    const Json& all = json["attributes"];
    const std::uint64_t vertices = count(accessor(*all.begin()));
    std::map<std::string, std::set<int>> numbers;
    for (const auto& [name, index] : all.items()) {
      const std::string place = at + "/attributes" / std::string_view(name);
      attribute(name, accessor(index), false, place);
      if (count(accessor(index)) != vertices)
        remarks_.error(place, "has " + std::to_string(count(accessor(index))) + " elements, but " +
                                  all.begin().key() + " has " + std::to_string(vertices));
      int number = -1;
      const std::string base = without_number(name, number);
      if (number >= 0 && name[0] != '_') numbers[base].insert(number);
    }
    for (const auto& [base, has] : numbers)
      if (*has.rbegin() + 1 != int(has.size()))
        remarks_.error(at + "/attributes",
                       base + "_0 to _" + std::to_string(*has.rbegin()) + " must all be there");
    if (numbers["JOINTS"].size() != numbers["WEIGHTS"].size())
      remarks_.error(at + "/attributes", "must have as many WEIGHTS as JOINTS");
    if (const Json& indices = member(json, "indices"); !indices.is_null()) {
      format(accessor(indices), index_formats, at + "/indices");
      no_stride(accessor(indices), at + "/indices");
      use(accessor(indices), 34963, at + "/indices");
    }
    const Json& targets = member(json, "targets");
    for (std::size_t i = 0; i < targets.size(); ++i)
      for (const auto& [name, index] : targets[i].items()) {
        const std::string place = at / std::string_view("targets") / i / std::string_view(name);
        attribute(name, accessor(index), true, place);
        if (!all.contains(name)) remarks_.error(place, "the primitive itself has no such attribute");
        if (count(accessor(index)) != vertices)
          remarks_.error(place, "has " + std::to_string(count(accessor(index))) + " elements for " +
                                    std::to_string(vertices) + " vertices");
      }
  }
  void attribute(const std::string& name, const Json& accessor, bool of_target, const std::string& at) {
    if (name.starts_with("_")) {  // of the application
      if (whole(accessor, "componentType", 0) == 5125)
        remarks_.error(at, "attributes must not be UNSIGNED_INT");
    } else if (const Formats* formats = formats_of(name, of_target)) {
      format(accessor, *formats, at);
    } else {
      return remarks_.error(at, in_quotes(name) + " is no attribute of glTF",
                            "names of one's own begin with _");
    }
    if (name == "POSITION" && (member(accessor, "min").is_null() || member(accessor, "max").is_null()))
      remarks_.error(at, "its accessor needs 'min' and 'max'");
    use(accessor, 34962, at);
    const Json& view = view_of(accessor);
    if (view.is_null()) return;
    const std::uint64_t stride = whole(view, "byteStride", std::uint64_t(layout_of(accessor).stride()));
    if (whole(accessor, "byteOffset", 0) % 4 != 0 || whole(view, "byteOffset", 0) % 4 != 0 ||
        (stride % 4 != 0 && count(accessor) > 1))
      remarks_.error(at, "every vertex must begin at a multiple of 4 bytes");
  }

  /// Sets parent_ and root_of_, and finds nodes that make no tree.
  void tree() {
    const Json& nodes = member(root_, "nodes");
    parent_.assign(nodes.size(), none);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (const Json& child : member(nodes[i], "children")) {
        std::size_t& parent = parent_[child.get<std::size_t>()];
        if (parent != none)
          remarks_.error(std::string("/nodes") / i / std::string_view("children"),
                         "node " + child.dump() + " is already a child of node " + std::to_string(parent));
        parent = i;
      }
    root_of_.assign(nodes.size(), none);
    // Walking up: who has not reached a root after all nodes have been passed goes in a circle.
    std::vector<char> is_safe(nodes.size(), 0);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      std::vector<std::size_t> way;
      std::size_t at = i;
      while (at != none && is_safe[at] == 0) {
        is_safe[at] = 2;
        way.push_back(at);
        at = parent_[at];
      }
      if (at != none && is_safe[at] == 2) {
        remarks_.error(std::string("/nodes") / at, "is its own descendant");
        remarks_.throw_errors();
      }
      const std::size_t root = at == none ? way.back() : root_of_[at];
      for (const std::size_t passed : way) is_safe[passed] = 1, root_of_[passed] = root;
    }
  }

  void node(const Json& json, const std::string& at) {
    const Json &mesh = member(json, "mesh"), &matrix = member(json, "matrix");
    for (const char* what : {"skin", "weights"})
      if (!member(json, what).is_null() && mesh.is_null())
        remarks_.error(at / std::string_view(what), "needs 'mesh' beside it");
    for (const char* what : {"translation", "rotation", "scale"})
      if (!matrix.is_null() && !member(json, what).is_null())
        remarks_.error(at, "has both 'matrix' and '" + std::string(what) + "'");
    if (!matrix.is_null() && (matrix[3] != 0 || matrix[7] != 0 || matrix[11] != 0 || matrix[15] != 1))
      remarks_.error(at + "/matrix", "its last row must be 0 0 0 1");
    if (const Json& rotation = member(json, "rotation"); !rotation.is_null()) {
      double square = 0;
      for (const Json& x : rotation) square += x.get<double>() * x.get<double>();
      // As far off as what is left of a unit quaternion in two decimals.
      if (std::abs(std::sqrt(square) - 1) > 0.01) remarks_.error(at + "/rotation", "is no unit quaternion");
    }
    if (mesh.is_null()) return;
    const Json& primitives = root_["meshes"][mesh.get<std::size_t>()]["primitives"];
    weights(json, member(primitives[0], "targets").size(), at);
    const bool skinned = std::any_of(primitives.begin(), primitives.end(), [](const Json& primitive) {
      return primitive["attributes"].contains("JOINTS_0");
    });
    if (!member(json, "skin").is_null() && !skinned)
      remarks_.error(at, "has a skin, but its mesh has no joints");
  }

  void scene(const Json& json, const std::string& at) {
    const Json& nodes = member(json, "nodes");
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (const std::size_t parent = parent_[nodes[i].get<std::size_t>()]; parent != none)
        remarks_.error(
            at / std::string_view("nodes") / i,
            "node " + nodes[i].dump() + " is no root, but a child of node " + std::to_string(parent));
  }

  void skin(const Json& json, const std::string& at) {
    const Json &joints = json["joints"], &binds = member(json, "inverseBindMatrices");
    const std::size_t root = root_of_[joints[0].get<std::size_t>()];
    for (const Json& joint : joints)
      if (root_of_[joint.get<std::size_t>()] != root) {
        remarks_.error(at + "/joints", "have no common root");
        break;
      }
    if (binds.is_null()) return;
    format(accessor(binds), matrix_formats, at + "/inverseBindMatrices");
    no_stride(accessor(binds), at + "/inverseBindMatrices");
    if (count(accessor(binds)) < joints.size())
      remarks_.error(at + "/inverseBindMatrices",
                     "its accessor has " + std::to_string(count(accessor(binds))) + " elements for " +
                         std::to_string(joints.size()) + " joints");
  }

  void animation(const Json& json, const std::string& at) {
    const Json &samplers = json["samplers"], &channels = json["channels"];
    for (std::size_t i = 0; i < samplers.size(); ++i) {
      const std::string place = at / std::string_view("samplers") / i;
      const Json& input = accessor(samplers[i]["input"]);
      format(input, time_formats, place + "/input");
      no_stride(input, place + "/input");
      no_stride(accessor(samplers[i]["output"]), place + "/output");
      if (member(input, "min").is_null() || member(input, "max").is_null())
        remarks_.error(place + "/input", "its accessor needs 'min' and 'max'");
    }
    std::set<std::pair<std::size_t, std::string>> targets;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const std::string place = at / std::string_view("channels") / i;
      if (whole(channels[i], "sampler", 0) >= samplers.size()) {
        remarks_.error(place + "/sampler", "there is no sampler " + channels[i]["sampler"].dump());
        continue;
      }
      channel(channels[i], samplers[whole(channels[i], "sampler", 0)], place);
      const Json& target = channels[i]["target"];
      if (const Json& node = member(target, "node");
          !node.is_null() && !targets.insert({node.get<std::size_t>(), text(target, "path")}).second)
        remarks_.error(place + "/target", "another channel has the same target");
    }
  }
  void channel(const Json& json, const Json& sampler, const std::string& at) {
    const Json& target = json["target"];
    const std::string path = text(target, "path");
    const Formats* formats = path == "translation" || path == "scale" ? &vector_formats
                             : path == "rotation"                     ? &rotation_formats
                             : path == "weights"                      ? &scalar_formats
                                                                      : nullptr;
    if (extension(target, "KHR_animation_pointer").is_object()) {
      const std::string place = at + "/target/extensions/KHR_animation_pointer";
      if (path != "pointer")
        remarks_.error(place, "the path beside it must be 'pointer', not " + in_quotes(path));
      if (!member(target, "node").is_null()) remarks_.error(place, "must have no 'node' beside it");
    }
    if (!formats)
      return remarks_.warn(at + "/target/path",
                           in_quotes(path) + " is not supported; the channel is ignored");
    const Json& output = accessor(sampler["output"]);
    format(output, *formats, at);
    const Json& index = member(target, "node");
    if (index.is_null()) return;
    const Json& node = root_["nodes"][index.get<std::size_t>()];
    if (path != "weights" && !member(node, "matrix").is_null())
      remarks_.error(at + "/target", "the node has a matrix, and cannot be animated");
    std::uint64_t each = text(sampler, "interpolation") == "CUBICSPLINE" ? 3 : 1;
    if (path == "weights") {
      const Json& mesh = member(node, "mesh");
      const std::size_t targets =
          mesh.is_null()
              ? 0
              : member(root_["meshes"][mesh.get<std::size_t>()]["primitives"][0], "targets").size();
      if (targets == 0) return remarks_.error(at + "/target", "the node has no morph targets");
      each *= targets;
    }
    const std::uint64_t keys = count(accessor(sampler["input"]));
    if (text(sampler, "interpolation") == "CUBICSPLINE" && keys < 2)
      remarks_.error(at, "cubic splines need two keys");
    if (count(output) != keys * each)
      remarks_.error(at, "its output has " + std::to_string(count(output)) + " elements in place of " +
                             std::to_string(keys * each));
  }

  static constexpr std::size_t none = ~std::size_t{0};
  const Json& root_;
  Remarks& remarks_;
  bool quantized_;
  std::map<std::size_t, int> use_of_view_;
  std::vector<std::size_t> parent_, root_of_;
};

}  // namespace

void check_scene_rules(const Json& root, Remarks& remarks) { SceneRules(root, remarks).check(); }

}  // namespace lambent::gltf
