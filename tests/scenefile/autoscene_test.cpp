#include "scenefile/autoscene.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "lambent/lambent.h"
#include "scenefile/read_scene.h"
#include "support.h"

namespace lambent {
namespace {

/// A model of one box.
Model box_model(const Vec3<double>& lower, const Vec3<double>& upper) {
  Mesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.push_back(cast<float>(Vec3<double>{
        corner & 1 ? upper.x : lower.x, corner & 2 ? upper.y : lower.y, corner & 4 ? upper.z : lower.z}));
  for (std::uint32_t i = 0; i < 6; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  Model model;
  model.shapes.push_back({"box", std::move(mesh), {}});
  model.materials.push_back({});
  return model;
}

std::string scene_text(const Model& model, const std::string& path, int width = 1280, int height = 720) {
  ModelChoices choices;
  choices.width = width, choices.height = height;
  return scene_for(model, path, choices).text;
}

/// The scene that the text for `model` is read back as.
Scene scene_of(const Model& model, const ModelChoices& choices, const std::string& file = "box.obj") {
  LoadedModels models;
  models.emplace(model_key("folder", file), model);
  return read_scene(parse_yaml(scene_for(model, "folder/" + file, choices).text, "scene"), "folder",
                    std::move(models));
}
Scene scene_of(const Model& model, int width = 1280, int height = 720, const std::string& file = "box.obj") {
  ModelChoices choices;
  choices.width = width, choices.height = height;
  return scene_of(model, choices, file);
}

struct Box {
  Vec3<double> lower, upper;
};
/// Boxes of all sizes and shapes, flat ones too, at most a thousand times their size from the origin.
Box random_box() {
  const double unit = std::pow(10.0, *rc::gen::inRange(-4, 5));
  const auto number = [&](int from, int to) { return unit * *rc::gen::inRange(from, to) / 100.0; };
  const Vec3<double> lower{number(-50000, 50000), number(-50000, 50000), number(-50000, 50000)};
  Vec3<double> size{number(0, 1000), number(0, 1000), number(0, 1000)};
  if (max_abs(size) < unit) size.x = unit;
  return {lower, lower + size};
}

const PointLight& point(const Light& light) { return std::get<PointLight>(light.light); }
Vec3<double> middle(const Bounds& box) { return 0.5 * (box.lower + box.upper); }
double radius(const Bounds& box) { return 0.5 * length(box.upper - box.lower); }
Bounds bounds_of(const Model& model) { return bounds(model.shapes.at(0)); }

TEST(Autoscene, SeesAllOfTheModelWithAMargin) {
  EXPECT_TRUE(rc::check([] {
    const Box box = random_box();
    const int width = *rc::gen::inRange(16, 3000), height = *rc::gen::inRange(16, 3000);
    const Model model = box_model(box.lower, box.upper);
    const Scene scene = scene_of(model, width, height);
    RC_ASSERT(scene.image.width == width && scene.image.height == height);
    const Camera& camera = scene.camera;
    const Vec3<double> forward = normalize(camera.target - camera.eye),
                       right = normalize(cross(forward, camera.up)), up = cross(right, forward);
    const double tan_y = std::tan(camera.fov * M_PI / 360), tan_x = tan_y * width / height;
    double extent = 0;  // how near to the picture's edge (1) the corners come
    for (const Vec3<float>& vertex : std::get<Mesh>(model.shapes[0].primitives).vertices) {
      const Vec3<double> way = cast<double>(vertex) - camera.eye;
      const double depth = dot(way, forward);
      RC_ASSERT(depth > 0);
      extent = std::max(
          {extent, std::abs(dot(way, right)) / (tan_x * depth), std::abs(dot(way, up)) / (tan_y * depth)});
    }
    RC_ASSERT(extent <= 0.901);  // nothing cut off,
    // and no nearer than need be: a margin of 10 %. Only in a picture like a ribbon the model's own size
    // keeps the camera further off.
    const double distance = length(camera.eye - camera.target);
    RC_ASSERT(extent >= 0.899 || distance < 1.001 * radius(bounds_of(model)));
    if (width < 3 * height) RC_ASSERT(extent >= 0.899);
  }));
}

TEST(Autoscene, FramesForTheSizeAskedFor) {
  // A wide plate in a tall picture: its ends must not be cut off.
  const test::TemporaryDirectory folder;
  test::write_text(folder.file("plate.obj"), "v -5 0 0\nv 5 0 0\nv 5 1 0\nv -5 1 0\nf 1 2 3 4\n");
  const ScenePtr scene = load_scene(folder.file("plate.obj"), {.set = {{"image.size", "[200, 400]"}}});
  const Camera& camera = scene->camera;
  const Vec3<double> forward = normalize(camera.target - camera.eye),
                     right = normalize(cross(forward, camera.up));
  for (const double x : {-5.0, 5.0}) {
    const Vec3<double> way = Vec3<double>{x, 0, 0} - camera.eye;
    EXPECT_LT(std::abs(dot(way, right) / dot(way, forward)), 0.5 * std::tan(camera.fov * M_PI / 360));
  }
}

TEST(Autoscene, StandsOnAFloorSeenFromAbove) {
  EXPECT_TRUE(rc::check([] {
    const Box box = random_box();
    const Model model = box_model(box.lower, box.upper);
    const Bounds around = bounds_of(model);
    const Scene scene = scene_of(model);
    RC_ASSERT(scene.objects.size() == 2u);
    const Shape& shape = scene.shapes[scene.objects[1].shape];
    const Disc& floor = std::get<std::vector<Disc>>(shape.primitives).at(0);
    RC_ASSERT((floor.normal == Vec3<double>{0, 1, 0}));
    RC_ASSERT(floor.center.y < around.lower.y);
    RC_ASSERT(around.lower.y - floor.center.y < 2e-3 * radius(around));
    RC_ASSERT(scene.camera.eye.y > floor.center.y);
    for (const Light& light : scene.lights) RC_ASSERT(point(light).position.y > floor.center.y);
    // The whole model stands on it.
    RC_ASSERT(floor.radius > radius(around));
  }));
}

TEST(Autoscene, LightsTheModelAlikeWhateverItsSize) {
  EXPECT_TRUE(rc::check([] {
    const Box box = random_box();
    const Model model = box_model(box.lower, box.upper);
    const Vec3<double> center = middle(bounds_of(model));
    const Scene scene = scene_of(model);
    RC_ASSERT(scene.illumination.model == ModelId::phong);
    RC_ASSERT(*scene.illumination.attenuation == attenuation_1_over_r);
    RC_ASSERT(*scene.illumination.ambient_attenuation == AmbientAttenuation::one_over_R);
    // What arrives at the centre: Ia / R, and Il / r of key, fill and rim.
    const double arriving[] = {0.85, 0.15, 0.3};
    RC_ASSERT(std::abs(scene.illumination.ambient[0] / length(scene.camera.eye - center) - 0.15) < 1e-4);
    RC_ASSERT(scene.lights.size() == 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      const PointLight& light = point(scene.lights[i]);
      RC_ASSERT(std::abs(light.intensity / length(light.position - center) - arriving[i]) < 1e-4);
      // None is so near that its 1/r stops growing before it reaches the model.
      RC_ASSERT(length(light.position - center) - radius(bounds_of(model)) >
                scene.illumination.minimum_distance);
    }
  }));
}

TEST(Autoscene, LightsAModelAsItsMaterialsAreMeant) {
  Model model = box_model({0, 0, 0}, {1, 1, 1});
  model.illumination = ModelId::mtl;
  const Scene scene = scene_of(model);
  EXPECT_EQ(scene.illumination.model, ModelId::mtl);
  EXPECT_EQ(*scene.illumination.attenuation, attenuation_1_over_r);  // the lamps are made for it
}

TEST(Autoscene, ScalesWithTheUnitOfLength) {
  EXPECT_TRUE(rc::check([] {
    const Box box = random_box();
    const double s = *rc::gen::element(0.001, 0.01, 0.3048, 2.54, 25.4, 1000.0);
    const Model a = box_model(box.lower, box.upper), b = box_model(s * box.lower, s * box.upper);
    const Scene one = scene_of(a), other = scene_of(b);
    // Numbers are rounded to 1e-5 of the model's size, or to ten times less; single precision adds its own.
    const double tolerance = s * (3e-5 * radius(bounds_of(a)) + 1e-6 * max_abs(middle(bounds_of(a))));
    const auto same = [&](const Vec3<double>& x, const Vec3<double>& y) {
      return max_abs(s * x - y) <= 10 * tolerance;
    };
    RC_ASSERT(same(one.camera.eye, other.camera.eye));
    RC_ASSERT(same(one.camera.target, other.camera.target));
    RC_ASSERT(one.camera.fov == other.camera.fov);
    RC_ASSERT(std::abs(s * one.illumination.ambient[0] - other.illumination.ambient[0]) <= 10 * tolerance);
    // 1e-10 is the least that a scene file may say.
    const double least = std::max(s * one.illumination.minimum_distance, 1e-10);
    RC_ASSERT(std::abs(least - other.illumination.minimum_distance) <= tolerance);
    for (std::size_t i = 0; i < 3; ++i) {
      RC_ASSERT(same(point(one.lights[i]).position, point(other.lights[i]).position));
      RC_ASSERT(std::abs(s * point(one.lights[i]).intensity - point(other.lights[i]).intensity) <=
                10 * tolerance);
    }
  }));
}

TEST(Autoscene, GivesTheSamePictureInAnyUnit) {
  const test::TemporaryDirectory folder;
  const auto picture = [&](double unit) {
    std::string text;
    const int vertices[][3] = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 1}};
    for (const auto& v : vertices) {
      text += "v";
      for (const int x : v) text += " " + std::to_string(x * unit);
      text += "\n";
    }
    test::write_text(folder.file("tetra.obj"), text + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    return render(load_scene(folder.file("tetra.obj"),
                             {.set = {{"image.size", "[128, 72]"}, {"image.samples", "4"}}}))
        .image;
  };
  const Image metres = picture(1);
  double brightest = 0, darkest = 1;
  for (const float value : metres.data)
    brightest = std::max(brightest, double(value)), darkest = std::min(darkest, double(value));
  EXPECT_GT(brightest, 0.5);  // the lit side is bright, the background is dark
  EXPECT_LT(darkest, 0.05);
  for (const double unit : {0.01, 25.4, 1000.0}) {
    // Rounded numbers move edges by less than a hundredth of a pixel: a sample may fall on the other side of
    // one.
    const Difference difference = compare_images(metres, picture(unit));
    EXPECT_LT(difference.root_mean_square, 5e-3) << unit;
    EXPECT_LT(difference.mean, 2e-4) << unit;
  }
}

TEST(Autoscene, CopesWithModelsWithoutSize) {
  for (const Vec3<double>& p : {Vec3<double>{0, 0, 0}, Vec3<double>{1, 2, 3}, Vec3<double>{0, 1e6, 0}}) {
    const Scene scene = scene_of(box_model(p, p));
    EXPECT_GT(length(scene.camera.eye - scene.camera.target), 0);
    EXPECT_NEAR(length(scene.camera.target - p), 0, 1e-3 * max_abs(p));
    EXPECT_EQ(scene.lights.size(), 3u);
  }
}

TEST(Autoscene, RefusesModelsOutOfReach) {
  try {
    scene_text(box_model({-5e9, -5e9, -5e9}, {5e9, 5e9, 5e9}), "folder/huge.obj");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "folder/huge.obj: error: the model is too large, or too far from the origin, for a camera "
                 "and lights around it\n"
                 "    hint: choose a larger unit of length: coordinates reach up to 10000000000");
  }
}

TEST(Autoscene, ReadsBackWhateverItsSize) {
  // Up to where it is refused, the scene has nothing out of reach: neither camera nor lights nor floor.
  for (double size = 1; size < 1e10; size *= 1.5) {
    const Model model = box_model({-size, -size, -size}, {size, size, size});
    std::string text;
    try {
      text = scene_text(model, "folder/box.obj");
    } catch (const InputError&) {
      EXPECT_GT(size, 5e7);
      continue;
    }
    EXPECT_TRUE(validate(scene_of(model)).empty()) << text;
  }
}

TEST(Autoscene, QuotesTheFilesName) {
  for (const std::string name :
       {"a b.obj", "it's.obj", "say \"hi\".obj", "back\\slash.obj", "#1: {x}, [y].obj", "line\nbreak.obj",
        "tab\t.obj", "\xC3\xA9t\xC3\xA9.obj", "-.obj", "~.obj"}) {
    const Scene scene = scene_of(box_model({0, 0, 0}, {1, 1, 1}), 64, 64, name);
    EXPECT_EQ(scene.objects.size(), 2u) << name;
  }
}

TEST(Autoscene, WritesShortNumbers) {
  const std::string text = scene_text(box_model({-1, -1, -1}, {1, 1, 1}), "cube.obj");
  std::size_t digits = 0;
  for (const char c : text) {
    digits = c >= '0' && c <= '9' ? digits + 1 : 0;
    EXPECT_LE(digits, 5u) << text;
  }
}

/// A model with everything of its own.
Model own_model() {
  Model model = box_model({-1, -1, -1}, {1, 1, 1});
  model.cameras = {
      {"", Camera{.eye = {1, 2, 3}, .target = {0.1, 0.2, 0.3}, .up = {0, 0, 1}, .fov = 45.079261488}}};
  model.image = [] {
    ImageSettings image;
    image.width = 320, image.height = 200;
    image.pattern = Pattern::corners, image.encoding = Encoding::none;
    return image;
  }();
  model.background = Rgb{0.078, 0.361, 0.753};
  model.spd_rules = true;
  model.lights.push_back({"light 1", {}, PointLight{.position = {4, 3, 2}, .intensity = 0.1234567890123}});
  model.lights.push_back(
      {"light 2", {}, PointLight{.position = {1, -4, 4}, .color = {1, 0.5, 0}, .intensity = 0.3}});
  return model;
}

TEST(Autoscene, KeepsWhatTheModelBrings) {
  const Model model = own_model();
  const Scene scene = scene_of(model, 1280, 720, "own.nff");
  EXPECT_EQ(scene.camera.eye, model.cameras[0].camera.eye);
  EXPECT_EQ(scene.camera.target, model.cameras[0].camera.target);
  EXPECT_EQ(scene.camera.up, model.cameras[0].camera.up);
  EXPECT_EQ(scene.camera.fov, model.cameras[0].camera.fov);
  EXPECT_EQ(scene.image.width, 320);
  EXPECT_EQ(scene.image.height, 200);
  EXPECT_EQ(scene.image.samples, 1);
  EXPECT_EQ(scene.image.pattern, Pattern::corners);
  EXPECT_EQ(scene.image.encoding, Encoding::none);
  EXPECT_EQ(scene.background, *model.background);
  ASSERT_EQ(scene.lights.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(scene.lights[i].name, model.lights[i].name);
    EXPECT_EQ(point(scene.lights[i]).position, point(model.lights[i]).position);
    EXPECT_EQ(point(scene.lights[i]).color, point(model.lights[i]).color);
    EXPECT_EQ(point(scene.lights[i]).intensity, point(model.lights[i]).intensity);
  }
  EXPECT_EQ(scene.illumination.model, ModelId::phong);
  EXPECT_EQ(*scene.illumination.attenuation, attenuation_none);
  EXPECT_EQ(*scene.illumination.ambient_attenuation, AmbientAttenuation::none);
  EXPECT_EQ(scene.illumination.ambient, (Rgb{0, 0, 0}));
  EXPECT_EQ(scene.whitted.max_depth, 5);
  EXPECT_TRUE(scene.whitted.trace_black_rays);
  EXPECT_EQ(scene.objects.size(), 1u);  // no floor
}

TEST(Autoscene, LightsAViewThatHasNoLights) {
  Model model = own_model();
  model.lights.clear();
  model.background.reset();
  const Scene scene = scene_of(model);
  EXPECT_EQ(scene.camera.eye, model.cameras[0].camera.eye);
  EXPECT_EQ(scene.background, (Rgb{0, 0, 0}));
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].name, "key");
  EXPECT_EQ(scene.objects.size(), 1u);
  // Light comes from the camera's side, and from above as the camera sees it.
  EXPECT_GT(dot(point(scene.lights[0]).position, model.cameras[0].camera.eye), 0);
  EXPECT_GT(point(scene.lights[0]).position.z, 0);
}

