#include "import/lint.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "support.h"

namespace lambent {
namespace {

using Strings = std::vector<std::string>;
using Files = std::map<std::string, std::string>;

/// "model.obj:3:1 message (hint)" of each remark.
Strings short_forms(const std::vector<Diagnostic>& remarks) {
  Strings result;
  for (Diagnostic d : remarks) {
    EXPECT_EQ(d.severity, Severity::warning);
    d.place.file = std::filesystem::path(d.place.file).filename().string();
    result.push_back(to_string(d.place) + " " + d.message + (d.hint.empty() ? "" : " (" + d.hint + ")"));
  }
  return result;
}

Strings lint(const std::string& text, const Files& beside = {}, const std::string& name = "model.obj") {
  const test::TemporaryDirectory folder;
  for (const auto& [file, content] : beside) test::write_text(folder.file(file), content);
  test::write_text(folder.file(name), text);
  return short_forms(name.ends_with(".mtl") ? lint_mtl(folder.file(name)) : lint_obj(folder.file(name)));
}
Strings lint_library(const std::string& text, const Files& beside = {}) {
  return lint(text, beside, "a.mtl");
}

/// A tetrahedron, closed and sound: vertices in lines 1 to 4.
const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
const std::string faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

TEST(Lint, NothingIsSaidOfWhatIsSound) {
  EXPECT_EQ(lint(corners + faces), Strings{});
  EXPECT_EQ(lint("mtllib a.mtl\n" + corners + "vt 0 0\nvn 0 0 -1\nusemtl a\nf 1/1/1 3/1/1 2/1/1\n",
                 {{"a.mtl", "newmtl a\nKa 0 0 0\nKd 1 1 1\nKs 1 1 1\nNs 9\nd 1\nillum 2\nmap_Kd a.png\n"},
                  {"a.png", ""}}),
            Strings{"model.obj:5:1 no face uses 1 vertex; this is the first"});
}

TEST(Lint, ACornerTwice) {
  EXPECT_EQ(lint(corners + faces + "f 1 2 2\n").at(1), "model.obj:9:1 this face has a corner twice");
}

TEST(Lint, NoArea) {
  EXPECT_EQ(lint(corners + "v 2 0 0\n" + faces + "f 1 2 5\n").at(1), "model.obj:10:1 this face has no area");
}

TEST(Lint, TheSameFaceAgain) {
  EXPECT_EQ(lint(corners + faces + "f 4 2 1\n"),
            Strings{"model.obj:9:1 this face has the corners of the one in line 6"});
}

TEST(Lint, FlippedNormals) {
  const std::string head = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 -1\n";
  const Strings said = lint(head + "f 1//2 2//2 3//2\n");
  ASSERT_EQ(said.size(), 2u);
  EXPECT_EQ(said[0], "model.obj:4:1 no face uses 1 normal; this is the first");
  EXPECT_EQ(said[1],
            "model.obj:6:1 the normals of this face's corners point to its back: its corners should be "
            "counter-clockwise seen from outside");
}

TEST(Lint, NormalsThatAreNone) {
  EXPECT_EQ(lint("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 0\nvn 0 0 3\nvn 0 0 1.01\nf 1//1 2//2 3//3\n"),
            (Strings{"model.obj:4:1 a normal without a direction; faces that have it are flat",
                     "model.obj:5:1 a normal is not of length 1; its direction alone counts"}));
}

TEST(Lint, WhatNoFaceUses) {
  EXPECT_EQ(
      lint("v 9 9 9\n" + corners + "v 8 8 8\nvt 0 0\nvt 1 1\nvn 0 0 1\nf 2/2 4/2 3/2\n"),
      Strings{"model.obj:1:1 no face uses 3 vertices, 1 texture coordinate, 1 normal; this is the first"});
  EXPECT_EQ(lint("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nl 3 4\n"),
            Strings{"model.obj:6:1 1 statement of points and lines skipped: they have no surface"});
  EXPECT_EQ(lint("v 0 0 0\n").size(), 1u);  // the warning of a cloud of points
}

TEST(Lint, DifferentForms) {
  EXPECT_EQ(lint("vt 0 0\n" + corners + "f 1/1 3/1 2/1\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"),
            Strings{"model.obj:7:1 faces have different forms: 3 v, 1 v/vt; this is the first that differs"});
}

TEST(Lint, Edges) {
  EXPECT_EQ(
      lint(corners + "v 1 1 1\n" + faces + "f 1 2 5\n"),
      (Strings{"model.obj:10:1 1 edge belongs to more than two faces; this is the third face of the first"}));
  EXPECT_EQ(
      lint(corners + "f 1 2 3\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"),
      Strings{"model.obj:6:1 two faces run along 3 edges in the same direction, so that one shows its back "
              "where the other shows its front; this face is the first"});
}

TEST(Lint, UsemtlWithoutFaces) {
  EXPECT_EQ(lint("mtllib a.mtl\n" + corners + "usemtl a\nusemtl b\n" + faces + "usemtl a\n",
                 {{"a.mtl", "newmtl b\nKd 1 1 1\n"}}),
            (Strings{"model.obj:6:1 no face comes before the next usemtl: this one comes to nothing",
                     "model.obj:12:1 no face comes before the next usemtl: this one comes to nothing"}));
}

TEST(Lint, MaterialsThatNobodyHasOrKnows) {
  EXPECT_EQ(lint("mtllib a.mtl b.mtl\n" + corners + "usemtl c\n" + faces,
                 {{"a.mtl", "newmtl a\nKd 1 1 1\nnewmtl b\nnewmtl b\n"}}),
            (Strings{"model.obj:1:14 material library 'b.mtl' is not there; its materials will be grey",
                     "model.obj:6:8 material 'c' is not defined; it is grey",
                     "a.mtl:1:8 material 'a' is on no face", "a.mtl:3:8 material 'b' is on no face",
                     "a.mtl:4:8 material 'b' is defined again; the first definition holds"}));
}

TEST(Lint, ImagesOnFacesWithoutTextureCoordinates) {
  EXPECT_EQ(
      lint("mtllib a.mtl\n" + corners + "usemtl a\n" + faces,
           {{"a.mtl", "newmtl a\nKd 1 1 1\nmap_Kd a.png\n"}, {"a.png", ""}}),
      Strings{"model.obj:7:1 4 faces have no texture coordinates, though the material 'a' has images; the "
              "first is this"});
}

TEST(Lint, ManyOfAKind) {
  std::string text = corners + faces;
  for (int i = 0; i < 12; ++i) text += "f 1 1 2\n";
  const Strings said = lint(text);
  ASSERT_EQ(said.size(), 12u);  // the reader's own remark among them
  EXPECT_EQ(said.back(), "model.obj and 2 more faces with a corner twice");
}

TEST(Lint, WrongFilesAreErrors) {
  EXPECT_THROW(lint(corners + "f 1 2 9\n"), InputError);
  EXPECT_THROW(lint("v 0 nan 0\n"), InputError);
  EXPECT_THROW(lint_library("newmtl a\nKd x\n"), InputError);
}

// ---- libraries ----

TEST(Lint, WhatIllumAsksFor) {
  const auto said = [](const std::string& lines) {
    const Strings remarks = lint_library("newmtl a\n" + lines);
    EXPECT_LE(remarks.size(), 1u);
    return remarks.empty() ? "" : remarks[0];
  };
  EXPECT_EQ(said("Kd 1 1 1\nillum 1\n"), "");
  EXPECT_EQ(said("Kd 1 1 1\n"), "");
  EXPECT_EQ(said("illum 1\n"), "a.mtl:2:1 illum 1 asks for Kd, which is not given");
  EXPECT_EQ(said("Kd 1 1 1\nillum 2\n"), "a.mtl:3:1 illum 2 asks for Ks, which is not given");
  EXPECT_EQ(said("Kd 1 1 1\nKs 0 0 0\nillum 3\n"), "a.mtl:4:1 illum 3 reflects by Ks, which is black");
  EXPECT_EQ(said("Kd 1 1 1\nKs 1 1 1\nillum 1\n"),
            "a.mtl:3:1 Ks comes to nothing: illum 1 has no highlight (illum 2 has one)");
  EXPECT_EQ(said("Kd 1 1 1\nKs 0 0 0\nillum 1\n"), "");
  EXPECT_EQ(said("Kd 1 1 1\nNs 9\n"), "a.mtl:3:1 Ns comes to nothing: without Ks there is no highlight");
  EXPECT_EQ(said("Ks 1 1 1\nTf 1 1 1\nillum 6\n"),
            "a.mtl:4:1 illum 6 refracts, but Ni is not given: nothing is bent");
  EXPECT_EQ(said("Ks 1 1 1\nNi 1.5\nillum 7\n"),
            "a.mtl:4:1 illum 7 lets light through by Tf or d, and neither is given");
  EXPECT_EQ(said("Pr 0.5\nKs 1 1 1\nillum 1\n"), "");  // illum says nothing here
}

TEST(Lint, NumbersThatContradictEachOther) {
  EXPECT_EQ(lint_library("newmtl a\nKd 1 1 1\nKd 0 0 0\nd 0.5\nTr 0.9\n"),
            (Strings{"a.mtl:3:1 Kd stands twice in this material; the last one holds",
                     "a.mtl:5:4 Tr contradicts d, of which it should be 1 - d; d is used"}));
}

TEST(Lint, ImagesThatMultiplyBlack) {
  EXPECT_EQ(
      lint_library("newmtl a\nKd 0 0 0\nmap_kd a.png\nmap_d a.png\nmap_Tr a.png\n", {{"a.png", ""}}),
      (Strings{"a.mtl:3:1 map_kd multiplies Kd, which is black: the image is not seen ('Kd 1 1 1' shows the "
               "image as it is)",
               "a.mtl:5:1 map_Tr comes to nothing: map_d is given, too"}));
}

TEST(Lint, NamesOfImagesByCase) {
  EXPECT_EQ(lint_library("newmtl a\nmap_Kd Wood.png\nnewmtl b\nmap_Kd wood.png\nnewmtl c\nmap_Kd no.png\n",
                         {{"wood.png", ""}}),
            (Strings{"a.mtl:2:8 image 'Wood.png' is not there and is left out",
                     "a.mtl:2:8 image 'Wood.png' is not there, but 'wood.png' is",
                     "a.mtl:4:8 image 'wood.png' is elsewhere written 'Wood.png'",
                     "a.mtl:6:8 image 'no.png' is not there and is left out"}));
}

TEST(Lint, ANameOfWhatMayNotBeReadIsNotCalledADifferentOne) {
  const test::TemporaryDirectory folder;
  test::write_text(folder.file("a.mtl"), "newmtl a\nmap_Kd wood.png\n");
  std::filesystem::create_symlink("/dev/zero", folder.file("wood.png"));
  EXPECT_EQ(short_forms(lint_mtl(folder.file("a.mtl"))),
            Strings{"a.mtl:2:8 image 'wood.png' is not there and is left out"});
}

// ---- files of others ----

TEST(Lint, EveryFileOfTheCorpusIsLookedThrough) {
  const auto data = test::data_dir();
  if (!data || !std::filesystem::is_directory(*data + "/obj"))
    GTEST_SKIP() << "the files of others are not here; LAMBENT_DATA may name their folder";
  int looked = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*data + "/obj")) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".obj" && ending != ".mtl") continue;
    SCOPED_TRACE(entry.path().string());
    try {
      const auto remarks =
          ending == ".obj" ? lint_obj(entry.path().string()) : lint_mtl(entry.path().string());
      EXPECT_LT(remarks.size(), 400u);
      ++looked;
    } catch (const InputError& error) {
      EXPECT_FALSE(error.diagnostics().empty());
    }
  }
  EXPECT_GT(looked, 0);
}

}  // namespace
}  // namespace lambent
