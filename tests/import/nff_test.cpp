#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <string>
#include <vector>

#include "import/model.h"
#include "support.h"

namespace lambent {
namespace {

Model read(const std::string& text) {
  const test::TemporaryDirectory folder;
  test::write_text(folder.file("model.nff"), text);
  return import_nff(folder.file("model.nff"));
}

/// What is wrong with a text: each error as "line:column: message | hint".
std::vector<std::string> errors_of(const std::string& text) {
  std::vector<std::string> errors;
  try {
    read(text);
  } catch (const InputError& error) {
    for (const Diagnostic& d : error.diagnostics()) {
      EXPECT_EQ(d.severity, Severity::error);
      EXPECT_TRUE(d.place.file.ends_with("/model.nff")) << d.place.file;
      errors.push_back(std::to_string(d.place.line) + ":" + std::to_string(d.place.column) + ": " +
                       d.message + (d.hint.empty() ? "" : " | " + d.hint));
    }
  }
  return errors;
}
using Errors = std::vector<std::string>;

template <class P> const P* primitives(const Model& model) {
  for (const Shape& shape : model.shapes)
    if (const P* found = std::get_if<P>(&shape.primitives)) return found;
  return nullptr;
}
const Shape& mesh_shape(const Model& model) {
  for (const Shape& shape : model.shapes)
    if (std::holds_alternative<Mesh>(shape.primitives)) return shape;
  throw std::runtime_error("no mesh");
}

const std::string view = "v from 1 2 3 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 512 256\n";

TEST(Nff, ReadsAView) {
  const Model model = read(
      "v\nfrom 2.1 1.3 1.7\nat 1 0 -1\nup 0 0 1\nangle 90\nhither 0.01\nresolution 640 480\ns 0 0 0 1\n");
  ASSERT_TRUE(!model.cameras.empty() && model.image);
  EXPECT_EQ(model.cameras[0].camera.projection, Projection::perspective);
  EXPECT_EQ(model.cameras[0].camera.eye, (Vec3<double>{2.1, 1.3, 1.7}));
  EXPECT_EQ(model.cameras[0].camera.target, (Vec3<double>{1, 0, -1}));
  EXPECT_EQ(model.cameras[0].camera.up, (Vec3<double>{0, 0, 1}));
  EXPECT_EQ(model.image->width, 640);
  EXPECT_EQ(model.image->height, 480);
  EXPECT_EQ(model.image->samples, 1);
  EXPECT_EQ(model.image->pattern, Pattern::corners);
  EXPECT_EQ(model.image->encoding, Encoding::none);
  // The angle spans 479 of the 480 rows: tan(fov / 2) = tan(45 degrees) * 480 / 479.
  EXPECT_NEAR(std::tan(model.cameras[0].camera.fov * M_PI / 360), 480.0 / 479.0, 1e-10);
  EXPECT_FALSE(model.background);
  EXPECT_TRUE(model.lights.empty());
}

TEST(Nff, TakesTheAngleAsItIsForOneRow) {
  EXPECT_EQ(read("v from 0 0 5 at 0 0 0 up 0 1 0 angle 40 resolution 7 1 s 0 0 0 1").cameras.at(0).camera.fov,
            40);
}

TEST(Nff, MeasuresTheAngleBetweenTheCentresOfTheOuterRows) {
  EXPECT_TRUE(rc::check([] {
    const int rows = *rc::gen::inRange(2, 5000);
    const double angle = *rc::gen::inRange(1, 100);
    const Model model = read("v from 0 0 5 at 0 0 0 up 0 1 0 angle " + std::to_string(angle) +
                             " resolution 9 " + std::to_string(rows) + "\ns 0 0 0 1");
    // The centre of the top row lies at 1 - 1/rows of the way from the middle to the upper edge.
    const double top_row = std::tan(model.cameras[0].camera.fov * M_PI / 360) * (1 - 1.0 / rows);
    RC_ASSERT(std::abs(top_row - std::tan(angle * M_PI / 360)) < 1e-9);
  }));
}

TEST(Nff, TakesTheViewsPartsInAnyOrderAndWithoutHither) {
  const Model a = read(view + "s 0 0 0 1"),
              b = read("v resolution 512 256 angle 45 up 0 1 0 at 0 0 0 from 1 2 3 s 0 0 0 1");
  EXPECT_EQ(a.cameras.at(0).camera.eye, b.cameras.at(0).camera.eye);
  EXPECT_EQ(a.cameras.at(0).camera.fov, b.cameras.at(0).camera.fov);
  EXPECT_EQ(b.image->width, 512);
}

TEST(Nff, ReadsBackgroundAndLights) {
  const Model model = read("b 0.078 0.361 0.753\nl 4 3 2\nl 1 -4 4 0.5 3 1\nl -3 1 5\nl 0 0 9\ns 0 0 0 1");
  EXPECT_EQ(*model.background, (Rgb{0.078, 0.361, 0.753}));
  ASSERT_EQ(model.lights.size(), 4u);
  const auto& first = std::get<PointLight>(model.lights[0].light);
  const auto& second = std::get<PointLight>(model.lights[1].light);
  EXPECT_EQ(first.position, (Vec3<double>{4, 3, 2}));
  EXPECT_EQ(first.color, (Rgb{1, 1, 1}));
  EXPECT_EQ(second.color[0], 0.5);
  EXPECT_EQ(second.color[1], 3);
  EXPECT_EQ(second.color[2], 1);
  // 1 / sqrt(n); the file has n = 4 lights.
  EXPECT_EQ(first.intensity, 0.5);
  EXPECT_EQ(second.intensity, 0.5);
  EXPECT_EQ(model.lights[1].name, "light 2");
  EXPECT_EQ(model.lights[1].place.line, 3);
}

TEST(Nff, ReadsFills) {
  const Model model = read(
      "f 1 0.5 0 0.8 0.1 45.3 0.9 1.5\ns 0 0 0 1\n  f 1 1 1 1 0 100000 0 0\ns 0 0 0 1\n"
      "f 1.0 .5 0 0.8 0.1 45.3 0.9 1.5 s 1 1 1 1");
  ASSERT_EQ(model.materials.size(), 2u);  // the third is the first again
  const Material &glass = model.materials[0], &chalk = model.materials[1];
  EXPECT_EQ(glass.name, "fill 1");
  EXPECT_EQ(glass.place.line, 1);
  EXPECT_EQ(glass.place.column, 1);
  EXPECT_EQ(glass.diffuse[0], 0.8);
  EXPECT_EQ(glass.diffuse[1], 0.8 * 0.5);
  EXPECT_EQ(glass.diffuse[2], 0);
  EXPECT_EQ(glass.ambient, glass.diffuse);
  EXPECT_EQ(glass.specular, (Rgb{0.1, 0.1, 0.1}));  // highlights are white
  EXPECT_EQ(glass.shininess, 45.3);
  EXPECT_EQ(glass.reflect, (Rgb{0.1, 0.1, 0.1}));
  EXPECT_EQ(glass.transmit, (Rgb{0.9, 0.9, 0.9}));
  EXPECT_EQ(glass.ior, 1.5);
  EXPECT_EQ(chalk.name, "fill 2");
  EXPECT_EQ(chalk.place.line, 3);
  EXPECT_EQ(chalk.place.column, 3);
  EXPECT_EQ(chalk.ior, 1);  // written 0
  EXPECT_EQ(model.shapes.at(0).material_of_primitive, (std::vector<std::uint32_t>{0, 1, 0}));
}

TEST(Nff, ReadsSpheresAndCones) {
  const Model model = read(
      "f 1 1 1 1 0 1 0 1\ns 1 2 3 4\nc\n0 0 0 2\n0 5 0 1\ns 0 0 0 -0.5\nc 1 1 1 -3 2 2 2 -3\nc 0 0 0 1 0 0 1 "
      "0");
  ASSERT_EQ(model.shapes.size(), 2u);
  const auto& spheres = *primitives<std::vector<Sphere>>(model);
  ASSERT_EQ(spheres.size(), 2u);
  EXPECT_EQ(spheres[0].center, (Vec3<double>{1, 2, 3}));
  EXPECT_EQ(spheres[0].radius, 4);
  EXPECT_EQ(spheres[1].radius, 0.5);  // the inside of a sphere: both sides are seen here
  const auto& cones = *primitives<std::vector<Cone>>(model);
  ASSERT_EQ(cones.size(), 3u);
  EXPECT_EQ(cones[0].from, (Vec3<double>{0, 0, 0}));
  EXPECT_EQ(cones[0].to, (Vec3<double>{0, 5, 0}));
  EXPECT_EQ(cones[0].radius_from, 2);
  EXPECT_EQ(cones[0].radius_to, 1);
  EXPECT_EQ(cones[1].radius_from, 3);
  EXPECT_EQ(cones[1].radius_to, 3);
  EXPECT_EQ(cones[2].radius_to, 0);
  EXPECT_TRUE(model.warnings.empty());
}

TEST(Nff, ReadsPolygonsWithoutNormals) {
  const Model model =
      read("f 1 1 1 1 0 1 0 1\np 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\nf 0 1 1 1 0 1 0 1\np 3 0 0 1 1 0 1 0 1 1");
  const Mesh& mesh = std::get<Mesh>(mesh_shape(model).primitives);
  EXPECT_EQ(mesh.vertices.size(), 7u);
  EXPECT_TRUE(mesh.normals.empty());
  ASSERT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(mesh_shape(model).material_of_primitive, (std::vector<std::uint32_t>{0, 0, 1}));
  for (const auto& [a, b, c] : mesh.triangles) {  // counter-clockwise, as the polygons are: facing +z
    const Vec3<float> normal =
        cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
    EXPECT_GT(normal.z, 0);
  }
}

TEST(Nff, CutsAConcavePolygonWithinItself) {
  // An arrowhead; the diagonal from its tip would leave it. Its area is 1.
  const Model model = read("f 1 1 1 1 0 1 0 1 p 4 0 0 0  2 -1 0  1 0 0  2 1 0");
  const Mesh& mesh = std::get<Mesh>(mesh_shape(model).primitives);
  ASSERT_EQ(mesh.triangles.size(), 2u);
  float area = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    area += length(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a])) / 2;
  EXPECT_FLOAT_EQ(area, 1);
}

