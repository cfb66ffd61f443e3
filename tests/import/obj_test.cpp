#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "math/functions.h"
#include "read_model.h"

namespace lambent {
namespace {

using test::mesh_of, test::printed, test::Strings, test::Triangles, test::warnings_of;

/// The model that `text` makes as an OBJ file; other files may lie beside it.
Model obj(const std::string& text, const test::Files& beside = {}) {
  return test::read_model(import_obj, "model.obj", text, {}, beside);
}
/// Everything that is wrong with `text`, as the program prints it.
Strings errors_of(const std::string& text, const test::Files& beside = {}) {
  return test::errors_when([&] { obj(text, beside); });
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

// ---- large files ----

/// A file that is read in several pieces: `lines` of a comment, 80 characters each.
std::string filler(int lines) {
  std::string text;
  for (int i = 0; i < lines; ++i) text += "#" + std::string(78, '-') + "\n";
  return text;
}

TEST(Obj, PlacesAreRightFarIntoALargeFile) {
  EXPECT_EQ(errors_of(square + filler(10000) + "f 1 2 3\n" + filler(10000) + "f 1 2 9\n"),
            (Strings{"model.obj:20006:7: error: face refers to vertex 9, but only 4 are defined so far\n"
                     "    f 1 2 9\n          ^"}));
  EXPECT_EQ(errors_of(square + "p\n" + filler(10000)).at(0).substr(0, 17), "model.obj:10005:8");
}

TEST(Obj, WarningsRememberWhatLiesFarBack) {
  const Model model = obj(square + "usemtl red\nl 1 2\nf 1 1 2\n" + filler(10000) + "usemtl blue\nf 1 2 3\n" +
                          filler(10000) + "usemtl red\nf 1 3 4\n");
  const Strings warnings = warnings_of(model);
  ASSERT_EQ(warnings.size(), 4u);
  EXPECT_EQ(
      warnings[0],
      "model.obj:5:8: warning: material 'red' is not defined; it is grey\n    usemtl red\n           ^\n"
      "    hint: the file names no material library (mtllib)");
  EXPECT_EQ(warnings[1].substr(0, 14), "model.obj:6:1:");
  EXPECT_EQ(warnings[2].substr(0, 14), "model.obj:7:1:");
  EXPECT_EQ(warnings[3].substr(0, 18), "model.obj:10008:8:");
  EXPECT_EQ(model.materials.at(0).place.line, 5);
  EXPECT_EQ(model.shapes.at(0).material_of_primitive, (std::vector<std::uint32_t>{1, 0}));
}

// ---- geometry ----

TEST(Obj, ATriangle) {
  const Model model = obj("v 0 0 0\nv 1.5 0 0\nv 0 2 -3\nf 1 2 3\n");
  ASSERT_EQ(model.shapes.size(), 1u);
  EXPECT_EQ(model.shapes[0].name, "model.obj");
  EXPECT_TRUE(model.shapes[0].material_of_primitive.empty());
  const Mesh& mesh = mesh_of(model);
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[1], (Vec3<float>{1.5f, 0, 0}));
  EXPECT_EQ(mesh.vertices[2], (Vec3<float>{0, 2, -3}));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(mesh.uvs.empty());
  EXPECT_EQ(warnings_of(model), Strings{});
  ASSERT_EQ(model.materials.size(), 1u);
  EXPECT_EQ(model.materials[0].name, "default");
  EXPECT_EQ(model.materials[0].diffuse, (Rgb{{0.8, 0.8, 0.8}}));
}

TEST(Obj, EveryFormOfACorner) {
  const std::string head = square + "vt 0 0\nvt 1 0.5 7\nvt 0.25\nvn 0 0 2\nvn 0 3 0\nvn 0 0 0\n";
  const Model v = obj(head + "f 1 2 3\n"), v_t = obj(head + "f 1/1 2/2 3/3\n"),
              v_n = obj(head + "f 1//1 2//2 3//3\n"), v_t_n = obj(head + "f 1/1/1 2/2/2 3/3/3\n");
  EXPECT_TRUE(mesh_of(v).uvs.empty() && mesh_of(v).normals.empty());
  EXPECT_TRUE(mesh_of(v_t).normals.empty());
  EXPECT_TRUE(mesh_of(v_n).uvs.empty());
  for (const Model* model : {&v_t, &v_t_n}) {
    ASSERT_EQ(mesh_of(*model).uvs.size(), 3u);
    EXPECT_EQ(mesh_of(*model).uvs[1].x, 1.f);
    EXPECT_EQ(mesh_of(*model).uvs[1].y, 0.5f);
    EXPECT_EQ(mesh_of(*model).uvs[2].x, 0.25f);
    EXPECT_EQ(mesh_of(*model).uvs[2].y, 0.f);
  }
  for (const Model* model : {&v_n, &v_t_n}) {  // unit length; a zero normal stays zero: the face's own
    ASSERT_EQ(mesh_of(*model).normals.size(), 3u);
    EXPECT_EQ(mesh_of(*model).normals[0], (Vec3<float>{0, 0, 1}));
    EXPECT_EQ(mesh_of(*model).normals[1], (Vec3<float>{0, 1, 0}));
    EXPECT_EQ(mesh_of(*model).normals[2], (Vec3<float>{0, 0, 0}));
  }
}

TEST(Obj, NegativeIndicesCountBackFromWhatIsDefinedSoFar) {
  const Model model = obj("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -4 -3 -1\n");
  EXPECT_EQ(mesh_of(model).vertices.size(), 4u);
  EXPECT_EQ(mesh_of(model).vertices[0], (Vec3<float>{0, 0, 0}));
  EXPECT_EQ(mesh_of(model).vertices[3], (Vec3<float>{0, 0, 1}));
  EXPECT_EQ(mesh_of(model).triangles, (Triangles{{0, 1, 2}, {0, 1, 3}}));
}

TEST(Obj, VerticesAreSharedWhereAllTheirIndicesAgree) {
  const std::string head = square + "vt 0 0\nvt 1 1\nvn 0 0 1\nvn 1 0 0\n";
  EXPECT_EQ(mesh_of(obj(head + "f 1//1 2//1 3//1\nf 1//1 3//1 4//1\n")).vertices.size(), 4u);
  EXPECT_EQ(mesh_of(obj(head + "f 1//1 2//1 3//1\nf 1//1 3//2 4//1\n")).vertices.size(), 5u);
  EXPECT_EQ(mesh_of(obj(head + "f 1/1 2/1 3/1\nf 1/2 3/2 4/2\n")).vertices.size(), 6u);
}

TEST(Obj, UnusedVerticesAreLeftOut) {
  const Model model = obj("v 5 5 5\nv 6 6 6\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 3 4 5\n");
  EXPECT_EQ(mesh_of(model).vertices.size(), 3u);
}

TEST(Obj, APolygonIsCutIntoTriangles) {
  EXPECT_EQ(mesh_of(obj(square + "f 1 2 3 4\n")).triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
  // An arrowhead: its fourth corner points inwards.
  EXPECT_EQ(mesh_of(obj("v -1 -1 0\nv 2 0 0\nv -1 1 0\nv 0 0 0\nf 1 2 3 4\n")).triangles,
            (Triangles{{0, 1, 3}, {1, 2, 3}}));
  // An L of six corners has the area 3.
  const Model l = obj("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n");
  double area = 0;
  for (const auto& t : mesh_of(l).triangles) {
    const auto& v = mesh_of(l).vertices;
    const float z = cross(v[t[1]] - v[t[0]], v[t[2]] - v[t[0]]).z;
    EXPECT_GT(z, 0);
    area += z / 2;
  }
  EXPECT_EQ(area, 3);
}

TEST(Obj, ColoursOfVerticesAreSrgbEncoded) {
  const Model model = obj("v 0 0 0 0.5\nv 1 0 0 0.5 1 0\nv 0 1 0 1 1 1 0.5\nv 1 1 0 red\nf 1 2 3\nf 2 4 3\n");
  const Mesh& mesh = mesh_of(model);
  EXPECT_EQ(mesh.vertices[1], (Vec3<float>{1, 0, 0}));
  ASSERT_EQ(mesh.colors.size(), 4u);
  const float half = 0.21404114f;                                 // ((0.5 + 0.055) / 1.055)^2.4
  EXPECT_EQ(mesh.colors[0], (std::array<float, 4>{1, 1, 1, 1}));  // a weight is no colour
  EXPECT_NEAR(mesh.colors[1][0], half, 1e-7);
  EXPECT_EQ(mesh.colors[1][1], 1);
  EXPECT_EQ(mesh.colors[1][2], 0);
  EXPECT_EQ(mesh.colors[1][3], 1);
  EXPECT_NEAR(mesh.colors[2][2], half, 1e-7);  // behind a weight
  EXPECT_EQ(mesh.colors[3], (std::array<float, 4>{1, 1, 1, 1}));
  EXPECT_EQ(warnings_of(model), Strings{});
  EXPECT_TRUE(mesh_of(obj(square + "f 1 2 3\n")).colors.empty());
}

TEST(Obj, ColoursOfVerticesBeyondOne) {
  const Model bytes = obj("v 0 0 0 255 0 51\nv 1 0 0\nv 0 1 0 1 1 1\nf 1 2 3\n");
  EXPECT_EQ(mesh_of(bytes).colors.at(0)[0], 1);
  EXPECT_NEAR(mesh_of(bytes).colors.at(0)[2], 0.03310477, 1e-7);  // 0.2
  EXPECT_EQ(mesh_of(bytes).colors.at(1), (std::array<float, 4>{1, 1, 1, 1}));
  EXPECT_LT(mesh_of(bytes).colors.at(2)[0], 0.001);
  EXPECT_EQ(
      warnings_of(bytes),
      (Strings{"model.obj:1:1: warning: colours of vertices above 1: all are taken as whole numbers from "
               "0 to 255\n    v 0 0 0 255 0 51\n    ^"}));
  const Model large = obj("v 0 0 0 1 1 1\nv 1 0 0 1.5 -0.5 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(mesh_of(large).colors.at(1), (std::array<float, 4>{1, 0, 0, 1}));
  EXPECT_EQ(warnings_of(large),
            (Strings{"model.obj:2:1: warning: colours of vertices go from 0 to 1; what is beyond is cut off\n"
                     "    v 1 0 0 1.5 -0.5 0\n    ^"}));
}

TEST(Obj, CommentsBlankLinesAndJoinedLines) {
  const Model model =
      obj("# C:\\made\\here\\\n\n   # indented\n\tv 0 0 0 # first\nv 1 0 \\\n 0\nv 0 1 0\r\nv 1 1 0\r\nf 1 2 "
          "\\\r\n  4 \\\n 3 # end");
  EXPECT_EQ(mesh_of(model).vertices.size(), 4u);
  EXPECT_EQ(mesh_of(model).triangles.size(), 2u);
}

TEST(Obj, Utf16AndByteOrderMark) {
  const std::string text = square + "f 1 2 3\n";
  std::string big = "\xfe\xff", little = "\xff\xfe";
  for (const char c : text) {
    big += {'\0', c};
    little += {c, '\0'};
  }
  for (const std::string& bytes : {big, little, "\xef\xbb\xbf" + text})
    EXPECT_EQ(mesh_of(obj(bytes)).triangles.size(), 1u);
}

TEST(Obj, TrianglesWithoutAreaAreCounted) {
  const Model model = obj(square + "v 2 0 0\nf 1 2 3\nf 1 2 5\nf 1 1 2\n");
  EXPECT_EQ(mesh_of(model).triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(
      warnings_of(model),
      (Strings{"model.obj:7:1: warning: 2 triangles without an area left out; the first is in this face\n"
               "    f 1 2 5\n"
               "    ^"}));
}

TEST(Obj, PointsLinesAndWhatIsUnknownGiveOneWarningEach) {
  const Model model = obj(square + "p 1 2\nl 1 2 3\nl 2 3\ncurv 0 1 1 2\ncurv 0 1 2 3\nvw 1 2\nf 1 2 3\n");
  EXPECT_EQ(
      warnings_of(model),
      (Strings{"model.obj:5:1: warning: 3 statements of points and lines skipped: they have no surface\n"
               "    p 1 2\n"
               "    ^",
               "model.obj:8:1: warning: statement 'curv' is not supported; it is ignored wherever it stands\n"
               "    curv 0 1 1 2\n"
               "    ^",
               "model.obj:10:1: warning: statement 'vw' is not supported; it is ignored wherever it stands\n"
               "    vw 1 2\n"
               "    ^"}));
}

TEST(Obj, AnyNumberOfUnknownStatementsGivesFewWarnings) {
  std::string text = square + "f 1 2 3\n";
  for (int i = 0; i < 1000; ++i) text += "word" + std::to_string(i) + "\n";
  EXPECT_EQ(obj(text).warnings.size(), 20u);
}

// ---- normals ----

TEST(Obj, FacesWithoutNormalsBesideOthersStayFlat) {
  const Model model = obj(square + "vn 0 0 1\nf 1//1 2//1 3//1\ns 1\nf 1 3 4\n");
  const Mesh& mesh = mesh_of(model);
  ASSERT_EQ(mesh.normals.size(), 6u);
  EXPECT_EQ(mesh.normals[0], (Vec3<float>{0, 0, 1}));
  for (std::uint32_t i : mesh.triangles[1]) EXPECT_EQ(mesh.normals[i], (Vec3<float>{0, 0, 0}));
}

TEST(Obj, SmoothingGroupsAverageNormalsByArea) {
  // A floor of area 2 x 1 and a wall of area 1 x 1 along the edge x = 0; their normals are +z and +x.
  const std::string roof = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\n";
  const Model smooth = obj(roof + "s 1\nf 1 2 3 4\nf 1 4 6 5\n");
  const Mesh& mesh = mesh_of(smooth);
  ASSERT_EQ(mesh.vertices.size(), 6u);
  ASSERT_EQ(mesh.normals.size(), 6u);
  const float five = std::sqrt(5.f);
  for (int shared : {0, 3}) {  // (1, 0, 2) / sqrt 5
    EXPECT_FLOAT_EQ(mesh.normals[shared].x, 1 / five);
    EXPECT_FLOAT_EQ(mesh.normals[shared].z, 2 / five);
  }
  EXPECT_EQ(mesh.normals[1], (Vec3<float>{0, 0, 1}));
  EXPECT_EQ(mesh.normals[4], (Vec3<float>{1, 0, 0}));

  // In two groups the edge is sharp; faces outside of groups are flat.
  const Model two = obj(roof + "s 1\nf 1 2 3 4\ns 2\nf 1 4 6 5\n");
  EXPECT_EQ(mesh_of(two).vertices.size(), 8u);
  for (std::uint32_t i : mesh_of(two).triangles[0])
    EXPECT_EQ(mesh_of(two).normals[i], (Vec3<float>{0, 0, 1}));
  const Model off = obj(roof + "s 1\nf 1 2 3 4\ns off\nf 1 4 6 5\n");
  for (std::uint32_t i : mesh_of(off).triangles[2])
    EXPECT_EQ(mesh_of(off).normals[i], (Vec3<float>{0, 0, 0}));
  EXPECT_TRUE(mesh_of(obj(roof + "s 0\nf 1 2 3 4\nf 1 4 6 5\n")).normals.empty());
}

TEST(Obj, SmoothingCrossesSeamsOfTextureCoordinates) {
  const std::string text =
      "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\nvt 0 0\nvt 1 1\ns 1\nf 1/1 2/1 3/1 4/1\nf 1/2 "
      "4/2 6/2 5/2\n";
  const Model model = obj(text);
  const Mesh& mesh = mesh_of(model);
  ASSERT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.normals[0], mesh.normals[4]);  // position 1, on both sides of the seam
  EXPECT_GT(mesh.normals[0].x, 0);
  EXPECT_GT(mesh.normals[0].z, 0);
}

// ---- materials ----

TEST(Obj, MaterialsOfFaces) {
  const Model model =
      obj("mtllib a.mtl\n" + square +
              "f 1 2 3\nusemtl red\nf 1 3 4\nusemtl blue\nf 1 2 4\nusemtl red\nf 2 3 4\nusemtl unused\n",
          {{"a.mtl", "newmtl blue\nKd 0 0 1\nnewmtl unused\nKd 1 1 1\nnewmtl red\nKd 1 0 0\n"}});
  ASSERT_EQ(model.materials.size(), 3u);  // in the order in which faces name them
  EXPECT_EQ(model.materials[0].name, "default");
  EXPECT_EQ(model.materials[1].name, "red");
  EXPECT_EQ(model.materials[1].diffuse, (Rgb{{1, 0, 0}}));
  EXPECT_EQ(model.materials[1].place.line, 5);
  EXPECT_EQ(std::filesystem::path(model.materials[1].place.file).filename(), "a.mtl");
  EXPECT_EQ(model.materials[2].name, "blue");
  EXPECT_EQ(model.shapes[0].material_of_primitive, (std::vector<std::uint32_t>{0, 1, 2, 1}));
  EXPECT_EQ(warnings_of(model), Strings{});
}

TEST(Obj, LibraryMayBeNamedAfterItsMaterials) {
  const Model model =
      obj(square + "usemtl red\nf 1 2 3\nmtllib a.mtl\n", {{"a.mtl", "newmtl red\nKd 1 0 0\n"}});
  ASSERT_EQ(model.materials.size(), 1u);
  EXPECT_EQ(model.materials[0].diffuse, (Rgb{{1, 0, 0}}));
}

TEST(Obj, NamesOfLibraries) {
  const std::map<std::string, std::string> libraries{{"a.mtl", "newmtl a\nKd 1 0 0\n"},
                                                     {"b c.mtl", "newmtl b c\nKd 0 1 0\n"}};
  const std::string faces = square + "usemtl a\nf 1 2 3\nusemtl b c\nf 1 3 4\n";
  const auto first = [&](const std::string& mtllib) {
    const Model model = obj(mtllib + "\n" + faces, libraries);
    return std::pair(model.materials.at(0).diffuse[0] == 1, model.materials.at(1).diffuse[0] == 0);
  };
  EXPECT_EQ(first("mtllib a.mtl"), std::pair(true, false));
  EXPECT_EQ(first("mtllib b c.mtl"), std::pair(false, true));         // a blank in the name
  EXPECT_EQ(first("mtllib a.mtl b\\ c.mtl"), std::pair(true, true));  // two, the blank kept by a backslash
  EXPECT_EQ(first("mtllib a.mtl\nmtllib b c.mtl"), std::pair(true, true));
  EXPECT_EQ(first("mtllib .\\a.mtl"), std::pair(true, false));                // as Windows writes it
  EXPECT_EQ(first("mtllib C:\\made\\there\\a.mtl"), std::pair(true, false));  // beside the model
}

TEST(Obj, LibrariesOutsideAreNotRead) {
  const test::TemporaryDirectory folder;
  std::filesystem::create_directories(folder.file("model/deep"));
  test::write_text(folder.file("red.mtl"), "newmtl red\nKd 1 0 0\nmap_Kd wood.png\n");
  test::write_text(folder.file("wood.png"), "any bytes");
  test::write_text(folder.file("model/m.obj"), "mtllib ../red.mtl\n" + square + "usemtl red\nf 1 2 3\n");
  const Model safe = import_obj(folder.file("model/m.obj"));
  EXPECT_EQ(safe.materials.at(0).diffuse, (Rgb{{0.8, 0.8, 0.8}}));
  EXPECT_EQ(warnings_of(safe).at(0),
            "m.obj:1:8: warning: material library '../red.mtl' lies outside of the model's folder and is not "
            "read; its materials will be grey\n    mtllib ../red.mtl\n           ^\n"
            "    hint: --allow-outside lets files name files that lie elsewhere");
  ImportOptions options;
  options.limits.allow_outside = true;
  EXPECT_EQ(import_obj(folder.file("model/m.obj"), options).textures.size(), 1u);
  options.limits.allow_outside = false;
  options.root = folder.path();
  EXPECT_EQ(import_obj(folder.file("model/m.obj"), options).textures.size(), 1u);
  // A library below may name an image above it, within the model's folder.
  test::write_text(folder.file("model/wood.png"), "any bytes");
  test::write_text(folder.file("model/deep/red.mtl"), "newmtl red\nmap_Kd ../wood.png\n");
  test::write_text(folder.file("model/n.obj"), "mtllib deep/red.mtl\n" + square + "usemtl red\nf 1 2 3\n");
  EXPECT_EQ(import_obj(folder.file("model/n.obj")).textures.size(), 1u);
}

TEST(Obj, TexturesOfTheMaterialsThatAreShown) {
  const Model model =
      obj("mtllib a.mtl\nmtllib b.mtl\n" + square + "usemtl b\nf 1 2 3\nusemtl a\nf 1 3 4\n",
          {{"a.mtl",
            "newmtl none\nmap_Kd not shown.png\nnewmtl a\nmap_Kd wood.png\nmap_Ks wood.png\nbump wood.png\n"},
           {"b.mtl", "newmtl b\nmap_Kd wood.png\nmap_d leaf.png\n"},
           {"wood.png", "w"},
           {"leaf.png", "l"},
           {"not shown.png", "n"}});
  ASSERT_EQ(model.textures.size(), 3u);  // wood as colour, leaf, wood as heights
  EXPECT_TRUE(model.textures[0].srgb);
  EXPECT_FALSE(model.textures[1].srgb);
  EXPECT_FALSE(model.textures[2].srgb);
  EXPECT_EQ(std::filesystem::path(model.textures[2].source.file).filename(), "wood.png");
  EXPECT_EQ(model.textures[0].source.place.line, 2);
  const auto texture = [&](int material, MapSlot slot) {
    for (const MaterialMap& map : model.materials.at(std::size_t(material)).maps)
      if (map.slot == slot) return int(map.map.texture);
    return -1;
  };
  EXPECT_EQ(texture(0, MapSlot::diffuse), 0);
  EXPECT_EQ(texture(0, MapSlot::opacity), 1);
  EXPECT_EQ(texture(1, MapSlot::diffuse), 0);
  EXPECT_EQ(texture(1, MapSlot::specular), 0);
  EXPECT_EQ(texture(1, MapSlot::bump), 2);
}

TEST(Obj, TheFirstLibraryWithAMaterialGivesIt) {
  const Model model = obj("mtllib a.mtl b.mtl\n" + square + "usemtl m\nf 1 2 3\n",
                          {{"a.mtl", "newmtl m\nKd 1 0 0\n"}, {"b.mtl", "newmtl m\nKd 0 1 0\n"}});
  EXPECT_EQ(model.materials.at(0).diffuse, (Rgb{{1, 0, 0}}));
}

TEST(Obj, MissingLibrariesAndMaterialsAreGrey) {
  const Model model = obj("mtllib no such.mtl\n" + square + "usemtl dark red\nf 1 2 3\n");
  ASSERT_EQ(model.materials.size(), 1u);
  EXPECT_EQ(model.materials[0].name, "dark red");
  EXPECT_EQ(model.materials[0].place.line, 6);
  EXPECT_EQ(model.materials[0].diffuse, (Rgb{{0.8, 0.8, 0.8}}));
  EXPECT_EQ(
      warnings_of(model),
      (Strings{
          "model.obj:1:8: warning: material library 'no such.mtl' is not there; its materials will be grey\n"
          "    mtllib no such.mtl\n"
          "           ^",
          "model.obj:6:8: warning: material 'dark red' is not defined; it is grey\n"
          "    usemtl dark red\n"
          "           ^"}));
  EXPECT_EQ(warnings_of(obj(square + "usemtl red\nf 1 2 3\n")),
            (Strings{"model.obj:5:8: warning: material 'red' is not defined; it is grey\n"
                     "    usemtl red\n"
                     "           ^\n"
                     "    hint: the file names no material library (mtllib)"}));
}

TEST(Obj, NamelessMaterials) {
  const Model model = obj("mtllib a.mtl\n" + square + "f 1 2 3\nusemtl default\nf 1 3 4\n",
                          {{"a.mtl", "newmtl default\nKd 1 0 0\n"}});
  ASSERT_EQ(model.materials.size(), 2u);
  EXPECT_EQ(model.materials[0].name, "default_2");
  EXPECT_EQ(model.materials[1].name, "default");
}

TEST(Obj, ErrorsInALibraryNameTheLibrary) {
  EXPECT_EQ(errors_of("mtllib a.mtl\n" + square + "f 1 2 9\n", {{"a.mtl", "newmtl a\nKd 1 0 zero\n"}}),
            (Strings{"a.mtl:2:8: error: 'zero' is not a number\n"
                     "    Kd 1 0 zero\n"
                     "           ^",
                     "model.obj:6:7: error: face refers to vertex 9, but only 4 are defined so far\n"
                     "    f 1 2 9\n"
                     "          ^"}));
}

// ---- what is wrong ----

TEST(Obj, IndicesOutOfRange) {
  EXPECT_EQ(errors_of("v 0 0 0\nf 1 2 0\n"),
            (Strings{"model.obj:2:5: error: face refers to vertex 2, but only 1 is defined so far\n"
                     "    f 1 2 0\n"
                     "        ^"}));
  EXPECT_EQ(errors_of(square + "f 1 0 3\n"),
            (Strings{"model.obj:5:5: error: face refers to vertex 0, but they count from 1\n"
                     "    f 1 0 3\n"
                     "        ^"}));
  EXPECT_EQ(errors_of(square + "f 1 2 -5\n"),
            (Strings{"model.obj:5:7: error: face refers to vertex -5, but only 4 are defined so far\n"
                     "    f 1 2 -5\n"
                     "          ^"}));
  EXPECT_EQ(
      errors_of("vt 0 0\n" + square + "f 1/1 2/1 3/2\n"),
      (Strings{"model.obj:6:13: error: face refers to texture coordinate 2, but only 1 is defined so far\n"
               "    f 1/1 2/1 3/2\n"
               "                ^"}));
  EXPECT_EQ(errors_of(square + "f 1/-1 2/-1 3/-1\n").size(), 1u);
  EXPECT_EQ(errors_of(square + "vn 0 0 1\nf 1//1 2//2 3//1\n"),
            (Strings{"model.obj:6:11: error: face refers to normal 2, but only 1 is defined so far\n"
                     "    f 1//1 2//2 3//1\n"
                     "              ^"}));
  EXPECT_EQ(
      errors_of(square + "f 1 2 99999999999999999999\n").at(0).substr(0, 95),
      "model.obj:5:7: error: face refers to vertex 99999999999999999999, but only 4 are defined so far");
}

TEST(Obj, NormalsAndTextureCoordinatesThatAreNowhereAreLeftOut) {
  const Model model = obj(square + "f 1/1/5 2/2/6 3/3/7\nf 1/1/5 3/3/7 4/4/8\n");
  EXPECT_EQ(mesh_of(model).vertices.size(), 4u);
  EXPECT_TRUE(mesh_of(model).uvs.empty() && mesh_of(model).normals.empty());
  EXPECT_EQ(
      warnings_of(model),
      (Strings{"model.obj:5:5: warning: faces from here on name texture coordinates before any is defined; "
               "they are left out\n    f 1/1/5 2/2/6 3/3/7\n        ^",
               "model.obj:5:7: warning: faces from here on name normals before any is defined; they are "
               "left out\n    f 1/1/5 2/2/6 3/3/7\n          ^"}));
}

TEST(Obj, CornersThatAreNone) {
  EXPECT_EQ(errors_of(square + "f 1 2 x\n"),
            (Strings{"model.obj:5:7: error: 'x' is no corner of a face\n"
                     "    f 1 2 x\n"
                     "          ^\n"
                     "    hint: corners are written v, v/vt, v//vn or v/vt/vn"}));
  for (const char* corner : {"1.5", "/1", "1/x", "1//x", "1/1/1/1", "-", "1e0"})
    EXPECT_EQ(errors_of(square + "vt 0 0\nvn 0 0 1\nf " + corner + " 2 3\n").size(), 1u) << corner;
}

TEST(Obj, CornersOfDifferentForms) {
  EXPECT_EQ(errors_of(square + "vt 0 0\nf 1/1 2 3/1\n"),
            (Strings{"model.obj:6:7: error: '2' and '1/1' name different things in one face\n"
                     "    f 1/1 2 3/1\n"
                     "          ^\n"
                     "    hint: all corners of a face have the same form: v, v/vt, v//vn or v/vt/vn"}));
}

TEST(Obj, TooFewOfAnything) {
  EXPECT_EQ(errors_of(square + "f 1 2\n"),
            (Strings{"model.obj:5:6: error: a face needs at least 3 corners, found 2\n"
                     "    f 1 2\n"
                     "         ^"}));
  EXPECT_EQ(errors_of("v 1 2\n").at(0),
            "model.obj:1:6: error: a vertex needs 3 numbers, found 2\n    v 1 2\n         ^");
  EXPECT_EQ(errors_of("vn 1 # 2 3\n").at(0),
            "model.obj:1:11: error: a normal needs 3 numbers, found 1\n    vn 1 # 2 3\n              ^");
  EXPECT_EQ(errors_of("vt\n").at(0),
            "model.obj:1:3: error: a texture coordinate needs 1 number, found 0\n    vt\n      ^");
}

TEST(Obj, NumbersThatAreNone) {
  for (const char* word : {"nan", "-inf", "1.#IND", "0x1", "1,5", "zero"})
    EXPECT_EQ(errors_of("v 0 " + std::string(word) + " 0\n").at(0),
              "model.obj:1:5: error: '" + std::string(word) +
                  "' is not a number that a vertex can have\n    v 0 " + word + " 0\n        ^");
  EXPECT_EQ(
      errors_of("v 0 0 1e39\n").at(0),
      "model.obj:1:7: error: '1e39' is too large: coordinates go up to 3.4e38\n    v 0 0 1e39\n          ^");
  EXPECT_EQ(errors_of("s smooth\n").at(0),
            "model.obj:1:3: error: a smoothing group is a number from 0 on, or 'off'\n    s smooth\n      ^");
}

TEST(Obj, ABrokenVertexDoesNotAccuseTheFacesBehindIt) {
  EXPECT_EQ(errors_of("v 0 0 x\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").size(), 1u);
}

TEST(Obj, ErrorsAreCollectedUpToTwenty) {
  std::string text = square;
  for (int i = 0; i < 19; ++i) text += "f 1 2 9\n";
  EXPECT_EQ(errors_of(text).size(), 19u);
  for (int i = 0; i < 19; ++i) text += "f 1 2 9\n";
  EXPECT_EQ(errors_of(text).size(), 20u);
}

TEST(Obj, WithoutFacesThereIsNoModel) {
  EXPECT_EQ(errors_of(""), (Strings{"model.obj:1:1: error: the file is empty"}));
  EXPECT_EQ(errors_of("vn 0 0 1\np\n"), (Strings{"model.obj:2:2: error: the file has no faces: it holds 0 "
                                                 "vertices and 1 statement of points and lines, which "
                                                 "have no surface\n"
                                                 "    p\n"
                                                 "     ^"}));
  EXPECT_EQ(errors_of(square + "curv 0 1 1 2\n").size(), 1u);  // control points are no points
  EXPECT_EQ(errors_of(square + "f 1 1 2\n"), (Strings{"model.obj:5:1: error: no face has an area\n"
                                                      "    f 1 1 2\n"
                                                      "    ^"}));
}

TEST(Obj, PointsAndLinesAloneAreBallsAndRods) {
  const Model model =
      obj("mtllib a.mtl\nv 0 0 0\nv 3 0 0\nv 3 4 0\nv 9 9 9\nusemtl a\nl 1 2 3 3\nusemtl b\np -3 -2\n",
          {{"a.mtl", "newmtl a\nnewmtl b\nKd 1 0 0\n"}});
  ASSERT_EQ(model.shapes.size(), 2u);
  const auto& balls = std::get<std::vector<Sphere>>(model.shapes[0].primitives);
  const auto& rods = std::get<std::vector<Cone>>(model.shapes[1].primitives);
  ASSERT_EQ(balls.size(), 3u);
  ASSERT_EQ(rods.size(), 2u);
  EXPECT_EQ(balls[2].center, (Vec3<double>{3, 4, 0}));
  EXPECT_EQ(rods[1].from, (Vec3<double>{3, 0, 0}));
  EXPECT_EQ(rods[1].to, (Vec3<double>{3, 4, 0}));
  for (const Sphere& ball : balls) EXPECT_DOUBLE_EQ(ball.radius, 5.0 / 400);  // the diagonal is 5
  for (const Cone& rod : rods)
    EXPECT_TRUE(rod.radius_from == balls[0].radius && rod.radius_to == rod.radius_from);
  EXPECT_EQ(model.materials.size(), 2u);
  EXPECT_EQ(model.shapes[1].material_of_primitive, (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(
      warnings_of(model),
      (Strings{"model.obj:7:1: warning: the file has points and lines alone; they are shown as balls and "
               "rods\n    l 1 2 3 3\n    ^"}));
  EXPECT_EQ(errors_of(square + "l 1 9\n").size(), 1u);
}

TEST(Obj, VerticesAloneAreBalls) {
  const Model model = obj("v 0 0 0\nvn 0 0 1\nv 1 0 0\n");
  ASSERT_EQ(model.shapes.size(), 1u);
  EXPECT_EQ(std::get<std::vector<Sphere>>(model.shapes[0].primitives).size(), 2u);
  EXPECT_EQ(warnings_of(model).at(0).substr(0, 72),
            "model.obj:3:8: warning: the file has vertices alone; they are shown as b");
  const Model one = obj("v 5 0 0\n");
  EXPECT_GT(std::get<std::vector<Sphere>>(one.shapes[0].primitives).at(0).radius, 0);
}

TEST(Obj, LimitsHold) {
  const test::TemporaryDirectory folder;
  test::write_text(folder.file("model.obj"), "mtllib m.mtl\n" + square + "f 1 2 3 4\n");
  test::write_text(folder.file("m.mtl"), std::string(200, '#'));
  const auto error_with = [&](const Limits& limits) {
    ImportOptions options;
    options.limits = limits;
    try {
      import_obj(folder.file("model.obj"), options);
    } catch (const InputError& error) {
      return printed(error.diagnostics().at(0));
    }
    return std::string();
  };
  Limits limits;
  limits.primitives = 2;
  limits.file_bytes = 200;
  EXPECT_EQ(error_with(limits), "");
  limits.primitives = 1;
  EXPECT_EQ(error_with(limits),
            "model.obj:6:1: error: more than 1 primitive may not be read\n    f 1 2 3 4\n    ^");
  limits.primitives = 2;
  limits.file_bytes = 100;
  EXPECT_EQ(error_with(limits), "m.mtl: error: the file has 200 bytes; the limit is 100");
}

TEST(Obj, AMissingFileIsNamed) {
  const test::TemporaryDirectory folder;
  try {
    import_obj(folder.file("no.obj"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().at(0).message,
              "cannot open '" + folder.file("no.obj") + "': No such file or directory");
  }
}

TEST(Obj, AnyTextIsReadOrRefused) {
  EXPECT_TRUE(rc::check("random statements give a sound mesh or errors with lines", [] {
    const auto words = *rc::gen::container<std::vector<std::string>>(rc::gen::element<std::string>(
        "v", "f", "vn", "vt", "p", "l", "s", "usemtl", "mtllib", "\n", "\n", "\nv 0 1 2", "\nf 1 2 3 4 5",
        "\nf -1 -2 -3", "0", "1", "2", "-1", "1/1", "1//1", ".5", "1e30", "\\\n", "#", "/", "x"));
    std::string text = *rc::gen::element<std::string>("", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n");
    for (const std::string& word : words) text += word + " ";
    try {
      const Model model = obj(text);
      if (!std::holds_alternative<Mesh>(model.shapes.at(0).primitives)) return;
      const Mesh& mesh = mesh_of(model);
      RC_ASSERT(!mesh.triangles.empty());
      for (const auto& t : mesh.triangles)
        for (const std::uint32_t i : t) RC_ASSERT(i < mesh.vertices.size());
    } catch (const InputError& error) {
      RC_ASSERT(!error.diagnostics().empty());
      RC_ASSERT(error.diagnostics()[0].place.line > 0);
    }
  }));
}

// ---- files of others ----

TEST(Obj, EveryFileOfTheCorpusIsReadOrRefusedWithItsPlace) {
  const auto data = test::data_dir();
  if (!data) GTEST_SKIP() << "the files of others are not here; LAMBENT_DATA may name their folder";
  int read = 0, refused = 0;
  for (const char* part : {"obj", "invalid-mesh"}) {
    const std::filesystem::path folder = std::filesystem::path(*data) / part;
    if (!std::filesystem::is_directory(folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".obj") continue;
      SCOPED_TRACE(entry.path().string());
      try {
        const Model model = import_model(entry.path().string());
        ASSERT_FALSE(model.shapes.empty());
        ++read;
        if (!std::holds_alternative<Mesh>(model.shapes[0].primitives)) continue;  // points and lines alone
        const Mesh& mesh = mesh_of(model);
        EXPECT_FALSE(mesh.triangles.empty());
        EXPECT_TRUE(std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [](const Vec3<float>& v) {
          return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
        }));
        EXPECT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.vertices.size());
        EXPECT_TRUE(std::all_of(mesh.normals.begin(), mesh.normals.end(), [](const Vec3<float>& n) {
          return n == Vec3<float>{} || std::abs(length(n) - 1) < 1e-6f;
        }));
        EXPECT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == mesh.vertices.size());
        for (const auto& t : mesh.triangles)
          for (const std::uint32_t i : t) ASSERT_LT(i, mesh.vertices.size());
        const auto& of = model.shapes[0].material_of_primitive;
        EXPECT_TRUE(of.empty() || of.size() == mesh.triangles.size());
        for (const std::uint32_t i : of) ASSERT_LT(i, model.materials.size());
        EXPECT_FALSE(model.materials.empty());
      } catch (const InputError& error) {
        ASSERT_FALSE(error.diagnostics().empty());
        EXPECT_EQ(error.diagnostics()[0].place.file, entry.path().string());
        EXPECT_GT(error.diagnostics()[0].place.line, 0);
        EXPECT_FALSE(error.diagnostics()[0].message.empty());
        ++refused;
      }
    }
  }
  if (read + refused == 0) GTEST_SKIP() << "the folder with files of others holds no OBJ files";
  EXPECT_GT(read, refused);
}

// ---- which format a file has ----

TEST(Import, TheEndingNamesTheFormat) {
  EXPECT_TRUE(is_model_file("a/b.obj"));
  EXPECT_TRUE(is_model_file("A.OBJ"));
  EXPECT_TRUE(is_model_file("balls.Nff"));
  EXPECT_FALSE(is_model_file("scene.yaml"));
  EXPECT_FALSE(is_model_file("obj"));
  EXPECT_FALSE(is_model_file(""));
  EXPECT_EQ(model_file_endings(), ".obj, .nff, .ply, .stl, .gltf, .glb");
}

TEST(Import, AnUnknownEndingIsAnswered) {
  try {
    import_model("teapot.xyz");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(printed(error.diagnostics().at(0)),
              "teapot.xyz: error: the ending of 'teapot.xyz' names no model format\n    hint: known endings: "
              ".obj, .nff, .ply, .stl, .gltf, .glb");
  }
}

}  // namespace
}  // namespace lambent
