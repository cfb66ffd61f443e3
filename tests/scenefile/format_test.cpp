// The schema, the manual and the catalogue: made from the tables, complete, and current.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <filesystem>

#include "scene/scene.h"
#include "scenefile/errors.h"
#include "scenefile/format.h"
#include "scenefile/json_schema.h"
#include "scenefile/nearest.h"
#include "support.h"

namespace lambent::test {
namespace {

const Topic& topic(const std::string& name) {
  for (const Topic& one : catalogue())
    if (one.name == name) return one;
  throw std::logic_error("there is no topic " + name);
}

TEST(Catalogue, HoldsEveryModelAndLight) {
  std::vector<std::string> models, lights;
  for (const Entry& entry : topic("models").entries) models.push_back(entry.name);
  for (const Entry& entry : topic("lights").entries) lights.push_back(entry.name);
  ASSERT_EQ(models.size(), std::size_t(model_count));
  for (int i = 0; i < model_count; ++i) EXPECT_EQ(models[std::size_t(i)], model_infos[i].name);
  // The variant of all lights ends with std::monostate, which is none.
  EXPECT_EQ(lights.size() + 1, std::variant_size_v<AnyLight>);
  EXPECT_EQ(lights[0], PointLight::info.name);
}

TEST(Catalogue, EveryParameterHasASentenceAndADefaultUnlessRequired) {
  for (const Topic& one : catalogue())
    for (const Entry& entry : one.entries)
      for (const ParameterInfo& parameter : entry.parameters) {
        EXPECT_FALSE(parameter.sentence.empty()) << entry.name << "." << parameter.name;
        EXPECT_FALSE(parameter.type.empty()) << entry.name << "." << parameter.name;
        EXPECT_TRUE(parameter.required ? parameter.default_value.empty() : true)
            << entry.name << "." << parameter.name;
      }
}

TEST(Catalogue, TellsAParameterAsPeopleWriteIt) {
  const Entry& camera = topic("camera").entries.at(0);
  const auto fov = std::find_if(camera.parameters.begin(), camera.parameters.end(),
                                [](const auto& p) { return p.name == "fov"; });
  ASSERT_NE(fov, camera.parameters.end());
  EXPECT_EQ(fov->type, "number");
  EXPECT_EQ(fov->unit, "degrees");
  EXPECT_EQ(fov->default_value, "40");
  EXPECT_EQ(fov->range, "0.01 to 179");
  EXPECT_FALSE(fov->required);
}

/// Whatever the catalogue says is the default must be accepted, and be what holds anyway.
TEST(Catalogue, DefaultsAreWhatTheyAreSaidToBe) {
  for (const std::string name : {"camera", "image", "illumination"}) {
    for (const ParameterInfo& parameter : topic(name).entries.at(0).parameters) {
      if (parameter.default_value.empty()) continue;
      const ScenePtr plain = parse_scene(head);
      const ScenePtr said =
          parse_scene(head, "s", {{{name + "." + parameter.name, parameter.default_value}}});
      const SceneSummary a = summarize(plain), b = summarize(said);
      EXPECT_EQ(a.camera, b.camera) << parameter.name;
      EXPECT_EQ(a.model, b.model) << parameter.name;
      EXPECT_EQ(a.width, b.width) << parameter.name;
      EXPECT_EQ(a.samples, b.samples) << parameter.name;
    }
  }
}

TEST(Schema, CompletesEveryKeyOfEveryTable) {
  const Json schema = Json::parse(scene_schema());
  EXPECT_EQ(schema["$schema"], "http://json-schema.org/draft-07/schema#");
  const Json& definitions = schema["definitions"];
  const auto holds = [](const Json& object, const std::vector<Field>& fields) {
    EXPECT_EQ(object["additionalProperties"], false);
    for (const Field& field : fields) {
      EXPECT_TRUE(object["properties"].contains(field.name)) << field.name;
      EXPECT_TRUE(object["properties"][field.name].contains("description")) << field.name;
    }
  };
  const Format& f = format();
  holds(schema, f.top.fields);
  holds(definitions["camera"], f.camera.fields);
  holds(definitions["image"], f.image.fields);
  holds(definitions["illumination"], f.illumination.fields);
  holds(definitions["material"], f.material.fields);
  for (const Section& light : f.lights) holds(definitions["light"]["properties"][light.name], light.fields);
  for (const Section& shape : f.shapes) holds(definitions["object"]["properties"][shape.name], shape.fields);
  for (const Section& model : f.models) holds(definitions["material"], model.fields);
}

TEST(Schema, AcceptsWhatTheReaderAcceptsAndRefusesTheRest) {
  const JsonSchema schema(Json::parse(scene_schema()));
  const auto agree = [&](const std::string& rest, bool good) {
    const std::string text = head + rest;
    EXPECT_EQ(errors_of(text).empty(), good) << text << report(text);
    EXPECT_EQ(schema.accepts(json_of(*parse_yaml(text, "s").root)), good) << text;
  };
  agree("", true);
  agree("background: 0.5\n", true);
  agree("background: \"#a0b0c0\"\n", true);
  agree("background: \"#a0b0c\"\n", false);
  agree("background: [1, 2]\n", false);
  agree("illumination: {attenuation: 1/r^2}\n", true);
  agree("illumination: {attenuation: {linear: 1}}\n", true);
  agree("illumination: {attenuation: {}}\n", false);
  agree("illumination: {attenuation: 1/r^3}\n", false);
  agree("integrator: {}\n", false);
  agree("integrator: {whitted: {max_depth: 3}}\n", true);
  agree("integrator: {view: {show: depth}}\n", true);
  agree("integrator: {view: {show: rays, max_depth: 3}}\n", true);
  agree("integrator: {view: {}}\n", false);
  agree("integrator: {view: {show: everything}}\n", false);
  agree("integrator: {whitted: {}, view: {show: depth}}\n", false);
  agree("lights: []\n", true);
  agree("lights: [{point: {position: [0, 1, 0]}, spot: {position: [0, 1, 0], target: [0, 0, 0]}}]\n", false);
  agree("lights: [{name: a}]\n", false);
  agree("materials: [{diffuse: 1}]\n", false);
  agree("objects: [{sphere: {center: [0, 0, 0], radius: 1}, material: {shininess: 10}}]\n", true);
  agree("objects: [{sphere: {center: [0, 0, 0], radius: 1}, material: {shininess: -10}}]\n", false);
  agree("objects: [{sphere: {center: [0, 0, 0], radius: 1}, transform: {scale: 2}}]\n", true);
  agree(
      "objects: [{sphere: {center: [0, 0, 0], radius: 1}, transform: [{scale: [2, 1, 1]}, {rotate: {axis: z, "
      "degrees: 1}}]}]\n",
      true);
  agree("objects: [{sphere: {center: [0, 0, 0], radius: 1}, transform: {scale: 2, translate: [0, 0, 1]}}]\n",
        false);
  agree("objects: [{plane: {point: [0, 0, 0], normal: [0, 1, 0], size: [2, 0]}}]\n", false);
  agree("objects: [{mesh: {}}]\n", false);
  agree("objects: [{mesh: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles: [[0, 1, 2]]}}]\n", true);
  agree("objects: [{mesh: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles: [[0, 1, -2]]}}]\n", false);
  agree("objects: [{name: empty}]\n", false);
}

TEST(Manual, ItsExampleIsAScene) {
  const std::string manual = scene_manual();
  const std::size_t begin = manual.find("```yaml\nlambent: 1");
  ASSERT_NE(begin, std::string::npos);
  const std::string example = manual.substr(begin + 8, manual.find("```", begin + 8) - begin - 8);
  EXPECT_EQ(report(example), "");
  const ScenePtr scene = parse_scene(example);
  EXPECT_EQ(scene->objects.size(), 3u);
  EXPECT_EQ(scene->lights.size(), 2u);
}

TEST(Manual, TellsOfEveryKeyAndModel) {
  const std::string manual = scene_manual();
  for (const Topic& one : catalogue())
    for (const Entry& entry : one.entries) {
      if (one.name == "models" || one.name == "lights" || one.name == "shapes") {
        EXPECT_NE(manual.find("### `" + entry.name + "`"), std::string::npos) << entry.name;
      }
      EXPECT_NE(manual.find(entry.equation), std::string::npos) << entry.name;
      for (const ParameterInfo& parameter : entry.parameters)
        EXPECT_NE(manual.find("| `" + parameter.name + "` |"), std::string::npos) << parameter.name;
    }
}

/// The files under docs/ are written by the program; whoever changes a table writes them anew.
TEST(Docs, AreCurrent) {
  const std::string docs = std::string(LAMBENT_SOURCE_DIR) + "/docs/";
  EXPECT_TRUE(read_text(docs + "lambent.schema.json") == scene_schema())
      << "docs/lambent.schema.json is old; script/docs writes it anew";
  EXPECT_TRUE(read_text(docs + "scene-format.md") == scene_manual())
      << "docs/scene-format.md is old; script/docs writes it anew";
}

TEST(EditDistance, CountsLettersAndSwaps) {
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("from", "form"), 1);
  EXPECT_EQ(edit_distance("Phong", "phong"), 0);
  EXPECT_EQ(edit_distance("diffuse", "difuse"), 1);
}

TEST(EditDistance, IsSymmetricAndBounded) {
  EXPECT_TRUE(rc::check([] {
    const auto word = [] { return *rc::gen::container<std::string>(rc::gen::inRange('a', 'e')); };
    const std::string a = word(), b = word();
    const int distance = edit_distance(a, b);
    RC_ASSERT(distance == edit_distance(b, a));
    RC_ASSERT(distance <= int(std::max(a.size(), b.size())));
    RC_ASSERT(distance >= std::abs(int(a.size()) - int(b.size())));
    RC_ASSERT((distance == 0) == (a == b));
  }));
}

TEST(Nearest, NamesWhatIsNearEnough) {
  const std::vector<std::string> known{"ambient", "diffuse", "specular"};
  EXPECT_EQ(nearest("difuse", known), "diffuse");
  EXPECT_EQ(nearest("Ambiant", known), "ambient");
  EXPECT_EQ(nearest("roughness", known), "");
  EXPECT_EQ(suggestion("roughness", known), "known are: ambient, diffuse, specular");
  EXPECT_EQ(nearest(std::string(100000, 'a'), known), "");
}

}  // namespace
}  // namespace lambent::test