TEST(Nff, NormalisesThePatchesNormals) {
  const Model model = read(
      "f 1 1 1 1 0 1 0 1\np 3 0 0 0 1 0 0 0 1 0\n"
      "pp 3\n0 0 0 0 0 2\n1 0 0 3 0 4\n0 1 0 0 1e200 0\np 3 0 0 5 1 0 5 0 1 5");
  const Mesh& mesh = std::get<Mesh>(mesh_shape(model).primitives);
  ASSERT_EQ(mesh.normals.size(), 9u);
  for (const std::size_t flat : {0, 1, 2, 6, 7, 8}) EXPECT_EQ(mesh.normals[flat], (Vec3<float>{0, 0, 0}));
  EXPECT_EQ(mesh.normals[3], (Vec3<float>{0, 0, 1}));
  EXPECT_EQ(mesh.normals[4], (Vec3<float>{0.6f, 0, 0.8f}));
  EXPECT_EQ(mesh.normals[5], (Vec3<float>{0, 1, 0}));
  EXPECT_TRUE(model.warnings.empty());
}

TEST(Nff, DrawsAPatchWithAZeroNormalFlat) {
  const Model model = read(
      "f 1 1 1 1 0 1 0 1\npp 3 0 0 0 0 0 1  1 0 0 0 0 0  0 1 0 0 0 1\npp 3 0 0 0 0 0 0  1 0 0 0 0 1  0 1 0 0 "
      "0 1");
  EXPECT_TRUE(std::get<Mesh>(mesh_shape(model).primitives).normals.empty());
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_EQ(model.warnings[0].severity, Severity::warning);
  EXPECT_EQ(model.warnings[0].message, "a normal of this patch is zero; such patches are drawn flat");
  EXPECT_EQ(model.warnings[0].place.line, 2);
}

