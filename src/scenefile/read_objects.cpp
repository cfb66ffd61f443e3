#include "scenefile/read_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "illumination/metallic_roughness.h"
#include "import/paths.h"
#include "scene/uniform_material.h"
#include "scenefile/map_settings.h"
#include "scenefile/nearest.h"
#include "scenefile/shape_settings.h"
#include "scenefile/shapes.h"

namespace lambent {
namespace {

/// `a` and `b`, two keys of one mapping, must not hold the same point.
bool differ(Reader& reader, const Values& values, const char* a, const char* b, const Vec3<double>& at_a,
            const Vec3<double>& at_b) {
  if (max_abs(at_a - at_b) > 0) return true;
  const Value* where = values.find(b);
  reader.error(where->place(), fmt::format("'{}' and '{}' are the same point", a, b));
  return false;
}

bool read_capped(Reader& reader, const Values& values) {
  bool capped = false;
  if (const Value* value = values.find("capped")) reader.boolean(*value, capped);
  return capped;
}

/// A list of short lists of numbers, each handed to `take`.
template <std::size_t N, class Take>
bool rows(Reader& reader, const Value& value, const char* element, const Range& range, const Take& take) {
  const auto list = reader.list(value, element);
  if (!list) return false;
  bool good = true;
  for (const Value& one : *list) {
    std::array<double, N> row{};
    const Value named{one.node, nullptr, one.label + " of " + value.label};
    if (reader.numbers(named, range, row)) take(row, named);
    else good = false;
  }
  return good;
}

std::vector<Vec3<double>> points(Reader& reader, const Value& value, const char* element, const Field& field,
                                 bool& good) {
  std::vector<Vec3<double>> result;
  good = rows<3>(reader, value, element, limits(field),
                 [&](const std::array<double, 3>& p, const Value&) {
                   result.push_back({p[0], p[1], p[2]});
                 }) &&
         good;
  return result;
}

void read_rough(Reader& reader, const Values& material, const Value& value, Material& out) {
  const auto& fields = format().metallic_roughness.fields;
  out.metallic_roughness.emplace();
  if (const auto values = reader.mapping(value, fields, "a metallic-roughness material"))
    reader.table(*values, fields, *out.metallic_roughness);
  for (const char* other : {"ambient", "diffuse", "specular", "shininess", "reflect", "transmit", "ior"})
    if (const Value* one = material.find(other))
      reader.error(*one->key, one->label + " stands beside 'metallic_roughness'", "which takes its place");
}

/// A table of one number or of several against wavelength: as many as there are wavelengths.
std::optional<Samples> read_column(Reader& reader, const Value& value, const Range& range,
                                   const std::vector<double>& wavelengths) {
  auto numbers = reader.numbers(value, range);
  if (!numbers) return {};
  if (numbers->size() != wavelengths.size()) {
    reader.error(
        *value.node,
        fmt::format("{} has {} numbers, 'wavelengths' {}", value.label, numbers->size(), wavelengths.size()),
        "there is one for each wavelength");
    return {};
  }
  return Samples{wavelengths, std::move(*numbers)};
}

/// The one of `list` that `value` names; null, and why, where there is none.
template <class Named>
const Named* named(Reader& reader, const Value& value, const char* kind, const std::vector<Named>& list) {
  std::string name;
  if (!reader.text(value, fmt::format("a {}'s name or a mapping", kind), name)) return nullptr;
  std::vector<std::string> known;
  for (const Named& one : list) {
    if (name == one.name) return &one;
    known.emplace_back(one.name);
  }
  reader.error(*value.node, fmt::format("there is no {} '{}'", kind, name), suggestion(name, known));
  return nullptr;
}

std::optional<Metal> read_metal(Reader& reader, const Value& value) {
  if (value.node->kind != Node::Kind::mapping) {
    const NamedMetal* found = named(reader, value, "metal", metals());
    if (found == nullptr) return {};
    return Metal{found->name, found->constants};
  }
  const auto& fields = format().metal.fields;
  const auto values = reader.mapping(value, fields, "a metal");
  if (!values) return {};
  const Value *at = values->find("wavelengths"), *n = values->find("n"), *k = values->find("k");
  if (at == nullptr || n == nullptr || k == nullptr) return {};  // which has been said
  const auto wavelengths = reader.wavelengths(*at);
  if (!wavelengths) return {};
  const auto real = read_column(reader, *n, limits(*find(fields, "n")), *wavelengths),
             imaginary = read_column(reader, *k, limits(*find(fields, "k")), *wavelengths);
  if (!real || !imaginary) return {};
  return Metal{"", {*real, *imaginary}};
}

std::optional<Glass> read_glass(Reader& reader, const Value& value) {
  if (value.node->kind != Node::Kind::mapping) {
    const NamedGlass* found = named(reader, value, "glass", glasses());
    if (found == nullptr) return {};
    return Glass{found->name, found->index};
  }
  const auto& fields = format().glass.fields;
  const auto values = reader.mapping(value, fields, "a glass");
  if (!values) return {};
  const Value *at = values->find("wavelengths"), *n = values->find("n"), *ior = values->find("ior"),
              *abbe = values->find("abbe");
  if (at != nullptr || n != nullptr) {
    if (at == nullptr || n == nullptr) {
      const Value& one = at != nullptr ? *at : *n;
      reader.error(*one.key, fmt::format("{} needs '{}'", one.label, at != nullptr ? "n" : "wavelengths"),
                   "a glass is a name, {ior, abbe}, or {wavelengths: [...], n: [...]}");
      return {};
    }
    for (const Value* other : {ior, abbe})
      if (other != nullptr)
        reader.error(*other->key, other->label + " stands beside 'n', which takes its place");
    const auto wavelengths = reader.wavelengths(*at);
    if (!wavelengths) return {};
    const auto index = read_column(reader, *n, limits(*find(fields, "n")), *wavelengths);
    if (!index || ior != nullptr || abbe != nullptr) return {};
    return Glass{"", *index};
  }
  double index = 1.5, number = 0;
  if (ior != nullptr && !reader.number(*ior, limits(*find(fields, "ior")), index)) return {};
  if (abbe == nullptr) return Glass{"", Cauchy{index, 0}};
  if (!reader.number(*abbe, limits(*find(fields, "abbe")), number)) return {};
  return Glass{"", glass_of(index, number)};
}

/// The numbers that a metal or a glass brings, where the material gives none: those of a metallic-roughness
/// material that reflects as much as the substance (illumination/metallic_roughness.h), as factors on it.
void complete(const Values& values, Material& out) {
  const bool metal = std::holds_alternative<Metal>(*out.substance);
  MetallicRoughness rough;
  rough.roughness = out.roughness;
  const auto lecture = lecture_material(numbers_of(rough));
  const auto set = [&](const char* name, auto Material::*member, const auto& value) {
    if (values.find(name) == nullptr) out.*member = value;
  };
  set("ambient", &Material::ambient, metal ? lecture.ka : Rgb{});
  set("diffuse", &Material::diffuse, metal ? lecture.kd : Rgb{});
  set("specular", &Material::specular, lecture.ks);
  // Phong's lobe is as wide as Blinn's with four times the power.
  set("shininess", &Material::shininess, lecture.n / 4);
  set("reflect", &Material::reflect, lecture.reflect);
  set("transmit", &Material::transmit, metal ? Rgb{} : grey(1.0));
  if (!out.model) out.model = ModelId::wavelength_specular;
}

void read_substance(Reader& reader, const Values& values, Material& out) {
  const Value *metal = values.find("metal"), *glass = values.find("glass");
  if (metal == nullptr && glass == nullptr) return;
  const Value& one = metal != nullptr ? *metal : *glass;
  if (metal != nullptr && glass != nullptr) {
    reader.error(*glass->key, "'glass' stands beside 'metal'", "a surface is one of them");
    return;
  }
  for (const char* other : {"metallic_roughness", "ior"})
    if (const Value* beside = values.find(other))
      reader.error(*beside->key, fmt::format("{} stands beside {}", beside->label, one.label),
                   "which says what reflects and refracts");
  if (const Value* roughness = values.find("roughness"))
    if (out.model != ModelId::povray) reader.number(*roughness, zero_to_one, out.roughness);
  if (metal != nullptr) {
    if (auto found = read_metal(reader, *metal)) out.substance = std::move(*found);
  } else if (auto found = read_glass(reader, *glass)) {
    out.substance = std::move(*found);
  }
  if (out.substance) complete(values, out);
}

bool is_color(MapSlot slot) {
  switch (slot) {
    case MapSlot::ambient:
    case MapSlot::diffuse:
    case MapSlot::specular:
    case MapSlot::reflect:
    case MapSlot::transmit:
    case MapSlot::emission:
    case MapSlot::base_color:
    case MapSlot::specular_color:
      return true;
    default:
      return false;
  }
}

bool is_rough(MapSlot slot) { return slot >= MapSlot::base_color; }

/// The matrix of scale, turn and offset, in this order.
bool read_matrix(Reader& reader, const Values& values, double degrees, std::array<double, 6>& matrix) {
  std::array<double, 2> scale{1, 1}, offset{0, 0};
  const Range range{-largest_number, largest_number};
  if (const Value* value = values.find("scale"))
    if (!reader.numbers(*value, range, scale)) return false;
  if (const Value* value = values.find("offset"))
    if (!reader.numbers(*value, range, offset)) return false;
  const auto [sine, cosine] = sincos_degrees(degrees);
  matrix = {cosine * scale[0], -sine * scale[1], offset[0], sine * scale[0], cosine * scale[1], offset[1]};
  return true;
}

void read_map(Reader& reader, const Value& value, MapSlot slot, const Files& files,
              std::vector<Texture>& textures, Material& out) {
  MaterialMap map{slot, {}};
  bool srgb = is_color(slot);
  const Value* file = &value;
  std::optional<Values> values;
  if (value.node->kind == Node::Kind::mapping) {
    const auto& fields = format().map.fields;
    values = reader.mapping(value, fields, "a map");
    if (!values) return;
    MapSettings settings;
    reader.table(*values, fields, settings);
    map.map.gain = settings.gain, map.map.offset = settings.base, map.map.strength = settings.strength;
    std::string word;
    if (const Value* encoding = values->find("encoding"))
      if (reader.one_of(*encoding, {"srgb", "linear"}, word)) srgb = word == "srgb";
    if (const Value* wrap = values->find("wrap")) reader.choice(*wrap, map.map.wrap_u);
    map.map.wrap_v = map.map.wrap_u;
    if (const Value* filter = values->find("filter"))
      if (reader.one_of(*filter, {"linear", "nearest"}, word)) map.map.nearest = word == "nearest";
    const std::vector<std::string> channels{"luminance", "r", "g", "b", "alpha"};
    if (const Value* channel = values->find("channel"))
      if (reader.one_of(*channel, channels, word))
        map.map.channel =
            std::int8_t(std::find(channels.begin(), channels.end(), word) - channels.begin() - 1);
    int uv_set = 0;
    if (const Value* set = values->find("uv_set")) reader.integer(*set, {0, 1}, uv_set);
    map.map.uv_set = std::uint8_t(uv_set);
    if (!read_matrix(reader, *values, settings.rotate, map.map.matrix)) return;
    file = values->find("file");
    if (file == nullptr) return;
  }
  if (const auto texture = read_image_file(reader, *file, srgb, files, textures)) {
    map.map.texture = *texture;
    out.maps.push_back(map);
  }
}

void read_maps(Reader& reader, const Value& value, const Files& files, std::vector<Texture>& textures,
               Material& out) {
  const auto values = reader.mapping(value, format().maps.fields, "the maps");
  if (!values) return;
  for (const Value& one : values->values) {
    const MapSlot slot = *meaning_of<MapSlot>(one.key->text);
    if (is_rough(slot) && !out.metallic_roughness) {
      reader.error(*one.key, one.label + " is a map of 'metallic_roughness', which this material has not",
                   "give it metallic_roughness: {}");
      continue;
    }
    read_map(reader, one, slot, files, textures, out);
  }
}

}  // namespace

std::optional<std::string> Files::find(Reader& reader, const Value& value) const {
  std::string name;
  if (!reader.text(value, "a file's name", name)) return {};
  const std::string path = model_key(folder, name);
  // A name on the command line is the user's own, whatever the scene's author had in mind.
  const bool of_scene = reader.document().sources[std::size_t(value.node->source)].is_file;
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    const std::string reason = error ? error.message() : "No such file or directory";
    reader.error(*value.node, "cannot open '" + path + "': " + reason, suggest_file(path));
  } else if (std::filesystem::is_directory(status)) {
    reader.error(*value.node, "cannot open '" + path + "': it is a folder");
  } else if (of_scene && !import.limits.allow_outside &&
             !lies_below(import.root.empty() ? folder : import.root, path)) {
    reader.error(*value.node, "'" + name + "' lies outside of the scene's folder",
                 "put it there or below, or allow it with --allow-outside");
  } else {
    return path;
  }
  return {};
}

