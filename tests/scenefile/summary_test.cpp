// What is said of a scene's textures and cameras.

#include <gtest/gtest.h>

#include "image/formats.h"
#include "lambent/lambent.h"
#include "scene/scene.h"
#include "support.h"

namespace lambent {
namespace {

Texture texture_named(const std::string& name) {
  Texture texture;
  texture.source.name = name;
  return texture;
}

TEST(Summary, TellsOfTexturesWhereverTheyAre) {
  const test::TemporaryDirectory folder;
  const std::string png =
      encode_png({3, 2, {"R", "G", "B"}, std::vector<float>(18, 0.5f)}, {}, {8, true}, "p");
  test::write_text(folder.file("p.png"), png);
  auto scene = std::make_shared<Scene>();
  scene->textures = {texture_named("p.png"), texture_named("image 1 of a.glb"), texture_named("none.png"),
                     texture_named("cut.png")};
  scene->textures[0].source.file = folder.file("p.png");
  scene->textures[1].source.bytes = std::make_shared<const std::string>(png);
  scene->textures[1].srgb = false;
  scene->textures[2].source.file = folder.file("none.png");
  scene->textures[3].source.bytes = std::make_shared<const std::string>(png.substr(0, 30));
  scene->model_cameras = {"front", ""};
  const SceneSummary summary = summarize(scene);
  ASSERT_EQ(summary.textures.size(), 4u);
  for (const std::size_t i : {0, 1}) {
    const SceneSummary::Image& image = summary.textures[i];
    EXPECT_EQ(image.format, "PNG");
    EXPECT_EQ(image.width, 3);
    EXPECT_EQ(image.height, 2);
    EXPECT_EQ(image.channels, 3);
    EXPECT_EQ(image.color, i == 0);
    EXPECT_EQ(image.problem, "");
  }
  EXPECT_EQ(summary.textures[0].name, "p.png");
  EXPECT_EQ(summary.textures[2].format, "");
  EXPECT_NE(summary.textures[2].problem.find("No such file"), std::string::npos)
      << summary.textures[2].problem;
  EXPECT_NE(summary.textures[3].problem.find("the file ends too early"), std::string::npos);
  EXPECT_EQ(summary.cameras, (std::vector<std::string>{"front", ""}));
}

TEST(Summary, TheStudioIsInNoFile) {
  const SceneSummary summary = summarize(
      parse_scene("lambent: 1\ncamera: {eye: [0, 0, 9], target: [0, 0, 0]}\nbackground: {file: studio}\n"));
  ASSERT_EQ(summary.textures.size(), 1u);
  EXPECT_EQ(summary.textures[0].width, 256);
  EXPECT_EQ(summary.textures[0].problem, "");
}

TEST(Summary, CountsWhatIsShownByObjects) {
  const ScenePtr scene = parse_scene(
      "lambent: 1\ncamera: {eye: [0, 0, 9], target: [0, 0, 0]}\nobjects:\n  - {sphere: {center: [0, 0, 0], "
      "radius: 1}}\n"
      "  - {box: {min: [0, 0, 0], max: [1, 1, 1]}}\n  - {box: {min: [2, 0, 0], max: [3, 1, 1]}}\n");
  EXPECT_EQ(summarize(scene).shown, 1u + 12 + 12);
}

}  // namespace
}  // namespace lambent