TEST(Nff, TakesANeutralGreyBeforeTheFirstFill) {
  const Model model = read("s 0 0 0 1\ns 0 0 0 2\nf 1 0 0 1 0 1 0 1\ns 0 0 0 3");
  ASSERT_EQ(model.materials.size(), 2u);
  EXPECT_EQ(model.materials[0].name, "no fill");
  EXPECT_EQ(model.materials[0].diffuse, Material{}.diffuse);
  EXPECT_EQ(model.materials[1].name, "fill 1");
  EXPECT_EQ(model.shapes.at(0).material_of_primitive, (std::vector<std::uint32_t>{0, 0, 1}));
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_EQ(model.warnings[0].message, "an object before the first fill 'f'; it is drawn in a neutral grey");
}

TEST(Nff, PassesOverComments) {
  const Model model = read("# first\n\n#\nf 1 1 1 #rgb\n1 0 1 0 1 # s 0 0 0 9\ns 0 0 0 1# the end");
  EXPECT_EQ(primitives<std::vector<Sphere>>(model)->size(), 1u);
}

TEST(Nff, BreaksLinesAnywhere) {
  EXPECT_TRUE(rc::check([] {
    // The same words, parted in any way, are the same model.
    const std::vector<std::string> words = {"f", "1", "1", "1", "1", "0", "1", "0", "1", "s", "1",
                                            "2", "3", "4", "c", "0", "0", "0", "1", "0", "1", "0",
                                            "2", "p", "3", "0", "0", "0", "1", "0", "0", "0", "1",
                                            "0", "l", "7", "8", "9", "0", "1", "0"};
    std::string text;
    for (const std::string& word : words)
      text += word + *rc::gen::element<std::string>(" ", "\n", "\t", "\r\n", "  ", " # 7\n");
    const Model model = read(text);
    RC_ASSERT(model.shapes.size() == 3u);
    RC_ASSERT((primitives<std::vector<Sphere>>(model)->at(0).center == Vec3<double>{1, 2, 3}));
    RC_ASSERT(primitives<std::vector<Cone>>(model)->at(0).radius_to == 2);
    RC_ASSERT((std::get<PointLight>(model.lights.at(0).light).color == Rgb{0, 1, 0}));
  }));
}

