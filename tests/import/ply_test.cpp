#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "lambent/image.h"
#include "read_model.h"

namespace lambent {
namespace {

using test::Bytes, test::mesh_of, test::Strings, test::Triangles, test::warnings_of;
using Color = std::array<float, 4>;

Model ply(const std::string& bytes, const ImportOptions& options = {}, const test::Files& beside = {}) {
  return test::read_model(import_ply, "model.ply", bytes, options, beside);
}
const std::vector<Sphere>& spheres_of(const Model& model) {
  return std::get<std::vector<Sphere>>(model.shapes.at(0).primitives);
}
std::string error_of(const std::string& bytes, const ImportOptions& options = {}) {
  const Strings errors = test::errors_when([&] { ply(bytes, options); });
  return errors.empty() ? "no error" : errors[0];
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string faces = "property list uchar int vertex_indices\n";
std::string head(const char* format, int vertices, const std::string& more, int face_count) {
  return "ply\nformat " + std::string(format) + " 1.0\nelement vertex " + std::to_string(vertices) + "\n" +
         xyz + more + "element face " + std::to_string(face_count) + "\n" + faces + "end_header\n";
}
const std::string triangle = head("ascii", 3, "", 1) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

// ---- formats and types ----

TEST(Ply, ATriangle) {
  const Model model = ply(triangle);
  ASSERT_EQ(model.shapes.size(), 1u);
  EXPECT_EQ(model.shapes[0].name, "model.ply");
  const Mesh& mesh = mesh_of(model);
  EXPECT_EQ(mesh.vertices, (std::vector<Vec3<float>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_TRUE(mesh.normals.empty() && mesh.uvs.empty() && mesh.colors.empty());
  EXPECT_EQ(warnings_of(model), Strings{});
  ASSERT_EQ(model.materials.size(), 1u);
  EXPECT_EQ(model.materials[0].diffuse, (Rgb{{0.7, 0.7, 0.7}}));
  EXPECT_EQ(model.materials[0].ambient, (Rgb{{0.7, 0.7, 0.7}}));
  EXPECT_EQ(model.illumination, ModelId::blinn_phong);
  EXPECT_FALSE(model.z_up);
}

TEST(Ply, EveryTypeUnderBothNamesInEveryFormat) {
  const std::vector<std::array<const char*, 2>> names = {
      {"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},   {"ushort", "uint16"},
      {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};
  const auto put = [](Bytes& bytes, std::size_t type, int value) {
    switch (type) {
      case 0:
        return void(bytes << std::int8_t(value));
      case 1:
        return void(bytes << std::uint8_t(value));
      case 2:
        return void(bytes << std::int16_t(value));
      case 3:
        return void(bytes << std::uint16_t(value));
      case 4:
        return void(bytes << std::int32_t(value));
      case 5:
        return void(bytes << std::uint32_t(value));
      case 6:
        return void(bytes << float(value));
      default:
        return void(bytes << double(value));
    }
  };
  const int rows[3][3] = {{0, 0, 0}, {100, 7, 1}, {0, 3, 90}};
  for (std::size_t type = 0; type < names.size(); ++type) {
    for (const char* name : names[type]) {
      for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        SCOPED_TRACE(std::string(name) + " " + format);
        const std::string whole = type < 6 ? name : "uint8", t = name;
        const std::string header =
            "ply\nformat " + std::string(format) + " 1.0\nelement vertex 3\nproperty " + t + " x\nproperty " +
            t + " y\nproperty " + t + " z\nproperty " + t + " other\nelement face 1\nproperty list " + whole +
            " " + whole + " vertex_index\nend_header\n";
        const std::size_t whole_type = type < 6 ? type : 1;
        Bytes bytes(std::string(format) != "binary_big_endian");
        std::string text;
        for (const auto& row : rows) {
          for (const int value : row) put(bytes, type, value), text += std::to_string(value) + " ";
          put(bytes, type, 55), text += "55\n";
        }
        for (const int value : {3, 0, 1, 2})
          put(bytes, whole_type, value), text += std::to_string(value) + " ";
        const Model model = ply(header + (std::string(format) == "ascii" ? text : bytes.text));
        EXPECT_EQ(mesh_of(model).vertices, (std::vector<Vec3<float>>{{0, 0, 0}, {100, 7, 1}, {0, 3, 90}}));
        EXPECT_EQ(mesh_of(model).triangles, (Triangles{{0, 1, 2}}));
      }
    }
  }
}

TEST(Ply, EndsOfLines) {
  std::string crlf, cr;
  for (const char c : triangle) c == '\n' ? crlf += "\r\n" : crlf += c, cr += c == '\n' ? '\r' : c;
  EXPECT_EQ(mesh_of(ply(crlf)).triangles.size(), 1u);
  EXPECT_EQ(mesh_of(ply(cr)).triangles.size(), 1u);
  EXPECT_EQ(mesh_of(ply("\xef\xbb\xbf" + triangle)).triangles.size(), 1u);
  // Binary data may begin with a byte that would be one: x = 0x0d0a000a.
  for (const std::string end : {"\n", "\r\n"}) {
    std::string header;
    for (const char c : head("binary_big_endian", 3, "", 1)) header += c == '\n' ? end : std::string(1, c);
    Bytes bytes(false);
    bytes << 0x0a0d000a << 0.f << 0.f << 1.f << 0.f << 0.f << 0.f << 1.f << 0.f << std::uint8_t(3) << 0 << 1
          << 2;
    EXPECT_EQ(mesh_of(ply(header + bytes.text)).vertices.at(0).x, std::bit_cast<float>(0x0a0d000a));
  }
}

TEST(Ply, AnyOrderAndWhatIsUnknown) {
  const Model model =
      ply("ply\nformat ascii 1.0\nobj_info made by hand\ncomment end_header is not here\n"
          "element nothing 1000000000000\nelement face 1\nproperty float area\n"
          "property list uchar float weights\nproperty list uchar int vertex_indices\nelement camera 2\n"
          "property list uint8 double matrix\nproperty int id\nelement vertex 3\nproperty uchar flag\n"
          "property float z\nproperty float y\nproperty list uchar int bones\nproperty float x\nend_header\n"
          "0.5 2 1 1 3 0 1 2\n\n3 9 9 9 1\n0 2\n1 5 3 2 7 7 0\n1 5 3 0 1\n  1 5 4 1 7 0\n");
  EXPECT_EQ(mesh_of(model).vertices, (std::vector<Vec3<float>>{{0, 3, 5}, {1, 3, 5}, {0, 4, 5}}));
  EXPECT_EQ(mesh_of(model).triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(warnings_of(model), Strings{});

  Bytes bytes(true);
  bytes << std::uint8_t(2) << 1.f << 2.f << std::uint8_t(3) << 0 << 1 << 2;
  bytes << std::uint8_t(1) << 9.0 << 4 << std::uint8_t(0) << 5;
  for (int i = 0; i < 3; ++i) bytes << float(i) << std::uint8_t(i) << float(i * i) << 0.f;
  const Model binary =
      ply("ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list uchar float weights\n"
          "property list uchar int vertex_indices\nelement camera 2\nproperty list uint8 double matrix\n"
          "property int id\nelement vertex 3\nproperty float x\nproperty uchar flag\nproperty float y\n"
          "property float z\nend_header\n" +
          bytes.text);
  EXPECT_EQ(mesh_of(binary).vertices, (std::vector<Vec3<float>>{{0, 0, 0}, {1, 1, 0}, {2, 4, 0}}));
}

TEST(Ply, MoreNumbersInALineThanTheHeaderNames) {
  EXPECT_EQ(warnings_of(ply(head("ascii", 3, "", 1) + "0 0 0\n1 0 0 7\n0 1 0\n3 0 1 2\n")),
            (Strings{"model.ply:11:7: warning: this line holds more numbers than the header names; they are "
                     "ignored\n    1 0 0 7\n          ^"}));
}

// ---- what vertices have ----

TEST(Ply, NormalsAndTextureCoordinates) {
  const std::string more = "property short nx\nproperty short ny\nproperty short nz\n";
  for (const char* uv : {"s t", "u v", "texture_u texture_v", "texture_s texture_t"}) {
    const std::string names = uv, u = names.substr(0, names.find(' ')), v = names.substr(names.find(' ') + 1);
    const Model model =
        ply(head("ascii", 3, more + "property float " + u + "\nproperty float " + v + "\n", 1) +
            "0 0 0 0 0 127 0 0.25\n1 0 0 0 0 0 1 0.5\n0 1 0 3 0 4 0 1\n3 0 1 2\n");
    EXPECT_EQ(mesh_of(model).normals, (std::vector<Vec3<float>>{{0, 0, 1}, {0, 0, 0}, {0.6f, 0, 0.8f}}));
    ASSERT_EQ(mesh_of(model).uvs.size(), 3u);
    EXPECT_EQ(mesh_of(model).uvs[1].x, 1.f);
    EXPECT_EQ(mesh_of(model).uvs[1].y, 0.5f);
  }
}

TEST(Ply, Colors) {
  const auto colors = [](const char* type, const std::string& values) {
    std::string more;
    for (const char* name : {"red", "green", "blue", "alpha"})
      more += "property " + std::string(type) + " " + name + "\n";
    const Model model =
        ply(head("ascii", 3, more, 1) + "0 0 0 " + values + "\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n3 0 1 2\n");
    EXPECT_EQ(model.materials.at(0).diffuse, (Rgb{{1, 1, 1}}));
    return mesh_of(model).colors.at(0);
  };
  EXPECT_EQ(colors("uchar", "255 0 128 51"), (Color{1, 0, float(linear_from_srgb(128 / 255.0)), 0.2f}));
  EXPECT_EQ(colors("ushort", "65535 0 32768 13107"),
            (Color{1, 0, float(linear_from_srgb(32768 / 65535.0)), 0.2f}));
  EXPECT_EQ(colors("int", "300 -5 255 255"), (Color{1, 0, 1, 1}));
  EXPECT_EQ(colors("float", "2.5 nan 0.5 0.5"), (Color{2.5f, 0, 0.5f, 0.5f}));
}

TEST(Ply, AnAlphaThatWouldShowNothing) {
  const std::string more =
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n";
  const Model model =
      ply(head("ascii", 3, more, 1) + "0 0 0 255 0 0 0\n1 0 0 255 0 0 0\n0 1 0 255 0 0 0\n3 0 1 2\n");
  EXPECT_EQ(mesh_of(model).colors.at(2), (Color{1, 0, 0, 1}));
  EXPECT_EQ(warnings_of(model),
            (Strings{"model.ply: warning: every vertex has an alpha of 0, which would show "
                     "nothing; alpha is ignored"}));
}

TEST(Ply, CoordinatesThatAreNoNumbers) {
  const Model model =
      ply(head("ascii", 5, "", 3) +
          "0 0 0\n1 0 0\n0 1 0\nnan -NaN(ind) 1.#QNAN\n1e39 1e400 -inf\n3 0 1 2\n3 0 1 3\n3 4 1 2\n");
  EXPECT_EQ(mesh_of(model).triangles.size(), 1u);
  EXPECT_EQ(mesh_of(model).vertices.size(), 3u);
  EXPECT_EQ(warnings_of(model),
            (Strings{"model.ply: warning: 2 faces left out: a vertex has coordinates that are no "
                     "numbers"}));
}

TEST(Ply, VerticesThatNoFaceUsesDoNotCount) {
  const Model model =
      ply(head("ascii", 4, "property uchar red\nproperty uchar green\nproperty uchar blue\n", 1) +
          "9e9 0 0 1 1 1\n0 0 0 255 255 255\n1 0 0 0 0 0\n0 1 0 0 0 0\n3 1 2 3\n");
  EXPECT_EQ(mesh_of(model).vertices, (std::vector<Vec3<float>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh_of(model).colors.at(0), (Color{1, 1, 1, 1}));
  EXPECT_EQ(mesh_of(model).triangles, (Triangles{{0, 1, 2}}));
}

// ---- faces ----

TEST(Ply, Polygons) {
  const std::string points = "0 0 0\n2 0 0\n2 2 0\n1 0.5 0\n0 2 0\n";
  EXPECT_EQ(mesh_of(ply(head("ascii", 5, "", 1) + points + "4 0 1 2 4\n")).triangles,
            (Triangles{{0, 1, 2}, {0, 2, 3}}));
  // Concave: the area is what it is, 4 - 1.5, and no triangle is turned over.
  const Mesh mesh = mesh_of(ply(head("ascii", 5, "", 1) + points + "5 0 1 2 3 4\n"));
  ASSERT_EQ(mesh.triangles.size(), 3u);
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const double twice =
        cross(mesh.vertices[t[1]] - mesh.vertices[t[0]], mesh.vertices[t[2]] - mesh.vertices[t[0]]).z;
    EXPECT_GT(twice, 0);
    area += twice / 2;
  }
  EXPECT_EQ(area, 2.5);
  // A concave quadrilateral is not cut along the outside.
  EXPECT_EQ(mesh_of(ply(head("ascii", 5, "", 1) + points + "4 3 4 1 2\n")).triangles.size(), 2u);
}

TEST(Ply, FacesWithoutAnAreaAreLeftOut) {
  const Model model = ply(head("ascii", 3, "", 4) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n2 0 1\n3 0 1 1\n0\n");
  EXPECT_EQ(mesh_of(model).triangles.size(), 1u);
  EXPECT_EQ(warnings_of(model),
            (Strings{"model.ply: warning: 3 faces or parts of them left out: they have no area"}));
  EXPECT_EQ(error_of(head("ascii", 3, "", 1) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 1\n"),
            "model.ply: error: no face has an area");
}

TEST(Ply, Strips) {
  const std::string header = "ply\nformat ascii 1.0\nelement vertex 6\n" + xyz +
                             "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                             "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n";
  // Every other triangle is turned; -1 begins anew; 2 2 turns a corner.
  EXPECT_EQ(mesh_of(ply(header + "5 0 1 2 3 4\n")).triangles, (Triangles{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}}));
  EXPECT_EQ(mesh_of(ply(header + "9 0 1 2 -1 2 3 4 -1 5\n")).triangles.size(), 2u);
  const Model model = ply(header + "8 0 1 2 2 3 3 4 5\n");
  EXPECT_EQ(mesh_of(model).triangles, (Triangles{{0, 1, 2}, {4, 3, 5}}));
  EXPECT_EQ(warnings_of(model), Strings{});
}

TEST(Ply, ColorsOfFacesSplitVertices) {
  const std::string header = "ply\nformat ascii 1.0\nelement vertex 4\n" + xyz + "element face 2\n" + faces +
                             "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
                             "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  const Mesh two = mesh_of(ply(header + "3 0 1 2 255 0 0\n3 0 2 3 0 0 255\n"));
  EXPECT_EQ(two.triangles, (Triangles{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(two.colors,
            (std::vector<Color>{
                {1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}, {0, 0, 1, 1}, {0, 0, 1, 1}, {0, 0, 1, 1}}));
  EXPECT_EQ(mesh_of(ply(header + "3 0 1 2 9 9 9\n3 0 2 3 9 9 9\n")).vertices.size(), 4u);
}

TEST(Ply, TextureCoordinatesOfFaces) {
  const std::string text = "ply\nformat ascii 1.0\ncomment TextureFile skin of cow.png\nelement vertex 4\n" +
                           xyz + "element face 2\n" + faces +
                           "property list uchar float texcoord\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                           "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0.5 0 1 1 0 1\n";
  const Model model = ply(text, {}, {{"skin of cow.png", "not read here"}});
  EXPECT_EQ(mesh_of(model).triangles, (Triangles{{0, 1, 2}, {3, 2, 4}}));
  EXPECT_EQ(mesh_of(model).uvs.at(0).x, 0.f);
  EXPECT_EQ(mesh_of(model).uvs.at(3).x, 0.5f);
  ASSERT_EQ(model.textures.size(), 1u);
  EXPECT_EQ(std::filesystem::path(model.textures[0].source.file).filename(), "skin of cow.png");
  EXPECT_TRUE(model.textures[0].srgb);
  EXPECT_EQ(model.materials.at(0).maps.size(), 2u);
  EXPECT_EQ(model.materials.at(0).diffuse, (Rgb{{1, 1, 1}}));
  EXPECT_EQ(warnings_of(model), Strings{});
  const Model without = ply(text);
  EXPECT_TRUE(without.textures.empty());
  EXPECT_EQ(warnings_of(without),
            (Strings{"model.ply:3:21: warning: texture 'skin of cow.png' is not there\n"
                     "    comment TextureFile skin of cow.png\n                        ^"}));
}

TEST(Ply, SeveralTextures) {
  const Model model =
      ply("ply\nformat ascii 1.0\ncomment TextureFile a.png\ncomment TextureFile b.png\nelement vertex 4\n" +
              xyz + "property float s\nproperty float t\nelement face 2\n" + faces +
              "property int texnumber\nend_header\n0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n"
              "3 0 1 2 1\n3 0 2 3 0\n",
          {}, {{"a.png", ""}, {"b.png", ""}});
  EXPECT_EQ(model.textures.size(), 2u);
  EXPECT_EQ(model.materials.size(), 2u);
  EXPECT_EQ(model.shapes[0].material_of_primitive, (std::vector<std::uint32_t>{1, 0}));
}

TEST(Ply, BallsAreSmoothAndCubesAreNot) {
  const Model cube = ply(head("ascii", 8, "", 6) +
                         "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
                         "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 2 3 7 6\n4 1 2 6 5\n4 3 0 4 7\n");
  EXPECT_TRUE(mesh_of(cube).normals.empty());
  EXPECT_EQ(mesh_of(cube).triangles.size(), 12u);
  EXPECT_EQ(mesh_of(cube).vertices.size(), 8u);
}

// ---- clouds ----

TEST(Ply, PointsBecomeSpheres) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex 9\n" + xyz +
                     "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
  for (int i = 0; i < 9; ++i)
    text += i == 4 ? "nan nan nan 0 0 0\n"
                   : std::to_string(2 * (i % 3)) + " " + std::to_string(2 * (i / 3)) + " 0 " +
                         (i < 4 ? "255 0 0\n" : "0 128 0\n");
  const Model model = ply(text);
  ASSERT_EQ(spheres_of(model).size(), 8u);
  for (const Sphere& sphere : spheres_of(model)) EXPECT_EQ(sphere.radius, 1.5);  // 0.75 of 2
  EXPECT_EQ(spheres_of(model)[7].center, (Vec3<double>{4, 4, 0}));
  ASSERT_EQ(model.materials.size(), 2u);
  EXPECT_EQ(model.materials[0].diffuse, (Rgb{{1, 0, 0}}));
  EXPECT_EQ(model.materials[1].ambient, (Rgb{{0, double(float(linear_from_srgb(128 / 255.0))), 0}}));
  EXPECT_EQ(model.shapes[0].material_of_primitive, (std::vector<std::uint32_t>{0, 0, 0, 0, 1, 1, 1, 1}));
  EXPECT_EQ(warnings_of(model),
            (Strings{"model.ply: warning: 1 point left out: the coordinates are no numbers"}));
}

// ---- what is wrong ----

TEST(Ply, WrongHeaders) {
  EXPECT_EQ(error_of(""), "model.ply: error: the file is empty");
  EXPECT_EQ(error_of("bla"), "model.ply: error: not a PLY file: it does not begin with the line 'ply'");
  EXPECT_EQ(error_of("plywood\n"), "model.ply: error: not a PLY file: it does not begin with the line 'ply'");
  EXPECT_EQ(error_of("ply\nformat binary_mixed_endian 1.0\n"),
            "model.ply:2:8: error: unknown format 'binary_mixed_endian'\n    format binary_mixed_endian 1.0\n"
            "           ^\n    hint: formats are: ascii, binary_little_endian, binary_big_endian, each in "
            "version 1.0");
  EXPECT_EQ(error_of("ply\ncomment none\nend_header\n").substr(0, 50),
            "model.ply:3:11: error: the header names no format\n");
  const std::string ascii = "ply\nformat ascii 1.0\n";
  for (const auto& [line, message] : std::map<std::string, std::string>{
           {"property float x", "a property before any element"},
           {"elements vertex 3", "unknown statement 'elements' in the header"},
           {"element vertex", "element 'vertex' has no count"},
           {"element vertex -1", "element 'vertex' needs a count, not '-1'"},
           {"element vertex 3 4", "unexpected '4' behind the element's count"},
           {"element face 1\nelement face 2", "a second element 'face'"},
           {"element face 1\nproperty float16 x", "unknown type 'float16'"},
           {"element face 1\nproperty list float int vertex_indices",
            "the length of a list is a whole number, not a float"},
           {"element face 1\nproperty list int float vertex_indices",
            "indices of vertices are whole numbers, not of type 'float'"},
           {"element face 1\nproperty int", "the property has no name"},
           {"element face 1\nproperty int a b", "unexpected 'b' behind the property's name"},
           {"element vertex 1\nproperty int x\nproperty int x", "a second property 'x'"},
           {"element face 0\nend_header", "the file has no element 'vertex'"},
           {"element vertex 0\nproperty int x\nproperty int z\nend_header",
            "the vertices have no property 'y'"},
           {"element vertex 1\n" + xyz + "element face 1\nproperty int a\nend_header",
            "element 'face' has no list 'vertex_indices'"},
           {"element vertex 5000000000\n" + xyz + "end_header",
            "5000000000 vertices are more than can be numbered"},
           {"element face 571", "the file ends within its header"}}) {
    const std::string error = error_of(ascii + line + "\n");
    EXPECT_NE(error.find(": error: " + message + "\n"), std::string::npos) << line << "\n" << error;
  }
}

TEST(Ply, WrongNumbers) {
  EXPECT_EQ(error_of(head("ascii", 3, "", 1) + "0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n"),
            "model.ply:11:3: error: 'x' is not a number\n    1 x 0\n      ^");
  EXPECT_EQ(error_of(head("ascii", 3, "", 1) + "0 0 0\n1 0\n0 1 0\n3 0 1 2\n"),
            "model.ply:11:4: error: this line holds too few numbers for element 'vertex'\n    1 0\n       ^");
  EXPECT_EQ(error_of(head("ascii", 3, "", 1) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
            "model.ply:13:7: error: the face refers to vertex 3, but there are 3, which count from 0\n    3 "
            "0 1 3\n          ^");
  EXPECT_EQ(error_of(head("ascii", 3, "", 1) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n"),
            "model.ply:13:7: error: '1.5' is not a whole number\n    3 0 1 1.5\n          ^");
  EXPECT_EQ(error_of(head("ascii", 3, "", 1) + "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n"),
            "model.ply:13:1: error: a list of length -3\n    -3 0 1 2\n    ^");
  EXPECT_EQ(
      error_of(head("ascii", 3, "", 1) + "0 0 0\n1 0 0\n0 1 0\n\n\n"),
      "model.ply:12:6: error: the file ends behind 0 of 1 line of element 'face'\n    0 1 0\n         ^");
  EXPECT_EQ(error_of(head("ascii", 3, "", 1) + std::string("0 0 0\n\0 0 0", 11)),
            "model.ply: error: the header says ascii, but byte 160 is zero, which is no text");
}

TEST(Ply, CountsThatTheFileCannotHold) {
  // Refused before memory is taken for them.
  EXPECT_EQ(
      error_of(head("ascii", 2000000000, "", 1) + "0 0 0\n"),
      "model.ply:10:1: error: the file is too short: 2000000000 lines of element 'vertex' cannot stand in 6 "
      "bytes\n    0 0 0\n    ^");
  EXPECT_EQ(
      error_of(head("binary_little_endian", 2000000000, "", 1) + "0123"),
      "model.ply: error: the file is too short: 2000000000 rows of element 'vertex' take 12 bytes each at "
      "least, but only 4 follow byte 178");
  Bytes bytes(true);
  for (int i = 0; i < 9; ++i) bytes << float(i % 4);
  const std::string vertices = head("binary_little_endian", 3, "", 1) + bytes.text;
  EXPECT_EQ(error_of(vertices + std::string("\xff\0\0\0\0", 5)),
            "model.ply: error: at byte 205, in face 0: a list of 255 numbers, but only 4 bytes follow");
  EXPECT_EQ(error_of(vertices + std::string("\x03\0\0\0\0\1\0\0\0\7\0\0\0", 13)),
            "model.ply: error: at byte 214, in face 0: the face refers to vertex 7, but there are 3, which "
            "count from 0");
}

TEST(Ply, Limits) {
  ImportOptions options;
  options.limits.file_bytes = 100;
  EXPECT_EQ(error_of(triangle, options), "model.ply: error: the file has 180 bytes; the limit is 100");
  options = {};
  options.limits.primitives = 1;
  EXPECT_EQ(error_of(head("ascii", 3, "", 2) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 1\n", options),
            "model.ply:14:7: error: more than 1 triangle, which is the limit\n    3 0 2 1\n          ^");
  EXPECT_EQ(
      error_of("ply\nformat ascii 1.0\nelement vertex 2\n" + xyz + "end_header\n1 2 3\n4 5 6\n", options),
      "model.ply: error: 2 points, and the limit is 1");
}

TEST(Ply, HeadersWithManyNames) {
  // In linear time: a set that is cleared for each element took minutes.
  std::string text = "ply\nformat ascii 1.0\nelement vertex 0\n" + xyz;
  for (int i = 0; i < 100000; ++i) text += "property char a" + std::to_string(i) + "\n";
  for (int i = 0; i < 100000; ++i) text += "element b" + std::to_string(i) + " 0\n";
  EXPECT_EQ(error_of(text + "end_header\n"), "model.ply: error: the file has neither faces nor points");
}

TEST(Ply, AnyTextIsReadOrRefused) {
  EXPECT_TRUE(rc::check("random words give a sound mesh, a cloud or an error", [] {
    const auto words = *rc::gen::container<std::vector<std::string>>(
        rc::gen::element<std::string>("0", "1", "2", "3", "4", "-1", "\n", "\n", "\n0 0 0\n", "nan", "1e30",
                                      "x", "\n3 0 1 2\n", "\n4 0 1 2 3\n"));
    std::string text =
        head("ascii", *rc::gen::inRange(0, 6), *rc::gen::element<std::string>("", "property int red\n"),
             *rc::gen::inRange(0, 3));
    for (const std::string& word : words) text += word + " ";
    try {
      const Model model = ply(text);
      if (const Mesh* mesh = std::get_if<Mesh>(&model.shapes.at(0).primitives)) {
        RC_ASSERT(!mesh->triangles.empty());
        for (const auto& t : mesh->triangles)
          for (const std::uint32_t i : t) RC_ASSERT(i < mesh->vertices.size());
      } else {
        RC_ASSERT(!spheres_of(model).empty());
      }
    } catch (const InputError& error) {
      RC_ASSERT(!error.diagnostics().at(0).message.empty());
    }
  }));
}

// ---- files of others ----

TEST(Ply, FilesOfOthers) {
  const auto data = test::data_dir();
  if (!data || !std::filesystem::is_directory(*data + "/ply"))
    GTEST_SKIP() << "the files of others are not here; LAMBENT_DATA may name their folder";
  // What must be refused, and by which words.
  const std::map<std::string, std::string> wrong = {
      {"colors-unsupported-type.ply", "neither faces nor points"},
      {"colors4-not-same-type.ply", "neither faces nor points"},
      {"empty.ply", "e"},  // one of no bytes, one of no vertices
      {"extra-token-face-element.ply", "unexpected 'extradata' behind the element's count"},
      {"extra-token-face-property.ply", "unexpected 'extradata' behind the property's name"},
      {"format-missing.ply", "the file ends within its header"},
      {"format-too-late.ply", "the format must stand before 'element'"},
      {"format-unsupported.ply", "unknown format"},
      {"integer-literal-at-file-end.ply", "the file ends within its header"},
      {"integer-literal-too-large.ply", "the file ends within its header"},
      {"invalid-face-index-type.ply", "indices of vertices are whole numbers"},
      {"invalid-face-property.ply", "unexpected 'extradata' behind the property's name"},
      {"invalid-face-type.ply", "unknown type 'float16'"},
      {"invalid-signature.ply", "not a PLY file"},
      {"invalid-vertex-type.ply", "unknown type 'float16'"},
      {"issue623.ply", "too few numbers"},
      {"normals-not-tightly-packed.ply", "neither faces nor points"},
      {"normals-unsupported-type.ply", "neither faces nor points"},
      {"positions-not-all.ply", "no property 'y'"},
      {"positions-not-tightly-packed.ply", "neither faces nor points"},
      {"positions-unsupported-type.ply", "neither faces nor points"},
      {"texcoords-not-same-type.ply", "neither faces nor points"},
      {"texcoords-not-tightly-packed.ply", "neither faces nor points"},
      {"texcoords-unsupported-type.ply", "neither faces nor points"},
      {"unexpected-property.ply", "a property before any element"},
      {"unsupported-face-size.ply", "the file ends at byte 214, within face 1 of 2"},
      {"unknown-element.ply", "the file ends within its header"},
      {"payload_JVN42386607", "a second element 'vertex'"}};
  int read = 0, refused = 0;
  for (const char* part : {"/ply", "/invalid-mesh"}) {
    if (!std::filesystem::is_directory(*data + part)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(*data + part)) {
      const std::string name = entry.path().filename().string();
      if (!entry.is_regular_file() || (entry.path().extension() != ".ply" && !wrong.count(name))) continue;
      SCOPED_TRACE(entry.path().string());
      try {
        const Model model = import_ply(entry.path().string());
        EXPECT_FALSE(wrong.count(name));
        if (const Mesh* mesh = std::get_if<Mesh>(&model.shapes.at(0).primitives)) {
          EXPECT_FALSE(mesh->triangles.empty());
          EXPECT_TRUE(mesh->normals.empty() || mesh->normals.size() == mesh->vertices.size());
          EXPECT_TRUE(mesh->uvs.empty() || mesh->uvs.size() == mesh->vertices.size());
          EXPECT_TRUE(mesh->colors.empty() || mesh->colors.size() == mesh->vertices.size());
        }
        ++read;
      } catch (const InputError& error) {
        const std::string message = error.diagnostics().at(0).message;
        ASSERT_TRUE(wrong.count(name)) << message;
        EXPECT_NE(message.find(wrong.at(name)), std::string::npos) << message;
        EXPECT_EQ(error.diagnostics()[0].place.file, entry.path().string());
        ++refused;
      }
    }
  }
  EXPECT_GT(read, 20);
  EXPECT_GT(refused, 20);
}

TEST(Ply, OneMeshInThreeFormats) {
  const auto data = test::data_dir();
  if (!data || !std::filesystem::is_directory(*data + "/ply/happly"))
    GTEST_SKIP() << "the files of others are not here; LAMBENT_DATA may name their folder";
  const Mesh a = mesh_of(import_ply(*data + "/ply/happly/platonic_shelf.ply"));
  const Mesh b = mesh_of(import_ply(*data + "/ply/happly/platonic_shelf_big_endian.ply"));
  const Mesh c = mesh_of(import_ply(*data + "/ply/happly/platonic_shelf_ascii.ply"));
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.triangles.size(), c.triangles.size());
  EXPECT_EQ(mesh_of(import_ply(*data + "/ply/tinyply/icosahedron.ply")).triangles,
            mesh_of(import_ply(*data + "/ply/tinyply/icosahedron_ascii.ply")).triangles);
}

}  // namespace
}  // namespace lambent