std::optional<std::uint32_t> read_image_file(Reader& reader, const Value& file, bool srgb, const Files& files,
                                             std::vector<Texture>& textures) {
  const auto path = files.find(reader, file);
  if (!path) return {};
  Texture texture;
  texture.source = {*path, *path, nullptr, place_of(reader.document(), *file.node), true};
  texture.srgb = srgb;
  textures.push_back(std::move(texture));
  return std::uint32_t(textures.size() - 1);
}

bool read_material(Reader& reader, const Value& value, const std::vector<Field>& fields,
                   const std::string& what, const Illumination& illumination, const Files& files,
                   std::vector<Texture>& textures, Material& out) {
  const auto values = reader.mapping(value, fields, what);
  if (!values) return false;
  const std::size_t before = reader.count();
  out.place = place_of(reader.document(), *value.node);
  if (const Value* model = values->find("model")) {
    std::string word;
    if (reader.one_of(*model, names_of(format().models), word))
      for (int i = 0; i < model_count; ++i)
        if (word == model_infos[i].name) out.model = ModelId(i);
  }
  reader.table(*values, fields, out);
  out.spectra = reader.spectra<Material>(*values);
  read_substance(reader, *values, out);
  if (const Value* alpha = values->find("alpha")) reader.choice(*alpha, out.alpha);
  if (const Value* rough = values->find("metallic_roughness")) read_rough(reader, *values, *rough, out);
  if (const Value* maps = values->find("maps")) read_maps(reader, *maps, files, textures, out);
  // Two models may use one name for parameters of different ranges: the material's own model decides.
  const std::size_t chosen = std::size_t(int(out.model.value_or(illumination.model)));
  for (std::size_t i = 0; i < format().models.size(); ++i) {
    for (const Field& field : format().models[i].fields) {
      const Value* own = values->find(field.name);
      if (field.name == "roughness" && out.substance && i != chosen) continue;  // read above
      if (own == nullptr || (out.own.count(field.name) != 0 && i != chosen)) continue;
      const Field* decisive = find(format().models[chosen].fields, field.name);
      const Field& rule = decisive != nullptr ? *decisive : field;
      double number = 0;
      int whole = 0;
      if (rule.type == FieldType::integer ? reader.integer(*own, limits(rule), whole)
                                          : reader.number(*own, limits(rule), number))
        out.own[field.name] = rule.type == FieldType::integer ? double(whole) : number;
    }
  }
  return reader.count() == before && !values->unknown_keys;
}

