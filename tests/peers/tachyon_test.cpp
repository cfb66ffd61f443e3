// Tachyon's pictures of the scenes that we export for it, beside ours.

#include <gtest/gtest.h>

#include "peers/pictures.h"

namespace lambent {
namespace {

using test::Compared;

constexpr Compared scenes[] = {
    {"Blinn", "Blinn's highlight; a point light, a sun, a spot", R"(
lambent: 1
camera: {eye: [1, 2, 7], target: [0, 0.7, 0], fov: 40}
image: {size: [160, 120]}
illumination: {model: tachyon, ambient: 0.3}
integrator: {whitted: {max_depth: 1}}
background: [0.05, 0.1, 0.2]
lights:
  - {point: {position: [3, 5, 4], color: [0.6, 0.55, 0.5]}}
  - {directional: {direction: [1, -2, -0.7], color: [0.1, 0.15, 0.2]}}
  - {spot: {position: [-3, 5, 3], target: [0, 0, 0], angle: 30, softness: 0, color: [0.1, 0.4, 0.3]}}
materials:
  - {name: a, ambient: [0.3, 0.1, 0.05], diffuse: [0.6, 0.2, 0.1], specular: 0.4, shininess: 30}
  - {name: b, ambient: [0.04, 0.12, 0.2], diffuse: [0.1, 0.3, 0.5], specular: 0.6, shininess: 8}
  - {name: c, diffuse: 0.4, emission: 0.05}
objects:
  - {sphere: {center: [-1, 0.8, 0], radius: 0.8}, material: a}
  - {sphere: {center: [0, 0, 0], radius: 0.5}, material: b, transform: [{scale: 2}, {translate: [1, 1, -1]}]}
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: c}
)"},
    {"Phong", "Phong's highlight under attenuation, mirrors in mirrors, cylinders, discs", R"(
lambent: 1
camera: {eye: [-2, 3, 7], target: [0, 0.7, 0], fov: 42}
image: {size: [160, 120]}
illumination: {model: tachyon, ambient: 0.4, attenuation: {constant: 0.5, linear: 0.03, quadratic: 0.02}}
integrator: {whitted: {max_depth: 4}}
lights:
  - {point: {position: [3, 5, 4], color: [0.7, 0.6, 0.5]}}
  - {spot: {position: [-4, 4, 4], target: [-1, 0, 0], angle: 60, softness: 0, color: [0.1, 0.2, 0.3]}}
materials:
  - {name: a, diffuse: 0.3, specular: 0.5, shininess: 20, highlight: 1, reflect: 0.3}
  - {name: b, ambient: [0.03, 0.05, 0.01], diffuse: [0.15, 0.25, 0.05], specular: 0.2, shininess: 60, highlight: 1}
  - {name: c, ambient: 0.1, diffuse: 0.4, reflect: 0.2}
objects:
  - {cylinder: {from: [-1.4, 0.1, 0], to: [-1, 1.6, 0.3], radius: 0.6}, material: a}
  - {sphere: {center: [1.2, 0.8, 0.5], radius: 0.8}, material: b}
  - {plane: {point: [0, -0.1, 0], normal: [0, 1, 0]}, material: c}
  - {disc: {center: [0, 1.2, -2], normal: [0.2, 0.1, 1], radius: 1.3}, material: a}
)"},
    {"Fast", "the fast highlight; a pane of glass and its shadow", R"(
lambent: 1
camera: {eye: [0.5, 2, 6], target: [0, 0.8, 0], fov: 45}
image: {size: [160, 120]}
illumination: {model: tachyon, ambient: 0.2}
integrator: {whitted: {max_depth: 6}}
background: [0.1, 0.2, 0.4]
lights: [{point: {position: [3, 5, 4], intensity: 0.6}}]
materials:
  - {name: a, ambient: [0.3, 0.1, 0.05], diffuse: [0.6, 0.2, 0.1], specular: 0.2, shininess: 30, highlight: 2}
  - {name: b, ambient: [0.01, 0.02, 0.03], diffuse: [0.1, 0.2, 0.3], specular: 0.1, shininess: 20, highlight: 2, transmit: 0.6, ior: 1}
  - {name: c, diffuse: 0.5, specular: 0.2, highlight: 2}
objects:
  - {sphere: {center: [-0.9, 0.8, 0], radius: 0.8}, material: a}
  - {disc: {center: [0.3, 1.2, 1.4], normal: [0.2, 0.1, 1], radius: 0.9}, material: b}
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: c}
)"},
    {"Placed", "our own phong; an instance of a mesh with normals, a box; no shadows, no perspective", R"(
lambent: 1
camera: {projection: orthographic, eye: [3, 4, 6], target: [0, 0.5, 0], height: 4.5}
image: {size: [160, 120]}
illumination: {model: phong, attenuation: none, ambient: 0.2, ambient_attenuation: none}
integrator: {whitted: {max_depth: 1, shadows: false}}
lights: [{point: {position: [3, 5, 4], intensity: 0.8}}]
materials:
  - {name: a, ambient: [0.3, 0.1, 0.05], diffuse: [0.6, 0.2, 0.1], specular: 0.2, shininess: 30}
  - {name: b, ambient: [0.02, 0.08, 0.06], diffuse: [0.1, 0.4, 0.3], specular: 0.3, shininess: 20}
  - {name: c, diffuse: 0.5}
objects:
  - mesh:
      vertices: [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1], [0, 0.5, 0]]
      triangles: [[0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0]]
      normals: [[-0.3, 1, -0.3], [0.3, 1, -0.3], [0.3, 1, 0.3], [-0.3, 1, 0.3], [0, 1, 0]]
    material: a
    transform: [{scale: [0.8, 1, 0.6]}, {rotate: {axis: y, degrees: 25}}, {translate: [-1.2, 0, 0]}]
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: c}
  - {box: {min: [-0.3, 0, -0.3], max: [0.3, 0.6, 0.3]}, material: b, transform: [{rotate: {axis: y, degrees: 40}}, {translate: [0.6, 0, 0.9]}]}
)"},
};