TEST(Autoscene, FramesAModelThatHasLightsButNoView) {
  Model model = own_model();
  model.cameras.clear();
  model.image.reset();
  const Scene scene = scene_of(model, 300, 100);
  EXPECT_EQ(scene.image.width, 300);
  EXPECT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.camera.eye, scene_of(box_model({-1, -1, -1}, {1, 1, 1}), 300, 100).camera.eye);
  EXPECT_EQ(scene.objects.size(), 1u);
}

TEST(Autoscene, HasViewsFromAllSides) {
  const Model model = box_model({-1, 0, -1}, {1, 3, 2});
  const Vec3<double> center{0, 1.5, 0.5};
  const auto camera = [&](const std::string& name, const std::string& up) {
    ModelChoices choices;
    choices.camera = name, choices.up = up;
    return scene_of(model, choices).camera;
  };
  const auto way = [&](const std::string& name, const std::string& up) {
    const Camera one = camera(name, up);
    return normalize(one.eye - one.target);
  };
  const auto expect = [](const Vec3<double>& a, const Vec3<double>& b) {
    EXPECT_LT(max_abs(a - b), 1e-4) << a.x << " " << a.y << " " << a.z;
  };
  expect(way("front", ""), {0, 0, 1});
  expect(way("back", ""), {0, 0, -1});
  expect(way("left", ""), {-1, 0, 0});
  expect(way("right", ""), {1, 0, 0});
  expect(way("top", ""), {0, 1, 0});
  expect(camera("top", "").up, {0, 0, -1});
  expect(way("front", "z"), {0, -1, 0});
  expect(way("back", "z"), {0, 1, 0});
  expect(way("left", "z"), {-1, 0, 0});
  expect(way("top", "z"), {0, 0, 1});
  expect(camera("top", "z").up, {0, 1, 0});
  expect(camera("front", "z").up, {0, 0, 1});
  expect(camera("three-quarter", "").eye, scene_of(model).camera.eye);
  for (const char* view : {"front", "back", "left", "right", "top"})
    expect(cross(way(view, ""), center - camera(view, "").target), {0, 0, 0});
}