ObjectReader::ObjectReader(Reader& reader, Scene& scene, std::string folder, LoadedModels models,
                           const ImportOptions& import)
    : reader_(reader),
      scene_(scene),
      folder_(std::move(folder)),
      import_(import),
      loaded_(std::move(models)) {
  if (import_.root.empty()) import_.root = folder_;
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    by_name_.emplace(scene.materials[i].name, std::uint32_t(i));
}

void ObjectReader::add_shape(std::string name, Primitives primitives) {
  placed_shapes_.push_back({{}, std::uint32_t(scene_.shapes.size()), {}, {}});
  scene_.shapes.push_back({std::move(name), std::move(primitives), {}});
}

std::uint32_t ObjectReader::default_material() {
  if (!default_material_) {
    default_material_ = std::uint32_t(scene_.materials.size());
    scene_.materials.emplace_back().name = "default";
  }
  return *default_material_;
}

std::optional<std::uint32_t> ObjectReader::material(const Value& value) {
  if (value.node->kind == Node::Kind::mapping) {
    Material material;
    // Its name is the object's affair; a name of its own would be one that nothing can refer to.
    std::vector<Field> fields = format().material.fields;
    if (!read_material(reader_, value, fields, "a material", scene_.illumination, {folder_, import_},
                       scene_.textures, material))
      return {};
    material.name = fmt::format("material {}", ++inline_materials_);
    scene_.materials.push_back(std::move(material));
    return std::uint32_t(scene_.materials.size() - 1);
  }
  std::string name;
  if (!reader_.text(value, "a material's name or a mapping", name)) return {};
  if (const auto found = by_name_.find(name); found != by_name_.end()) return found->second;
  std::string hint = "the scene has no list of materials";
  if (!by_name_.empty()) {
    // What was meant is looked for among all names, but not for thousands of errors among thousands of names.
    constexpr std::size_t most_compared = 100000;
    hint.clear();
    compared_ += by_name_.size();
    if (compared_ <= most_compared) {
      std::vector<std::string> known;
      for (const auto& [other, index] : by_name_) known.push_back(other);
      hint = suggestion(name, known);
    }
  }
  reader_.error(*value.node, "there is no material '" + name + "'", hint);
  return {};
}

