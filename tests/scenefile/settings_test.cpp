// Values from outside the file: --set path.to.key=value.

#include <gtest/gtest.h>

#include "scene/scene.h"
#include "scenefile/errors.h"
#include "scenefile/sample.h"

namespace lambent::test {
namespace {

LoadOptions set(const std::string& path, const std::string& value) { return {{{path, value}}}; }

std::string complaint(const std::string& path, const std::string& value) {
  return report(sample_scene, set(path, value));
}

TEST(Settings, ReplaceAndAdd) {
  EXPECT_EQ(parse_scene(sample_scene, "s", set("image.samples", "9"))->image.samples, 9);
  EXPECT_EQ(parse_scene(head, "s", set("image.samples", "9"))->image.samples, 9);
  EXPECT_EQ(parse_scene(head, "s", set("integrator.whitted.max_depth", "3"))->whitted.max_depth, 3);
  EXPECT_EQ(parse_scene(head, "s", set("background", "[0.1, 0.2, 0.3]"))->background, (Rgb{{0.1, 0.2, 0.3}}));
  EXPECT_EQ(parse_scene(head, "s", set("background", "#ffffff"))->background, grey(1.0));
  EXPECT_EQ(parse_scene(head, "s", set("camera.eye.2", "7"))->camera.eye, (Vec3<double>{0, 0, 7}));
  EXPECT_EQ(
      parse_scene("lambent: 1\n", "s", {{{"camera", "{eye: [0, 0, 1], target: [0, 0, 0]}"}}})->camera.eye.z,
      1);
}

TEST(Settings, ANumberOfSamplesTakesThePlaceOfCorners) {
  const std::string corners = head + "image: {pattern: corners}\n";
  EXPECT_EQ(parse_scene(corners, "s")->image.pattern, Pattern::corners);
  EXPECT_EQ(parse_scene(corners, "s", set("image.samples", "9"))->image.pattern, Pattern::stratified);
  const LoadOptions both{{{"image.samples", "9"}, {"image.pattern", "corners"}}};
  EXPECT_EQ(parse_scene(head, "s", both)->image.pattern, Pattern::corners);
}

TEST(Settings, LaterOnesWin) {
  const LoadOptions options{{{"image.samples", "9"}, {"image", "{size: [7, 5]}"}, {"image.samples", "4"}}};
  const ScenePtr scene = parse_scene(sample_scene, "s", options);
  EXPECT_EQ(scene->image.samples, 4);
  EXPECT_EQ(scene->image.width, 7);
  EXPECT_EQ(scene->image.filter, Filter::box);  // the whole image was replaced
}

TEST(Settings, ElementsByNameAndIndex) {
  const auto intensity = [](const std::string& path, std::size_t light) {
    const ScenePtr scene = parse_scene(sample_scene, "s", set(path, "4"));
    return std::visit(
        [](const auto& one) {
          if constexpr (requires { one.intensity; }) return one.intensity;
          return -1.0;
        },
        scene->lights[light].light);
  };
  EXPECT_EQ(intensity("lights.key.point.intensity", 0), 4);
  EXPECT_EQ(intensity("lights.1.directional.intensity", 1), 4);
  const std::string text = head + "materials: [{name: a.b, diffuse: 1}]\n";
  EXPECT_EQ(parse_scene(text, "s", set("materials.a.b.diffuse", "0.5"))->materials[0].diffuse, grey(0.5));
}

TEST(Settings, AModelsSwitchesAreWholeNumbers) {
  const std::string text = head + "materials: [{name: m, model: mtl}]\n";
  EXPECT_EQ(parse_scene(text, "s", set("materials.m.illum", "7"))->materials[0].own.at("illum"), 7);
  EXPECT_NE(report(text, set("materials.m.illum", "2.5")).find("must be a whole number, not '2.5'"),
            std::string::npos);
  EXPECT_NE(report(text, set("materials.m.illum", "11")).find("0 to 10"), std::string::npos);
}

TEST(Settings, AliasedValuesChangeInOnePlaceOnly) {
  const std::string text =
      head + "lights:\n- {name: a, point: &p {position: [0, 1, 0]}}\n- {name: b, point: *p}\n";
  const ScenePtr scene = parse_scene(text, "s", set("lights.b.point.intensity", "5"));
  EXPECT_EQ(std::get<PointLight>(scene->lights[0].light).intensity, 1);
  EXPECT_EQ(std::get<PointLight>(scene->lights[1].light).intensity, 5);
}

TEST(SettingsMessages, NameTheSettingAndShowTheValue) {
  EXPECT_EQ(complaint("image.samples", "abc"),
            R"(--set image.samples=abc: error: 'samples' must be a number, not 'abc'
    abc
    ^
    hint: numbers are written in decimals: 16, 0.5, -1e-3
)");
  EXPECT_EQ(complaint("image.sampels", "3"),
            R"(--set image.sampels=3: error: unknown key 'sampels' in the image
    hint: did you mean 'samples'?
)");
  EXPECT_EQ(complaint("lights.kex.point.intensity", "3"),
            R"(--set lights.kex.point.intensity=3: error: 'lights' has no element 'kex'
    hint: did you mean 'key'?
)");
  EXPECT_EQ(complaint("lights.front.point.intensity", "3"),
            R"(--set lights.front.point.intensity=3: error: 'lights' has no element 'front'
    hint: known are: key, lamp
)");
  EXPECT_EQ(complaint("camera.eye.3", "3"), R"(--set camera.eye.3=3: error: 'camera.eye' has no element '3'
    hint: its indices are 0 to 2
)");
  EXPECT_EQ(complaint("camera.fov.x", "3"),
            R"(--set camera.fov.x=3: error: 'camera.fov' is the single value '40': there is no 'x' in it
    hint: set 'camera.fov' as a whole
)");
  EXPECT_EQ(complaint("image.samples", ""), R"(--set image.samples=: error: 'samples' has no value
    hint: it must be a whole number
)");
  EXPECT_EQ(complaint("image.size", "[1"),
            R"(--set image.size=[1: error: this is not YAML: did not find expected ',' or ']'
    [1
    ^
    hint: a list that opens with [ must close with ], with commas between its elements
)");
  EXPECT_EQ(complaint("image..samples", "3"),
            R"(--set image..samples=3: error: a setting is written path.to.key=value
    hint: for example image.samples=16
)");
}

TEST(SettingsMessages, TheFilesOwnErrorsComeFirst) {
  const auto errors = errors_of(head + "image: {samples: 0}\n", {{{"lights.0", "3"}, {"background", "x"}}});
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_EQ(errors[0].place.file, "scene.yaml");
  EXPECT_EQ(errors[1].place.file, "--set lights.0=3");
  EXPECT_EQ(errors[2].place.file, "--set background=x");
}

}  // namespace
}  // namespace lambent::test
