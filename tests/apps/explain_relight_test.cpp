// lambent explain and lambent relight, as a user runs them.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "lambent/image.h"
#include "run_program.h"
#include "small_scene.h"

namespace lambent {
namespace {

class ExplainProgram : public ::testing::Test {
 protected:
  ExplainProgram() { test::write_text(folder_.file("scene.yaml"), test::small_scene); }
  test::ProgramResult run(const std::vector<std::string>& words) {
    return test::run_program(words, folder_.path());
  }
  test::TemporaryDirectory folder_;
};

TEST_F(ExplainProgram, DerivesThePixelOfTheRenderedExr) {
  ASSERT_EQ(0, run({"render", "scene.yaml", "-o", "a.exr", "-q"}).exit_code);
  const Image image = read_image(folder_.file("a.exr")).image;
  const test::ProgramResult result = run({"explain", "scene.yaml", "--pixel", "4,3", "--json"});
  ASSERT_EQ(0, result.exit_code) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(image.pixel(4, 3)[c], json["linear"][c].get<float>());
  EXPECT_EQ(true, json["adds_up"]);
}

TEST_F(ExplainProgram, TextHasNoEscapesInAPipeAndGoesToAFile) {
  const test::ProgramResult piped = run({"explain", "scene.yaml", "--pixel", "4,3"});
  EXPECT_EQ(0, piped.exit_code);
  EXPECT_EQ(std::string::npos, piped.out.find('\x1b'));
  EXPECT_NE(std::string::npos, piped.out.find("N.L"));
  EXPECT_EQ(0, run({"explain", "scene.yaml", "--pixel", "4,3", "-o", "pixel.txt"}).exit_code);
  EXPECT_EQ(piped.out, test::read_text(folder_.file("pixel.txt")));
  EXPECT_EQ(
      0u, run({"explain", "scene.yaml", "--pixel", "4,3", "--format", "latex"}).out.find("\\documentclass"));
  EXPECT_EQ(
      0u, run({"explain", "scene.yaml", "--pixel", "4,3", "--format", "mathml"}).out.find("<!DOCTYPE html>"));
  EXPECT_EQ(0u, run({"explain", "scene.yaml", "--pixel", "4,3", "--trace"}).out.find("eye "));
}

TEST_F(ExplainProgram, MistakesAreNamed) {
  for (const auto& [words, said] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"explain", "scene.yaml"}, "--pixel is missing"},
           {{"explain", "scene.yaml", "--pixel", "8,0"}, "there is no pixel 8,0 in a picture of 8 x 6"},
           {{"explain", "scene.yaml", "--pixel", "4"}, "--pixel wants x,y"},
           {{"explain", "scene.yaml", "--pixel", "4,3", "--sample", "1"}, "the pixel has no sample 1"},
           {{"explain", "scene.yaml", "--pixel", "4,3", "--format", "txt"}, "unknown format 'txt'"},
           {{"render", "scene.yaml", "--layers", "-o", "a.png"}, "layers need an EXR"},
           {{"relight", "scene.yaml", "-o", "a.png"}, "scene.yaml"},
           {{"relight", "a.exr", "--light", "key=half", "-o", "a.png"}, "--light wants NAME=FACTOR"}}) {
    const test::ProgramResult result = run(words);
    EXPECT_EQ(2, result.exit_code) << said;
    EXPECT_NE(std::string::npos, result.err.find(said)) << result.err;
  }
}

TEST_F(ExplainProgram, LayersRelightLikeANewRender) {
  EXPECT_EQ(0,
            run({"render", "scene.yaml", "--layers", "-q"}).exit_code);  // scene.exr: what it makes, unasked
  ASSERT_EQ(0, run({"relight", "scene.exr", "--light", "key=0.25", "-o", "relit.exr"}).exit_code);
  ASSERT_EQ(0,
            run({"render", "scene.yaml", "--set", "lights.key.point.intensity=0.5", "-o", "anew.exr", "-q"})
                .exit_code);
  const Difference difference =
      compare_images(read_image(folder_.file("relit.exr")).image, read_image(folder_.file("anew.exr")).image);
  EXPECT_LT(difference.largest_relative, 1e-5);
  EXPECT_EQ(2, run({"relight", "anew.exr", "-o", "x.png"}).exit_code) << "there are no layers in it";
}

}  // namespace
}  // namespace lambent