// ---- errors

TEST(NffErrors, UnknownStatements) {
  const std::string all = "NFF has the statements v, b, l, f, c, s, p and pp";
  EXPECT_EQ(errors_of("tess 4\ns 0 0 0 1"), (Errors{"1:1: unknown statement 'tess' | " + all}));
  EXPECT_EQ(errors_of("  42\n"), (Errors{"1:3: unknown statement '42' | " + all}));
  EXPECT_EQ(errors_of("s 0 0 0 1\nS 0 0 0 1\n"), (Errors{"2:1: unknown statement 'S' | " + all}));
}

TEST(NffErrors, TooManyWords) {
  EXPECT_EQ(errors_of("f 1 1 1 1 0 1 0 1 wood.jpg"),
            (Errors{"1:19: unexpected 'wood.jpg' behind the statement 'f' | it is written: f R G B Kd Ks "
                    "Shine T ior; NFF has no textures"}));
  EXPECT_EQ(errors_of("f 1 1 1 1 0 1 0 1\ns 0 0 0 1\n2 3\nb 0 0 0 1"),
            (Errors{"3:1: unexpected '2' behind the statement 's' | it is written: s X Y Z radius",
                    "4:9: unexpected '1' behind the statement 'b' | it is written: b R G B"}));
}

TEST(NffErrors, MissingNumbers) {
  const std::string fill = "f 1 1 1 1 0 1 0 1\n";
  EXPECT_EQ(
      errors_of(fill + "s 0 0 0\ns 1 1 1 1"),
      (Errors{"3:1: expected a number for the sphere's radius, found 's' | it is written: s X Y Z radius"}));
  EXPECT_EQ(errors_of(fill + "s 0 abc 0 1"),
            (Errors{"2:5: expected a number for the y of the sphere's centre, "
                    "found 'abc' | it is written: s X Y Z radius"}));
  EXPECT_EQ(errors_of(fill + "s 0 nan 0 1"),
            (Errors{"2:5: expected a number for the y of the sphere's centre, "
                    "found 'nan' | it is written: s X Y Z radius"}));
  EXPECT_EQ(errors_of("f 1 1 1 1 1\ns 0 0 0 1"),
            (Errors{"2:1: expected a number for the Phong power Shine, found 's' | it is written: f R G B Kd "
                    "Ks Shine T ior"}));
  EXPECT_EQ(errors_of("l 1 2 3 0.5\n" + fill + "s 0 0 0 1"),
            (Errors{"2:1: expected a number for the green, found 'f' | it is written: l X Y Z [R G B]"}));
  EXPECT_EQ(errors_of(fill + "p 4 0 0 0 1 0 0 1 1 0\ns 0 0 0 1"),
            (Errors{"3:1: expected a number for the x of vertex 4 of 4, found 's' | it is written: p N, then "
                    "N times X Y Z"}));
  EXPECT_EQ(errors_of(fill + "pp 3 0 0 0 0 0 s"),
            (Errors{"2:16: expected a number for the z of the normal of vertex 1 of 3, found 's' | it is "
                    "written: pp N, then N times X Y Z and the normal's X Y Z"}));
  EXPECT_EQ(errors_of(fill + "p 3.5 0 0 0"),
            (Errors{"2:3: expected an integer for the number of vertices, found '3.5' | it is written: p N, "
                    "then N times X Y Z"}));
  EXPECT_EQ(errors_of("v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 resolution 512\ns 0 0 0 1"),
            (Errors{"2:1: expected an integer for the height, found 's' | it is written: v from X Y Z at X Y "
                    "Z up X Y Z angle DEGREES hither DISTANCE resolution WIDTH HEIGHT"}));
}

