// POV-Ray's pictures of the scenes that we export for it, beside ours.

#include <gtest/gtest.h>

#include "peers/pictures.h"

namespace lambent {
namespace {

using test::Compared;

constexpr Compared scenes[] = {
    {"Phong", "phong's highlight, balls and planes, three kinds of light", R"(
lambent: 1
camera: {eye: [1, 2, 7], target: [0, 0.7, 0], fov: 40}
image: {size: [160, 120]}
illumination: {model: povray, ambient: [0.3, 0.2, 0.25]}
integrator: {whitted: {max_depth: 1}}
background: [0.05, 0.1, 0.2]
lights:
  - {point: {position: [3, 5, 4], color: [0.6, 0.55, 0.5]}}
  - {directional: {direction: [1, -2, -0.7], color: [0.1, 0.15, 0.2]}}
  - {spot: {position: [-3, 5, 3], target: [0, 0, 0], angle: 30, softness: 0.6, exponent: 3, color: [0.1, 0.4, 0.3]}}
materials:
  - {name: a, ambient: [0.1, 0.3, 0.2], diffuse: [0.6, 0.2, 0.1], specular: 0.4, shininess: 30}
  - {name: b, ambient: [0.2, 0, 0.4], diffuse: [0.1, 0.3, 0.5], specular: 0.6, shininess: 8, brilliance: 1.7}
  - {name: c, diffuse: [0.4, 0.4, 0.3], specular: 0}
  - {name: d, diffuse: 0, ambient: [0.5, 0, 0.3], emission: [0, 0.1, 0.05]}
objects:
  - {sphere: {center: [-1, 0.8, 0], radius: 0.8}, material: a}
  - {sphere: {center: [1, 1, -1], radius: 1}, material: b}
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: c}
  - {sphere: {center: [0.6, 0.3, 1.2], radius: 0.3}, material: d}
)"},
    {"Specular", "specular with roughness and brilliance, light that fades, discs, cylinders, cones", R"(
lambent: 1
camera: {eye: [-2, 3, 7], target: [0, 0.7, 0], fov: 42}
image: {size: [160, 120]}
illumination: {model: povray, ambient: 0.4, attenuation: {constant: 0.5, quadratic: 0.02}}
integrator: {whitted: {max_depth: 1}}
lights:
  - {point: {position: [3, 5, 4], color: [0.9, 0.8, 0.7]}}
  - {spot: {position: [-4, 4, 4], target: [-1, 0, 0], angle: 60, softness: 0.3, color: [0.2, 0.3, 0.4]}}
materials:
  - {name: a, diffuse: [0.3, 0.2, 0.1], pov_specular: 0.5, roughness: 0.02, brilliance: 0.5}
  - {name: b, diffuse: [0.1, 0.3, 0.2], pov_specular: 0.3, roughness: 0.1, specular: 0.2, shininess: 60}
  - {name: c, diffuse: 0.4, brilliance: 2}
  - {name: d, diffuse: [0.4, 0.3, 0.1], pov_specular: 0.2}
objects:
  - {cylinder: {from: [-1.4, 0.1, 0], to: [-1, 1.6, 0.3], radius: 0.6}, material: a}
  - {cone: {from: [1, 0, 0], to: [1.2, 1.8, 0], radius_from: 0.9, radius_to: 0.2}, material: b}
  - {plane: {point: [0, -0.1, 0], normal: [0, 1, 0]}, material: c}
  - {disc: {center: [0, 1.2, -2], normal: [0.2, 0.1, 1], radius: 1.3}, material: d}
)"},
    {"LectureModels", "our own models: phong under 1/r, blinn_phong, mtl, opengl with a local viewer", R"(
lambent: 1
camera: {eye: [0, 2.5, 8], target: [0, 0.6, 0], fov: 38}
image: {size: [160, 120]}
illumination: {model: phong, attenuation: 1/r, ambient: 0.2, ambient_attenuation: none}
integrator: {whitted: {max_depth: 1}}
lights:
  - {point: {position: [2, 5, 5], intensity: 3}}
  - {point: {position: [-5, 3, 4], intensity: 1.5, color: [0.3, 0.5, 1]}}
materials:
  - {name: a, diffuse: [0.6, 0.2, 0.1], specular: 0.3, shininess: 40}
  - {name: b, diffuse: [0.1, 0.5, 0.2], specular: 0.3, shininess: 40, model: blinn_phong}
  - {name: c, diffuse: [0.1, 0.2, 0.6], specular: 0.3, shininess: 25, model: mtl, illum: 2}
  - {name: d, diffuse: [0.5, 0.4, 0.1], specular: 0.3, shininess: 25, model: opengl, local_viewer: 1, two_sided: 1}
  - {name: e, diffuse: 0.5}
objects:
  - {sphere: {center: [-2, 0.7, 0], radius: 0.7}, material: a}
  - {sphere: {center: [-0.5, 0.7, 0.5], radius: 0.7}, material: b}
  - {sphere: {center: [1, 0.7, 0], radius: 0.7}, material: c}
  - {sphere: {center: [2.4, 0.7, -0.6], radius: 0.7}, material: d}
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: e}
)"},
    {"Mirrors", "mirrors in mirrors", R"(
lambent: 1
camera: {eye: [0.5, 2, 6], target: [0, 0.8, 0], fov: 45}
image: {size: [160, 120]}
illumination: {model: povray, ambient: 0.1}
integrator: {whitted: {max_depth: 4}}
background: [0.1, 0.2, 0.4]
lights: [{point: {position: [3, 5, 4], intensity: 0.6}}]
materials:
  - {name: a, diffuse: [0.4, 0.2, 0.1], specular: 0.2, shininess: 30, reflect: [0.5, 0.4, 0.3]}
  - {name: b, diffuse: [0.1, 0.2, 0.3], reflect: 0.4}
  - {name: c, diffuse: 0.4, reflect: 0.25}
objects:
  - {sphere: {center: [-0.9, 0.8, 0], radius: 0.8}, material: a}
  - {sphere: {center: [0.9, 0.8, -0.3], radius: 0.8}, material: b}
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: c}
)"},
    {"Glass", "a pane that lets light through, and its shadow", R"(
lambent: 1
camera: {eye: [0.5, 2, 6], target: [0, 0.8, 0], fov: 45}
image: {size: [160, 120]}
illumination: {model: povray, ambient: 0.2}
integrator: {whitted: {max_depth: 6}}
background: [0.1, 0.2, 0.4]
lights: [{point: {position: [3, 5, 4], intensity: 0.8}}]
materials:
  - {name: a, diffuse: [0.6, 0.2, 0.1], specular: 0.2, shininess: 30}
  - {name: b, diffuse: [0.1, 0.2, 0.3], specular: 0.1, shininess: 20, transmit: 0.6, ior: 1}
  - {name: c, diffuse: 0.5}
objects:
  - {sphere: {center: [-0.9, 0.8, 0], radius: 0.8}, material: a}
  - {disc: {center: [0.3, 1.2, 1.4], normal: [0.2, 0.1, 1], radius: 0.9}, material: b}
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: c}
)"},
    {"Refraction", "a glass ball that refracts and mirrors", R"(
lambent: 1
camera: {eye: [0.5, 2, 6], target: [0, 0.8, 0], fov: 45}
image: {size: [160, 120]}
illumination: {model: povray, ambient: 0.2}
integrator: {whitted: {max_depth: 7}}
background: [0.1, 0.2, 0.4]
lights: [{point: {position: [3, 5, 4], intensity: 0.8}}]
materials:
  - {name: a, diffuse: [0.6, 0.2, 0.1], specular: 0.2, shininess: 30}
  - {name: b, diffuse: [0.05, 0.1, 0.1], specular: 0.1, shininess: 20, transmit: 0.7, ior: 1.5, reflect: 0.1}
  - {name: c, diffuse: 0.5}
objects:
  - {sphere: {center: [-0.9, 0.8, -1], radius: 0.8}, material: a}
  - {sphere: {center: [0.3, 0.9, 0.8], radius: 0.8}, material: b}
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: c}
)"},
    {"Placed", "a mesh with normals, a box, a stretched ball, each moved; no shadows, no perspective", R"(
lambent: 1
camera: {projection: orthographic, eye: [3, 4, 6], target: [0, 0.5, 0], height: 4.5}
image: {size: [160, 120]}
illumination: {model: povray, ambient: 0.2}
integrator: {whitted: {max_depth: 1, shadows: false}}
lights: [{point: {position: [3, 5, 4], intensity: 0.8}}]
materials:
  - {name: a, diffuse: [0.6, 0.2, 0.1], specular: 0.2, shininess: 30}
  - {name: b, diffuse: [0.1, 0.4, 0.3], specular: 0.3, shininess: 20}
  - {name: c, diffuse: 0.5}
  - {name: d, diffuse: [0.2, 0.2, 0.5], pov_specular: 0.2}
objects:
  - mesh:
      vertices: [[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1], [0, 0.5, 0]]
      triangles: [[0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0]]
      normals: [[-0.3, 1, -0.3], [0.3, 1, -0.3], [0.3, 1, 0.3], [-0.3, 1, 0.3], [0, 1, 0]]
    material: a
    transform: [{scale: [0.8, 1, 0.6]}, {rotate: {axis: y, degrees: 25}}, {translate: [-1.2, 0, 0]}]
  - {sphere: {center: [0, 0, 0], radius: 1}, material: b, transform: [{scale: [0.5, 0.9, 0.7]}, {translate: [1.2, 0.9, 0.3]}]}
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: c}
  - {box: {min: [-0.3, 0, -0.3], max: [0.3, 0.6, 0.3]}, material: d, transform: [{rotate: {axis: y, degrees: 40}}, {translate: [0.2, 0, 1.3]}]}
)"},
};

