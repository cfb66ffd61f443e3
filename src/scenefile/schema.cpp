// The JSON Schema of scene files, made from the format's sections: editors complete and check by it.

#include <cmath>
#include <nlohmann/json.hpp>

#include "lambent/lambent.h"
#include "scenefile/format.h"
#include "scenefile/names.h"
#include "spectra/optical.h"

namespace lambent {
namespace {

using Json = nlohmann::ordered_json;

Json reference(const char* definition) { return {{"$ref", std::string("#/definitions/") + definition}}; }

/// Whole numbers without a point, so that the text is short.
Json number(double value) {
  if (value == std::floor(value) && std::abs(value) < 1e15) return std::int64_t(value);
  return value;
}

Json number_in(const Range& range, const char* type = "number") {
  return {{"type", type}, {"minimum", number(range.min)}, {"maximum", number(range.max)}};
}

Json array_of(Json items, std::size_t fewest, std::size_t most = 0) {
  Json array{{"type", "array"}, {"items", std::move(items)}, {"minItems", fewest}};
  if (most > 0) array["maxItems"] = most;
  return array;
}

Json words(const std::vector<std::string>& choices) { return {{"type", "string"}, {"enum", choices}}; }

/// A mapping in which every key is known.
Json object_of(const Section& section, Json properties) {
  Json required = Json::array();
  for (const Field& field : section.fields)
    if (field.required) required.push_back(field.name);
  Json object{{"type", "object"}, {"description", section.title}, {"properties", std::move(properties)}};
  if (!required.empty()) object["required"] = std::move(required);
  object["additionalProperties"] = false;
  return object;
}

/// Exactly one of these keys must be there.
Json one_of_keys(const std::vector<std::string>& names) {
  Json alternatives = Json::array();
  for (const std::string& name : names) alternatives.push_back({{"required", {name}}});
  return alternatives;
}

Json value_of_type(const Field& field) {
  const Range range = limits(field);
  const Json vector = array_of(number_in(range), 3, 3);
  switch (field.type) {
    case FieldType::number:
      return number_in(range);
    case FieldType::integer:
      return number_in(range, "integer");
    case FieldType::boolean:
      return {{"type", "boolean"}};
    case FieldType::color:
      return {{"oneOf",
               {array_of(number_in(range), 3, 3),
                number_in(range),
                {{"type", "string"}, {"pattern", "^#[0-9a-fA-F]{6}$"}},
                reference("spectrum")}}};
    case FieldType::vector:
    case FieldType::point:
    case FieldType::direction:
      return vector;
    case FieldType::choice:
      return words(field.choices);
    case FieldType::name:
    case FieldType::file:
      return {{"type", "string"}, {"minLength", 1}};
    case FieldType::image_size:
      return array_of(number_in(range, "integer"), 2, 2);
    case FieldType::extent:
      return array_of(number_in(range), 2, 2);
    case FieldType::points:
      return array_of(vector, field.required ? 3 : 0);
    case FieldType::directions:
      return array_of(vector, 0);
    case FieldType::triangles:
      return array_of(array_of(number_in({0, 4294967295.0}, "integer"), 3, 3), 1);
    case FieldType::uvs:
      return array_of(array_of(number_in(range), 2, 2), 0);
    case FieldType::factors:
      return {{"oneOf", {number_in(range), vector}}};
    case FieldType::axis:
      return {{"oneOf", {words({"x", "y", "z"}), vector}}};
    case FieldType::matrix:
      return array_of(array_of(number_in(range), 4, 4), 3, 3);
    case FieldType::attenuation:
      return {{"oneOf", {words(names_of<Attenuation>()), reference("attenuation")}}};
    case FieldType::samples:
      return {{"oneOf", {number_in(range, "integer"), reference("samples")}}};
    case FieldType::material:
      return {{"oneOf", {{{"type", "string"}, {"minLength", 1}}, reference("material")}}};
    case FieldType::background:
      return {{"oneOf",
               {array_of(number_in(range), 3, 3),
                number_in(range),
                {{"type", "string"}, {"pattern", "^#[0-9a-fA-F]{6}$"}},
                reference("background")}}};
    case FieldType::map:
      return {{"oneOf", {{{"type", "string"}, {"minLength", 1}}, reference("map")}}};
    case FieldType::substance: {
      const bool metal = field.name == "metal";
      std::vector<std::string> names;
      if (metal)
        for (const NamedMetal& one : metals()) names.emplace_back(one.name);
      else
        for (const NamedGlass& one : glasses()) names.emplace_back(one.name);
      return {{"oneOf", {words(names), reference(metal ? "metal" : "glass")}}};
    }
    case FieldType::numbers:
      return array_of(number_in(range), 1);
    case FieldType::wavelengths:
      return {{"oneOf",
               {number_in({1, most_wavelengths}, "integer"),
                array_of(number_in(range), 1, std::size_t(most_wavelengths))}}};
    case FieldType::transform:
      return {{"oneOf", {reference("step"), array_of(reference("step"), 0)}}};
    case FieldType::motion:
      return {{"oneOf", {reference("motion_step"), array_of(reference("motion_step"), 0)}}};
    case FieldType::section:
      return reference(field.name.c_str());
    case FieldType::sections:
      return array_of(reference(field.name.substr(0, field.name.size() - 1).c_str()), 0);
  }
  __builtin_unreachable();
}

Json schema_of(const Field& field) {
  Json schema = value_of_type(field);
  // Draft 7 reads nothing beside a $ref, so that it stands in an allOf of its own.
  if (schema.contains("$ref")) schema = {{"allOf", {schema}}};
  schema["description"] = field.sentence + (field.unit.empty() ? "" : " Unit: " + field.unit + ".");
  if (!field.default_value.empty()) {
    Json value = Json::parse(field.default_value, nullptr, false);
    schema["default"] = value.is_discarded() ? Json(field.default_value) : value;
  }
  return schema;
}

Json properties_of(const Section& section) {
  Json properties = Json::object();
  for (const Field& field : section.fields) properties[field.name] = schema_of(field);
  return properties;
}

Json object_of(const Section& section) { return object_of(section, properties_of(section)); }

/// A mapping with the fields of `section` and exactly one of `kinds`.
Json one_kind_of(const Section& section, const std::vector<Section>& kinds) {
  Json properties = properties_of(section);
  for (const Section& kind : kinds) properties[kind.name] = object_of(kind);
  Json object = object_of(section, std::move(properties));
  object["oneOf"] = one_of_keys(names_of(kinds));
  return object;
}

}  // namespace

std::string scene_schema() {
  const Format& f = format();
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Lambent scene"}};
  schema.update(object_of(f.top));
  Json& definitions = schema["definitions"] = Json::object();
  definitions["camera"] = object_of(f.camera);
  definitions["image"] = object_of(f.image);
  definitions["film"] = object_of(f.film);
  definitions["samples"] = object_of(f.samples);
  definitions["samples"]["minProperties"] = 1;
  definitions["adaptive"] = object_of(f.adaptive);
  definitions["illumination"] = object_of(f.illumination);
  definitions["attenuation"] = object_of(f.attenuation);
  definitions["attenuation"]["minProperties"] = 1;
  definitions["integrator"] = object_of(f.integrator);
  definitions["integrator"]["oneOf"] = one_of_keys(names_of(f.integrators));
  for (const Section& integrator : f.integrators) definitions[integrator.name] = object_of(integrator);
  definitions["light"] = one_kind_of(f.light, f.lights);
  definitions["material"] = object_of(f.material);
  Section named = f.material;
  named.name = "named material";
  named.fields.insert(named.fields.begin(), f.material_name);
  definitions["named_material"] = object_of(named);
  schema["properties"]["materials"]["items"] = reference("named_material");
  Json object = one_kind_of(f.object, f.shapes);
  object["properties"]["mesh"]["oneOf"] = {
      {{"required", {"file"}},
       {"not", {{"anyOf", one_of_keys({"vertices", "triangles", "normals", "uvs"})}}}},
      {{"required", {"vertices", "triangles"}}, {"not", {{"required", {"file"}}}}}};
  definitions["object"] = std::move(object);
  definitions["ambient_occlusion"] = object_of(f.ambient_occlusion);
  definitions["background"] = object_of(f.background);
  definitions["fog"] = object_of(f.fog);
  definitions["metallic_roughness"] = object_of(f.metallic_roughness);
  definitions["metal"] = object_of(f.metal);
  definitions["glass"] = object_of(f.glass);
  definitions["glass"]["minProperties"] = 1;
  definitions["glass"]["oneOf"] = {{{"required", {"wavelengths", "n"}}},
                                   {{"not", {{"anyOf", one_of_keys({"wavelengths", "n"})}}}}};
  definitions["spectrum"] = object_of(f.spectrum);
  definitions["spectrum"]["oneOf"] = {{{"required", {"blackbody"}}},
                                      {{"required", {"wavelengths", "values"}}},
                                      {{"required", {"wavelengths", "power"}}}};
  definitions["maps"] = object_of(f.maps);
  definitions["map"] = object_of(f.map);
  for (const char* pair : {"scale", "offset"})
    definitions["map"]["properties"][pair] = array_of(number_in({-largest_number, largest_number}), 2, 2);
  definitions["rotate"] = object_of(f.rotate);
  definitions["step"] = object_of(f.transform);
  definitions["step"]["oneOf"] = one_of_keys(names_of(f.transform.fields));
  definitions["motion_step"] = object_of(f.motion);
  definitions["motion_step"]["oneOf"] = one_of_keys(names_of(f.motion.fields));
  return schema.dump(2) + "\n";
}

}  // namespace lambent