TEST(NffErrors, TruncatedFiles) {
  EXPECT_EQ(
      errors_of("s 0 0 # 1"),
      (Errors{"1:10: the file ends before the z of the sphere's centre | it is written: s X Y Z radius"}));
  EXPECT_EQ(errors_of("c 0 0 0 1\n"), (Errors{"1:10: the file ends before the x of the apex's centre | it is "
                                              "written: c X Y Z radius X Y Z radius"}));
  EXPECT_EQ(
      errors_of("p"),
      (Errors{"1:2: the file ends before the number of vertices | it is written: p N, then N times X Y Z"}));
  EXPECT_EQ(errors_of("p 1000000000000 0 0 0"),
            (Errors{"1:22: the file ends before the x of vertex 2 of 1000000000000 | it is written: p N, "
                    "then N times X Y Z"}));
}

TEST(NffErrors, NoObject) {
  const std::string message =
      "the file holds no object | a model needs at least one of the statements s, c, p and pp";
  EXPECT_EQ(errors_of(""), (Errors{"1:1: " + message}));
  EXPECT_EQ(errors_of("b 0 0 0\n"), (Errors{"1:8: " + message}));
}

TEST(NffErrors, Ranges) {
  EXPECT_EQ(errors_of("f 1 -1 1 1 0 1 0 1"), (Errors{"1:5: the green is -1; it must be from 0 to 1000000"}));
  EXPECT_EQ(errors_of("f 1 1 1 -0.5 0 1 0 1"),
            (Errors{"1:9: the diffuse coefficient Kd is -0.5; it must be from 0 to 1000000"}));
  EXPECT_EQ(errors_of("f 1 1 1 1 -1 1 0 1"),
            (Errors{"1:11: the specular coefficient Ks is -1; it must be from 0 to 1000000"}));
  EXPECT_EQ(errors_of("f 1 1 1 1 0 -3 0 1"),
            (Errors{"1:13: the Phong power Shine is -3; it must be from 0 to 1000000"}));
  EXPECT_EQ(errors_of("f 1 1 1 1 0 1 1.5 1"),
            (Errors{"1:15: the transmittance T is 1.5; it must be from 0 to 1"}));
  EXPECT_EQ(errors_of("f 1 1 1 1 0 1 0 -1"),
            (Errors{"1:17: the index of refraction is -1; it must be 0, or from 0.01 to 100"}));
  EXPECT_EQ(errors_of("f 1 1 1 1 0 1 0 1000"),
            (Errors{"1:17: the index of refraction is 1000; it must be 0, or from 0.01 to 100"}));
  EXPECT_EQ(errors_of("b 0 0 -1"), (Errors{"1:7: the blue is -1; it must be from 0 to 1000000"}));
  EXPECT_EQ(
      errors_of("s 0 1e11 0 1"),
      (Errors{
          "1:5: the y of the sphere's centre is 100000000000; it must be from -10000000000 to 10000000000"}));
}