TEST(Autoscene, StandsUprightWhereZIsUp) {
  Model model = box_model({-1, -2, 0.5}, {1, 2, 3});
  model.z_up = true;
  const Scene scene = scene_of(model);
  EXPECT_EQ(scene.camera.up, (Vec3<double>{0, 0, 1}));
  EXPECT_GT(scene.camera.eye.z, scene.camera.target.z);
  const Disc& floor = std::get<std::vector<Disc>>(scene.shapes[scene.objects[1].shape].primitives).at(0);
  EXPECT_EQ(floor.normal, (Vec3<double>{0, 0, 1}));
  EXPECT_LT(floor.center.z, 0.5);
  EXPECT_GT(floor.center.z, 0.49);
  for (const Light& light : scene.lights) EXPECT_GT(point(light).position.z, 2);
  // The same model lying on its back, y up: what was (x, y, z) is (x, z, -y).
  const Model lying = box_model({-1, 0.5, -2}, {1, 3, 2});
  const Scene other = scene_of(lying);
  EXPECT_LT(
      max_abs(Vec3<double>{scene.camera.eye.x, scene.camera.eye.z, -scene.camera.eye.y} - other.camera.eye),
      1e-4);
  ModelChoices choices;
  choices.up = "y";
  EXPECT_EQ(scene_of(model, choices).camera.up, (Vec3<double>{0, 1, 0}));
  choices.up = "x";
  EXPECT_THROW(scene_of(model, choices), InputError);
}

