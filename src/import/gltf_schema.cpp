#include "import/gltf_schema.h"

#include <cmath>
#include <map>
#include <set>
#include <span>

#include "import/text_file.h"

namespace lambent::gltf {

namespace {

enum class Is { boolean, whole, number, text, index, object };

struct Schema;

/// What one member of an object must be.
struct Rule {
  const char* name;
  Is is;
  const char* target = nullptr;    ///< Of an index: the JSON pointer of the list that it points into.
  const Schema* schema = nullptr;  ///< Of an object.
  bool must = false;
  double least = -1.7976931348623157e308, most = 1.7976931348623157e308;
  bool above = false;           ///< `least` itself is too little.
  const char* among = nullptr;  ///< The values that are allowed, between blanks.
  bool list = false;            ///< An array of such values;
  std::size_t fewest = 1, largest = ~std::size_t{0};
  bool unique = false;
  bool by_name = false;  ///< An object whose members, whatever their names, are such values.

  constexpr Rule needed() const {
    Rule r = *this;
    r.must = true;
    return r;
  }
  constexpr Rule from(double low) const {
    Rule r = *this;
    r.least = low;
    return r;
  }
  constexpr Rule over(double low) const {
    Rule r = *this;
    r.least = low, r.above = true;
    return r;
  }
  constexpr Rule to(double high) const {
    Rule r = *this;
    r.most = high;
    return r;
  }
  constexpr Rule one_of(const char* values) const {
    Rule r = *this;
    r.among = values;
    return r;
  }
  constexpr Rule some(std::size_t least_count = 1, std::size_t most_count = ~std::size_t{0}) const {
    Rule r = *this;
    r.list = true, r.fewest = least_count, r.largest = most_count;
    return r;
  }
  constexpr Rule exactly(std::size_t count) const { return some(count, count); }
  constexpr Rule different() const {
    Rule r = *this;
    r.list = r.unique = true;
    return r;
  }
  constexpr Rule any_name() const {
    Rule r = *this;
    r.by_name = true;
    return r;
  }
};

struct Schema {
  const char* name;  ///< Extensions say by it where they may stand.
  std::span<const Rule> rules;
};

constexpr Rule boolean(const char* name) { return {name, Is::boolean}; }
constexpr Rule whole(const char* name) { return {name, Is::whole}; }
constexpr Rule number(const char* name) { return {name, Is::number}; }
constexpr Rule text(const char* name) { return {name, Is::text}; }
constexpr Rule index(const char* name, const char* target) { return {name, Is::index, target}; }
constexpr Rule object(const char* name, const Schema& schema) { return {name, Is::object, nullptr, &schema}; }
constexpr Rule objects(const char* name, const Schema& schema) { return object(name, schema).some(); }

// ---- the specification's schema, from the leaves up

constexpr Rule asset_rules[] = {text("version").needed(), text("minVersion"), text("generator"),
                                text("copyright")};
constexpr Schema asset_schema{"asset", asset_rules};

constexpr Rule sparse_indices_rules[] = {index("bufferView", "/bufferViews").needed(),
                                         whole("byteOffset").from(0),
                                         whole("componentType").needed().one_of("5121 5123 5125")};
constexpr Schema sparse_indices_schema{"sparse indices", sparse_indices_rules};
constexpr Rule sparse_values_rules[] = {index("bufferView", "/bufferViews").needed(),
                                        whole("byteOffset").from(0)};
constexpr Schema sparse_values_schema{"sparse values", sparse_values_rules};
constexpr Rule sparse_rules[] = {whole("count").needed().from(1),
                                 object("indices", sparse_indices_schema).needed(),
                                 object("values", sparse_values_schema).needed()};
constexpr Schema sparse_schema{"sparse", sparse_rules};
constexpr Rule accessor_rules[] = {index("bufferView", "/bufferViews"),
                                   whole("byteOffset").from(0),
                                   whole("componentType").needed().one_of("5120 5121 5122 5123 5125 5126"),
                                   boolean("normalized"),
                                   whole("count").needed().from(1),
                                   text("type").needed().one_of("SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4"),
                                   number("min").some(1, 16),
                                   number("max").some(1, 16),
                                   object("sparse", sparse_schema)};
constexpr Schema accessor_schema{"accessor", accessor_rules};
constexpr Rule buffer_rules[] = {text("uri"), whole("byteLength").needed().from(1)};
constexpr Schema buffer_schema{"buffer", buffer_rules};
constexpr Rule buffer_view_rules[] = {
    index("buffer", "/buffers").needed(), whole("byteOffset").from(0), whole("byteLength").needed().from(1),
    whole("byteStride").from(4).to(252), whole("target").one_of("34962 34963")};
constexpr Schema buffer_view_schema{"bufferView", buffer_view_rules};

constexpr Rule target_rules[] = {index("node", "/nodes"), text("path").needed()};
constexpr Schema target_schema{"animation target", target_rules};
constexpr Rule channel_rules[] = {whole("sampler").needed().from(0),
                                  object("target", target_schema).needed()};
constexpr Schema channel_schema{"animation channel", channel_rules};
constexpr Rule animation_sampler_rules[] = {index("input", "/accessors").needed(),
                                            text("interpolation").one_of("LINEAR STEP CUBICSPLINE"),
                                            index("output", "/accessors").needed()};
constexpr Schema animation_sampler_schema{"animation sampler", animation_sampler_rules};
constexpr Rule animation_rules[] = {objects("channels", channel_schema).needed(),
                                    objects("samplers", animation_sampler_schema).needed()};
constexpr Schema animation_schema{"animation", animation_rules};

constexpr Rule perspective_rules[] = {number("aspectRatio").over(0), number("yfov").needed().over(0),
                                      number("zfar").over(0), number("znear").needed().over(0)};
constexpr Schema perspective_schema{"perspective", perspective_rules};
constexpr Rule orthographic_rules[] = {number("xmag").needed(), number("ymag").needed(),
                                       number("zfar").needed().over(0), number("znear").needed().from(0)};
constexpr Schema orthographic_schema{"orthographic", orthographic_rules};
constexpr Rule camera_rules[] = {text("type").needed().one_of("perspective orthographic"),
                                 object("perspective", perspective_schema),
                                 object("orthographic", orthographic_schema)};
constexpr Schema camera_schema{"camera", camera_rules};

constexpr Rule image_rules[] = {text("uri"), text("mimeType"), index("bufferView", "/bufferViews")};
constexpr Schema image_schema{"image", image_rules};
constexpr Rule sampler_rules[] = {
    whole("magFilter").one_of("9728 9729"), whole("minFilter").one_of("9728 9729 9984 9985 9986 9987"),
    whole("wrapS").one_of("33071 33648 10497"), whole("wrapT").one_of("33071 33648 10497")};
constexpr Schema sampler_schema{"sampler", sampler_rules};
constexpr Rule texture_rules[] = {index("sampler", "/samplers"), index("source", "/images")};
constexpr Schema texture_schema{"texture", texture_rules};

constexpr Rule texture_info_rules[] = {index("index", "/textures").needed(), whole("texCoord").from(0),
                                       number("scale"), number("strength").from(0).to(1)};
constexpr Schema texture_info_schema{"textureInfo", texture_info_rules};
constexpr Rule texture_info(const char* name) { return object(name, texture_info_schema); }
constexpr Rule factor(const char* name) { return number(name).from(0).to(1); }
constexpr Rule color(const char* name) { return factor(name).exactly(3); }
constexpr Rule metallic_roughness_rules[] = {
    factor("baseColorFactor").exactly(4), texture_info("baseColorTexture"), factor("metallicFactor"),
    factor("roughnessFactor"), texture_info("metallicRoughnessTexture")};
constexpr Schema metallic_roughness_schema{"pbrMetallicRoughness", metallic_roughness_rules};
constexpr Rule material_rules[] = {object("pbrMetallicRoughness", metallic_roughness_schema),
                                   texture_info("normalTexture"),
                                   texture_info("occlusionTexture"),
                                   texture_info("emissiveTexture"),
                                   color("emissiveFactor"),
                                   text("alphaMode").one_of("OPAQUE MASK BLEND"),
                                   number("alphaCutoff").from(0),
                                   boolean("doubleSided")};
constexpr Schema material_schema{"material", material_rules};

constexpr Rule attributes = index("attributes", "/accessors").any_name();
constexpr Rule primitive_rules[] = {attributes.needed(), index("indices", "/accessors"),
                                    index("material", "/materials"), whole("mode").from(0).to(6),
                                    index("targets", "/accessors").any_name().some()};
constexpr Schema primitive_schema{"primitive", primitive_rules};
constexpr Rule mesh_rules[] = {objects("primitives", primitive_schema).needed(), number("weights").some()};
constexpr Schema mesh_schema{"mesh", mesh_rules};
constexpr Rule node_rules[] = {index("camera", "/cameras"), index("children", "/nodes").some().different(),
                               index("skin", "/skins"),     number("matrix").exactly(16),
                               index("mesh", "/meshes"),    number("rotation").from(-1).to(1).exactly(4),
                               number("scale").exactly(3),  number("translation").exactly(3),
                               number("weights").some()};
constexpr Schema node_schema{"node", node_rules};
constexpr Rule scene_rules[] = {index("nodes", "/nodes").some().different()};
constexpr Schema scene_schema{"scene", scene_rules};
constexpr Rule skin_rules[] = {index("inverseBindMatrices", "/accessors"), index("skeleton", "/nodes"),
                               index("joints", "/nodes").needed().some().different()};
constexpr Schema skin_schema{"skin", skin_rules};

constexpr Rule root_rules[] = {text("extensionsUsed").some().different(),
                               text("extensionsRequired").some().different(),
                               objects("accessors", accessor_schema),
                               objects("animations", animation_schema),
                               object("asset", asset_schema).needed(),
                               objects("buffers", buffer_schema),
                               objects("bufferViews", buffer_view_schema),
                               objects("cameras", camera_schema),
                               objects("images", image_schema),
                               objects("materials", material_schema),
                               objects("meshes", mesh_schema),
                               objects("nodes", node_schema),
                               objects("samplers", sampler_schema),
                               index("scene", "/scenes"),
                               objects("scenes", scene_schema),
                               objects("skins", skin_schema),
                               objects("textures", texture_schema)};
constexpr Schema root_schema{"root", root_rules};

// ---- extensions

constexpr const char* all_lights = "/extensions/KHR_lights_punctual/lights";
constexpr Rule spot_rules[] = {number("innerConeAngle").from(0).to(1.5707964),
                               number("outerConeAngle").over(0).to(1.5707964)};
constexpr Schema spot_schema{"spot", spot_rules};
constexpr Rule light_rules[] = {color("color"), number("intensity").from(0),
                                text("type").needed().one_of("directional point spot"),
                                number("range").over(0), object("spot", spot_schema)};
constexpr Schema light_schema{"light", light_rules};
constexpr Rule lights_rules[] = {objects("lights", light_schema).needed()};
constexpr Schema lights_schema{"lights", lights_rules};
constexpr Rule node_light_rules[] = {index("light", all_lights).needed()};
constexpr Schema node_light_schema{"node light", node_light_rules};
constexpr Schema no_members{"unlit", {}};
constexpr Rule specular_rules[] = {factor("specularFactor"), texture_info("specularTexture"),
                                   number("specularColorFactor").from(0).exactly(3),
                                   texture_info("specularColorTexture")};
constexpr Schema specular_schema{"specular", specular_rules};
constexpr Rule ior_rules[] = {number("ior").from(0)};
constexpr Schema ior_schema{"ior", ior_rules};
constexpr Rule transmission_rules[] = {factor("transmissionFactor"), texture_info("transmissionTexture")};
constexpr Schema transmission_schema{"transmission", transmission_rules};
constexpr Rule emissive_strength_rules[] = {number("emissiveStrength").from(0)};
constexpr Schema emissive_strength_schema{"emissive strength", emissive_strength_rules};
constexpr Rule clearcoat_rules[] = {
    factor("clearcoatFactor"), texture_info("clearcoatTexture"), factor("clearcoatRoughnessFactor"),
    texture_info("clearcoatRoughnessTexture"), texture_info("clearcoatNormalTexture")};
constexpr Schema clearcoat_schema{"clearcoat", clearcoat_rules};
constexpr Rule specular_glossiness_rules[] = {
    factor("diffuseFactor").exactly(4), texture_info("diffuseTexture"), color("specularFactor"),
    factor("glossinessFactor"), texture_info("specularGlossinessTexture")};
constexpr Schema specular_glossiness_schema{"specular-glossiness", specular_glossiness_rules};
constexpr Rule texture_transform_rules[] = {number("offset").exactly(2), number("rotation"),
                                            number("scale").exactly(2), whole("texCoord").from(0)};
constexpr Schema texture_transform_schema{"texture transform", texture_transform_rules};
constexpr Rule dispersion_rules[] = {number("dispersion").from(0)};
constexpr Schema dispersion_schema{"dispersion", dispersion_rules};
constexpr Rule iridescence_rules[] = {factor("iridescenceFactor"),
                                      texture_info("iridescenceTexture"),
                                      number("iridescenceIor").from(1),
                                      number("iridescenceThicknessMinimum").from(0),
                                      number("iridescenceThicknessMaximum").from(0),
                                      texture_info("iridescenceThicknessTexture")};
constexpr Schema iridescence_schema{"iridescence", iridescence_rules};
constexpr Rule sheen_rules[] = {color("sheenColorFactor"), texture_info("sheenColorTexture"),
                                factor("sheenRoughnessFactor"), texture_info("sheenRoughnessTexture")};
constexpr Schema sheen_schema{"sheen", sheen_rules};
constexpr Rule volume_rules[] = {number("thicknessFactor").from(0), texture_info("thicknessTexture"),
                                 number("attenuationDistance").over(0), color("attenuationColor")};
constexpr Schema volume_schema{"volume", volume_rules};
constexpr Rule anisotropy_rules[] = {factor("anisotropyStrength"), number("anisotropyRotation"),
                                     texture_info("anisotropyTexture")};
constexpr Schema anisotropy_schema{"anisotropy", anisotropy_rules};
constexpr Rule variant_rules[] = {text("name").needed()};
constexpr Schema variant_schema{"variant", variant_rules};
constexpr Rule variants_rules[] = {objects("variants", variant_schema).needed()};
constexpr Schema variants_schema{"variants", variants_rules};
constexpr Rule mapping_rules[] = {
    index("variants", "/extensions/KHR_materials_variants/variants").needed().some().different(),
    index("material", "/materials").needed()};
constexpr Schema mapping_schema{"mapping", mapping_rules};
constexpr Rule mappings_rules[] = {objects("mappings", mapping_schema).needed()};
constexpr Schema mappings_schema{"mappings", mappings_rules};
constexpr Rule visibility_rules[] = {boolean("visible")};
constexpr Schema visibility_schema{"visibility", visibility_rules};
constexpr Rule pointer_rules[] = {text("pointer").needed()};
constexpr Schema pointer_schema{"pointer", pointer_rules};
constexpr Rule webp_rules[] = {index("source", "/images")};
constexpr Schema webp_schema{"webp", webp_rules};

/// An extension's object in one place where it may stand.
struct Extension {
  const char* name;
  const Schema* where;
  const Schema* what;
  bool understood;
};
constexpr Extension known_extensions[] = {
    {"KHR_lights_punctual", &root_schema, &lights_schema, true},
    {"KHR_lights_punctual", &node_schema, &node_light_schema, true},
    {"KHR_materials_unlit", &material_schema, &no_members, true},
    {"KHR_materials_specular", &material_schema, &specular_schema, true},
    {"KHR_materials_ior", &material_schema, &ior_schema, true},
    {"KHR_materials_transmission", &material_schema, &transmission_schema, true},
    {"KHR_materials_emissive_strength", &material_schema, &emissive_strength_schema, true},
    {"KHR_materials_clearcoat", &material_schema, &clearcoat_schema, true},
    {"KHR_materials_pbrSpecularGlossiness", &material_schema, &specular_glossiness_schema, true},
    {"KHR_texture_transform", &texture_info_schema, &texture_transform_schema, true},
    {"KHR_mesh_quantization", nullptr, nullptr, true},
    {"KHR_node_visibility", &node_schema, &visibility_schema, true},
    {"KHR_materials_dispersion", &material_schema, &dispersion_schema, false},
    {"KHR_materials_iridescence", &material_schema, &iridescence_schema, false},
    {"KHR_materials_sheen", &material_schema, &sheen_schema, false},
    {"KHR_materials_volume", &material_schema, &volume_schema, false},
    {"KHR_materials_anisotropy", &material_schema, &anisotropy_schema, false},
    {"KHR_materials_variants", &root_schema, &variants_schema, false},
    {"KHR_materials_variants", &primitive_schema, &mappings_schema, false},
    {"KHR_animation_pointer", &target_schema, &pointer_schema, false},
    {"EXT_texture_webp", &texture_schema, &webp_schema, false},
};

// ---- the check

std::string shown(const Json& value) {
  if (value.is_string()) return in_quotes(value.get<std::string>());
  if (value.is_array()) return "a list";
  if (value.is_object()) return "an object";
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool is_among(const char* values, const std::string& value) {
  return (" " + std::string(values) + " ").find(" " + value + " ") != std::string::npos;
}

class Check {
 public:
  Check(const Json& root, Remarks& remarks) : root_(root), remarks_(remarks) {
    const Json& used = member(root, "extensionsUsed");
    if (used.is_array())
      for (const Json& name : used)
        if (name.is_string()) used_.insert(name.get<std::string>());
  }

  void object(const Json& value, const Schema& schema, const std::string& at) {
    if (!value.is_object()) return remarks_.error(at, "must be an object, not " + shown(value));
    for (const Rule& rule : schema.rules) {
      const auto found = value.find(rule.name);
      if (found != value.end()) any(*found, rule, at / std::string_view(rule.name));
      else if (rule.must) remarks_.error(at, "needs '" + std::string(rule.name) + "'");
    }
    if (const auto name = value.find("name"); name != value.end() && !name->is_string())
      remarks_.error(at / std::string_view("name"), "must be text, not " + shown(*name));
    if (const auto all = value.find("extensions"); all != value.end())
      extensions(*all, schema, at / std::string_view("extensions"));
  }

 private:
  void any(const Json& value, const Rule& rule, const std::string& at) {
    if (!rule.list) return rule.by_name ? members(value, rule, at) : one(value, rule, at);
    if (!value.is_array()) return remarks_.error(at, "must be a list, not " + shown(value));
    if (value.size() < rule.fewest || value.size() > rule.largest) {
      const std::string count = rule.fewest == rule.largest ? std::to_string(rule.fewest) + " elements"
                                : value.size() > rule.fewest
                                    ? "at most " + std::to_string(rule.largest) + " elements"
                                    : "at least one element";
      return remarks_.error(at, "must have " + count + ", not " + std::to_string(value.size()));
    }
    std::set<Json> seen;
    for (std::size_t i = 0; i < value.size(); ++i) {
      rule.by_name ? members(value[i], rule, at / i) : one(value[i], rule, at / i);
      if (rule.unique && !seen.insert(value[i]).second)
        remarks_.error(at / i, shown(value[i]) + " stands twice in the list");
    }
  }

  void members(const Json& value, const Rule& rule, const std::string& at) {
    if (!value.is_object()) return remarks_.error(at, "must be an object, not " + shown(value));
    if (value.empty()) return remarks_.error(at, "must not be empty");
    for (const auto& [name, element] : value.items()) one(element, rule, at / std::string_view(name));
  }

  void one(const Json& value, const Rule& rule, const std::string& at) {
    switch (rule.is) {
      case Is::boolean:
        if (!value.is_boolean()) remarks_.error(at, "must be true or false, not " + shown(value));
        return;
      case Is::whole:
        return whole(value, rule, at);
      case Is::number:
        return within(value, rule, at);
      case Is::text:
        if (!value.is_string()) return remarks_.error(at, "must be text, not " + shown(value));
        if (rule.among && !is_among(rule.among, value.get<std::string>()))
          remarks_.error(at, shown(value) + " is not known", "one of: " + std::string(rule.among));
        return;
      case Is::index:
        return index(value, rule, at);
      case Is::object:
        return object(value, *rule.schema, at);
    }
  }

  void within(const Json& value, const Rule& rule, const std::string& at) {
    if (!value.is_number()) return remarks_.error(at, "must be a number, not " + shown(value));
    const double x = value.get<double>();
    if (x < rule.least || (rule.above && x <= rule.least) || x > rule.most)
      remarks_.error(at, shown(value) + " is out of range");
  }

  /// 2.0 is as whole as 2 (chapter 2.7.1); up to 2^53 doubles hold every whole number.
  static bool is_whole(const Json& value) {
    return value.is_number() && std::abs(value.get<double>()) <= 9007199254740992.0 &&
           value.get<double>() == std::floor(value.get<double>());
  }
  void whole(const Json& value, const Rule& rule, const std::string& at) {
    if (!is_whole(value)) return remarks_.error(at, "must be a whole number, not " + shown(value));
    if (rule.among) {
      if (!is_among(rule.among, std::to_string(value.get<std::int64_t>())))
        remarks_.error(at, shown(value) + " is not known", "one of: " + std::string(rule.among));
      return;
    }
    within(value, rule, at);
  }

  void index(const Json& value, const Rule& rule, const std::string& at) {
    if (!is_whole(value) || value.get<double>() < 0)
      return remarks_.error(at, "must be an index of 0 or more, not " + shown(value));
    const std::size_t count = size_of(rule.target);
    if (value.get<std::size_t>() >= count)
      remarks_.error(at, "there is no " + std::string(rule.target) + "/" + shown(value) +
                             (count == 0 ? "" : ": the list has " + std::to_string(count)));
  }
  std::size_t size_of(const char* target) {
    const auto [found, is_new] = sizes_.try_emplace(target, 0);
    const Json::json_pointer pointer(target);
    if (is_new && root_.contains(pointer) && root_[pointer].is_array()) found->second = root_[pointer].size();
    return found->second;
  }

  void extensions(const Json& all, const Schema& where, const std::string& at) {
    if (!all.is_object()) return remarks_.error(at, "must be an object, not " + shown(all));
    for (const auto& [name, value] : all.items()) {
      const std::string place = at / std::string_view(name);
      if (!used_.contains(name)) {
        remarks_.error(place, "the extension is not declared",
                       "add \"" + name + "\" to the list /extensionsUsed");
        continue;
      }
      if (!value.is_object()) {
        remarks_.error(place, "must be an object, not " + shown(value));
        continue;
      }
      bool known = false, found = false;
      for (const Extension& extension : known_extensions) {
        if (name != extension.name) continue;
        known = true;
        if (extension.where != &where) continue;
        found = true;
        object(value, *extension.what, place);
      }
      if (known && !found) remarks_.error(place, "this extension has no place here");
    }
  }

  const Json& root_;
  Remarks& remarks_;
  std::map<std::string, std::size_t> sizes_;
  std::set<std::string> used_;
};

}  // namespace

void check_schema(const Json& root, Remarks& remarks) { Check(root, remarks).object(root, root_schema, ""); }

bool is_understood(std::string_view extension) {
  for (const Extension& known : known_extensions)
    if (extension == known.name) return known.understood;
  return false;
}

}  // namespace lambent::gltf
