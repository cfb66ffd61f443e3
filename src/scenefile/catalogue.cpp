// What there is, for people: the format's sections as the public API shows them.

#include "lambent/lambent.h"
#include "scenefile/format.h"
#include "scenefile/nearest.h"

namespace lambent {
namespace {

ParameterInfo parameter(const Field& field) {
  ParameterInfo info;
  info.name = field.name;
  info.type = type_name(field.type);
  info.unit = field.unit;
  info.default_value = field.default_value;
  info.range = field.choices.empty() ? describe(field.range) : join(field.choices);
  info.sentence = field.sentence;
  info.required = field.required;
  return info;
}

Entry entry(const Section& section) {
  Entry result{section.name, section.title,       section.equation,           section.source, section.differs,
               {},           section.attenuation, section.ambient_attenuation};
  for (const Field& field : section.fields) result.parameters.push_back(parameter(field));
  return result;
}

Topic topic(std::string name, std::string title, const std::vector<Section>& sections) {
  Topic result{std::move(name), std::move(title), {}};
  for (const Section& section : sections) result.entries.push_back(entry(section));
  return result;
}

}  // namespace

const std::vector<Topic>& catalogue() {
  static const std::vector<Topic> topics = [] {
    const Format& f = format();
    Section material = f.material;
    material.fields.insert(material.fields.begin(), f.material_name);
    return std::vector<Topic>{
        topic("models", "Illumination models: what one light contributes at a point", f.models),
        topic("lights", "Lights", f.lights),
        topic("shapes", "Shapes of objects", f.shapes),
        topic("materials", "What a material may say", {material}),
        topic("camera", "The camera", {f.camera}),
        topic("image", "The image", {f.image}),
        topic("film", "What is kept beside the colours", {f.film}),
        topic("illumination", "The equation's choices for the whole scene", {f.illumination}),
        topic("fog", "Fog", {f.fog}),
        topic("integrators", "Integrators: how rays are followed", f.integrators),
    };
  }();
  return topics;
}

}  // namespace lambent