std::string model_key(const std::string& folder, const std::string& file) {
  const std::filesystem::path path =
      std::filesystem::path(folder) / file;  // an absolute `file` stands for itself
  return path.lexically_normal().string();
}

/// Gives each object of a model a list of the materials that its shape has, and no others: a list of all of
/// them for each of many objects would make gigabytes of a small file.
void list_own_materials(Model& model) {
  if (model.objects.empty())
    for (std::uint32_t i = 0; i < model.shapes.size(); ++i) model.objects.push_back({{}, i, {}, {}});
  std::vector<std::vector<std::uint32_t>> own(model.shapes.size());
  constexpr std::uint32_t none = ~0u;
  std::vector<std::uint32_t> place(model.materials.size(), none);
  for (std::size_t i = 0; i < model.shapes.size(); ++i) {
    std::vector<std::uint32_t>& of_primitive = model.shapes[i].material_of_primitive;
    if (of_primitive.empty()) own[i] = {0};
    for (std::uint32_t& material : of_primitive) {
      if (place[material] == none) {
        place[material] = std::uint32_t(own[i].size());
        own[i].push_back(material);
      }
      material = place[material];
    }
    for (const std::uint32_t material : own[i]) place[material] = none;
    if (own[i].size() == 1) std::vector<std::uint32_t>().swap(of_primitive);
  }
  for (ModelObject& object : model.objects) object.materials = own[object.shape];
}

