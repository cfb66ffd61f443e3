// What the text means: values arrive where they belong, shapes become the primitives they should.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <string>

#include "import/gltf_builder.h"
#include "scene/scene.h"
#include "scenefile/errors.h"
#include "scenefile/sample.h"
#include "scenefile/shapes.h"
#include "support.h"

namespace lambent::test {
namespace {

using Point = Vec3<double>;

double distance(const Point& a, const Point& b) { return length(a - b); }

/// Six times the volume that closed triangles enclose; positive where they face outward.
double six_volumes(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += dot(cast<double>(mesh.vertices[a]),
               cross(cast<double>(mesh.vertices[b]), cast<double>(mesh.vertices[c])));
  return sum;
}

/// The sum of the triangles' areas times their normals.
Point area_vector(const Mesh& mesh) {
  Point sum;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Point p = cast<double>(mesh.vertices[a]);
    sum = sum + 0.5 * cross(cast<double>(mesh.vertices[b]) - p, cast<double>(mesh.vertices[c]) - p);
  }
  return sum;
}

const Mesh& mesh_of(const Scene& scene, std::size_t object) {
  return std::get<Mesh>(scene.shapes[scene.objects[object].shape].primitives);
}

ScenePtr with_objects(const std::string& objects) { return parse_scene(head + "objects:\n" + objects); }

TEST(SceneFile, EveryValueOfTheSampleArrives) {
  const ScenePtr scene = parse_scene(sample_scene, "folder/sample.yaml");
  EXPECT_EQ(scene->name, "sample.yaml");
  EXPECT_EQ(scene->camera.projection, Projection::perspective);
  EXPECT_EQ(scene->camera.eye, (Point{0, 1.4, 5}));
  EXPECT_EQ(scene->camera.target, (Point{0, 0.6, 0}));
  EXPECT_EQ(scene->camera.fov, 40);
  EXPECT_EQ(scene->image.width, 64);
  EXPECT_EQ(scene->image.height, 48);
  EXPECT_EQ(scene->image.samples, 4);
  EXPECT_EQ(scene->image.filter, Filter::tent);
  EXPECT_EQ(scene->image.pattern, Pattern::stratified);
  EXPECT_EQ(scene->image.encoding, Encoding::none);
  EXPECT_EQ(scene->illumination.model, ModelId::phong);
  EXPECT_EQ(scene->illumination.attenuation, (Attenuation{1, 0.5, 0.25}));
  EXPECT_EQ(scene->illumination.ambient_attenuation, AmbientAttenuation::one_over_R);
  EXPECT_EQ(scene->illumination.ambient, grey(0.2));
  EXPECT_EQ(scene->illumination.minimum_distance, 0.01);
  EXPECT_EQ(scene->whitted.max_depth, 4);
  EXPECT_TRUE(scene->whitted.shadows);
  EXPECT_FALSE(scene->whitted.colored_shadows);
  EXPECT_EQ(scene->background, (Rgb{{linear_from_srgb(0x20 / 255.0), linear_from_srgb(0x30 / 255.0),
                                     linear_from_srgb(0x40 / 255.0)}}));

  ASSERT_EQ(scene->lights.size(), 3u);
  EXPECT_EQ(scene->lights[0].name, "key");
  EXPECT_EQ(scene->lights[0].place.line, 28);
  EXPECT_EQ(std::get<PointLight>(scene->lights[0].light).position, (Point{3, 4, 4}));
  EXPECT_EQ(std::get<PointLight>(scene->lights[0].light).intensity, 8);
  EXPECT_EQ(scene->lights[1].name, "light 2");
  EXPECT_EQ(std::get<DirectionalLight>(scene->lights[1].light).color, grey(0.5));
  EXPECT_EQ(std::get<SpotLight>(scene->lights[2].light).softness, 0.3);

  ASSERT_GE(scene->materials.size(), 2u);
  EXPECT_EQ(scene->materials[0].name, "red");
  EXPECT_EQ(scene->materials[0].model, ModelId::blinn_phong);
  EXPECT_EQ(scene->materials[0].specular, grey(0.5));
  EXPECT_EQ(scene->materials[0].ior, 1.3);
  EXPECT_FALSE(scene->materials[1].model.has_value());
  EXPECT_EQ(scene->objects[0].name, "ball");
  EXPECT_EQ(scene->objects[0].materials, std::vector<std::uint32_t>{0});
  EXPECT_EQ(scene->objects[1].name, "object 2");
  EXPECT_EQ(scene->objects[1].place.line, 76);
}

TEST(SceneFile, WhatIsNotSaidIsAsTheStructsHaveIt) {
  const ScenePtr scene = parse_scene(head);
  EXPECT_EQ(scene->image.width, ImageSettings{}.width);
  EXPECT_EQ(scene->camera.up, Camera{}.up);
  EXPECT_FALSE(scene->illumination.attenuation.has_value());
  EXPECT_FALSE(scene->illumination.ambient_attenuation.has_value());
  EXPECT_EQ(scene->whitted.max_depth, WhittedSettings{}.max_depth);
  EXPECT_TRUE(scene->lights.empty() && scene->objects.empty() && scene->materials.empty());
}

TEST(SceneFile, WordsOfAttenuation) {
  const auto attenuation = [](const std::string& word) {
    return parse_scene(head + "illumination: {attenuation: " + word + "}\n")->illumination.attenuation;
  };
  EXPECT_EQ(attenuation("none"), attenuation_none);
  EXPECT_EQ(attenuation("1/r"), attenuation_1_over_r);
  EXPECT_EQ(attenuation("1/r^2"), attenuation_1_over_r2);
  EXPECT_EQ(attenuation("{quadratic: 2}"), (Attenuation{0, 0, 2}));
  EXPECT_EQ(
      parse_scene(head + "illumination: {ambient_attenuation: none}\n")->illumination.ambient_attenuation,
      AmbientAttenuation::none);
}

TEST(SceneFile, UselessCameraKeysAreWarnedOf) {
  const ScenePtr scene = parse_scene("lambent: 1\ncamera: {eye: [0, 0, 5], target: [0, 0, 0], height: 3}\n");
  ASSERT_EQ(warnings(scene).size(), 1u);
  EXPECT_EQ(warnings(scene)[0].severity, Severity::warning);
  EXPECT_EQ(warnings(scene)[0].message, "'height' has no effect: the camera is perspective");
  EXPECT_EQ(warnings(scene)[0].place.line, 2);
}

TEST(SceneFile, ABoxIsClosedAndFacesOutward) {
  EXPECT_TRUE(rc::check([] {
    const auto side = [] { return *rc::gen::inRange(1, 100); };
    const double a = side(), b = side(), c = side();
    const Point corner{double(*rc::gen::inRange(-50, 50)), 3, -7};
    const Mesh mesh = box(corner, corner + Point{a, b, c});
    RC_ASSERT(mesh.triangles.size() == 12u);
    RC_ASSERT(std::abs(six_volumes(mesh) - 6 * a * b * c) < 1e-9 * a * b * c + 1e-6);
    RC_ASSERT(distance(area_vector(mesh), {}) < 1e-9);  // of a closed surface it is zero
  }));
}

TEST(SceneFile, ARectangleFacesItsNormalAndItsWidthIsHorizontal) {
  // A floor: width along x, height along z.
  const ScenePtr floor = with_objects("- plane: {point: [1, 2, 3], normal: [0, 7, 0], size: [4, 2]}\n");
  const Bounds box = bounds(*floor);
  EXPECT_LT(distance(box.lower, {-1, 2, 2}), 1e-6);
  EXPECT_LT(distance(box.upper, {3, 2, 4}), 1e-6);
  // A wall facing z: width along x, height along y.
  const ScenePtr wall = with_objects("- plane: {point: [0, 0, 0], normal: [0, 0, 1], size: [4, 2]}\n");
  EXPECT_LT(distance(bounds(*wall).upper, {2, 1, 0}), 1e-6);

  EXPECT_TRUE(rc::check([] {
    const auto number = [] { return *rc::gen::inRange(-9, 10) / 3.0; };
    const Point n{number(), number(), number()};
    RC_PRE(length(n) > 0.1);
    const Mesh mesh = rectangle({{0, 0, 0}, n}, 3, 2);
    RC_ASSERT(distance(area_vector(mesh), 6.0 * normalize(n)) < 1e-5);
    const Point width = cast<double>(mesh.vertices[1]) - cast<double>(mesh.vertices[0]);
    RC_ASSERT(std::abs(length(width) - 3) < 1e-5);
    RC_ASSERT(std::abs(width.y) < 1e-5);
  }));
}

TEST(SceneFile, AConcavePolygonKeepsItsArea) {
  // A square of side 2 without the triangle (2, 2) (1, 0.5) (0, 2): 4 - 2 * 1.5 / 2 = 2.5.
  const ScenePtr scene =
      with_objects("- polygon: {vertices: [[0, 0, 0], [2, 0, 0], [2, 2, 0], [1, 0.5, 0], [0, 2, 0]]}\n");
  const Mesh& mesh = mesh_of(*scene, 0);
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_LT(distance(area_vector(mesh), {0, 0, 2.5}), 1e-6);
}

TEST(SceneFile, CapsFaceOutwardAndATipNeedsNone) {
  const ScenePtr scene = with_objects(
      "- cylinder: {from: [0, 0, 0], to: [0, 2, 0], radius: 0.5, capped: true}\n"
      "- cone: {from: [0, 0, 0], to: [0, 2, 0], radius_from: 1, radius_to: 0, capped: true}\n"
      "- cylinder: {from: [0, 0, 0], to: [0, 2, 0], radius: 0.5}\n");
  ASSERT_EQ(scene->objects.size(), 5u);
  const auto& caps = std::get<std::vector<Disc>>(scene->shapes[scene->objects[1].shape].primitives);
  ASSERT_EQ(caps.size(), 2u);
  EXPECT_EQ(caps[0].normal, (Point{0, -1, 0}));
  EXPECT_EQ(caps[1].normal, (Point{0, 1, 0}));
  EXPECT_EQ(caps[1].center, (Point{0, 2, 0}));
  EXPECT_EQ(scene->objects[1].name, scene->objects[0].name);
  EXPECT_EQ(std::get<std::vector<Disc>>(scene->shapes[scene->objects[3].shape].primitives).size(), 1u);
  const auto& cylinder = std::get<std::vector<Cone>>(scene->shapes[scene->objects[0].shape].primitives);
  EXPECT_EQ(cylinder[0].radius_from, 0.5);
  EXPECT_EQ(cylinder[0].radius_to, 0.5);
}

TEST(SceneFile, TransformsApplyInTheOrderWritten) {
  const auto image_of = [](const std::string& transform, const Point& p) {
    const ScenePtr scene =
        with_objects("- sphere: {center: [0, 0, 0], radius: 1}\n  transform: " + transform + "\n");
    return transform_point(scene->objects[0].world_from_object, p);
  };
  EXPECT_EQ(image_of("[{scale: 2}, {translate: [1, 0, 0]}]", {1, 1, 1}), (Point{3, 2, 2}));
  EXPECT_EQ(image_of("[{translate: [1, 0, 0]}, {scale: 2}]", {1, 1, 1}), (Point{4, 2, 2}));
  EXPECT_EQ(image_of("{scale: [1, 2, -3]}", {1, 1, 1}), (Point{1, 2, -3}));
  // Right-handed about y: z goes to x.
  EXPECT_LT(distance(image_of("{rotate: {axis: y, degrees: 90}}", {0, 0, 1}), {1, 0, 0}), 1e-15);
  EXPECT_LT(distance(image_of("{rotate: {axis: [0, 5, 0], degrees: 90}}", {0, 0, 1}), {1, 0, 0}), 1e-15);
  // A third of a turn about the diagonal: x goes to y.
  EXPECT_LT(distance(image_of("{rotate: {axis: [1, 1, 1], degrees: 120}}", {1, 0, 0}), {0, 1, 0}), 1e-15);
  EXPECT_EQ(image_of("{matrix: [[1, 2, 3, 4], [0, 1, 0, 5], [0, 0, 1, 6]]}", {1, 1, 1}), (Point{10, 6, 7}));
  EXPECT_EQ(image_of("[]", {1, 2, 3}), (Point{1, 2, 3}));
}

TEST(SceneFile, InlineMeshesNormaliseTheirNormals) {
  const ScenePtr scene = parse_scene(sample_scene);
  const Mesh& mesh = mesh_of(*scene, scene->objects.size() - 1);
  ASSERT_EQ(mesh.normals.size(), 3u);
  EXPECT_EQ(mesh.normals[1], (Vec3<float>{0, 0, 1}));
  EXPECT_EQ(mesh.normals[2], (Vec3<float>{0, 0, 0}));  // the face's own
  EXPECT_EQ(mesh.uvs.size(), 3u);
}

TEST(SceneFile, MaterialsByNameInPlaceAndByDefault) {
  const ScenePtr scene = parse_scene(head +
                                     "materials: [{name: red, diffuse: [1, 0, 0]}]\n"
                                     "objects:\n"
                                     "- {sphere: {center: [0, 0, 0], radius: 1}, material: red}\n"
                                     "- {sphere: {center: [0, 0, 0], radius: 1}, material: {diffuse: 0.25}}\n"
                                     "- {sphere: {center: [0, 0, 0], radius: 1}}\n"
                                     "- {sphere: {center: [0, 0, 0], radius: 1}}\n");
  const auto material = [&](std::size_t object) {
    return scene->materials[scene->objects[object].materials[0]];
  };
  EXPECT_EQ(material(0).diffuse, (Rgb{{1, 0, 0}}));
  EXPECT_EQ(material(1).diffuse, grey(0.25));
  EXPECT_EQ(material(2).diffuse, Material{}.diffuse);
  EXPECT_EQ(scene->objects[2].materials, scene->objects[3].materials);
  EXPECT_EQ(scene->materials.size(), 3u);
}

TEST(SceneFile, ErrorsInALongLineKeepWhatIsNear) {
  std::string text = head + "objects: [";
  for (int i = 0; i < 300; ++i) text += "{sphere: {center: [0, 0, 0], radius: -1}}, ";
  const auto errors = errors_of(text + "]\n");
  ASSERT_EQ(errors.size(), 300u);
  for (const Diagnostic& error : errors) {
    EXPECT_LE(error.excerpt.size(), 1200u);
    EXPECT_EQ(error.excerpt.substr(std::size_t(error.caret_column) - 1, 2), "-1");
  }
}

TEST(SceneFile, FaultsOfValuesStandUnderTheirCharacter) {
  // Columns are characters, carets stand under bytes; each umlaut has two of these.
  const std::string one = "{name: \"\xc3\xa4\xc3\xa4\", sphere: {center: [1e10, 0, 0], radius: 1e9}}";
  const auto errors = errors_of(head + "objects: [" + one + ", " + one + "]\n");
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_EQ(errors[0].message, "'\xc3\xa4\xc3\xa4' reaches beyond 1e10 scene units from the origin");
  EXPECT_EQ(errors[1].place.column - errors[0].place.column, int(one.size()) - 2 + 2);
  for (const Diagnostic& error : errors)
    EXPECT_EQ(error.excerpt.substr(std::size_t(error.caret_column) - 1, 7), "{name: ");
}

TEST(SceneFile, NotEveryOneOfManyMisspelledNamesIsLookedUp) {
  std::string text = head + "materials:\n";
  for (int i = 0; i < 600; ++i) text += "- {name: material" + std::to_string(i) + "}\n";
  text += "objects:\n";
  for (int i = 0; i < 600; ++i)
    text += "- {sphere: {center: [0, 0, 0], radius: 1}, material: matreial" + std::to_string(i) + "}\n";
  const auto errors = errors_of(text);
  ASSERT_EQ(errors.size(), 600u);
  EXPECT_EQ(errors[0].hint, "did you mean 'material0'?");
  EXPECT_EQ(errors[599].message, "there is no material 'matreial599'");
  EXPECT_EQ(errors[599].hint, "");
}

/// A model with two materials, in a folder of its own.
class MeshFiles : public testing::Test {
 protected:
  MeshFiles() {
    write_text(folder_.file("two.mtl"), "newmtl a\nKd 0.1 0.1 0.1\nnewmtl b\nKd 0.2 0.2 0.2\n");
    write_text(folder_.file("two.obj"),
               "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 4\n");
  }
  ScenePtr parse(const std::string& rest) const {
    return parse_scene(head + rest, folder_.file("scene.yaml"));
  }
  TemporaryDirectory folder_;
};

TEST_F(MeshFiles, ObjectsShareOneShape) {
  const ScenePtr scene = parse(
      "objects:\n- {mesh: {file: two.obj}}\n- {mesh: {file: ./two.obj}, transform: {translate: [5, 0, "
      "0]}}\n");
  ASSERT_EQ(scene->objects.size(), 2u);
  EXPECT_EQ(scene->shapes.size(), 1u);
  EXPECT_EQ(scene->objects[0].shape, scene->objects[1].shape);
  EXPECT_EQ(scene->materials.size(), 2u);
  EXPECT_EQ(scene->objects[1].world_from_object.translation, (Point{5, 0, 0}));
  EXPECT_EQ(summarize(scene).triangles, 2u);
}

TEST_F(MeshFiles, TheScenesMaterialsStandInForTheFiles) {
  const ScenePtr scene = parse("materials: [{name: b, diffuse: 0.9}]\nobjects: [{mesh: {file: two.obj}}]\n");
  const Object& object = scene->objects[0];
  ASSERT_EQ(object.materials.size(), 2u);
  EXPECT_NEAR(scene->materials[object.materials[0]].diffuse[0], 0.1, 1e-12);
  EXPECT_EQ(scene->materials[object.materials[1]].diffuse, grey(0.9));
}

TEST_F(MeshFiles, NothingIsSaidOfAMaterialThatTheSceneReplaces) {
  write_text(folder_.file("bare.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl b\nf 1 2 3\n");
  EXPECT_EQ(warnings(parse("objects: [{mesh: {file: bare.obj}}]\n")).size(), 1u);
  EXPECT_EQ(warnings(parse("materials: [{name: b}]\nobjects: [{mesh: {file: bare.obj}}]\n")).size(), 0u);
}

TEST_F(MeshFiles, AnObjectsMaterialReplacesAll) {
  const ScenePtr scene =
      parse("materials: [{name: red, diffuse: 0.9}]\nobjects: [{mesh: {file: two.obj}, material: red}]\n");
  const Object& object = scene->objects[0];
  const Shape& shape = scene->shapes[object.shape];
  ASSERT_EQ(shape.material_of_primitive.size(), 2u);
  for (const std::uint32_t index : shape.material_of_primitive)
    EXPECT_EQ(scene->materials[object.materials.at(index)].name, "red");
}

TEST_F(MeshFiles, ObjectsCountNoMaterialsButTheirOwn) {
  GltfBuilder file;
  const std::size_t corners = file.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  for (int i = 0; i < 3; ++i) {
    file.root["materials"].push_back({{"name", "m" + std::to_string(i)}});
    file.show({{"attributes", {{"POSITION", corners}}}, {"material", i}});
  }
  write_text(folder_.file("three.gltf"), file.text());
  const ScenePtr scene = parse("objects: [{mesh: {file: three.gltf}}]\n");
  ASSERT_EQ(scene->objects.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const Object& object = scene->objects[i];
    ASSERT_EQ(object.materials.size(), 1u);
    EXPECT_EQ(scene->materials[object.materials[0]].name, "m" + std::to_string(i));
    EXPECT_TRUE(scene->shapes[object.shape].material_of_primitive.empty());
  }
}

/// What is wrong with a scene of the folder, or nothing.
std::string message_of(const std::string& path) {
  try {
    load_scene(path);
  } catch (const InputError& error) {
    return error.diagnostics().at(0).message;
  }
  return {};
}

TEST_F(MeshFiles, ScenesThatShowScenesDoNotMultiplyWithoutEnd) {
  // Ten of the next one on each of five levels are 100,000 objects.
  for (int level = 0; level <= 5; ++level) {
    std::string text = head + "objects:\n";
    for (int i = 0; i < (level < 5 ? 10 : 1); ++i)
      text += level < 5 ? "- {scene: {file: ten" + std::to_string(level + 1) + ".yaml}}\n"
                        : "- {sphere: {center: [0, 0, 0], radius: 1}}\n";
    write_text(folder_.file("ten" + std::to_string(level) + ".yaml"), text);
  }
  const LoadOptions small{.limits = {.primitives = 1000}};
  EXPECT_EQ(load_scene(folder_.file("ten1.yaml"), small)->objects.size(), 10000u);
  const auto refused = [&] { load_scene(folder_.file("ten0.yaml"), small); };
  EXPECT_THROW(refused(), InputError);
  EXPECT_EQ(load_scene(folder_.file("ten0.yaml"))->objects.size(), 100000u);
}

TEST_F(MeshFiles, ScenesAreNotReadWithoutEnd) {
  // Two files on each of 13 levels, each of which shows both of the next level: 2^13 ways to the last one.
  for (int level = 0; level <= 13; ++level)
    for (const char* which : {"a", "b"}) {
      const std::string next = std::to_string(level + 1);
      write_text(folder_.file(which + std::to_string(level) + ".yaml"),
                 head + (level < 13 ? "objects: [{scene: {file: a" + next + ".yaml}}, {scene: {file: b" +
                                          next + ".yaml}}]\n"
                                    : "objects: [{sphere: {center: [0, 0, 0], radius: 1}}]\n"));
    }
  EXPECT_NE(message_of(folder_.file("a0.yaml")).find("scenes show scenes more than 4096 times over"),
            std::string::npos);
  EXPECT_EQ(message_of(folder_.file("a4.yaml")), "");  // the count begins anew
}

TEST_F(MeshFiles, AModelFileIsASceneOfItsOwn) {
  const ScenePtr scene = load_scene(folder_.file("two.obj"));
  EXPECT_EQ(scene->name, "two.obj");
  EXPECT_GE(scene->lights.size(), 1u);
  const Bounds box = bounds(*scene);
  EXPECT_LE(box.lower.x, 0);
  EXPECT_GE(box.upper.x, 1);
  // What is written down for it reads back as the same.
  write_text(folder_.file("again.yaml"), scene_text_of_model(folder_.file("two.obj")));
  const ScenePtr again = load_scene(folder_.file("again.yaml"));
  EXPECT_EQ(again->camera.eye, scene->camera.eye);
  EXPECT_EQ(again->objects.size(), scene->objects.size());
}

TEST_F(MeshFiles, AModelFilesSceneTakesSettings) {
  const ScenePtr scene = load_scene(folder_.file("two.obj"),
                                    {{{"image.size", "[40, 30]"}, {"integrator.whitted.max_depth", "2"}}});
  EXPECT_EQ(scene->image.width, 40);
  EXPECT_EQ(scene->whitted.max_depth, 2);
}

TEST_F(MeshFiles, FilesThatAreNotThereOrOfNoKnownKind) {
  const auto message = [](const std::string& path) -> Diagnostic {
    try {
      load_scene(path);
    } catch (const InputError& error) {
      return error.diagnostics().at(0);
    }
    return {};
  };
  EXPECT_EQ(message(folder_.file("tow.obj")).message,
            "cannot open '" + folder_.file("tow.obj") + "': No such file or directory");
  EXPECT_EQ(message(folder_.file("tow.obj")).hint, "did you mean 'two.obj'?");
  EXPECT_EQ(message(folder_.path()).message, "cannot open '" + folder_.path() + "': it is a folder");
  write_text(folder_.file("song.mp3"), "la");
  EXPECT_EQ(message(folder_.file("song.mp3")).message, "'.mp3' is no kind of file that Lambent reads");
  EXPECT_EQ(message(folder_.file("song.mp3")).hint.substr(0, 27), "scenes: .yaml, .yml, .json;");
  EXPECT_EQ(message("/no/such/folder/scene.yaml").hint, "the folder '/no/such/folder' does not exist");
}

TEST(SceneFile, SummarySaysWhatThereIs) {
  const SceneSummary summary = summarize(parse_scene(sample_scene, "sample.yaml"));
  EXPECT_EQ(summary.name, "sample.yaml");
  EXPECT_EQ(summary.camera, "perspective, fov 40 degrees, from 0 1.4 5 to 0 0.6 0");
  EXPECT_EQ(summary.model,
            "phong, attenuation {constant: 1, linear: 0.5, quadratic: 0.25}, ambient attenuation 1/R");
  EXPECT_EQ(summary.integrator, "whitted, max_depth 4, shadows opaque");
  EXPECT_EQ(summary.spheres, 1u);
  EXPECT_EQ(summary.planes, 1u);
  EXPECT_EQ(summary.cones, 2u);
  EXPECT_EQ(summary.discs, 4u);                   // one, two caps of the cylinder, one of the cone
  EXPECT_EQ(summary.triangles, 2u + 12 + 2 + 1);  // rectangle, box, polygon, mesh
  ASSERT_GE(summary.lights.size(), 1u);
  EXPECT_EQ(summary.lights[0].name, "key");
  EXPECT_EQ(summary.lights[0].kind, "point");
  EXPECT_EQ(summary.lights[0].detail, "position 3 4 4, intensity 8");
  EXPECT_EQ(summary.materials[0].kind, "blinn_phong");
  EXPECT_EQ(summary.objects[1].kind, "plane");
  EXPECT_EQ(summary.objects[1].detail, "material floor");
}

}  // namespace
}  // namespace lambent::test
