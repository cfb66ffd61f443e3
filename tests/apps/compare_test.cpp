#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <regex>

#include "apps/small_scene.h"
#include "lambent/lambent.h"
#include "lambent/sheet.h"
#include "run_program.h"

namespace lambent::test {
namespace {

class Compare : public SceneFolder {
 protected:
  ProgramResult compare(const std::vector<std::string>& words) const { return run("compare", words); }
  Image picture(const std::string& name) const { return read_image(folder.file(name)).image; }
  /// What `lambent render` makes of the scene.
  Image rendered(std::vector<std::string> words) const {
    words.insert(words.begin(), {"render", "scene.yaml", "-q", "-o", "one.exr"});
    const ProgramResult result = run_program(words, folder.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return picture("one.exr");
  }
};

std::vector<std::string> every_model() {
  std::vector<std::string> names;
  for (const Topic& topic : catalogue())
    if (topic.name == "models")
      for (const Entry& entry : topic.entries) names.push_back(entry.name);
  return names;
}

/// How often `part` lies in `whole`, bit for bit.
int found_in(const Image& whole, const Image& part) {
  int count = 0;
  for (int y = 0; y + part.height <= whole.height; ++y)
    for (int x = 0; x + part.width <= whole.width; ++x) {
      bool same = true;
      for (int row = 0; row < part.height && same; ++row)
        same = std::equal(part.pixel(0, row), part.pixel(0, row) + part.width * 3, whole.pixel(x, y + row));
      count += same;
    }
  return count;
}

TEST_F(Compare, TheSheetIsNamedAfterTheInputAndShowsEveryModel) {
  const ProgramResult result = compare({"scene.yaml"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  const ReadImage sheet = read_image(folder.file("scene-compare.png"));
  EXPECT_TRUE(std::regex_search(
      result.err, std::regex("scene-compare\\.png: " + std::to_string(sheet.image.width) + " x " +
                             std::to_string(sheet.image.height) + ", " +
                             std::to_string(every_model().size()) + " pictures of 8 x 6, [0-9.]+ s\n$")))
      << result.err;
  std::string models;
  for (const Entry& entry : catalogue()[0].entries) models += (models.empty() ? "" : ", ") + entry.name;
  const auto value_of = [&](const std::string& key) -> std::string {
    for (const auto& [name, value] : sheet.metadata)
      if (name == key) return value;
    return "nothing";
  };
  EXPECT_EQ(value_of("lambent:models"), models);
  EXPECT_EQ(value_of("lambent:scene"), "scene.yaml");
  EXPECT_EQ(value_of("lambent:version"), version());
  EXPECT_NE(value_of("lambent:settings").find("size: [8, 6]"), std::string::npos);
}

TEST_F(Compare, EachPictureIsWhatRenderMakes) {
  const ProgramResult result =
      compare({"scene.yaml", "--models", "phong,conventional", "--size", "24x18", "--samples", "2", "--set",
               "lights.key.point.intensity=3", "-o", "sheet.exr", "-o", "sheet.png", "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out + result.err, "");
  EXPECT_TRUE(std::filesystem::exists(folder.file("sheet.png")));
  const Image sheet = picture("sheet.exr");
  for (const char* model : {"phong", "conventional"}) {
    const Image one = rendered(
        {"--model", model, "--size", "24x18", "--samples", "2", "--set", "lights.key.point.intensity=3"});
    EXPECT_EQ(found_in(sheet, one), 1) << model;
  }
}

TEST_F(Compare, TheSheetHasTheLibrarysSize) {
  ASSERT_EQ(compare({"scene.yaml", "--models", "phong,blinn_phong,conventional", "--columns", "3", "--size",
                     "160x90", "-o", "wide.png"})
                .exit_code,
            0);
  ASSERT_EQ(compare({"scene.yaml", "--models", "phong,blinn_phong,conventional", "--columns", "1", "--size",
                     "160x90", "-o", "high.png"})
                .exit_code,
            0);
  std::vector<SheetCell> cells;
  for (const char* model : {"phong", "blinn_phong", "conventional"})
    for (const Entry& entry : catalogue()[0].entries)
      if (entry.name == model) {
        SheetCell cell;
        cell.picture = {160, 90, {"R", "G", "B"}, std::vector<float>(160 * 90 * 3)};
        cell.title = entry.name;
        cell.subtitle = entry.equation;
        cells.push_back(cell);
      }
  for (const int columns : {3, 1}) {
    SheetOptions options;
    options.title = "scene.yaml";
    options.subtitle = "160 \u00d7 90 pixels, 1 sample per pixel";
    options.columns = columns;
    const Image expected = make_sheet(cells, options).image;
    const Image sheet = picture(columns == 3 ? "wide.png" : "high.png");
    EXPECT_EQ(sheet.width, expected.width);
    EXPECT_EQ(sheet.height, expected.height);
  }
}

TEST_F(Compare, ALargeSceneIsShownSmaller) {
  const ProgramResult result =
      compare({"scene.yaml", "--models", "phong", "--set", "image.size=[1280, 720]", "-o", "sheet.png"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("1 picture of 480 x 270"), std::string::npos) << result.err;
}

TEST_F(Compare, TheSameBitsForAnyNumberOfThreads) {
  ASSERT_EQ(compare({"scene.yaml", "--difference", "--threads", "1", "-o", "a.png"}).exit_code, 0);
  ASSERT_EQ(compare({"scene.yaml", "--difference", "--threads", "3", "-o", "b.png"}).exit_code, 0);
  EXPECT_EQ(read_text(folder.file("a.png")), read_text(folder.file("b.png")));
}

TEST_F(Compare, TheDifferenceIsMeasuredAndItsPixelNamed) {
  const ProgramResult result =
      compare({"scene.yaml", "--models", "conventional,phong,conventional_not", "--difference"});
  EXPECT_EQ(result.exit_code, 2) << "conventional_not is no model";
  const ProgramResult good =
      compare({"scene.yaml", "--models", "conventional,phong", "--difference", "--samples", "4", "--set",
               "lights.key.point.intensity=3", "-q", "-o", "sheet.exr"});
  ASSERT_EQ(good.exit_code, 0) << good.err;
  const std::vector<std::string> same{"--samples", "4", "--set", "lights.key.point.intensity=3", "--model"};
  const auto of_model = [&](const std::string& model) {
    std::vector<std::string> words = same;
    words.push_back(model);
    return rendered(words);
  };
  const SignedDifference difference = signed_difference(of_model("phong"), of_model("conventional"));
  ASSERT_NE(difference.largest, 0);
  char expected[400];
  std::snprintf(
      expected, sizeof expected,
      "Difference of luminance, model less conventional:\n"
      "model           largest  at pixel        mean\n"
      "phong         %+9.3g  %-9s  %+9.3g\n"
      "    lambent explain scene.yaml --pixel %d,%d --model phong --size 8x6 --set image.samples=4 --set "
      "lights.key.point.intensity=3\n",
      difference.largest, (std::to_string(difference.x) + "," + std::to_string(difference.y)).c_str(),
      difference.mean, difference.x, difference.y);
  EXPECT_EQ(good.out.substr(0, std::string(expected).size()), expected);
  // Then that pixel, derived under both equations.
  const std::string derived = good.out.substr(std::string(expected).size());
  const std::string at = std::to_string(difference.x) + "," + std::to_string(difference.y);
  for (const char* model : {"conventional", "phong"})
    EXPECT_NE(derived.find(std::string("\n---- ") + model + " at " + at + "\n"), std::string::npos);
  EXPECT_NE(derived.find("add up to the rendered pixel, bit for bit"), std::string::npos);
  const Image colors = difference_picture(difference.values, color_bar_limit(difference.largest));
  EXPECT_EQ(found_in(picture("sheet.exr"), colors), 1) << "the difference is not in the sheet";
}

TEST_F(Compare, NoDifferenceIsNone) {
  // Without light, all models are alike.
  const ProgramResult result = compare({"scene.yaml", "--models", "phong,blinn_phong", "--difference",
                                        "--set", "lights.key.point.intensity=0", "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out,
            "Difference of luminance, model less phong:\n"
            "model          largest  at pixel        mean\n"
            "blinn_phong          0  -                  0\n");
}

TEST_F(Compare, TheCommandLineItPrintsIsOneForAShell) {
  std::filesystem::create_directory(folder.file("it's here"));
  write_text(folder.file("it's here/scene.yaml"), small_scene);
  const ProgramResult result = compare({"it's here/scene.yaml", "--models", "conventional,phong",
                                        "--difference", "--set", "image={samples: 4}", "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // --set has the last word in every command: what it replaced as a whole is completed behind it.
  EXPECT_NE(result.out.find(" explain 'it'\\''s here/scene.yaml' "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" --set 'image={samples: 4}' --set 'image.size=[480, 270]'\n"), std::string::npos)
      << result.out;
}

TEST_F(Compare, AttenuationIsTheScenesOrTheModels) {
  // The scene says none, so attenuated and conventional are one and the same; on its own it fades with 1/r^2.
  const std::vector<std::string> scene_says{
      "scene.yaml", "--models", "conventional,attenuated",      "--difference",
      "-q",         "--set",    "illumination.attenuation=none"};
  EXPECT_NE(compare(scene_says).out.find("attenuated            0"), std::string::npos)
      << compare(scene_says).out;
  std::vector<std::string> own = scene_says;
  own.insert(own.end(), {"--own-attenuation", "-o", "own.exr"});
  const ProgramResult result = compare(own);
  EXPECT_NE(result.out.find(" --set 'illumination.attenuation=1/r^2'"), std::string::npos) << result.out;
  EXPECT_EQ(found_in(picture("own.exr"), rendered({"--model", "attenuated"})), 1);
}

TEST_F(Compare, MaterialsThatKeepTheirModelAreNamed) {
  write_text(folder.file("own.yaml"),
             std::regex_replace(small_scene, std::regex("name: red,"), "name: red, model: conventional,"));
  const ProgramResult result = compare({"own.yaml", "--models", "phong"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(
      result.err.rfind(
          "own.yaml: warning: a material names a model of its own and keeps it in every picture: 'red'\n", 0),
      0u)
      << result.err;
  EXPECT_EQ(compare({"own.yaml", "--models", "phong", "-q"}).err, "");
}

TEST_F(Compare, TheProgressIsThatOfAllPictures) {
  const ProgramResult result = compare({"scene.yaml", "--models", "phong,conventional", "--size", "64x64"});
  std::string expected;
  for (int percent = 10; percent <= 100; percent += 10)
    expected += std::to_string(percent) + " %(, [0-9:.]+ (s|min|h) left)?\n";
  EXPECT_TRUE(std::regex_match(result.err, std::regex(expected + "scene-compare\\.png: .*\n"))) << result.err;
}

// ---- what goes wrong

TEST_F(Compare, MistakesTouchNoFile) {
  struct Mistake {
    std::vector<std::string> words;
    std::string err;
  };
  const std::string help = "    hint: 'lambent compare --help' says how it is used\n";
  const Mistake mistakes[] = {
      {{}, "error: INPUT is missing\n" + help},
      {{"scene.yaml", "--model", "phong"},
       "error: unknown option '--model'\n    hint: did you mean '--models'?\n"},
      {{"scene.yaml", "--models", "phnog"},
       "error: unknown model 'phnog'\n    hint: did you mean 'phong'?\n"},
      {{"scene.yaml", "--models", "oren_nayar_of_all"},
       fmt::format("error: unknown model 'oren_nayar_of_all'\n    hint: known are {}\n",
                   fmt::join(every_model(), ", "))},
      {{"scene.yaml", "--set", "integrator.view.show=normals"},
       "error: 'scene.yaml' shows a view of normals, which no model changes\n"
       "    hint: --set 'integrator={whitted: {}}' shows its colours\n"},
      {{"scene.yaml", "--models", "phong,conventional,phong"}, "error: the model 'phong' is named twice\n"},
      {{"scene.yaml", "--models", "phong,"},
       "error: --models wants names with commas between them, not 'phong,'\n"
       "    hint: for example --models conventional,phong\n"},
      {{"scene.yaml", "--models", "phong", "--difference"},
       "error: --difference wants two models or more\n    hint: for example --models conventional,phong\n"},
      {{"scene.yaml", "--set", "illumination.model=phong"},
       "error: --set illumination.model says what --models varies\n"
       "    hint: for a picture of one model: 'lambent render scene.yaml --model phong'\n"},
      {{"scene.yaml", "--columns", "0"}, "error: --columns wants a whole number, 1 or more, not '0'\n"},
      {{"scene.yaml", "--size", "640"},
       "error: --size wants width x height in pixels, not '640'\n    hint: for example --size 1280x720\n"},
      {{"scene.yaml", "--samples", "many"}, "error: --samples wants a whole number, 1 or more, not 'many'\n"},
      {{"scene.yaml", "-o", "sheet.gif"},
       "error: cannot tell the format of 'sheet.gif' from its ending\n"
       "    hint: pictures are written as .png or .exr\n"},
  };
  for (const Mistake& mistake : mistakes) {
    const ProgramResult result = compare(mistake.words);
    EXPECT_EQ(result.err, mistake.err);
    EXPECT_EQ(result.out, "") << mistake.err;
    EXPECT_EQ(result.exit_code, 2) << mistake.err;
  }
  EXPECT_EQ(files(), 2u);
}

TEST_F(Compare, ABrokenSceneTouchesNoFile) {
  write_text(folder.file("broken.yaml"), small_scene + "backgruond: 3\n");
  const ProgramResult result = compare({"broken.yaml", "-o", "old.png"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("broken.yaml:11:1: error: "), std::string::npos) << result.err;
  EXPECT_TRUE(old_is_untouched());
  EXPECT_EQ(compare({"nowhere.yaml", "-o", "old.png"}).exit_code, 2);
  EXPECT_EQ(compare({"scene.yaml", "-o", "no/where.png"}).exit_code, 1);
  EXPECT_TRUE(old_is_untouched());
  EXPECT_EQ(files(), 3u);
}

TEST_F(Compare, AnInterruptStopsItAndTouchesNoFile) {
  RunningProgram program(
      program_and({"compare", "scene.yaml", "-o", "old.png", "--size", "1000x1000", "--samples", "64"}),
      folder.path());
  ASSERT_TRUE(program.waits_for("10 %"));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("error: interrupted; no file was written\n"), std::string::npos) << result.err;
  EXPECT_TRUE(old_is_untouched());
  EXPECT_EQ(files(), 2u);
}

}  // namespace
}  // namespace lambent::test