const ObjectReader::Placed* ObjectReader::model(const Value& file, bool is_scene) {
  std::string name;
  if (!reader_.text(file, "a file's name", name)) return nullptr;
  const std::string key = model_key(folder_, name);
  const auto known = placed_.find(key);
  if (known != placed_.end()) return known->second.good ? &known->second : nullptr;
  Placed& placed = placed_[key];

  std::optional<Model> model;
  if (const auto loaded = loaded_.find(key); loaded != loaded_.end()) {
    model = std::move(loaded->second);
    loaded_.erase(loaded);
  } else if (!is_scene && !is_model_file(name)) {
    reader_.error(*file.node, "'" + name + "' is no model file that Lambent reads",
                  "known endings: " + model_file_endings());
    return nullptr;
  } else {
    const auto path = Files{folder_, import_}.find(reader_, file);
    if (!path) return nullptr;
    try {
      model = is_scene ? import_scene(*path, import_) : import_model(*path, import_);
    } catch (const InputError& wrong) {
      for (const Diagnostic& diagnostic : wrong.diagnostics()) reader_.error(*file.node, diagnostic);
      return nullptr;
    }
  }
  if (!is_scene) list_own_materials(*model);  // a scene's objects have theirs
  for (const Shape& shape : model->shapes) stored_ += primitive_count(shape);
  if (stored_ > import_.limits.primitives) {
    reader_.error(*file.node,
                  fmt::format("together the files have more than {} primitives", import_.limits.primitives),
                  "--max-primitives sets another limit");
    return nullptr;
  }
  std::vector<Place> replaced_places;
  const std::size_t first_material = scene_.materials.size();
  for (Material& material : model->materials) {
    if (const auto replaced = by_name_.find(material.name); replaced != by_name_.end()) {
      placed.materials.push_back(replaced->second);
      replaced_places.push_back(material.place);
      continue;
    }
    placed.materials.push_back(std::uint32_t(scene_.materials.size()));
    scene_.materials.push_back(std::move(material));
  }
  const auto first_texture = std::uint32_t(scene_.textures.size());
  std::move(model->textures.begin(), model->textures.end(), std::back_inserter(scene_.textures));
  for (std::size_t i = first_material; i < scene_.materials.size(); ++i)
    for (MaterialMap& map : scene_.materials[i].maps) map.map.texture += first_texture;
  const auto first_shape = std::uint32_t(scene_.shapes.size());
  placed.objects = std::move(model->objects);
  for (ModelObject& object : placed.objects) object.shape += first_shape;
  std::move(model->shapes.begin(), model->shapes.end(), std::back_inserter(scene_.shapes));
  for (Diagnostic& warning : model->warnings) {
    // What was odd about a material that the scene replaces matters to nobody.
    const bool moot = std::any_of(replaced_places.begin(), replaced_places.end(), [&](const Place& place) {
      return place.line > 0 && place.line == warning.place.line && place.file == warning.place.file;
    });
    if (!moot) scene_.warnings.push_back(std::move(warning));
  }
  placed.good = true;
  return &placed;
}