TEST(NffErrors, Shapes) {
  EXPECT_EQ(errors_of("s 0 0 0 0"), (Errors{"1:9: the sphere's radius is 0; it must be 1e-10 at least"}));
  EXPECT_EQ(errors_of("s 0 0 0 -1e-300"),
            (Errors{"1:9: the sphere's radius is 1e-300; it must be 1e-10 at least"}));
  EXPECT_EQ(errors_of("c 0 0 0 1 0 1 0 -1"), (Errors{"1:17: one radius of the cone is negative and the other "
                                                     "is not | two negative radii show the cone's inside"}));
  EXPECT_EQ(errors_of("c 0 0 0 0 0 1 0 0"), (Errors{"1:17: both radii of the cone are 0"}));
  EXPECT_EQ(
      errors_of("c 0 1 0 0 0 1 0 1"),
      (Errors{
          "1:1: base and apex of the cone are the same point | a flat disc is written as a polygon 'p'"}));
  EXPECT_EQ(errors_of("p 2 0 0 0 1 1 1"), (Errors{"1:3: a polygon has 3 vertices at least, not 2"}));
  EXPECT_EQ(errors_of("pp -1"), (Errors{"1:4: a polygon has 3 vertices at least, not -1"}));
}

TEST(NffErrors, Views) {
  const std::string usage =
      "it is written: v from X Y Z at X Y Z up X Y Z angle DEGREES hither DISTANCE resolution WIDTH HEIGHT";
  EXPECT_EQ(errors_of("v from 0 0 5 at 0 0 0 up 0 1 0 resolution 5 5"),
            (Errors{"1:1: the view lacks 'angle' | " + usage}));
  EXPECT_EQ(errors_of("v\n"), (Errors{"1:1: the view lacks 'from' | " + usage}));
  EXPECT_EQ(errors_of("v from 0 0 5 from 0 0 4"), (Errors{"1:14: 'from' stands twice in one view"}));
  EXPECT_EQ(errors_of(view + view + "s 0 0 0 1"), (Errors{"2:1: a second view 'v' | a file has one view"}));
  EXPECT_EQ(errors_of("b 0 0 0 b 1 1 1"),
            (Errors{"1:9: a second background 'b' | a file has one background"}));
  EXPECT_EQ(errors_of("v from 0 0 5 at 0 0 0 up 0 1 0 angle 0 resolution 5 5"),
            (Errors{"1:38: the angle is 0; it must be from 0.01 to 179"}));
  EXPECT_EQ(errors_of("v from 0 0 5 at 0 0 0 up 0 1 0 angle 180 resolution 5 5"),
            (Errors{"1:38: the angle is 180; it must be from 0.01 to 179"}));
  // 2 atan(2 tan(178.5 / 2)) = 179.24995...
  EXPECT_EQ(errors_of("v from 0 0 5 at 0 0 0 up 0 1 0 angle 178.5 resolution 2 2"),
            (Errors{"1:38: the angle is too wide for 2 rows: it spans 179.2500 degrees from edge to edge | "
                    "cameras see 179 degrees at most"}));
  EXPECT_EQ(errors_of("v from 0 0 5 at 0 0 5 up 0 1 0 angle 45 resolution 5 5"),
            (Errors{"1:14: 'from' and 'at' are the same point: the view has no direction"}));
  EXPECT_EQ(errors_of("v from 0 0 5 at 0 0 0 up 0 0 0 angle 45 resolution 5 5"),
            (Errors{"1:23: the direction 'up' is zero"}));
  EXPECT_EQ(errors_of("v from 0 0 5 at 0 0 0 up 0 0 -2 angle 45 resolution 5 5"),
            (Errors{"1:23: the direction 'up' is along the way from 'from' to 'at'"}));
  EXPECT_EQ(errors_of("v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 resolution 0 5"),
            (Errors{"1:52: the width is 0; it must be from 1 to 65536 pixels"}));
  EXPECT_EQ(errors_of("v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 resolution 5 70000"),
            (Errors{"1:54: the height is 70000; it must be from 1 to 65536 pixels"}));
}