/// A picture as Tachyon writes it with -format PPM48.
Image read_ppm48(const std::string& path) {
  const std::string text = test::read_text(path);
  std::istringstream head(text);
  std::string kind;
  Image image;
  int largest = 0;
  head >> kind >> image.width >> image.height >> largest;
  const std::size_t begin = std::size_t(head.tellg()) + 1,
                    count = std::size_t(image.width) * image.height * 3;
  if (kind != "P6" || largest != 65535 || text.size() != begin + 2 * count)
    throw std::runtime_error(path + " is no PPM of 16 bits");
  for (std::size_t i = 0; i < count; ++i) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[begin + 2 * i + k]); };
    image.data.push_back(float((byte(0) * 256 + byte(1)) / 65535.0));
  }
  return image;
}

class PeerTachyon : public testing::TestWithParam<Compared> {};

TEST_P(PeerTachyon, MakesTheSamePicture) {
  const Compared& one = GetParam();
  if (!test::program_on_path("tachyon")) {
    test::not_compared("Tachyon", one.what, "tachyon is not installed");
    GTEST_SKIP() << "Tachyon is not here: script/bootstrap --peers installs it";
  }
  const ScenePtr scene = parse_scene(one.yaml);
  const test::TemporaryDirectory folder;
  const auto ran =
      test::render_exported(scene, ExportFormat::tachyon, "tachyon", "dat", "", {"-mediumshade"}, folder);
  ASSERT_EQ(ran.exit_code, 0) << ran.out << ran.err;
  const Image theirs = read_ppm48(folder.file("scene.ppm"));

  // Theirs is sampled at the upper right corners of its pixels. A picture of ours that is larger by one pixel
  // both ways, with pixels of the same size, has its centres there: our pixel (x + 1, y) is their (x, y).
  const SceneSummary summary = summarize(scene);
  const double larger = double(summary.height + 1) / summary.height;
  LoadOptions set;
  set.set.push_back({"image.size", fmt::format("[{}, {}]", summary.width + 1, summary.height + 1)});
  const std::string yaml = one.yaml;
  const auto number_after = [&](const std::string& key) {
    return std::stod(yaml.substr(yaml.find(key) + key.size()));
  };
  if (yaml.find("orthographic") != std::string::npos)
    set.set.push_back({"camera.height", fmt::format("{}", larger * number_after("height: "))});
  else
    set.set.push_back(
        {"camera.fov",
         fmt::format("{}", 360 / M_PI * std::atan(larger * std::tan(number_after("fov: ") * M_PI / 360)))});
  const Image ours = render(parse_scene(yaml, "scene", set)).image;
  const auto apart = test::how_far_apart(ours, test::smooth_pixels(yaml, set), [&](int x, int y) {
    return x >= 1 && y < theirs.height ? theirs.pixel(x - 1, y) : nullptr;
  });
  test::expect_telling(apart, ours);
  SCOPED_TRACE(fmt::format("at {}, {}: ours {}", apart.x, apart.y,
                           fmt::join(ours.pixel(apart.x, apart.y), ours.pixel(apart.x, apart.y) + 3, " ")));
  test::conform("Tachyon " + test::version_in(ran.out, "Version "), one.what,
                fmt::format("{} pixels", apart.compared), 1e-4, apart.largest);
}

INSTANTIATE_TEST_SUITE_P(Scenes, PeerTachyon, testing::ValuesIn(scenes),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace lambent