bool ObjectReader::inline_mesh(const Values& values, const Section& section) {
  const Value* vertices = values.find("vertices");
  const Value* triangles = values.find("triangles");
  const auto field = [&](const char* name) -> const Field& { return *find(section.fields, name); };
  if (vertices == nullptr || triangles == nullptr) {
    const Node& at = values.whole.key != nullptr ? *values.whole.key : *values.whole.node;
    if (!values.unknown_keys)
      reader_.error(at, vertices != nullptr    ? "a mesh with 'vertices' needs 'triangles'"
                        : triangles != nullptr ? "a mesh with 'triangles' needs 'vertices'"
                                               : "a mesh needs 'file', or 'vertices' and 'triangles'");
    return false;
  }
  bool good = true;
  Mesh mesh;
  for (const Vec3<double>& p : points(reader_, *vertices, "vertex", field("vertices"), good))
    mesh.vertices.push_back(cast<float>(p));
  const std::size_t count = vertices->node->children.size();
  const auto one_each = [&](const Value& value) {
    if (value.node->kind != Node::Kind::list || value.node->children.size() == count) return;
    reader_.error(*value.node, fmt::format("{} has {} elements, but there are {} vertices", value.label,
                                           value.node->children.size(), count));
    good = false;
  };
  if (const auto list = reader_.list(*triangles, "triangle")) {
    if (list->empty()) {
      reader_.error(*triangles->node, "'triangles' is an empty list", "a mesh has one triangle at least");
      good = false;
    }
    for (const Value& one : *list) {
      std::array<double, 3> corners{};
      if (!reader_.numbers({one.node, nullptr, one.label + " of 'triangles'"}, {0, 4294967295.0}, corners)) {
        good = false;
        continue;
      }
      std::array<std::uint32_t, 3> triangle{};
      for (std::size_t i = 0; i < 3; ++i) {
        const Node& corner = *one.node->children[i];
        if (corners[i] != std::floor(corners[i])) {
          reader_.error(corner, fmt::format("an index of {} is {}, but must be a whole number", one.label,
                                            corner.text));
          good = false;
        } else if (corners[i] >= double(count)) {
          reader_.error(
              corner,
              fmt::format("{} refers to vertex {}, but there are only {}", one.label, corner.text, count),
              count > 0 ? fmt::format("indices are 0 to {}", count - 1) : "");
          good = false;
        } else {
          triangle[i] = std::uint32_t(corners[i]);
        }
      }
      mesh.triangles.push_back(triangle);
    }
  } else {
    good = false;
  }
  if (const Value* normals = values.find("normals")) {
    for (const Vec3<double>& n : points(reader_, *normals, "normal", field("normals"), good))
      mesh.normals.push_back(cast<float>(max_abs(n) > 0 ? normalize(n) : n));
    one_each(*normals);
  }
  if (const Value* uvs = values.find("uvs")) {
    good = rows<2>(reader_, *uvs, "uv", limits(field("uvs")),
                   [&](const std::array<double, 2>& uv, const Value&) {
                     mesh.uvs.push_back({float(uv[0]), float(uv[1])});
                   }) &&
           good;
    one_each(*uvs);
  }
  if (good) add_shape("mesh", std::move(mesh));
  return good;
}

