// The command line: what is said of mistakes, word for word, and what help there is.

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "apps/small_scene.h"
#include "lambent/lambent.h"
#include "run_program.h"

namespace lambent::test {
namespace {

const std::vector<std::string> commands{"render", "compare", "check", "info", "list", "diff", "convert"};

struct Mistake {
  std::vector<std::string> words;
  std::string err;
};

TEST(Usage, MistakesAreNamedWithTheNearestRemedy) {
  const TemporaryDirectory folder;
  write_text(folder.file("scene.yaml"), small_scene);
  const std::string render_help = "    hint: 'lambent render --help' says how it is used\n";
  const Mistake mistakes[] = {
      {{"rendr", "scene.yaml"}, "error: unknown command 'rendr'\n    hint: did you mean 'render'?\n"},
      {{"scene.yaml"},
       "error: unknown command 'scene.yaml'\n    hint: did you mean 'lambent render scene.yaml'?\n"},
      {{"frobnicate"},
       "error: unknown command 'frobnicate'\n    hint: known are render, compare, check, info, list, diff, "
       "convert, explain, relight\n"},
      {{"--verison"}, "error: unknown option '--verison'\n    hint: did you mean '--version'?\n"},
      {{"render"}, "error: INPUT is missing\n" + render_help},
      {{"render", "--smaples", "4"},
       "error: unknown option '--smaples'\n    hint: did you mean '--samples'?\n"},
      {{"render", "scene.yaml", "--sizes=3x4"},
       "error: unknown option '--sizes'\n    hint: did you mean '--size'?\n"},
      {{"render", "scene.yaml", "other.yaml"},
       "error: 'other.yaml' is one too many for 'lambent render'\n" + render_help},
      {{"render", "scene.yaml", "--size", "640"},
       "error: --size wants width x height in pixels, not '640'\n    hint: for example --size 1280x720\n"},
      {{"render", "scene.yaml", "--size", "0x9"},
       "error: --size wants width x height in pixels, not '0x9'\n    hint: for example --size 1280x720\n"},
      {{"render", "scene.yaml", "--size", "4x4x4"},
       "error: --size wants width x height in pixels, not '4x4x4'\n    hint: for example --size 1280x720\n"},
      {{"render", "scene.yaml", "--samples", "many"},
       "error: --samples wants a whole number, 1 or more, not 'many'\n"},
      {{"render", "scene.yaml", "--samples", "1", "--samples", "2"},
       "error: --samples is given more than once\n" + render_help},
      {{"render", "scene.yaml", "--threads", "-1"},
       "error: --threads wants a whole number, 0 or more, not '-1'\n"},
      {{"render", "scene.yaml", "--threads", "99999999999"},
       "error: --threads wants a whole number, 0 or more, not '99999999999'\n"},
      {{"render", "scene.yaml", "--tile", "0"}, "error: --tile wants a whole number, 1 or more, not '0'\n"},
      {{"render", "scene.yaml", "--view", "nromals"},
       "--set integrator.view.show=nromals: error: 'show' is 'nromals', which is not known here\n"
       "    nromals\n    ^\n    hint: did you mean 'normals'?\n"},
      {{"render", "scene.yaml", "--view", "uv", "--layers"},
       "--set film.layers=true: error: a view has no layers\n    true\n    ^\n"
       "    hint: layers are what the colours of 'whitted' are made of; leave out one of the two\n"},
      {{"render", "scene.yaml", "--bits", "12"}, "error: --bits is 8 or 16, not '12'\n"},
      {{"render", "scene.yaml", "--set", "samples"},
       "error: --set wants path.to.key=value, not 'samples'\n    hint: for example --set image.samples=16\n"},
      {{"diff", "a.png"}, "error: B is missing\n    hint: 'lambent diff --help' says how it is used\n"},
      {{"diff", "a.png", "b.png", "--tolerance", "nan"},
       "error: --tolerance wants a number, 0 or more, not 'nan'\n"},
      {{"list", "--json", "--schema"}, "error: --json, --schema and --manual exclude each other\n"},
      {{"list", "modles"}, "error: unknown topic 'modles'\n    hint: did you mean 'models'?\n"},
      {{"list", "phong"},
       "error: unknown topic 'phong'\n    hint: did you mean 'lambent list models phong'?\n"},
      {{"list", "models", "phnog"},
       "error: unknown name in models 'phnog'\n    hint: did you mean 'phong'?\n"},
      {{"convert", "a.obj", "b.obj"},
       "error: cannot make 'b.obj' of 'a.obj'\n"
       "    hint: a model becomes a scene (.yaml), a scene or a model a scene of POV-Ray (.pov) or Tachyon "
       "(.dat), a picture a picture (.png, .exr)\n"},
      {{"convert", "a.obj", "b.png"},
       "error: 'a.obj' is not a picture\n"
       "    hint: 'lambent render a.obj -o b.png' makes a picture of a scene or a model\n"},
  };
  for (const Mistake& mistake : mistakes) {
    const ProgramResult result = run_program(mistake.words, folder.path());
    EXPECT_EQ(result.err, mistake.err);
    EXPECT_EQ(result.out, "") << mistake.err;
    EXPECT_EQ(result.exit_code, 2) << mistake.err;
  }
}

TEST(Usage, WithoutACommandTheHelpIsShownAndStillItIsAnError) {
  const TemporaryDirectory folder;
  const ProgramResult result = run_program({}, folder.path());
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  for (const std::string& command : commands) EXPECT_NE(result.err.find(command), std::string::npos);
  EXPECT_NE(result.err.find("error: no command was given\n"), std::string::npos);
}

TEST(Usage, VersionIsTheLibrarys) {
  const TemporaryDirectory folder;
  const ProgramResult result = run_program({"--version"}, folder.path());
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, std::string("lambent ") + version() + "\n");
}

TEST(Usage, EveryHelpHasAnExampleAndFitsInEightyColumns) {
  const TemporaryDirectory folder;
  std::vector<std::vector<std::string>> helps{{"--help"}};
  for (const std::string& command : commands) helps.push_back({command, "--help"});
  for (const std::vector<std::string>& words : helps) {
    const ProgramResult result = run_program(words, folder.path());
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_NE(result.out.find("\nExamples:\n  lambent "), std::string::npos) << result.out;
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80u) << line;
  }
  const std::string overview = run_program({"--help"}, folder.path()).out;
  for (const std::string& command : commands)
    EXPECT_NE(overview.find("\n  " + command + " "), std::string::npos);
}

TEST(Usage, WhatIsPrintedIntoNothingIsAFailure) {
  const TemporaryDirectory folder;
  ProgramResult result = run_shell("$LAMBENT list >&-", folder.path());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "error: cannot write to standard output: Bad file descriptor\n");
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  result = run_shell("$LAMBENT list >/dev/full", folder.path());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "error: cannot write to standard output: No space left on device\n");
}

TEST(Usage, AReaderThatHasSeenEnoughIsNoFailure) {
  const TemporaryDirectory folder;
  // The manual is longer than a pipe holds only by chance, so the reader goes before anything is written.
  const ProgramResult result =
      run_shell("{ sleep 0.2; $LAMBENT list --manual; echo $? >code; } | true", folder.path());
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(read_text(folder.file("code")), "0\n");
}

}  // namespace
}  // namespace lambent::test
