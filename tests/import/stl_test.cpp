#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "lambent/image.h"
#include "read_model.h"

namespace lambent {
namespace {

using test::mesh_of, test::Strings, test::Triangles, test::warnings_of;
using Color = std::array<float, 4>;

Model stl(const std::string& bytes, const ImportOptions& options = {}) {
  return test::read_model(import_stl, "model.stl", bytes, options);
}
std::string error_of(const std::string& bytes, const ImportOptions& options = {}) {
  const Strings errors = test::errors_when([&] { stl(bytes, options); });
  return errors.empty() ? "no error" : errors[0];
}

struct Facet {
  float corners[9];
  std::uint16_t attribute = 0;
};
std::string binary(const std::vector<Facet>& facets, std::string header = "made by hand",
                   bool little = true) {
  header.resize(80);
  test::Bytes bytes(little);
  bytes << std::uint32_t(facets.size());
  for (const Facet& facet : facets) {
    for (int i = 0; i < 3; ++i) bytes << 0.f;
    for (const float x : facet.corners) bytes << x;
    bytes << facet.attribute;
  }
  return header + bytes.text;
}
const std::vector<Facet> square = {{{0, 0, 0, 1, 0, 0, 1, 1, 0}}, {{0, 0, 0, 1, 1, 0, -0.f, 1, 0}}};

std::string facet(const std::string& corners, const std::string& normal = "normal 0 0 1") {
  std::string text = " facet " + normal + "\n  outer loop\n";
  for (std::size_t i = 0; i < corners.size(); i += 6) text += "   vertex " + corners.substr(i, 5) + "\n";
  return text + "  endloop\n endfacet\n";
}
const std::string one = facet("0 0 0 1 0 0 0 1 0 ");

// ---- binary ----

TEST(Stl, Binary) {
  const Model model = stl(binary(square));
  EXPECT_EQ(model.shapes.at(0).name, "model.stl");
  EXPECT_EQ(mesh_of(model).vertices, (std::vector<Vec3<float>>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh_of(model).triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_TRUE(mesh_of(model).normals.empty() && mesh_of(model).colors.empty());
  EXPECT_EQ(model.materials.at(0).diffuse, (Rgb{{0.7, 0.7, 0.7}}));
  EXPECT_EQ(model.illumination, ModelId::blinn_phong);
  EXPECT_TRUE(model.z_up);
  EXPECT_EQ(warnings_of(model), Strings{});
}

TEST(Stl, TheSizeSaysWhichKindItIs) {
  EXPECT_EQ(mesh_of(stl(binary(square, "solid but binary"))).triangles.size(), 2u);
  EXPECT_EQ(mesh_of(stl(binary(square, "solid\nfacet normal 0 0 1\n", false))).triangles.size(), 2u);
  EXPECT_EQ(mesh_of(stl(binary(square, "\xff\xfe", true))).triangles.size(), 2u);
}

TEST(Stl, FilesThatEndTooEarlyOrTooLate) {
  const std::string whole = binary(square);
  EXPECT_EQ(error_of(whole.substr(0, 150)),
            "model.stl: error: the file ends at byte 150, within facet 2 of 2; it should have 184 bytes\n    "
            "hint: it "
            "is cut off, or no STL file");
  EXPECT_EQ(
      error_of(whole.substr(0, 70)),
      "model.stl: error: the file ends at byte 70, within the header of 84 bytes that a binary STL has");
  EXPECT_EQ(warnings_of(stl(whole + "more")),
            (Strings{"model.stl: warning: 4 bytes behind the 2 facets that the file counts are ignored"}));
  EXPECT_EQ(error_of(binary({})), "model.stl: error: the file has no facets");
  EXPECT_EQ(error_of(binary({}) + "more"),
            "model.stl: error: the file has no facets, but 4 bytes behind the 0 facets that the file counts");
  EXPECT_EQ(error_of(""), "model.stl: error: the file has no facets");
}

TEST(Stl, FacetsWithoutAnAreaAreLeftOut) {
  const float nan = std::nanf("");
  const Model model =
      stl(binary({square[0], {{0, 0, 0, 1, 1, 1, 1, 1, 1}}, {{0, 0, nan, 1, 0, 0, 0, 1, 0}}}));
  EXPECT_EQ(mesh_of(model).triangles.size(), 1u);
  EXPECT_EQ(mesh_of(model).vertices.size(), 3u);
  EXPECT_EQ(
      warnings_of(model),
      (Strings{
          "model.stl: warning: 1 facet left out: a corner has coordinates that are no numbers, or too large",
          "model.stl: warning: 1 facet left out: they have no area"}));
  EXPECT_EQ(error_of(binary({{{0, 0, 0, 1, 1, 1, 1, 1, 1}}})), "model.stl: error: no facet has an area");
}

TEST(Stl, Colors) {
  std::vector<Facet> facets = square;
  facets[0].attribute = 0x8000 | 31 << 10 | 16;  // VisCAM: red is high
  const float half = float(linear_from_srgb(16 / 31.0));
  const Mesh viscam = mesh_of(stl(binary(facets)));
  EXPECT_EQ(viscam.vertices.size(), 6u);
  EXPECT_EQ(viscam.colors.at(0), (Color{1, 0, half, 1}));
  EXPECT_EQ(viscam.colors.at(3), (Color{0.7f, 0.7f, 0.7f, 1}));
  facets[0].attribute = 31 | 16 << 5;  // Magics: red is low, and bit 15 means: the common colour
  facets[1].attribute = 0x8000;
  const Model magics = stl(binary(facets, std::string("COLOR=\xff\x80\0\xff,", 11)));
  EXPECT_EQ(mesh_of(magics).colors.at(0), (Color{1, half, 0, 1}));
  EXPECT_EQ(mesh_of(magics).colors.at(3), (Color{1, float(linear_from_srgb(128 / 255.0)), 0, 1}));
  EXPECT_EQ(magics.materials.at(0).diffuse, (Rgb{{1, 1, 1}}));
  facets[0].attribute = 7;  // of no known meaning
  EXPECT_TRUE(mesh_of(stl(binary(facets))).colors.empty());
}

TEST(Stl, RoundThingsAreSmooth) {
  const auto prism = [](int sides) {  // its side only
    std::vector<Facet> facets;
    for (int i = 0; i < sides; ++i) {
      const double a = i * 6.283185307179586 / sides, b = ((i + 1) % sides) * 6.283185307179586 / sides;
      const float x0 = float(std::cos(a)), y0 = float(std::sin(a)), x1 = float(std::cos(b)),
                  y1 = float(std::sin(b));
      facets.push_back({{x0, y0, 0, x1, y1, 0, x1, y1, 1}});
      facets.push_back({{x0, y0, 0, x1, y1, 1, x0, y0, 1}});
    }
    return mesh_of(stl(binary(facets)));
  };
  EXPECT_TRUE(prism(8).normals.empty());
  EXPECT_EQ(prism(8).vertices.size(), 16u);
  const Mesh round = prism(20);
  ASSERT_EQ(round.normals.size(), 40u);
  for (std::size_t i = 0; i < 40; ++i) {  // outwards, as far as the two triangles of a side pull it
    EXPECT_NEAR(length(round.normals[i]), 1, 1e-6);
    EXPECT_GT(dot(round.normals[i], round.vertices[i] - Vec3<float>{0, 0, round.vertices[i].z}), 0.99f);
  }
}

// ---- ASCII ----

TEST(Stl, Ascii) {
  const Model model = stl("solid part one\n" + one + facet("1 0 0 1 1 0 0 1 0 ", "normal nan nan nan") +
                          "endsolid part one\n");
  ASSERT_EQ(model.shapes.size(), 1u);
  EXPECT_EQ(model.shapes[0].name, "part one");
  EXPECT_EQ(mesh_of(model).vertices.size(), 4u);
  EXPECT_EQ(mesh_of(model).triangles, (Triangles{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_TRUE(model.z_up);
  EXPECT_EQ(warnings_of(model), Strings{});
}

TEST(Stl, SeveralSolidsWithAnyNames) {
  const Model model = stl(" SOLID facet outer loop\n" + one +
                          "EndSolid\nsolid empty\nendsolid empty\nsolid\t\xe6\x9c\x88\xe7\x90\x83\r\n" +
                          facet("0 0 1 1 0 1 0 1 1 ", "") + "endsolid facet\nsolid\n" + one + "endsolid");
  ASSERT_EQ(model.shapes.size(), 3u);
  EXPECT_EQ(model.shapes[0].name, "facet outer loop");
  EXPECT_EQ(model.shapes[1].name, "\xe6\x9c\x88\xe7\x90\x83");
  EXPECT_EQ(model.shapes[2].name, "model.stl");
  EXPECT_EQ(mesh_of(model, 1).vertices.at(0), (Vec3<float>{0, 0, 1}));
  EXPECT_EQ(model.materials.size(), 1u);
}

TEST(Stl, AsciiWithoutLinesAndInUtf16) {
  std::string flat = one, wide = "\xff\xfe";
  std::replace(flat.begin() + 1, flat.end(), '\n', ' ');
  EXPECT_EQ(mesh_of(stl("solid x\n" + flat + " endsolid")).triangles.size(), 1u);
  for (const char c : "solid x\n" + one + "endsolid\n") wide += c, wide += '\0';
  EXPECT_EQ(mesh_of(stl(wide)).triangles.size(), 1u);
}

TEST(Stl, FacetsOfMoreCorners) {
  EXPECT_EQ(mesh_of(stl("solid\n" + facet("0 0 0 1 0 0 1 1 0 0 1 0 ") + "endsolid\n")).triangles.size(), 2u);
}

TEST(Stl, WrongAscii) {
  EXPECT_EQ(error_of("solid a\nendsolid a\n"), "model.stl: error: the file has no facets");
  EXPECT_EQ(error_of("  \n"), "model.stl: error: the file has no facets");
  EXPECT_EQ(error_of("solid a\n" + one + "color 1 2 3\n"),
            "model.stl:9:1: error: expected 'facet' or 'endsolid', found 'color'\n    color 1 2 3\n    ^");
  EXPECT_EQ(error_of("solid a\n" + facet("0 0 0 1 x 0 0 1 0 ")),
            "model.stl:5:13: error: expected a coordinate in facet 1, found 'x'\n       vertex 1 x 0\n       "
            "         ^");
  EXPECT_EQ(error_of("solid a\n" + facet("0 0 0 1 0 0 ")),
            "model.stl:6:3: error: facet 1 has 2 corners; it needs 3\n      endloop\n      ^");
  EXPECT_EQ(error_of("solid a\n" + one.substr(0, 60)),
            "model.stl:5:12: error: the file ends within facet 1\n       vertex 1\n               ^");
  EXPECT_EQ(error_of("solid a\n facet normal 0 0 1 1 1\n"),
            "model.stl:2:21: error: expected 'outer loop' behind the normal of facet 1, found '1'\n"
            "     facet normal 0 0 1 1 1\n                        ^");
  EXPECT_EQ(
      warnings_of(stl("solid a\n" + one)),
      (Strings{"model.stl:8:10: warning: the file ends without 'endsolid'; it may be cut off\n     endfacet\n"
               "             ^"}));
}

TEST(Stl, PlacesAreRightFarIntoALargeFile) {
  std::string text = "solid a\n";
  for (int i = 0; i < 10000; ++i) text += one;
  EXPECT_EQ(error_of(text + facet("0 0 0 1 x 0 0 1 0 ")).substr(0, 61),
            "model.stl:70005:13: error: expected a coordinate in facet 100");
  EXPECT_EQ(mesh_of(stl(text + "endsolid\n")).triangles.size(), 10000u);
}

TEST(Stl, Limits) {
  ImportOptions options;
  options.limits.primitives = 1;
  EXPECT_EQ(error_of(binary(square), options), "model.stl: error: more than 1 facet, which is the limit");
  EXPECT_EQ(error_of("solid\n" + one + one, options),
            "model.stl: error: more than 1 facet, which is the limit");
  options.limits.file_bytes = 50;
  EXPECT_EQ(error_of(binary(square), options), "model.stl: error: the file has 184 bytes; the limit is 50");
}

// ---- files of others ----

TEST(Stl, FilesOfOthers) {
  const auto data = test::data_dir();
  if (!data || !std::filesystem::is_directory(*data + "/stl"))
    GTEST_SKIP() << "the files of others are not here; LAMBENT_DATA may name their folder";
  int read = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*data + "/stl")) {
    if (!entry.is_regular_file()) continue;
    SCOPED_TRACE(entry.path().string());
    const Model model = import_stl(entry.path().string());
    ASSERT_FALSE(model.shapes.empty());
    for (std::size_t i = 0; i < model.shapes.size(); ++i) {
      const Mesh& mesh = mesh_of(model, i);
      EXPECT_FALSE(mesh.triangles.empty());
      EXPECT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.vertices.size());
    }
    ++read;
  }
  EXPECT_GT(read, 15);
  // The same shapes, as text and as numbers.
  const std::string folder = *data + "/stl/numpy-stl/";
  for (const char* name : {"Cube", "Star", "Moon"})
    EXPECT_EQ(mesh_of(import_stl(folder + "stl_ascii/" + name + ".stl")).triangles.size(),
              mesh_of(import_stl(folder + "stl_binary/" + name + ".stl")).triangles.size())
        << name;
  EXPECT_EQ(import_stl(*data + "/stl/assimp/triangle_with_two_solids.stl").shapes.size(), 2u);
}

}  // namespace
}  // namespace lambent