bool ObjectReader::scene(const Values& values) {
  const Value* file = values.find("file");
  if (file == nullptr) return false;
  file_ = model(*file, true);
  if (file_ == nullptr) return false;
  placed_shapes_ = file_->objects;
  return true;
}

bool ObjectReader::mesh(const Values& values, const Section& section, Object&) {
  const Value* file = values.find("file");
  if (file == nullptr) return inline_mesh(values, section);
  bool good = true;
  for (const Value& other : values.values) {
    if (other.key->text == "file") continue;
    reader_.error(*other.key, other.label + " stands beside 'file'",
                  "a mesh comes from a file or is written out, not both");
    good = false;
  }
  file_ = model(*file);
  if (file_ == nullptr || !good) return false;
  placed_shapes_ = file_->objects;
  return true;
}

bool ObjectReader::shape(const Section& section, const Value& value, Object& object) {
  const auto values = reader_.mapping(value, section.fields, "a " + section.name);
  if (!values) return false;
  const std::size_t before = reader_.count();
  const auto read = [&](auto& settings) {
    reader_.table(*values, section.fields, settings);
    return reader_.count() == before && !values->unknown_keys &&
           std::all_of(section.fields.begin(), section.fields.end(), [&](const Field& field) {
             return !field.required || values->find(field.name) != nullptr;
           });
  };
  if (section.name == "sphere") {
    Sphere sphere;
    if (!read(sphere)) return false;
    add_shape(section.name, std::vector<Sphere>{sphere});
  } else if (section.name == "disc") {
    Disc disc;
    if (!read(disc)) return false;
    add_shape(section.name, std::vector<Disc>{disc});
  } else if (section.name == "plane") {
    Plane plane;
    std::array<double, 2> size{};
    const Value* extent = values->find("size");
    if (extent != nullptr) reader_.numbers(*extent, limits(*find(section.fields, "size")), size);
    if (!read(plane)) return false;
    if (extent != nullptr) add_shape("rectangle", rectangle(plane, size[0], size[1]));
    else add_shape(section.name, std::vector<Plane>{plane});
  } else if (section.name == "box") {
    BoxSettings settings;
    if (!read(settings)) return false;
    const char* axes[] = {"x", "y", "z"};
    const double lower[] = {settings.min.x, settings.min.y, settings.min.z},
                 upper[] = {settings.max.x, settings.max.y, settings.max.z};
    for (int i = 0; i < 3; ++i)
      if (!(lower[i] < upper[i]))
        reader_.error(values->find("max")->place(),
                      fmt::format("{} of 'max' is {}, but must be more than {}, that of 'min'", axes[i],
                                  upper[i], lower[i]));
    if (reader_.count() != before) return false;
    add_shape(section.name, box(settings.min, settings.max));
  } else if (section.name == "cylinder" || section.name == "cone") {
    Cone cone;
    const bool capped = read_capped(reader_, *values);
    if (section.name == "cylinder") {
      CylinderSettings settings;
      if (!read(settings)) return false;
      cone = {settings.from, settings.to, settings.radius, settings.radius};
    } else {
      if (!read(cone)) return false;
      if (cone.radius_from < positive.min && cone.radius_to < positive.min)
        reader_.error(values->find("radius_to")->place(), "'radius_from' and 'radius_to' are both 0",
                      "one of them may be");
    }
    differ(reader_, *values, "from", "to", cone.from, cone.to);
    if (reader_.count() != before) return false;
    add_shape(section.name, std::vector<Cone>{cone});
    if (capped) add_shape("caps", caps(cone));
  } else if (section.name == "polygon") {
    const Value* vertices = values->find("vertices");
    if (vertices == nullptr) return false;
    bool good = true;
    const auto corners = points(reader_, *vertices, "vertex", *find(section.fields, "vertices"), good);
    if (!good || values->unknown_keys) return false;
    if (corners.size() < 3) {
      reader_.error(vertices->place(),
                    fmt::format("a polygon needs 3 vertices at least, not {}", corners.size()));
      return false;
    }
    const double uneven = unevenness(corners);
    if (uneven < 0) {
      reader_.error(vertices->place(), "this polygon has no area");
      return false;
    }
    if (uneven > 1e-4) {
      reader_.error(
          vertices->place(),
          fmt::format("this polygon is not flat: its vertices lie up to {:.2g} of its size off their plane",
                      uneven),
          "up to 1e-4 is allowed; for a curved surface use a mesh");
      return false;
    }
    add_shape(section.name, polygon(corners));
  } else if (section.name == "scene") {
    return scene(*values);
  } else {
    return mesh(*values, section, object);
  }
  return reader_.count() == before;
}

