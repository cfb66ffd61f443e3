// Two pictures compared; one format made of another.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "apps/small_scene.h"
#include "lambent/lambent.h"
#include "run_program.h"

namespace lambent::test {
namespace {

class Files : public ::testing::Test {
 protected:
  ProgramResult run(const std::vector<std::string>& words) const { return run_program(words, folder.path()); }
  /// Three values for each of two pixels.
  void write(const std::string& name, const std::vector<float>& data) const {
    Image image;
    image.width = 2;
    image.height = 1;
    image.data = data;
    write_image(folder.file(name), image);
  }
  TemporaryDirectory folder;
};

TEST_F(Files, TheSameIsIdentical) {
  write("a.exr", {0, 1, 2, 3, 4, 5});
  write("b.exr", {0, 1, 2, 3, 4, 5});
  const ProgramResult result = run({"diff", "a.exr", "b.exr"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "identical: 2 x 1 pixels, every bit\n");
}

TEST_F(Files, ADifferenceIsMeasured) {
  write("a.exr", {0, 0, 0, 0.5f, 0.5f, 1});
  write("b.exr", {0, 0, 0, 0.5f, 0.5f, 0.75f});
  ProgramResult result = run({"diff", "a.exr", "b.exr", "-o", "d.exr"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  // |1 - 0.75| = 0.25 in one of six values: mean 0.25 / 6, root of the mean square 0.25 / sqrt(6). 0.75 is
  // 1.055 * 0.75^(1/2.4) - 0.055 = 0.8808 in sRGB, 225 of 255.
  EXPECT_EQ(result.out,
            "pixels that differ    1 of 2 (50 %)\n"
            "largest difference    0.25 at pixel 1,0 in B\n"
            "largest relative      0.25\n"
            "largest of 8 bits     30 of 255\n"
            "mean difference       0.0416667\n"
            "root mean square      0.102062\n"
            "beyond the tolerance of 0\n");
  const Image difference = read_image(folder.file("d.exr")).image;
  EXPECT_EQ(difference.pixel(1, 0)[2], 0.25f);
  EXPECT_EQ(difference.pixel(0, 0)[2], 0);

  EXPECT_EQ(run({"diff", "a.exr", "b.exr", "--tolerance", "0.2499"}).exit_code, 1);
  result = run({"diff", "a.exr", "b.exr", "--tolerance", "0.25"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.out.find("within the tolerance of 0.25\n"), std::string::npos) << result.out;
}

TEST_F(Files, NotANumberIsWithinNoTolerance) {
  write("a.exr", {0, 0, 0, 0, 0, 0});
  write("b.exr", {0, 0, 0, 0, 0, std::numeric_limits<float>::quiet_NaN()});
  EXPECT_EQ(run({"diff", "a.exr", "b.exr", "--tolerance", "1e30"}).exit_code, 1);
  EXPECT_EQ(run({"diff", "b.exr", "b.exr"}).exit_code, 0);
}

TEST_F(Files, BothZerosAreWithinEveryTolerance) {
  write("a.exr", {0, 0, 0, 0, 0, 0});
  write("b.exr", {0, 0, 0, 0, 0, -0.0f});
  const ProgramResult result = run({"diff", "a.exr", "b.exr"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.out.find("largest difference    0\n"), std::string::npos) << result.out;
}

TEST_F(Files, PicturesThatCannotBeComparedAreBadInput) {
  write("a.exr", {0, 0, 0, 0, 0, 0});
  Image narrow;
  narrow.width = narrow.height = 1;
  narrow.data = {0, 0, 0};
  write_image(folder.file("b.exr"), narrow);
  const ProgramResult result = run({"diff", "a.exr", "b.exr", "-o", "d.png"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("2 x 1"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder.file("d.png")));
  EXPECT_EQ(run({"diff", "a.exr", "nowhere.exr"}).exit_code, 2);
  write_text(folder.file("not.png"), "a text");
  EXPECT_EQ(run({"diff", "a.exr", "not.png"}).exit_code, 2);
}

TEST_F(Files, PicturesAreConvertedBothWays) {
  write("a.exr", {0, 0.25f, 0.5f, 0.75f, 1, 2});
  ASSERT_EQ(run({"convert", "a.exr", "a.png", "--bits", "16"}).exit_code, 0);
  ASSERT_EQ(run({"convert", "a.png", "b.exr"}).exit_code, 0);
  const Image b = read_image(folder.file("b.exr")).image;
  const float expected[] = {0, 0.25f, 0.5f, 0.75f, 1, 1};  // a PNG ends at 1
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(b.data[std::size_t(i)], expected[i], 2.4 * 0.5 / 65535) << i;
}

TEST_F(Files, AModelBecomesASceneThatRendersTheSame) {
  std::filesystem::create_directories(folder.file("models"));
  std::filesystem::create_directories(folder.file("scenes/mine"));
  write_text(folder.file("models/triangle.obj"), small_model);
  const ProgramResult result = run({"convert", "models/triangle.obj", "scenes/mine/t.yaml"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(read_text(folder.file("scenes/mine/t.yaml")).find("../../models/triangle.obj"),
            std::string::npos);
  EXPECT_EQ(result.err,
            "scenes/mine/t.yaml: warning: the scene names a file outside of its own folder\n"
            "    hint: 'lambent render' wants --allow-outside for it; or put the scene beside the model\n");
  // At the scene's own size: for another, the automatic camera of the model moves, the scene's does not.
  ASSERT_EQ(run({"render", "models/triangle.obj", "--samples", "1", "-o", "a.exr"}).exit_code, 0);
  ASSERT_EQ(
      run({"render", "scenes/mine/t.yaml", "--samples", "1", "-o", "b.exr", "--allow-outside"}).exit_code, 0);
  EXPECT_EQ(run({"diff", "a.exr", "b.exr"}).out, "identical: 1280 x 720 pixels, every bit\n");
}

TEST_F(Files, ASceneOfOnesOwnIsNotOverwrittenUnasked) {
  write_text(folder.file("triangle.obj"), small_model);
  write_text(folder.file("t.yaml"), "mine");
  const ProgramResult result = run({"convert", "triangle.obj", "t.yaml"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err, "error: 't.yaml' is there already\n    hint: --force overwrites it\n");
  EXPECT_EQ(read_text(folder.file("t.yaml")), "mine");
  EXPECT_EQ(run({"convert", "triangle.obj", "t.yaml", "--force"}).exit_code, 0);
  EXPECT_EQ(read_text(folder.file("t.yaml")).find("mine"), std::string::npos);
}

TEST_F(Files, ASceneIsExportedWithRemarks) {
  write_text(folder.file("s.yaml"),
             "lambent: 1\ncamera: {eye: [0, 0, 5], target: [0, 0, 0]}\n"
             "materials: [{name: gold, specular: [1, 0.8, 0.2]}]\n"
             "objects: [{sphere: {center: [0, 0, 0], radius: 1}, material: gold}]\n");
  ProgramResult result = run({"convert", "s.yaml", "s.pov"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find(
                "s.yaml:3:13: warning: POV-Ray gives highlights the light's colour; that of material 'gold'"),
            std::string::npos)
      << result.err;
  EXPECT_NE(read_text(folder.file("s.pov")).find("sphere { <0, 0, 0>, 1"), std::string::npos);
  result = run({"convert", "s.yaml", "s.pov"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err, "error: 's.pov' is there already\n    hint: --force overwrites it\n");
  EXPECT_EQ(run({"convert", "s.yaml", "s.pov", "--force"}).exit_code, 0);
  EXPECT_EQ(run({"convert", "s.yaml", "s.dat"}).exit_code, 0);
  EXPECT_EQ(read_text(folder.file("s.dat")).find("# s.yaml"), 0u);
}

TEST_F(Files, ABrokenModelLeavesNoScene) {
  write_text(folder.file("broken.obj"), "v 0 0 0\nf 1 2 3\n");
  const ProgramResult result = run({"convert", "broken.obj", "t.yaml"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("broken.obj:2"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder.file("t.yaml")));
}

}  // namespace
}  // namespace lambent::test
