// What the program does by itself with a model, and what can be said of that.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/small_scene.h"
#include "lambent/lambent.h"
#include "run_program.h"

namespace lambent::test {
namespace {

/// A folder with a model in it, too: a wedge, 4 wide, 2 high.
class ModelFiles : public SceneFolder {
 protected:
  ModelFiles() {
    write_text(folder.file("wedge.obj"),
               "v 0 0 0\nv 4 0 0\nv 4 0 1\nv 0 0 1\nv 4 2 0\nv 4 2 1\n"
               "f 1 2 3 4\nf 1 5 2\nf 4 3 6\nf 2 5 6 3\nf 1 4 6 5\n");
  }
  Image picture(const std::string& name) const { return read_image(folder.file(name)).image; }
  const std::vector<std::string> small{"--size", "32x24", "--samples", "1", "-q"};
  ProgramResult render(std::vector<std::string> words) const {
    words.insert(words.end(), small.begin(), small.end());
    return run("render", words);
  }
};

TEST_F(ModelFiles, AreSeenFromAnySide) {
  for (const char* view : {"three-quarter", "front", "back", "left", "right", "top"}) {
    const std::string output = std::string(view) + ".exr";
    ASSERT_EQ(render({"wedge.obj", "--camera", view, "-o", output}).exit_code, 0) << view;
  }
  ASSERT_EQ(render({"wedge.obj", "-o", "none.exr"}).exit_code, 0);
  EXPECT_EQ(compare_images(picture("none.exr"), picture("three-quarter.exr")).differing_pixels, 0u);
  for (const char* view : {"front", "back", "left", "right", "top"})
    EXPECT_GT(compare_images(picture("none.exr"), picture(std::string(view) + ".exr")).differing_pixels, 50u)
        << view;
}

TEST_F(ModelFiles, ACameraThatThereIsNot) {
  const ProgramResult result = render({"wedge.obj", "--camera", "fornt"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(
      result.err,
      "wedge.obj: error: there is no camera 'fornt'\n    hint: the file has none of its own; views of the "
      "whole model are three-quarter, front, back, left, right, top\n");
}

TEST_F(ModelFiles, TheirUpCanBeSaid) {
  ASSERT_EQ(run("convert", {"wedge.obj", "z.yaml", "--up", "z"}).exit_code, 0);
  EXPECT_NE(read_text(folder.file("z.yaml")).find("up: [0, 0, 1]"), std::string::npos);
  const ProgramResult result = run("convert", {"wedge.obj", "x.yaml", "--up", "x"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err,
            "wedge.obj: error: the axis that points up is y or z, not 'x'\n"
            "    hint: without --up it is y here\n");
}

TEST_F(ModelFiles, GroundAndBackgroundCanBeSaid) {
  ASSERT_EQ(render({"wedge.obj", "--no-ground", "--background", "0.1,0.2,0.3", "-o", "a.exr"}).exit_code, 0);
  const Image image = picture("a.exr");
  EXPECT_FLOAT_EQ(image.pixel(0, 23)[0], 0.1f);  // where the floor would be
  EXPECT_FLOAT_EQ(image.pixel(0, 23)[2], 0.3f);
  ASSERT_EQ(run("convert", {"wedge.obj", "a.yaml", "--no-ground", "--background", "#ff0000"}).exit_code, 0);
  EXPECT_NE(read_text(folder.file("a.yaml")).find("background: \"#ff0000\"\n"), std::string::npos);
  EXPECT_EQ(read_text(folder.file("a.yaml")).find("floor"), std::string::npos);
  EXPECT_EQ(run("check", {"a.yaml"}).exit_code, 0);
  // Of a scene, too.
  ASSERT_EQ(run("render", {"scene.yaml", "--background", "0.5", "-o", "b.exr", "-q"}).exit_code, 0);
  EXPECT_EQ(picture("b.exr").pixel(0, 0)[0], 0.5f);
}

TEST_F(ModelFiles, AnImageAsBackgroundIsNamedAsTheSceneSeesIt) {
  std::filesystem::create_directory(folder.file("scenes"));
  ASSERT_EQ(run("convert", {"wedge.obj", "scenes/a.yaml", "--background", "sky.hdr"}).exit_code, 0);
  EXPECT_NE(read_text(folder.file("scenes/a.yaml")).find("background: {file: \"../sky.hdr\"}\n"),
            std::string::npos);
}

TEST_F(ModelFiles, WhatIsForModelsIsNotForScenes) {
  const std::vector<std::vector<std::string>> options{{"--camera", "front"}, {"--up", "z"}, {"--no-ground"}};
  for (const auto& option : options) {
    std::vector<std::string> words{"scene.yaml"};
    words.insert(words.end(), option.begin(), option.end());
    const ProgramResult result = run("render", words);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(option[0] + " is for model files; this is a scene, which says that itself\n"),
              std::string::npos)
        << result.err;
  }
}

TEST_F(ModelFiles, OptionsAreNamedWhereTheyAreWrong) {
  const std::pair<std::vector<std::string>, std::string> mistakes[] = {
      {{"--time", "soon"}, "error: --time wants a number of seconds, not 'soon'\n"},
      {{"--max-pixels", "many"},
       "error: --max-pixels wants a number, 1 or more, not 'many'\n"
       "    hint: k, M and G are thousands, millions and thousand millions: 64M\n"},
      {{"--max-primitives", "0"},
       "error: --max-primitives wants a number, 1 or more, not '0'\n"
       "    hint: k, M and G are thousands, millions and thousand millions: 64M\n"},
      {{"--max-file-bytes", "1T"},
       "error: --max-file-bytes wants a number, 1 or more, not '1T'\n"
       "    hint: k, M and G are thousands, millions and thousand millions: 64M\n"},
      {{"--background", "blue"},
       "error: --background wants a colour or an image, not 'blue'\n"
       "    hint: a colour is a number, r,g,b (linear) or '#rrggbb'; an image ends in .hdr, .exr, .png or "
       ".jpg\n"},
      {{"--turntable", "0"}, "error: --turntable wants a whole number, 1 or more, not '0'\n"},
      {{"--turntable", "100001"}, "error: --turntable makes 100000 pictures at most\n"},
  };
  for (const auto& [option, error] : mistakes) {
    std::vector<std::string> words{"wedge.obj"};
    words.insert(words.end(), option.begin(), option.end());
    const ProgramResult result = run("render", words);
    EXPECT_EQ(result.err, error);
    EXPECT_EQ(result.exit_code, 2);
  }
}

TEST_F(ModelFiles, LimitsHold) {
  for (const char* command : {"render", "check", "info"}) {
    const ProgramResult result = run(command, {"wedge.obj", "--max-file-bytes", "0.05k"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("the file is too large: "), std::string::npos) << result.err;
  }
  write_image(folder.file("p.exr"), Image{4, 4, {"R", "G", "B"}, std::vector<float>(48, 1.0f)});
  EXPECT_EQ(run("info", {"p.exr", "--max-pixels", "16"}).exit_code, 0);
  const ProgramResult result = run("info", {"p.exr", "--max-pixels", "15"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("too large: 4 x 4 pixels"), std::string::npos) << result.err;
}

TEST_F(ModelFiles, FilesOutsideOfTheScenesFolderAreAsked) {
  std::filesystem::create_directory(folder.file("inner"));
  write_text(folder.file("inner/a.yaml"), small_scene + "  - {mesh: {file: ../wedge.obj}}\n");
  const ProgramResult refused = run("check", {"inner/a.yaml"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("error: '../wedge.obj' lies outside of the scene's folder\n"), std::string::npos)
      << refused.err;
  EXPECT_NE(refused.err.find("hint: put it there or below, or allow it with --allow-outside\n"),
            std::string::npos);
  for (const char* command : {"check", "info"})
    EXPECT_EQ(run(command, {"inner/a.yaml", "--allow-outside"}).exit_code, 0) << command;
  EXPECT_EQ(run("render", {"inner/a.yaml", "--allow-outside", "-q"}).exit_code, 0);
  EXPECT_EQ(run("convert", {"inner/a.yaml", "a.pov", "--allow-outside"}).exit_code, 0);
  // What the command line names is the user's own.
  EXPECT_EQ(run("render", {"inner/a.yaml", "-q", "--set", "objects.2.mesh.file=../wedge.obj"}).exit_code, 0);
  // Below is not outside.
  write_text(folder.file("b.yaml"), small_scene + "  - {mesh: {file: inner/../wedge.obj}}\n");
  EXPECT_EQ(run("check", {"b.yaml"}).exit_code, 0);
}

TEST_F(ModelFiles, CompareSaysHowToExplainThem) {
  write_text(folder.file("shiny.mtl"), "newmtl shiny\nKd 0.5 0.5 0.5\nKs 0.5 0.5 0.5\nNs 4\nillum 2\n");
  write_text(folder.file("shiny.obj"),
             "mtllib shiny.mtl\nusemtl shiny\n" + read_text(folder.file("wedge.obj")));
  const ProgramResult result =
      run("compare", {"shiny.obj", "--models", "phong,blinn_phong", "--difference", "--size", "16x12",
                      "--samples", "1", "--camera", "front", "--background", "0.1,0.2,0.3", "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find(" --camera front --background 0.1,0.2,0.3"), std::string::npos) << result.out;
  EXPECT_EQ(run("explain", {"wedge.obj", "--pixel", "8,6", "--size", "16x12", "--camera", "front"}).exit_code,
            0);
}

// ---- turntables

TEST_F(ModelFiles, ATurntableBeginsWithThePictureAndGoesOnceAround) {
  std::filesystem::create_directory(folder.file("out"));
  const ProgramResult result = run("render", {"wedge.obj", "--turntable", "4", "-o", "out/%02d.exr", "-o",
                                              "out/%d.png", "--size", "32x24", "--samples", "1"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("out/00.exr, out/0.png to out/03.exr, out/3.png: 32 x 24, "), std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("100 %"), std::string::npos);
  EXPECT_EQ(result.err.find("100 %"), result.err.rfind("100 %")) << "progress is of all pictures";
  ASSERT_EQ(render({"wedge.obj", "-o", "one.exr"}).exit_code, 0);
  EXPECT_EQ(read_text(folder.file("one.exr")), read_text(folder.file("out/00.exr")));
  for (const char* name : {"out/01.exr", "out/02.exr", "out/03.exr"})
    EXPECT_GT(compare_images(picture("one.exr"), picture(name)).differing_pixels, 50u) << name;
}

TEST_F(ModelFiles, ATurntableIsNamedAfterTheInput) {
  EXPECT_EQ(run("render", {"scene.yaml", "--turntable", "2", "-q"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder.file("scene-0000.png")));
  EXPECT_TRUE(std::filesystem::exists(folder.file("scene-0001.png")));
  EXPECT_EQ(run("render", {"scene.yaml", "-o", "one.png", "-q"}).exit_code, 0);
  EXPECT_EQ(read_text(folder.file("one.png")), read_text(folder.file("scene-0000.png")));
  EXPECT_EQ(run("render", {"scene.yaml", "--turntable", "2", "--layers", "-q"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder.file("scene-0001.exr")));
}

TEST_F(ModelFiles, ATurntablesStatisticsAreSums) {
  const auto stats = [&](std::vector<std::string> words) {
    words.insert(words.end(), {"--stats", "-"});
    return nlohmann::json::parse(render(words).out);
  };
  const auto one = stats({"wedge.obj"}), three = stats({"wedge.obj", "--turntable", "3"});
  EXPECT_EQ(three["rays"]["eye"].get<int>(), 3 * one["rays"]["eye"].get<int>());
  EXPECT_EQ(three["samples_per_pixel"], one["samples_per_pixel"]);
}

TEST_F(ModelFiles, NamesOfATurntableHaveOnePlaceForANumber) {
  const std::pair<std::string, std::string> mistakes[] = {
      {"a.png", "'a.png' has no place for a number"},
      {"100%%.png", "'100%%.png' has no place for a number"},
      {"%d-%d.png", "'%d-%d.png' has more than one place for a number"},
      {"%s.png", "'%s.png' has a % that is not %d, %4d, %04d or %%"},
      {"%04x.png", "'%04x.png' has a % that is not %d, %4d, %04d or %%"},
      {"a.png%", "'a.png%' has a % that is not %d, %4d, %04d or %%"},
      {"%99d.png", "'%99d.png' wants a number of more than 9 digits"},
  };
  for (const auto& [name, error] : mistakes) {
    const ProgramResult result = run("render", {"scene.yaml", "--turntable", "2", "-o", name});
    EXPECT_EQ(
        result.err,
        "error: " + error + "\n    hint: a turntable's pictures are numbered: for example -o out/%04d.png\n");
    EXPECT_EQ(result.exit_code, 2);
  }
  const ProgramResult nowhere = run("render", {"scene.yaml", "--turntable", "2", "-o", "no/%d.png"});
  EXPECT_EQ(nowhere.exit_code, 1);
  EXPECT_EQ(nowhere.err, "error: cannot write 'no/0.png': there is no folder 'no'\n");
  EXPECT_EQ(run("render", {"scene.yaml", "--turntable", "2", "-q", "-o", "50%%-%d.png"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder.file("50%-1.png")));
  // Without a turntable a per cent sign is a per cent sign.
  EXPECT_EQ(run("render", {"scene.yaml", "-q", "-o", "%d.png"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder.file("%d.png")));
}

// ---- info

TEST_F(ModelFiles, InfoSaysHowLargeAModelIsItself) {
  const ProgramResult result = run("info", {"wedge.obj", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto info = nlohmann::json::parse(result.out);
  EXPECT_EQ(info["bounds"]["lower"], (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(info["bounds"]["upper"], (std::vector<double>{4, 2, 1}));
  EXPECT_EQ(info["stored"]["triangles"], 8);
  EXPECT_EQ(info["shown"], 8);
  EXPECT_EQ(info["objects"].size(), 1u);
  EXPECT_EQ(info["cameras"], nlohmann::json::array());
  EXPECT_EQ(info["textures"], nlohmann::json::array());
  EXPECT_EQ(info["warnings"], nlohmann::json::array());
  const std::string text = run("info", {"wedge.obj"}).out;
  EXPECT_NE(text.find("  bounds      (0, 0, 0) to (4, 2, 1)\n"), std::string::npos) << text;
  EXPECT_NE(text.find("  shown       8 primitives\n"), std::string::npos) << text;
}

TEST_F(ModelFiles, InfoSaysWhatIsOdd) {
  write_text(folder.file("odd.obj"), "mtllib none.mtl\n" + small_model);
  const auto info = nlohmann::json::parse(run("info", {"odd.obj", "--json"}).out);
  ASSERT_EQ(info["warnings"].size(), 1u);
  EXPECT_EQ(info["warnings"][0]["place"].get<std::string>().rfind("odd.obj:1:", 0), 0u) << info["warnings"];
  const std::string text = run("info", {"odd.obj"}).out;
  EXPECT_NE(text.find("  warnings    1\n    odd.obj:1:"), std::string::npos) << text;
}

TEST_F(ModelFiles, InfoOfTheOtherPictures) {
  // Two pixels of a TGA: 24 bits, from the top; and of an HDR.
  const std::string tga{"\0\0\2\0\0\0\0\0\0\0\0\0\2\0\1\0\30\40\0\0\377\377\0\0", 24};
  write_text(folder.file("p.tga"), tga);
  write_text(folder.file("p.hdr"), "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x83");
  const auto info = nlohmann::json::parse(run("info", {"p.tga", "--json"}).out);
  EXPECT_EQ(info["format"], "TGA");
  EXPECT_EQ(info["width"], 2);
  EXPECT_EQ(info["channels"].size(), 3u);
  EXPECT_EQ(info["channels"][0]["max"], 1);  // the first pixel is red
  const std::string text = run("info", {"p.hdr"}).out;
  EXPECT_NE(text.find("  size        1 x 1\n  format      Radiance HDR\n"), std::string::npos) << text;
  EXPECT_NE(text.find("R: 4 to 4, mean 4\n"), std::string::npos) << text;
  // And they can be converted.
  EXPECT_EQ(run("convert", {"p.tga", "p.png"}).exit_code, 0);
  EXPECT_EQ(picture("p.png").data, (std::vector<float>{1, 0, 0, 0, 0, 1}));
}

}  // namespace
}  // namespace lambent::test