TEST(Autoscene, ChoosesAmongTheModelsCameras) {
  Model model = own_model();
  Camera other = model.cameras[0].camera;
  other.eye = {9, 9, 9};
  model.cameras = {{"first", model.cameras[0].camera}, {"2", other}, {"", other}, {"front", other}};
  const auto eye = [&](const std::string& name) {
    ModelChoices choices;
    choices.camera = name;
    return scene_of(model, choices).camera.eye;
  };
  EXPECT_EQ(eye(""), (Vec3<double>{1, 2, 3}));
  EXPECT_EQ(eye("1"), (Vec3<double>{1, 2, 3}));
  EXPECT_EQ(eye("first"), (Vec3<double>{1, 2, 3}));
  EXPECT_EQ(eye("3"), (Vec3<double>{9, 9, 9}));
  EXPECT_EQ(eye("front"), (Vec3<double>{9, 9, 9}));  // its own name comes first
  EXPECT_NE(eye("back"), (Vec3<double>{9, 9, 9}));
  try {
    eye("frnt");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "folder/box.obj: error: there is no camera 'frnt'\n"
                 "    hint: the file has 1 'first', 2 '2', 3, 4 'front'; views of the whole model are "
                 "three-quarter, front, back, left, right, top");
  }
  for (const char* wrong : {"0", "5", "-1", "1x"}) EXPECT_THROW(eye(wrong), InputError) << wrong;
}