TEST(NffErrors, AreAllReportedAndEndAfterTwenty) {
  // After an error, reading goes on at the next line that begins with a statement: `bar` is passed over.
  EXPECT_EQ(errors_of("s 0 0 0 1\nfoo\nbar 1 2\ns 0 0 0 0\np 2\n").size(), 3u);
  std::string text;
  for (int i = 0; i < 100; ++i) text += "s 0 0 0 0\n";
  EXPECT_EQ(errors_of(text).size(), 20u);
}

TEST(NffErrors, ShowTheLine) {
  try {
    read("f 1 1 1 1 0 1 0 1\n\ts 0 0 0 zero\n");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics()[0].excerpt, " s 0 0 0 zero");
    EXPECT_EQ(error.diagnostics()[0].caret_column, 10);
  }
}

/// Whatever stands in a file, it is read or refused; a sanitizer says whether anything else happened.
TEST(NffErrors, NeverGoBeyondInputError) {
  EXPECT_TRUE(rc::check([] {
    const auto words = *rc::gen::container<std::vector<std::string>>(rc::gen::element<std::string>(
        "v", "b", "l", "f", "c", "s", "p", "pp", "from", "at", "up", "angle", "resolution", "0", "1", "3",
        "-1", "4", "2.5", "1e300", "-1e-300", "nan", "#", "\n", "1e9", "x\xff", "99999999999999999999"));
    std::string text;
    for (const std::string& word : words) text += word + " ";
    try {
      const Model model = read(text);
      RC_ASSERT(!model.shapes.empty() && !model.materials.empty());
      for (const Shape& shape : model.shapes)
        RC_ASSERT(shape.material_of_primitive.size() == primitive_count(shape));
    } catch (const InputError& error) {
      RC_ASSERT(!error.diagnostics().empty() && error.diagnostics()[0].place.line > 0);
    }
  }));
}

// ---- the files of others

struct Counts {
  const char* file;
  std::size_t primitives;  ///< As Haines counts them: a polygon is one.
  std::size_t lights, fills;
};

// Haines' table counts 7382, 9345, 8196, 8401, 9264, 4096 and 8191 objects for the seven large scenes.
constexpr Counts spd[] = {
    {"balls_s2_c", 92, 3, 2},   {"balls_s3_c", 821, 3, 2},    {"balls_s4_c", 7382, 3, 2},
    {"gears_s1_c", 147, 5, 2},  {"gears_s4_c", 9345, 5, 63},  {"jacks_s2_t", 3024, 1, 1},
    {"mount_s4_c", 516, 1, 2},  {"mount_s6_c", 8196, 1, 2},   {"rings_s2_c", 301, 3, 7},
    {"rings_s7_c", 8401, 3, 7}, {"teapot_s12_c", 9264, 2, 3}, {"teapot_s4_c", 1008, 2, 3},
    {"tetra_s4_c", 256, 1, 1},  {"tetra_s6_c", 4096, 1, 1},   {"tree_s5_c", 127, 7, 2},
    {"tree_s11_c", 8191, 7, 2},
};

/// Polygons of a mesh whose polygons share no vertices: each has two triangles fewer than vertices.
std::size_t objects_in(const Shape& shape) {
  if (const Mesh* mesh = std::get_if<Mesh>(&shape.primitives))
    return (mesh->vertices.size() - mesh->triangles.size()) / 2;
  return primitive_count(shape);
}

