#include "import/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "import/paths.h"
#include "import/text_file.h"

namespace lambent::gltf {

namespace {

Rgb rgb(const Json& list, const Rgb& otherwise) {
  if (list.is_null()) return otherwise;
  return {{list[0].get<double>(), list[1].get<double>(), list[2].get<double>()}};
}

Wrap wrap(const Json& sampler, const char* key) {
  switch (whole(sampler, key, 10497)) {
    case 33071:
      return Wrap::clamp;
    case 33648:
      return Wrap::mirror;
    default:
      return Wrap::repeat;
  }
}

/// KHR_texture_transform takes (u, v) to T R S (u, v), with v downwards. Here v is 1 less that.
std::array<double, 6> transform_matrix(const Json& transform) {
  const Json &offset = member(transform, "offset"), &scale = member(transform, "scale");
  const double ox = offset.is_null() ? 0 : offset[0].get<double>(),
               oy = offset.is_null() ? 0 : offset[1].get<double>();
  const double sx = scale.is_null() ? 1 : scale[0].get<double>(),
               sy = scale.is_null() ? 1 : scale[1].get<double>();
  const double angle = number(transform, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
  // Theirs: u' = c sx u + s sy v + ox, v' = -s sx u + c sy v + oy; v and v' each replaced by 1 less it.
  return {c * sx, -s * sy, ox + s * sy, s * sx, c * sy, 1 - c * sy - oy};
}

/// Reflection of what is no metal with ior 1.5, head on.
constexpr double reflection_of_glass = 0.04;

}  // namespace

void Materials::read() {
  const Json& all = member(root_, "materials");
  for (std::size_t i = 0; i < all.size(); ++i) add(all[i], std::string("/materials") / i);
}

std::uint32_t Materials::of(const Json& primitive) {
  if (const Json& material = member(primitive, "material"); !material.is_null())
    return material.get<std::uint32_t>();
  if (!default_) {
    add(Json::object(), "");
    default_ = std::uint32_t(model_.materials.size() - 1);
    model_.materials.back().name = names_("default");
  }
  return *default_;
}

std::uint32_t Materials::tinted(std::uint32_t original, const std::array<float, 4>& color) {
  if (color == std::array<float, 4>{1, 1, 1, 1}) return original;
  const auto [found, is_new] = tinted_.try_emplace({original, color}, std::uint32_t(model_.materials.size()));
  if (!is_new) return found->second;
  // Each takes some hundred bytes; primitives may share colours, and so make many pairs of few.
  constexpr std::uint64_t harmless = 1 << 16, bytes_of_one = 64;
  if (tinted_.size() > harmless && tinted_.size() > buffers_.total() / bytes_of_one)
    remarks_.fail("/materials", "the colours of points, lines and what glows make " +
                                    std::to_string(tinted_.size()) +
                                    " materials, too many for a file of this size");
  Material material = model_.materials[original];
  material.name = names_(material.name + ", tinted");
  Rgb& base = material.metallic_roughness ? material.metallic_roughness->base_color : material.emission;
  for (int i = 0; i < 3; ++i) base[i] *= double(color[std::size_t(i)]);
  if (!traits_[original].opaque) material.opacity *= double(color[3]);
  model_.materials.push_back(std::move(material));
  traits_.push_back(MaterialTraits(traits_[original]));
  return found->second;
}

void Materials::add(const Json& json, const std::string& at) {
  Material material;
  if (!at.empty()) {
    const std::string name = name_in(json);
    material.name = names_(name.empty() ? "material " + std::to_string(model_.materials.size() + 1) : name);
  }
  material.place.file = remarks_.file();
  const std::string mode = text(json, "alphaMode", "OPAQUE");
  MaterialTraits traits;
  traits.opaque = mode == "OPAQUE";
  traits.unlit = extension(json, "KHR_materials_unlit").is_object();
  material.alpha = mode == "MASK" ? Alpha::mask : Alpha::blend;
  material.alpha_cutoff = number(json, "alphaCutoff", 0.5);
  material.one_sided = !flag(json, "doubleSided", false);
  const Json& glossy = extension(json, "KHR_materials_pbrSpecularGlossiness");
  if (traits.unlit) {
    // What it shows is its base colour, whatever the light.
    material.ambient = material.diffuse = Rgb{};
    const Json& settings = member(json, "pbrMetallicRoughness");
    base_color(member(settings, "baseColorFactor"), member(settings, "baseColorTexture"),
               at + "/pbrMetallicRoughness/baseColorTexture", mode, material);
  } else {
    material.metallic_roughness.emplace();
    if (glossy.is_object()) specular_glossiness(json, at, material);
    else metallic_roughness(json, at, material);
    extensions(json, at, material);
    if (TextureMap* normal =
            map(material, MapSlot::normal, member(json, "normalTexture"), at + "/normalTexture", false)) {
      normal->strength = number(json["normalTexture"], "scale", 1);
      traits.normal_uvs = normal->uv_set;
    }
    const Json& occlusion = member(json, "occlusionTexture");
    if (TextureMap* map_of_it =
            map(material, MapSlot::occlusion, occlusion, at + "/occlusionTexture", false, 0))
      map_of_it->strength = number(occlusion, "strength", 1);
    const double strength = number(extension(json, "KHR_materials_emissive_strength"), "emissiveStrength", 1);
    material.emission = strength * rgb(member(json, "emissiveFactor"), {});
    if (!(material.emission == Rgb{}))
      map(material, MapSlot::emission, member(json, "emissiveTexture"), at + "/emissiveTexture", true);
  }
  model_.materials.push_back(std::move(material));
  traits_.push_back(traits);
}

void Materials::base_color(const Json& factor, const Json& texture, const std::string& at,
                           const std::string& alpha_mode, Material& material) {
  const Rgb color = rgb(factor, {{1, 1, 1}});
  const MapSlot slot = material.metallic_roughness ? MapSlot::base_color : MapSlot::emission;
  (material.metallic_roughness ? material.metallic_roughness->base_color : material.emission) = color;
  map(material, slot, texture, at, true);
  if (alpha_mode == "OPAQUE") return;
  if (!factor.is_null()) material.opacity = factor[3].get<double>();
  map(material, MapSlot::opacity, texture, at, false, 3);
}

void Materials::metallic_roughness(const Json& json, const std::string& at, Material& material) {
  const Json& settings = member(json, "pbrMetallicRoughness");
  const std::string place = at + "/pbrMetallicRoughness";
  base_color(member(settings, "baseColorFactor"), member(settings, "baseColorTexture"),
             place + "/baseColorTexture", text(json, "alphaMode", "OPAQUE"), material);
  material.metallic_roughness->metallic = number(settings, "metallicFactor", 1);
  material.metallic_roughness->roughness = number(settings, "roughnessFactor", 1);
  const Json& texture = member(settings, "metallicRoughnessTexture");
  map(material, MapSlot::metallic, texture, place + "/metallicRoughnessTexture", false, 2);
  map(material, MapSlot::roughness, texture, place + "/metallicRoughnessTexture", false, 1);
}

/// Its reflection head on is given as it is, and that of the other kind of material is 0.04 specular_color.
void Materials::specular_glossiness(const Json& json, const std::string& at, Material& material) {
  const Json& settings = extension(json, "KHR_materials_pbrSpecularGlossiness");
  const std::string place = at + "/extensions/KHR_materials_pbrSpecularGlossiness";
  base_color(member(settings, "diffuseFactor"), member(settings, "diffuseTexture"), place + "/diffuseTexture",
             text(json, "alphaMode", "OPAQUE"), material);
  MetallicRoughness& target = *material.metallic_roughness;
  const double glossiness = number(settings, "glossinessFactor", 1);
  target.metallic = 0;
  target.roughness = 1 - glossiness;
  target.specular_color = (1 / reflection_of_glass) * rgb(member(settings, "specularFactor"), {{1, 1, 1}});
  const Json& texture = member(settings, "specularGlossinessTexture");
  map(material, MapSlot::specular_color, texture, place + "/specularGlossinessTexture", true);
  if (TextureMap* roughness =
          map(material, MapSlot::roughness, texture, place + "/specularGlossinessTexture", false, 3)) {
    target.roughness = 1;
    roughness->offset = 1, roughness->gain = -glossiness;
  }
}

void Materials::extensions(const Json& json, const std::string& at, Material& material) {
  MetallicRoughness& target = *material.metallic_roughness;
  if (const Json& ior = extension(json, "KHR_materials_ior"); ior.is_object()) {
    target.ior = number(ior, "ior", 1.5);
    if (target.ior < 1) {
      // 0 stands for a surface that reflects all of its specular colour.
      target.ior = 1.5;
      target.specular_color = (1 / reflection_of_glass) * target.specular_color;
    }
  }
  if (const Json& specular = extension(json, "KHR_materials_specular"); specular.is_object()) {
    const std::string place = at + "/extensions/KHR_materials_specular";
    target.specular = number(specular, "specularFactor", 1);
    target.specular_color = target.specular_color * rgb(member(specular, "specularColorFactor"), {{1, 1, 1}});
    map(material, MapSlot::specular_factor, member(specular, "specularTexture"), place + "/specularTexture",
        false, 3);
    map(material, MapSlot::specular_color, member(specular, "specularColorTexture"),
        place + "/specularColorTexture", true);
  }
  if (const Json& transmission = extension(json, "KHR_materials_transmission"); transmission.is_object()) {
    target.transmission = number(transmission, "transmissionFactor", 0);
    map(material, MapSlot::transmission, member(transmission, "transmissionTexture"),
        at + "/extensions/KHR_materials_transmission/transmissionTexture", false, 0);
  }
  if (const Json& clearcoat = extension(json, "KHR_materials_clearcoat"); clearcoat.is_object()) {
    const std::string place = at + "/extensions/KHR_materials_clearcoat";
    target.clearcoat = number(clearcoat, "clearcoatFactor", 0);
    target.clearcoat_roughness = number(clearcoat, "clearcoatRoughnessFactor", 0);
    map(material, MapSlot::clearcoat, member(clearcoat, "clearcoatTexture"), place + "/clearcoatTexture",
        false, 0);
    map(material, MapSlot::clearcoat_roughness, member(clearcoat, "clearcoatRoughnessTexture"),
        place + "/clearcoatRoughnessTexture", false, 1);
    if (member(clearcoat, "clearcoatNormalTexture").is_object() && target.clearcoat > 0)
      remarks_.warn(place + "/clearcoatNormalTexture",
                    "a coat with a relief of its own is not supported; it has that of the surface");
  }
}

TextureMap* Materials::map(Material& material, MapSlot slot, const Json& info, const std::string& at,
                           bool srgb, int channel) {
  if (!info.is_object()) return nullptr;
  const std::size_t number_of_texture = whole(info, "index", 0);
  const Json& json = root_["textures"][number_of_texture];
  const auto found = texture(json, std::string("/textures") / number_of_texture, srgb);
  if (!found) return nullptr;
  const Json& transform = extension(info, "KHR_texture_transform");
  TextureMap result;
  result.texture = *found;
  const std::uint64_t set = whole(transform, "texCoord", whole(info, "texCoord", 0));
  if (set > 1) remarks_.warn(at, "only TEXCOORD_0 and TEXCOORD_1 are supported; TEXCOORD_0 is used");
  result.uv_set = set == 1 ? 1 : 0;
  if (const Json& sampler = member(json, "sampler"); !sampler.is_null()) {
    const Json& settings = root_["samplers"][sampler.get<std::size_t>()];
    result.wrap_u = wrap(settings, "wrapS"), result.wrap_v = wrap(settings, "wrapT");
    result.nearest = whole(settings, "magFilter", 9729) == 9728;
  }
  if (transform.is_object()) result.matrix = transform_matrix(transform);
  result.channel = std::int8_t(channel);
  material.maps.push_back({slot, result});
  return &material.maps.back().map;
}

std::optional<std::uint32_t> Materials::texture(const Json& json, const std::string& at, bool srgb) {
  const Json& source = member(json, "source");
  if (source.is_null()) {
    remarks_.warn(at, "has no image in a format that is supported; it is left out", "PNG and JPEG are");
    return std::nullopt;
  }
  const std::size_t number_of_image = source.get<std::size_t>();
  const auto [found, is_new] =
      textures_.try_emplace({number_of_image, srgb}, std::uint32_t(model_.textures.size()));
  if (!is_new) return found->second;
  const std::optional<ImageSource>& from = image(number_of_image);
  if (!from) {
    textures_.erase(found);
    return std::nullopt;
  }
  Texture result;
  result.source = *from;
  result.srgb = srgb;
  model_.textures.push_back(std::move(result));
  return found->second;
}

const std::optional<ImageSource>& Materials::image(std::size_t number_of_image) {
  const auto [found, is_new] = images_.try_emplace(number_of_image);
  if (!is_new) return found->second;
  const Json& json = root_["images"][number_of_image];
  const std::string at = std::string("/images") / number_of_image, uri = text(json, "uri");
  ImageSource source;
  source.name = "image " + std::to_string(number_of_image) + " of " +
                std::filesystem::path(remarks_.file()).filename().string();
  source.place.file = remarks_.file();
  if (const Json& view = member(json, "bufferView"); !view.is_null()) {
    if (const auto bytes = buffers_.view(view.get<std::size_t>())) {
      // Images may share bytes, but not to the point that the file's size says nothing.
      image_bytes_ += bytes->size();
      if (image_bytes_ > 4 * buffers_.total())
        remarks_.fail(at, "the images have more bytes than the file several times over");
      source.bytes = std::make_shared<std::string>(*bytes);
    } else {
      remarks_.warn(at, "the image's bytes are missing; it is left out");
    }
  } else if (is_data_uri(uri)) {
    std::string complaint;
    source.bytes = std::make_shared<std::string>(read_data_uri(uri, complaint)->bytes);
  } else {
    const std::string name = *percent_decoded(uri);
    NamedFile file = has_scheme(uri) ? NamedFile{} : find_named_file(remarks_.file(), name, options_);
    if (file.path.empty() && !file.outside && name != uri && !has_scheme(uri))
      file = find_named_file(remarks_.file(), uri, options_);
    source.file = source.name = file.path;
    if (file.path.empty())
      remarks_.warn(at + "/uri",
                    in_quotes(name) +
                        (file.outside ? " lies outside of the model's folder" : " is not there") +
                        "; the surfaces are shown without it",
                    file.outside ? hint_for_outside : "");
  }
  if (source.bytes || !source.file.empty()) found->second = std::move(source);
  return found->second;
}

}  // namespace lambent::gltf