/// Files that show files multiply: what is stored once is an object each time, with a name of its own.
bool ObjectReader::has_room(const Object& object, const Value& value) {
  // An object takes as much memory as some ten triangles, and passes through several hands.
  constexpr std::uint64_t weight = 100, harmless = weight << 16;
  const std::uint64_t most = std::max(import_.limits.primitives, harmless);
  for (const ModelObject& part : placed_shapes_)
    shown_ += weight + object.name.size() + part.name.size() + part.materials.size();
  if (shown_ <= most) return true;
  if (!full_)
    reader_.error(*value.node, "the scene shows too many objects",
                  fmt::format("they count for more than {} primitives: {} each, and one for each letter of "
                              "their names; --max-primitives sets another limit",
                              most, weight));
  full_ = true;
  return false;
}

void ObjectReader::object(const Value& value, const std::string& default_name) {
  const Format& f = format();
  std::vector<Field> fields = f.object.fields;
  for (const Section& one : f.shapes) {
    Field& field = fields.emplace_back();
    field.name = one.name;
    field.type = FieldType::section;
  }
  const auto values = reader_.mapping(value, fields, "an object");
  if (!values) return;

  Object object;
  object.name = default_name;
  object.place = place_of(reader_.document(), *value.node);
  if (const Value* name = values->find("name")) reader_.text(*name, "text", object.name);
  if (const Value* transform = values->find("transform"))
    read_transform(reader_, *transform, object.world_from_object);
  if (const Value* motion = values->find("motion")) read_motion(reader_, *motion, object.motion);

  placed_shapes_.clear();
  file_ = nullptr;
  const Value* first = nullptr;
  bool good = true;
  for (const Value& one : values->values) {
    const auto section = std::find_if(f.shapes.begin(), f.shapes.end(),
                                      [&](const Section& s) { return s.name == one.key->text; });
    if (section == f.shapes.end()) continue;
    if (first != nullptr) {
      reader_.error(*one.key, one.label + " stands beside " + first->label,
                    "an object is one shape; make it a second object");
      good = false;
    } else {
      first = &one;
    }
    good = shape(*section, one, object) && good;
  }
  if (first == nullptr && !values->unknown_keys)
    reader_.error(*value.node, "this object has no shape", "a shape is one of: " + join(names_of(f.shapes)));

  std::optional<std::uint32_t> own;
  if (const Value* one = values->find("material")) {
    own = material(*one);
    if (!own) good = false;
  }
  if (!good || first == nullptr) return;
  if (file_ == nullptr) object.materials = {own ? *own : default_material()};
  if (!has_room(object, value)) return;
  const Transform placing = object.world_from_object;
  const std::string name = object.name;
  for (const ModelObject& part : placed_shapes_) {
    object.shape = part.shape;
    if (file_ != nullptr) {
      object.materials.clear();
      for (const std::uint32_t m : part.materials)
        object.materials.push_back(own ? *own : file_->materials[m]);
    }
    object.world_from_object = placing * part.world_from_object;
    object.name = part.name.empty() ? name : name + "/" + part.name;
    scene_.objects.push_back(object);
  }
}

}  // namespace lambent