TEST(NffFiles, TheStandardProceduralDatabasesAreWhole) {
  const auto data = test::data_dir();
  if (!data) GTEST_SKIP() << "the databases are not here: set LAMBENT_DATA to the folder that holds nff/spd";
  for (const Counts& expected : spd) {
    const Model model = import_model(*data + "/nff/spd/" + expected.file + ".nff");
    std::size_t objects = 0;
    for (const Shape& shape : model.shapes) {
      objects += objects_in(shape);
      EXPECT_EQ(shape.material_of_primitive.size(), primitive_count(shape));
      for (const std::uint32_t material : shape.material_of_primitive)
        EXPECT_LT(material, model.materials.size());
    }
    EXPECT_EQ(objects, expected.primitives) << expected.file;
    EXPECT_EQ(model.lights.size(), expected.lights) << expected.file;
    EXPECT_EQ(model.materials.size(), expected.fills) << expected.file;
    EXPECT_TRUE(!model.cameras.empty() && model.image && model.background) << expected.file;
    EXPECT_TRUE(model.warnings.empty()) << expected.file;
  }
}

TEST(NffFiles, OtherDialectsAreRefusedWithTheirPlace) {
  const auto data = test::data_dir();
  if (!data) GTEST_SKIP() << "the files are not here: set LAMBENT_DATA to the folder that holds nff/assimp";
  const auto first_error = [&](const std::string& name) -> std::string {
    const std::string path = *data + "/nff/assimp/" + name;
    try {
      import_model(path);
    } catch (const InputError& error) {
      const Diagnostic& d = error.diagnostics()[0];
      EXPECT_EQ(d.place.file, path);
      return std::to_string(d.place.line) + ":" + std::to_string(d.place.column) + ": " + d.message;
    }
    return "none";
  };
  EXPECT_EQ(first_error("ManyEarthsNotJustOne.nff"),
            "13:33: unexpected 'earthSpherical.jpg' behind the statement 'f'");
  EXPECT_EQ(first_error("WithCamera.nff"), "none");
  EXPECT_EQ(first_error("cone.nff"), "3:35: unexpected 'cantfindme.png' behind the statement 'f'");
  EXPECT_EQ(first_error("cylinder.nff"), "3:33: unexpected 'earthCylindric.jpg' behind the statement 'f'");
  EXPECT_EQ(first_error("dodecahedron.nff"), "1:1: unknown statement 'dod'");
  EXPECT_EQ(first_error("hexahedron.nff"),
            "2:1: expected a number for the diffuse coefficient Kd, found 'hex'");
  EXPECT_EQ(first_error("octahedron.nff"), "1:1: unknown statement 'oct'");
  EXPECT_EQ(first_error("positionTest.nff"), "3:1: unknown statement 'tess'");
  EXPECT_EQ(first_error("spheres.nff"), "11:1: expected a number for the index of refraction, found 's'");
  EXPECT_EQ(first_error("tetrahedron.nff"), "1:1: unknown statement 'tet'");
}

TEST(Nff, Limits) {
  const test::TemporaryDirectory folder;
  test::write_text(folder.file("model.nff"), "f 1 1 1 1 0 1 0 1\ns 0 0 0 1\ns 0 0 1 1\ns 0 0 x 1\n");
  const auto error = [&](const Limits& limits) {
    ImportOptions options;
    options.limits = limits;
    try {
      import_nff(folder.file("model.nff"), options);
    } catch (const InputError& e) {
      return std::to_string(e.diagnostics().at(0).place.line) + ": " + e.diagnostics()[0].message;
    }
    return std::string("none");
  };
  Limits limits;
  limits.primitives = 1;
  EXPECT_EQ(error(limits), "3: more than 1 spheres, cones and triangles, which is the limit");
  limits.file_bytes = 10;
  EXPECT_EQ(error(limits), "0: the file has 48 bytes; the limit is 10");
}

}  // namespace
}  // namespace lambent