TEST(Autoscene, FramesAllPlacedShapes) {
  Model model = box_model({-1, -1, -1}, {1, 1, 1});
  ModelObject far;
  far.world_from_object = translation({100, 0, 0});
  model.objects = {ModelObject{}, far};
  const Scene scene = scene_of(model);
  EXPECT_GT(scene.camera.target.x, 40);  // the nearer end looks longer
  EXPECT_LT(scene.camera.target.x, 70);
  EXPECT_GT(length(scene.camera.eye - scene.camera.target), 80);
  EXPECT_EQ(scene.objects.size(), 3u);
}

TEST(Autoscene, ScalesTheModelsOwnLights) {
  Model model = box_model({-1, -1, -1}, {1, 1, 1});
  PointLight lamp;
  lamp.position = {0, 10, 0}, lamp.intensity = 500;
  DirectionalLight sun;
  sun.intensity = 15;
  model.lights = {{"lamp", {}, lamp}, {"sun", {}, sun}};
  const Scene scene = scene_of(model);
  EXPECT_EQ(*scene.illumination.attenuation, attenuation_1_over_r2);
  EXPECT_EQ(scene.illumination.ambient, grey(0.05));
  // 500 / 10^2 + 15 = 20 becomes 1.
  EXPECT_NEAR(point(scene.lights[0]).intensity, 500 / 20.0, 1e-9);
  EXPECT_NEAR(std::get<DirectionalLight>(scene.lights[1].light).intensity, 15 / 20.0, 1e-9);
  EXPECT_FALSE(scene.whitted.trace_black_rays);
  EXPECT_EQ(scene.objects.size(), 1u);  // lights may stand below the model: no floor
}