class PeerPovray : public testing::TestWithParam<Compared> {};

TEST_P(PeerPovray, MakesTheSamePicture) {
  const Compared& one = GetParam();
  const auto program = test::program_on_path("povray");
  if (!program) {
    test::not_compared("POV-Ray", one.what, "povray is not installed");
    GTEST_SKIP() << "POV-Ray is not here: script/bootstrap --peers installs it";
  }
  const ScenePtr scene = parse_scene(one.yaml);
  const test::TemporaryDirectory folder;
  // No light comes that near to a surface, and none is reflected totally in a ball.
  const auto ran = test::render_exported(scene, ExportFormat::povray, "povray", "pov", " -D",
                                         {"minimum_distance", "reflected totally"}, folder);
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  // What the file holds is linear, and read_image takes it for sRGB.
  Image theirs = read_image(folder.file("scene.png")).image;
  for (float& value : theirs.data) value = float(srgb_from_linear(value));

  const Image ours = render(scene).image;
  ASSERT_EQ(ours.width, theirs.width);
  ASSERT_EQ(ours.height, theirs.height);
  const auto apart = test::how_far_apart(ours, test::smooth_pixels(one.yaml, {}),
                                         [&](int x, int y) { return theirs.pixel(x, y); });
  test::expect_telling(apart, ours);
  SCOPED_TRACE(
      fmt::format("at {}, {}: ours {}, theirs {}", apart.x, apart.y,
                  fmt::join(ours.pixel(apart.x, apart.y), ours.pixel(apart.x, apart.y) + 3, " "),
                  fmt::join(theirs.pixel(apart.x, apart.y), theirs.pixel(apart.x, apart.y) + 3, " ")));
  const auto version = test::RunningProgram({*program, "--version"}, folder.path()).wait();
  test::conform(test::version_in(version.out + version.err, "POV-Ray "), one.what,
                fmt::format("{} pixels", apart.compared), 1e-4, apart.largest);
}

INSTANTIATE_TEST_SUITE_P(Scenes, PeerPovray, testing::ValuesIn(scenes),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace lambent
