// The commands that only look.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/small_scene.h"
#include "lambent/lambent.h"
#include "run_program.h"

namespace lambent::test {
namespace {

using nlohmann::json;

class Look : public ::testing::Test {
 protected:
  Look() { write_text(folder.file("scene.yaml"), small_scene); }
  ProgramResult run(const std::vector<std::string>& words) const { return run_program(words, folder.path()); }
  TemporaryDirectory folder;
};

TEST_F(Look, CheckSaysOk) {
  const ProgramResult result = run({"check", "scene.yaml"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, "scene.yaml: ok, 2 objects, 1 light\n");
  EXPECT_EQ(result.err, "");
}

TEST_F(Look, CheckSaysEverythingThatIsWrongWithEveryFile) {
  write_text(folder.file("broken.yaml"), "lambent: 1\nlihgts: []\nimage: {size: [0, 4], samples: many}\n");
  const ProgramResult result = run({"check", "broken.yaml", "nowhere.yaml", "scene.yaml"});
  EXPECT_EQ(result.exit_code, 2);
  for (const char* text : {"broken.yaml:2:1: error: ", "did you mean 'lights'?",
                           "broken.yaml:3:16: error: ", "broken.yaml:3:32: error: ", "nowhere.yaml"})
    EXPECT_NE(result.err.find(text), std::string::npos) << text << " is not in\n" << result.err;
  EXPECT_NE(result.out.find("nowhere.yaml: 1 error\nscene.yaml: ok, 2 objects, 1 light\n"), std::string::npos)
      << result.out;
  std::size_t said = 0;
  for (std::size_t at = 0; (at = result.err.find("broken.yaml:", at)) != std::string::npos; ++at) ++said;
  EXPECT_EQ(result.out.rfind("broken.yaml: " + std::to_string(said) + " errors\n", 0), 0u) << result.out;
}

TEST_F(Look, CheckLooksThroughModelsAndTheirLibraries) {
  write_text(folder.file("model.obj"), "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 2 3 1\n");
  write_text(folder.file("a.mtl"), "newmtl a\nKs 1 1 1\nillum 1\n");
  const ProgramResult model = run({"check", "model.obj"});
  EXPECT_EQ(model.exit_code, 0);
  EXPECT_EQ(model.out.rfind("model.obj: ok, ", 0), 0u) << model.out;
  EXPECT_NE(model.out.find(", 4 warnings\n"), std::string::npos) << model.out;
  for (const char* text : {"model.obj:6:1: warning: this face has the corners of the one in line 5\n",
                           "a.mtl:1:8: warning: material 'a' is on no face\n",
                           "a.mtl:2:1: warning: Ks comes to nothing: illum 1 has no highlight\n"})
    EXPECT_NE(model.err.find(text), std::string::npos) << text << " is not in\n" << model.err;
  const ProgramResult library = run({"check", "a.mtl"});
  EXPECT_EQ(library.exit_code, 0);
  EXPECT_EQ(library.out, "a.mtl: ok, 2 warnings\n");
  write_text(folder.file("broken.mtl"), "newmtl a\nKs 1 1\n");
  const ProgramResult broken = run({"check", "broken.mtl", "nowhere.mtl"});
  EXPECT_EQ(broken.exit_code, 2);
  EXPECT_EQ(broken.out, "broken.mtl: 1 error\nnowhere.mtl: 1 error\n");
}

TEST_F(Look, InfoOfASceneForPrograms) {
  const ProgramResult result = run({"info", "scene.yaml", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json info = json::parse(result.out);
  EXPECT_EQ(info["name"], "scene.yaml");
  EXPECT_EQ(info["image"], (json{{"width", 8}, {"height", 6}, {"samples", 1}}));
  EXPECT_EQ(info["stored"]["spheres"], 1);
  EXPECT_EQ(info["stored"]["planes"], 1);
  // The infinite plane has no bounds; the sphere at (0, 0.6, 0) has.
  const double lower[] = {-0.6, 0, -0.6}, upper[] = {0.6, 1.2, 0.6};
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(info["bounds"]["lower"][axis].get<double>(), lower[axis], 1e-6);
    EXPECT_NEAR(info["bounds"]["upper"][axis].get<double>(), upper[axis], 1e-6);
  }
  ASSERT_EQ(info["objects"].size(), 2u);
  EXPECT_EQ(info["objects"][0]["primitives"], 1);
  EXPECT_EQ(info["objects"][0]["place"].get<std::string>().rfind("scene.yaml:9:", 0), 0u)
      << info["objects"][0];
  ASSERT_EQ(info["lights"].size(), 1u);
  EXPECT_EQ(info["lights"][0]["name"], "key");
  EXPECT_EQ(info["lights"][0]["kind"], "point");
  EXPECT_EQ(info["materials"][0]["name"], "red");
}

TEST_F(Look, InfoOfASceneForPeople) {
  const ProgramResult result = run({"info", "scene.yaml"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* text : {"scene.yaml\n", "8 x 6, 1 sample per pixel", "1 sphere, 1 plane\n",
                           "    key  point", "(-0.6, 0, -0.6) to (0.6, 1.2, 0.6)"})
    EXPECT_NE(result.out.find(text), std::string::npos) << text << " is not in\n" << result.out;
}

TEST_F(Look, InfoOfManyObjectsIsShort) {
  std::string text = small_scene;
  for (int i = 0; i < 100; ++i)
    text += "  - {sphere: {center: [0, 0, " + std::to_string(i) + "], radius: 1}}\n";
  write_text(folder.file("many.yaml"), text);
  const ProgramResult result = run({"info", "many.yaml"});
  EXPECT_LT(std::count(result.out.begin(), result.out.end(), '\n'), 60);
  EXPECT_NE(result.out.find("... and 82 more; --json lists them all\n"), std::string::npos) << result.out;
  EXPECT_EQ(json::parse(run({"info", "many.yaml", "--json"}).out)["objects"].size(), 102u);
}

TEST_F(Look, InfoOfAPicture) {
  Image image;
  image.width = 2;
  image.height = 1;
  image.data = {0, 0.25f, 1, 0.5f, 0.75f, 3};
  write_image(folder.file("p.exr"), image, {{"comment", "a \x1b[31mtrap\nand more\n"}});
  const json info = json::parse(run({"info", "p.exr", "--json"}).out);
  EXPECT_EQ(info["width"], 2);
  EXPECT_EQ(info["height"], 1);
  EXPECT_EQ(info["metadata"]["comment"], "a \x1b[31mtrap\nand more\n");
  const json blue = {{"name", "B"}, {"min", 1}, {"max", 3}, {"mean", 2}, {"not_finite", 0}};
  EXPECT_EQ(std::count(info["channels"].begin(), info["channels"].end(), blue), 1) << info["channels"];
  EXPECT_EQ(info["channels"].size(), 3u);

  const std::string text = run({"info", "p.exr"}).out;
  EXPECT_NE(text.find("B: 1 to 3, mean 2\n"), std::string::npos) << text;
  EXPECT_NE(text.find("comment: a ?[31mtrap\n      and more\n"), std::string::npos) << text;
}

TEST_F(Look, ListNamesAllThereIs) {
  const std::string overview = run({"list"}).out;
  for (const Topic& topic : catalogue()) {
    EXPECT_NE(overview.find(topic.name + "  "), std::string::npos) << topic.name;
    const std::string in_full = run({"list", topic.name}).out;
    for (const Entry& entry : topic.entries) {
      EXPECT_NE(overview.find("\n  " + entry.name + " "), std::string::npos) << entry.name;
      EXPECT_NE(in_full.find("\n" + entry.name + "  "), std::string::npos) << entry.name;
      for (const ParameterInfo& parameter : entry.parameters)
        EXPECT_NE(in_full.find("\n  " + parameter.name + " "), std::string::npos) << parameter.name;
    }
  }
  EXPECT_NE(run({"list", "models", "phong"}).out.find("phong"), std::string::npos);
  for (const Entry& model : catalogue()[0].entries) {
    EXPECT_NE(model.differs, "") << model.name;
    EXPECT_NE(run({"list", "models", model.name}).out.find("How it differs: "), std::string::npos)
        << model.name;
    EXPECT_EQ(json::parse(run({"list", "models", model.name, "--json"}).out)["differs"], model.differs);
    EXPECT_NE(scene_manual().find("How it differs from the lecture: " + model.differs), std::string::npos);
  }
}

TEST_F(Look, ListFitsInEightyColumns) {
  std::vector<std::vector<std::string>> lists{{"list"}};
  for (const Topic& topic : catalogue()) lists.push_back({"list", topic.name});
  for (const auto& words : lists) {
    std::istringstream lines(run(words).out);
    for (std::string line; std::getline(lines, line);) {
      const auto columns = std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xc0) != 0x80; });
      EXPECT_LE(columns, 80) << line;
    }
  }
}

TEST_F(Look, ListForPrograms) {
  const json all = json::parse(run({"list", "--json"}).out);
  ASSERT_EQ(all.size(), catalogue().size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Topic& topic = catalogue()[i];
    EXPECT_EQ(all[i]["name"], topic.name);
    ASSERT_EQ(all[i]["entries"].size(), topic.entries.size());
    EXPECT_EQ(all[i], json::parse(run({"list", topic.name, "--json"}).out));
    for (std::size_t j = 0; j < topic.entries.size(); ++j)
      EXPECT_EQ(all[i]["entries"][j]["parameters"].size(), topic.entries[j].parameters.size());
  }
  const json phong = json::parse(run({"list", "models", "phong", "--json"}).out);
  EXPECT_EQ(phong["name"], "phong");
}

TEST_F(Look, SchemaAndManualAreTheLibrarys) {
  const std::string schema = run({"list", "--schema"}).out;
  EXPECT_TRUE(json::parse(schema).contains("$schema"));
  EXPECT_EQ(schema.rfind(scene_schema(), 0), 0u);
  EXPECT_EQ(schema.back(), '\n');
  EXPECT_EQ(run({"list", "--manual"}).out.rfind(scene_manual(), 0), 0u);
}

}  // namespace
}  // namespace lambent::test