TEST(Autoscene, LeavesOutTheGround) {
  ModelChoices choices;
  choices.ground = false;
  choices.background = "[0.1, 0.2, 0.3]";
  const Scene scene = scene_of(box_model({0, 0, 0}, {1, 1, 1}), choices);
  EXPECT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.background, (Rgb{0.1, 0.2, 0.3}));
}

TEST(Turned, GoesOnceAroundTheModel) {
  const test::TemporaryDirectory folder;
  test::write_text(folder.file("plate.obj"), "v -5 0 0\nv 5 0 0\nv 5 1 2\nv -5 1 2\nf 1 2 3 4\n");
  const ScenePtr scene = load_scene(folder.file("plate.obj"));
  EXPECT_EQ(turned(scene, 0), scene);
  const Vec3<double> center{0, 0.5, 1};
  for (const double degrees : {90.0, 180.0, 270.0}) {
    const Camera &a = scene->camera, &b = turned(scene, degrees)->camera;
    EXPECT_NEAR(b.eye.y, a.eye.y, 1e-9);
    EXPECT_NEAR(length(b.eye - center), length(a.eye - center), 1e-9);
    EXPECT_NEAR(length(b.eye - b.target), length(a.eye - a.target), 1e-9);
  }
  // By a quarter, seen from above, from the front (+z) to the right (+x).
  const Vec3<double> before = scene->camera.eye - center, after = turned(scene, 90)->camera.eye - center;
  EXPECT_NEAR(after.x, before.z, 1e-9);
  EXPECT_NEAR(after.z, -before.x, 1e-9);
}

TEST(Turned, OfASceneGoesAroundTheTarget) {
  const ScenePtr scene =
      parse_scene("lambent: 1\ncamera: {eye: [3, 1, 5], target: [3, 1, 2], up: [0, 0.1, 1]}\n");
  const Camera camera = turned(scene, 180)->camera;
  EXPECT_EQ(camera.target, (Vec3<double>{3, 1, 2}));
  EXPECT_NEAR(length(camera.eye - camera.target), 3, 1e-12);
}

}  // namespace
}  // namespace lambent
