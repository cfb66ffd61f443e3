#include <gtest/gtest.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "apps/small_scene.h"
#include "lambent/lambent.h"
#include "run_program.h"

namespace lambent::test {
namespace {

class Render : public SceneFolder {
 protected:
  ProgramResult render(const std::vector<std::string>& words) const { return run("render", words); }
};

std::vector<std::string> keys_of(const nlohmann::json& object) {
  std::vector<std::string> keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  return keys;  // sorted: nlohmann::json keeps them so
}

TEST_F(Render, ThePictureIsNamedAfterTheInput) {
  const ProgramResult result = render({"scene.yaml"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  const Image image = read_image(folder.file("scene.png")).image;
  EXPECT_EQ(image.width, 8);
  EXPECT_EQ(image.height, 6);
  EXPECT_TRUE(std::regex_search(result.err, std::regex("scene\\.png: 8 x 6, [0-9.]+ s, [0-9]+ rays\n$")))
      << result.err;
}

TEST_F(Render, TheDefaultPictureStandsInTheCurrentFolder) {
  std::filesystem::create_directory(folder.file("elsewhere"));
  const ProgramResult result = run_program({"render", "../scene.yaml"}, folder.file("elsewhere"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(folder.file("elsewhere/scene.png")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("scene.png")));
}

TEST_F(Render, OneRenderWritesSeveralFiles) {
  const ProgramResult result = render({"-o", "a.png", "-o", "b.EXR", "scene.yaml", "--bits", "16"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Image coded = read_image(folder.file("a.png")).image;
  const Image exact = read_image(folder.file("b.EXR")).image;
  // 16 bits of sRGB: half a step, where the curve is flattest, is 2.3 * 0.5 / 65535 in linear light.
  EXPECT_LT(compare_images(coded, exact).largest, 2.4 * 0.5 / 65535);
}

TEST_F(Render, AnOldPictureIsReplaced) {
  EXPECT_EQ(render({"scene.yaml", "-o", "old.png"}).exit_code, 0);
  EXPECT_EQ(read_text(folder.file("old.png")).substr(1, 3), "PNG");
  EXPECT_EQ(files(), 2u) << "a temporary file was left";
}

TEST_F(Render, OneLineForEveryTenPercent) {
  const ProgramResult result = render({"scene.yaml", "--size", "64x64", "--tile", "4"});
  std::string expected;
  for (int percent = 10; percent <= 100; percent += 10)
    expected += std::to_string(percent) + " %(, [0-9:.]+ (s|min|h) left)?\n";
  EXPECT_TRUE(std::regex_match(result.err, std::regex(expected + "scene\\.png: .*\n"))) << result.err;
}

TEST_F(Render, QuietSaysNothing) {
  const ProgramResult result = render({"scene.yaml", "--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Render, StatsHoldTheCountsAndTimes) {
  const ProgramResult result =
      render({"scene.yaml", "--stats", "s.json", "--threads", "2", "--samples", "4"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto stats = nlohmann::json::parse(read_text(folder.file("s.json")));
  EXPECT_EQ(keys_of(stats), (std::vector<std::string>{"bytes", "isa", "noise", "peak_memory_bytes", "rays",
                                                      "samples_per_pixel", "scene", "seconds", "threads",
                                                      "tree_quality", "version"}));
  EXPECT_EQ(keys_of(stats["rays"]),
            (std::vector<std::string>{"ambient", "eye", "eye_hits", "reflection", "refraction", "shadow"}));
  EXPECT_EQ(keys_of(stats["seconds"]),
            (std::vector<std::string>{"build", "denoise", "develop", "parse", "render", "write"}));
  EXPECT_EQ(stats["rays"]["eye"], 8 * 6 * 4);
  EXPECT_EQ(stats["rays"]["refraction"], 0);
  EXPECT_GT(stats["rays"]["eye_hits"], 0);
  EXPECT_LE(stats["rays"]["eye_hits"], stats["rays"]["eye"]);
  for (const auto& second : stats["seconds"]) EXPECT_GE(second.get<double>(), 0);
  EXPECT_GT(stats["seconds"]["parse"], 0);
  EXPECT_GT(stats["seconds"]["write"], 0);
  EXPECT_GT(stats["peak_memory_bytes"], 100'000);
  EXPECT_EQ(stats["threads"], 2);
  EXPECT_EQ(stats["samples_per_pixel"], 4);
  EXPECT_EQ(keys_of(stats["scene"]),
            (std::vector<std::string>{"instances", "lights", "nodes", "primitives", "trees"}));
  EXPECT_EQ(stats["scene"]["primitives"], 2);
  EXPECT_EQ(keys_of(stats["bytes"]),
            (std::vector<std::string>{"film", "indices", "nodes", "normals", "placed", "refs", "shapes",
                                      "textures", "uvs", "vertices"}));
  EXPECT_EQ(stats["bytes"]["film"], 8 * 6 * 3 * sizeof(float));
  EXPECT_EQ(stats["version"], version());
}

TEST_F(Render, StatsOnStandardOutputAreNothingButJson) {
  const ProgramResult result = render({"scene.yaml", "--stats", "-", "--isa", available_isas().back()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out)["isa"], available_isas().back());
}

TEST_F(Render, ShorthandsAndSettings) {
  ASSERT_EQ(render({"scene.yaml", "-o", "a.exr", "--size", "5x3", "--model", "blinn_phong"}).exit_code, 0);
  ASSERT_EQ(render({"scene.yaml", "-o", "b.exr", "--set", "image.size=[5, 3]", "--set",
                    "illumination.model=blinn_phong"})
                .exit_code,
            0);
  ASSERT_EQ(render({"scene.yaml", "-o", "c.exr", "--size", "5x3", "--model", "conventional"}).exit_code, 0);
  const Image a = read_image(folder.file("a.exr")).image;
  EXPECT_EQ(a.width, 5);
  EXPECT_EQ(a.height, 3);
  EXPECT_EQ(compare_images(a, read_image(folder.file("b.exr")).image).differing_pixels, 0u);
  EXPECT_GT(compare_images(a, read_image(folder.file("c.exr")).image).differing_pixels, 0u);
}

TEST_F(Render, SetHasTheLastWordOverAShorthand) {
  ASSERT_EQ(render({"--set", "image.size=[4, 2]", "scene.yaml", "--size", "5x3"}).exit_code, 0);
  EXPECT_EQ(read_image(folder.file("scene.png")).image.width, 4);
}

TEST_F(Render, AModelIsFramedAndLitByItself) {
  write_text(folder.file("triangle.obj"), small_model);
  ASSERT_EQ(render({"triangle.obj", "--size", "32x32", "-o", "t.exr"}).exit_code, 0);
  const Image image = read_image(folder.file("t.exr")).image;
  EXPECT_NE(image.pixel(16, 16)[0], image.pixel(0, 0)[0]) << "the model is not in the middle";
}

// ---- what goes wrong

TEST_F(Render, ABrokenSceneTouchesNoFile) {
  write_text(folder.file("broken.yaml"), small_scene + "  - {spere: {radius: 1}}\nbackgruond: 3\n");
  const ProgramResult result = render({"broken.yaml", "-o", "old.png", "--stats", "s.json"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("broken.yaml:11:6: error: "), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("broken.yaml:12:1: error: "), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("did you mean 'background'?"), std::string::npos) << result.err;
  EXPECT_TRUE(old_is_untouched());
  EXPECT_EQ(files(), 3u);
}

TEST_F(Render, AMissingInputIsNamed) {
  const ProgramResult result = render({"nowhere.yaml", "-o", "old.png"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("nowhere.yaml"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("No such file or directory"), std::string::npos) << result.err;
  EXPECT_TRUE(old_is_untouched());
}

TEST_F(Render, AnUnknownInstructionSetTouchesNoFile) {
  const ProgramResult result = render({"scene.yaml", "-o", "old.png", "--isa", "mmx"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("mmx"), std::string::npos) << result.err;
  EXPECT_TRUE(old_is_untouched());
}

TEST_F(Render, OutputsAreLookedAtBeforeTheInput) {
  // The input is not even there: what is said is about the output.
  ProgramResult result = render({"nowhere.yaml", "-o", "old.png", "-o", "picture.gif"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err,
            "error: cannot tell the format of 'picture.gif' from its ending\n"
            "    hint: pictures are written as .png or .exr\n");

  result = render({"nowhere.yaml", "-o", "no/where.png"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "error: cannot write 'no/where.png': there is no folder 'no'\n");

  result = render({"nowhere.yaml", "-o", "scene.yaml/x.png"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "error: cannot write 'scene.yaml/x.png': 'scene.yaml' is not a folder\n");

  std::filesystem::create_directory(folder.file("folder.png"));
  result = render({"nowhere.yaml", "-o", "folder.png"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "error: cannot write 'folder.png': it is a folder\n");

  result = render({"nowhere.yaml", "--stats", "no/stats.json"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "error: cannot write 'no/stats.json': there is no folder 'no'\n");
  EXPECT_TRUE(old_is_untouched());
}

TEST_F(Render, WhatMayNotBeWrittenIsSaidBeforeTheWork) {
  if (::geteuid() == 0) GTEST_SKIP() << "the superuser may write everywhere";
  namespace fs = std::filesystem;
  fs::permissions(folder.file("old.png"), fs::perms::owner_read);
  ProgramResult result = render({"nowhere.yaml", "-o", "old.png"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "error: cannot write 'old.png': Permission denied\n");

  fs::create_directory(folder.file("closed"));
  fs::permissions(folder.file("closed"), fs::perms::owner_read | fs::perms::owner_exec);
  result = render({"nowhere.yaml", "-o", "closed/new.png"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "error: cannot write 'closed/new.png': the folder 'closed': Permission denied\n");
}

TEST_F(Render, AnInterruptStopsItAndTouchesNoFile) {
  for (const int signal : {SIGINT, SIGTERM}) {
    RunningProgram program(
        program_and({"render", "scene.yaml", "-o", "old.png", "--size", "1000x1000", "--samples", "64"}),
        folder.path());
    ASSERT_TRUE(program.waits_for("10 %"));
    program.send(signal);
    const ProgramResult result = program.wait();
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("error: interrupted; no file was written\n"), std::string::npos) << result.err;
    EXPECT_TRUE(old_is_untouched());
    EXPECT_EQ(files(), 2u);
  }
}

// ---- on a terminal

TEST_F(Render, TheBarFitsTheTerminalAndGoesAway) {
  for (const int width : {80, 30, 8}) {
    const ProgramResult result = run_on_terminal(
        {"render", "scene.yaml", "--size", "300x200", "--samples", "4", "--tile", "8"}, folder.path(), width);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::size_t last_line = result.err.rfind("\r\033[K");
    ASSERT_NE(last_line, std::string::npos) << "no bar was drawn: " << result.err;
    EXPECT_EQ(result.err.substr(last_line + 4).rfind("scene.png: 300 x 200", 0), 0u) << result.err;
    // Each state of the bar lies between a return to the line's start and the erasure of what is right of it.
    for (std::size_t at = 0; at < last_line;) {
      const std::size_t end = result.err.find("\033[K", at);
      EXPECT_EQ(result.err[at], '\r');
      EXPECT_LT(end - at - 1, std::size_t(width)) << result.err.substr(at, end - at);
      EXPECT_NE(result.err.substr(at, end - at).find(" %"), std::string::npos);
      at = end + 3;
    }
  }
}

TEST_F(Render, ColorsOnlyWhereTheyAreWelcome) {
  const std::vector<std::string> words{"render", "nowhere.yaml"};
  EXPECT_NE(run_on_terminal(words, folder.path(), 80).err.find("\033[1;31merror:\033[0m"), std::string::npos);
  ::setenv("NO_COLOR", "1", 1);
  const std::string plain = run_on_terminal(words, folder.path(), 80).err;
  ::unsetenv("NO_COLOR");
  EXPECT_NE(plain.find("error:"), std::string::npos);
  EXPECT_EQ(plain.find('\033'), std::string::npos);
  EXPECT_EQ(run_program(words, folder.path()).err.find('\033'), std::string::npos);
}

// ---- streams

TEST_F(Render, ClosedStreamsNeverLandInThePicture) {
  const ProgramResult open = run_shell("$LAMBENT render scene.yaml -o a.png", folder.path());
  ASSERT_EQ(open.exit_code, 0) << open.err;
  EXPECT_EQ(run_shell("$LAMBENT render scene.yaml -o b.png <&- >&- 2>&-", folder.path()).exit_code, 0);
  EXPECT_EQ(read_text(folder.file("a.png")), read_text(folder.file("b.png")));
}

TEST_F(Render, AReaderOfTheProgressMayGo) {
  const ProgramResult result =
      run_shell("{ $LAMBENT render scene.yaml --size 300x300 --tile 8; echo $? >code; } 2>&1 | head -n 1",
                folder.path());
  EXPECT_EQ(result.out.substr(0, 4), "10 %");
  EXPECT_EQ(read_text(folder.file("code")), "0\n");
  EXPECT_TRUE(std::filesystem::exists(folder.file("scene.png")));
}

}  // namespace
}  // namespace lambent::test
