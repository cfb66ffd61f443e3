// Painted surfaces, through the whole renderer, against closed forms.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "integrators/texture_lookup.h"
#include "lambent/lambent.h"
#include "scene/mip_levels.h"
#include "scene/scene.h"
#include "support.h"

namespace lambent {
namespace {

using V = Vec3<double>;

/// An uncompressed BMP of 24 bits, row 0 at the top.
template <class Color> void write_bmp(const std::string& path, int width, int height, const Color& color) {
  std::string bytes = "BM";
  const auto number = [&](std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) bytes += char(value >> (8 * i) & 255);
  };
  const int row = (width * 3 + 3) / 4 * 4;
  number(std::uint32_t(54 + row * height), 4), number(0, 4), number(54, 4), number(40, 4);
  number(std::uint32_t(width), 4), number(std::uint32_t(height), 4), number(1, 2), number(24, 2),
      number(0, 4);
  number(std::uint32_t(row * height), 4), number(2835, 4), number(2835, 4), number(0, 4), number(0, 4);
  for (int y = height - 1; y >= 0; --y) {
    for (int x = 0; x < width; ++x) {
      const std::array<int, 3> c = color(x, y);
      for (const int i : {2, 1, 0}) bytes += char(c[std::size_t(i)]);
    }
    bytes.append(std::size_t(row - width * 3), '\0');
  }
  std::ofstream(path, std::ios::binary) << bytes;
}

class Painted : public ::testing::Test {
 protected:
  ScenePtr scene(const std::string& text) const { return parse_scene(text, folder.file("scene.yaml")); }
  Image picture(const std::string& text) const { return render(scene(text)).image; }
  test::TemporaryDirectory folder;
};

/// A square of side 2 across z, seen straight on by an orthographic camera that it fills: pixels are texels.
std::string square(int size, const std::string& material, const std::string& more = "") {
  return fmt::format(
      "lambent: 1\ncamera: {{projection: orthographic, eye: [0, 0, 5], target: [0, 0, 0], height: 2}}\n"
      "image: {{size: [{0}, {0}]}}\nillumination: {{model: conventional, ambient: 0}}\n"
      "lights: [{{directional: {{direction: [0, 0, -1]}}}}]\n"
      "objects:\n  - mesh: {{vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], triangles: [[0, 1, "
      "2], [0, 2, "
      "3]], uvs: [[0, 0], [1, 0], [1, 1], [0, 1]]}}\n    material: {1}\n{2}",
      size, material, more);
}

TEST_F(Painted, ATextureIsTheRightWayUpAndDecoded) {
  write_bmp(folder.file("four.bmp"), 2, 2, [](int x, int y) -> std::array<int, 3> {
    return {x ? 255 : 0, y ? 255 : 0, 128};
  });
  const Image image = picture(square(2, "{diffuse: [0.5, 1, 1], maps: {diffuse: four.bmp}}"));
  // 128 / 255 is 0.2158605 in linear light: ((c + 0.055) / 1.055)^2.4
  const double blue = std::pow((128 / 255.0 + 0.055) / 1.055, 2.4);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) {
      EXPECT_NEAR(image.pixel(x, y)[0], 0.5 * x, 1e-6);
      EXPECT_NEAR(image.pixel(x, y)[1], y, 1e-6);
      EXPECT_NEAR(image.pixel(x, y)[2], blue, 1e-6);
    }
  const Image data = picture(square(2, "{diffuse: 1, maps: {diffuse: {file: four.bmp, encoding: linear}}}"));
  EXPECT_NEAR(data.pixel(0, 0)[2], 128 / 255.0, 1e-6);
}

TEST_F(Painted, ScaleTurnAndOffsetMoveTheImage) {
  // Only the texel at the lower left, u < 1/2 and v < 1/2, is white.
  write_bmp(folder.file("one.bmp"), 2, 2, [](int x, int y) -> std::array<int, 3> {
    const int v = x == 0 && y == 1 ? 255 : 0;
    return {v, v, v};
  });
  const auto white = [&](const std::string& how) {
    const Image image =
        picture(square(2, "{diffuse: 1, maps: {diffuse: {file: one.bmp, filter: nearest, " + how + "}}}"));
    std::string found;
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 2; ++x) found += image.pixel(x, y)[0] > 0.5 ? '1' : '0';
    return found;
  };
  EXPECT_EQ(white("wrap: repeat"), "0010");
  EXPECT_EQ(white("offset: [0.5, 0]"), "0001");
  EXPECT_EQ(white("offset: [0, 0.5]"), "1000");
  EXPECT_EQ(white("scale: [0.5, 0.5]"), "1111");
  EXPECT_EQ(white("scale: [2, 2], wrap: clamp"), "0000");  // the pixels' centres lie at 1/2 and beyond
  EXPECT_EQ(white("rotate: 90"), "1000");  // (u, v) -> (-v, u): (1/4, 3/4) looks at (-3/4, 1/4)
}

TEST_F(Painted, OpacityShowsTheRestOfWhatLiesBehind) {
  write_bmp(folder.file("half.bmp"), 2, 1, [](int x, int) -> std::array<int, 3> {
    return {x ? 255 : 51, 0, 0};
  });
  const std::string behind =
      "  - {plane: {point: [0, 0, -1], normal: [0, 0, 1]}, material: {diffuse: 0, ambient: 0, emission: [0, "
      "0, 1]}}\n";
  // 51 / 255 = 0.2: alpha is data
  const Image image =
      picture(square(2, "{diffuse: [1, 0, 0], maps: {opacity: {file: half.bmp, channel: r}}}", behind));
  EXPECT_NEAR(image.pixel(0, 0)[0], 0.2, 1e-6);
  EXPECT_NEAR(image.pixel(0, 0)[2], 0.8, 1e-6);
  EXPECT_NEAR(image.pixel(1, 0)[0], 1, 1e-6);
  EXPECT_NEAR(image.pixel(1, 0)[2], 0, 1e-6);
  const Image plain = picture(square(2, "{diffuse: [1, 0, 0], opacity: 0.25}", behind));
  EXPECT_NEAR(plain.pixel(0, 0)[0], 0.25, 1e-6);
  EXPECT_NEAR(plain.pixel(0, 0)[2], 0.75, 1e-6);
}

TEST_F(Painted, MasksAreHolesForRaysAndForLight) {
  write_bmp(folder.file("mask.bmp"), 2, 1, [](int x, int) -> std::array<int, 3> {
    return {x ? 255 : 100, 0, 0};
  });
  // The square stands before a wall, and the light falls straight through it: the wall is lit where the holes
  // are.
  const std::string wall =
      "  - {plane: {point: [0, 0, -1], normal: [0, 0, 1]}, material: {diffuse: [0, 0.5, 0]}}\n";
  std::string text = square(
      2, "{diffuse: [1, 0, 0], alpha: mask, maps: {opacity: {file: mask.bmp, channel: r, filter: nearest}}}",
      wall);
  for (const char* depth : {"1", "5"}) {  // a hole counts for no depth
    const Image image = picture(text + "integrator: {whitted: {max_depth: " + depth + "}}\n");
    EXPECT_NEAR(image.pixel(0, 0)[0], 0, 1e-6);
    EXPECT_NEAR(image.pixel(0, 0)[1], 0.5, 1e-6);  // and no shadow on it
    EXPECT_NEAR(image.pixel(1, 0)[0], 1, 1e-6);
  }
  // Without colours in shadows, a hole is still a hole.
  const Image image = picture(text + "integrator: {whitted: {colored_shadows: false}}\n");
  EXPECT_NEAR(image.pixel(0, 0)[1], 0.5, 1e-6);
}

TEST_F(Painted, AMaskWithoutAMapIsAllThereOrNotAtAll) {
  const std::string wall =
      "  - {plane: {point: [0, 0, -1], normal: [0, 0, 1]}, material: {diffuse: [0, 0.5, 0]}}\n";
  const Image gone = picture(square(1, "{diffuse: [1, 0, 0], alpha: mask, opacity: 0.2}", wall));
  EXPECT_NEAR(gone.pixel(0, 0)[0], 0, 1e-6);
  EXPECT_NEAR(gone.pixel(0, 0)[1], 0.5, 1e-6);  // and no shadow on the wall
  const Image there = picture(square(1, "{diffuse: [1, 0, 0], alpha: mask, opacity: 0.8}", wall));
  EXPECT_NEAR(there.pixel(0, 0)[0], 1, 1e-6);
  EXPECT_NEAR(there.pixel(0, 0)[1], 0, 1e-6);
}

TEST_F(Painted, OneSidedSurfacesAreNotSeenFromInside) {
  const std::string behind =
      "  - {plane: {point: [0, 0, -1], normal: [0, 0, 1]}, material: {diffuse: 0, ambient: 0, emission: [0, "
      "0, 1]}}\n";
  std::string turned = square(
      2, "{diffuse: [1, 0, 0], one_sided: true}\n    transform: {rotate: {axis: y, degrees: 180}}", behind);
  EXPECT_NEAR(picture(turned).pixel(0, 0)[2], 1, 1e-6);
  EXPECT_NEAR(picture(square(2, "{diffuse: [1, 0, 0], one_sided: true}", behind)).pixel(0, 0)[0], 1, 1e-6);
}

TEST_F(Painted, ANormalMapTiltsN) {
  // (r, g, b) = (204, 128, 230): x = 0.6, y about 0, z about 0.8
  write_bmp(folder.file("normal.bmp"), 1, 1, [](int, int) -> std::array<int, 3> { return {204, 128, 230}; });
  const V n = normalize(V{2 * 204 / 255.0 - 1, 2 * 128 / 255.0 - 1, 2 * 230 / 255.0 - 1});
  const Image image = picture(square(1, "{diffuse: 1, maps: {normal: normal.bmp}}"));
  EXPECT_NEAR(image.pixel(0, 0)[0], n.z, 1e-6);  // N.L with L = z
  // Green points to the image's top: lit from above, it is brighter where green is more.
  write_bmp(folder.file("up.bmp"), 1, 1, [](int, int) -> std::array<int, 3> { return {128, 204, 230}; });
  std::string text = square(1, "{diffuse: 1, maps: {normal: up.bmp}}");
  text.replace(text.find("[0, 0, -1]}}]"), 10, "[0, -1, -1]");
  const V up = normalize(V{2 * 128 / 255.0 - 1, 2 * 204 / 255.0 - 1, 2 * 230 / 255.0 - 1});
  EXPECT_NEAR(picture(text).pixel(0, 0)[0], (up.y + up.z) / std::sqrt(2), 1e-6);
}

TEST_F(Painted, ABumpMapTiltsNAsItsSlopeSays) {
  // Height grows along u from texel to texel by 2 / 255; the square is 2 wide, so the slope is 64 * (2 / 255)
  // / 2 a unit.
  write_bmp(folder.file("slope.bmp"), 64, 1, [](int x, int) -> std::array<int, 3> {
    return {2 * x, 2 * x, 2 * x};
  });
  const Image image = picture(square(9, "{diffuse: 1, maps: {bump: {file: slope.bmp, strength: 3}}}"));
  const double slope = 3 * 64 * (2 / 255.0) / 2;
  EXPECT_NEAR(image.pixel(4, 4)[0], 1 / std::sqrt(1 + slope * slope), 1e-5);
}

TEST_F(Painted, TheBackgroundIsAPictureAllAround) {
  // Four columns, from the left: behind (+z) on both sides, -x, the middle (-z), +x.
  write_bmp(folder.file("around.bmp"), 4, 2, [](int x, int y) -> std::array<int, 3> {
    return {x == 1 ? 255 : 0, x == 2 ? 255 : 0, y == 0 ? 255 : 0};
  });
  const auto color = [&](const std::string& target, const std::string& turn = "0") {
    const Image image = picture(
        "lambent: 1\ncamera: {eye: [0, 0, 0], target: " + target +
        ", up: [0, 1, 0.1], fov: 1}\nimage: {size: [1, 1]}\nbackground: {file: around.bmp, color: 2, turn: " +
        turn + "}\n");
    return std::vector<float>(image.data);
  };
  // The middle of a texel, where nothing is mixed: u = 0.625 is 45 degrees to the right of -z.
  const auto right = color("[1, 1, -1]"), left = color("[-1, 1, -1]");
  EXPECT_NEAR(right[0], 0, 0.1);
  EXPECT_NEAR(right[1], 2, 0.1);
  EXPECT_NEAR(left[0], 2, 0.1);
  EXPECT_NEAR(left[1], 0, 0.1);
  EXPECT_GT(right[2], 1.5);  // above the horizon
  EXPECT_LT(color("[1, -1, -1]")[2], 0.5);
  // Turned counter-clockwise by a quarter, what stood to the right of the middle stands to its left.
  EXPECT_NEAR(color("[-1, 1, -1]", "90")[1], 2, 0.1);
}

TEST_F(Painted, AmbientOcclusionIsTheShareOfTheSky) {
  // A disc of radius a at height h above the point hides a^2 / (a^2 + h^2) of the directions, by their
  // cosine.
  const double a = 1.5, h = 2;
  const Image image = picture(fmt::format(
      "lambent: 1\ncamera: {{projection: orthographic, eye: [0, 1, 0], target: [0, 0, 0], up: [0, 0, -1], "
      "height: "
      "0.001}}\nimage: {{size: [1, 1], samples: 64}}\nillumination: {{model: conventional, ambient: 0.8, "
      "ambient_occlusion: {{rays: 64}}}}\nobjects:\n  - {{plane: {{point: [0, 0, 0], normal: [0, 1, 0]}}, "
      "material: "
      "{{ambient: 0.5}}}}\n  - {{disc: {{center: [0, {}, 0], normal: [0, 1, 0], radius: {}}}}}\n",
      h, a));
  EXPECT_NEAR(image.pixel(0, 0)[0], 0.5 * 0.8 * (1 - a * a / (a * a + h * h)), 2e-3);
}

TEST_F(Painted, MissingAndDamagedImagesAreErrorsWithTheirPlace) {
  test::write_text(folder.file("damaged.png"), "no image");
  const auto error = [&](const std::string& file) -> Diagnostic {
    try {
      scene(square(1, "{maps: {diffuse: " + file + "}}"));
    } catch (const InputError& wrong) {
      return wrong.diagnostics().at(0);
    }
    return {};
  };
  EXPECT_EQ(error("nothing.png").place.line, 8);
  EXPECT_NE(error("nothing.png").message.find("cannot open"), std::string::npos);
  EXPECT_EQ(error("damaged.png").place.line, 8);
  EXPECT_NE(error("damaged.png").message.find("damaged.png"), std::string::npos);
  EXPECT_NE(error("../outside.png").message.find("cannot open"), std::string::npos);
  test::TemporaryDirectory elsewhere;
  write_bmp(elsewhere.file("image.bmp"), 1, 1, [](int, int) -> std::array<int, 3> { return {0, 0, 0}; });
  const Diagnostic outside = error(elsewhere.file("image.bmp"));
  EXPECT_NE(outside.message.find("outside"), std::string::npos);
  EXPECT_NE(outside.hint.find("--allow-outside"), std::string::npos);
}

TEST_F(Painted, AllTexturesTogetherHaveALimit) {
  write_bmp(folder.file("a.bmp"), 4, 4, [](int x, int y) -> std::array<int, 3> { return {x, y, 0}; });
  write_bmp(folder.file("b.bmp"), 4, 4, [](int x, int y) -> std::array<int, 3> { return {y, x, 0}; });
  const std::string text = square(1, "{maps: {diffuse: a.bmp, ambient: b.bmp}}");
  LoadOptions options;
  options.limits.pixels = 32;
  EXPECT_NO_THROW(parse_scene(text, folder.file("scene.yaml"), options));
  options.limits.pixels = 31;  // each has 16
  try {
    parse_scene(text, folder.file("scene.yaml"), options);
    ADD_FAILURE() << "was accepted";
  } catch (const InputError& wrong) {
    EXPECT_NE(wrong.diagnostics().at(0).message.find("b.bmp"), std::string::npos);
    EXPECT_NE(wrong.diagnostics().at(0).hint.find("--max-pixels"), std::string::npos);
  }
}

TEST_F(Painted, OneImageIsInMemoryOnce) {
  write_bmp(folder.file("a.bmp"), 4, 4, [](int x, int y) -> std::array<int, 3> { return {x, y, 0}; });
  const ScenePtr loaded = scene(square(1, "{maps: {diffuse: a.bmp, ambient: a.bmp, bump: a.bmp}}"));
  EXPECT_EQ(loaded->textures.size(), 2u);  // as colours and as data
}

TEST_F(Painted, ASceneFileCanShowAnother) {
  write_bmp(folder.file("a.bmp"), 1, 1, [](int, int) -> std::array<int, 3> { return {255, 255, 255}; });
  test::write_text(
      folder.file("ball.yaml"),
      "lambent: 1\ncamera: {eye: [0, 0, 5], target: [0, 0, 0]}\nillumination: {model: conventional, ambient: "
      "0}\nmaterials: [{name: red, diffuse: [1, 0, 0], maps: {diffuse: a.bmp}}]\nobjects:\n  - {name: ball, "
      "sphere: {center: [0, 0, 0], radius: 1}, material: red}\n");
  const std::string start =
      "lambent: 1\ncamera: {eye: [0, 0, 5], target: [0, 0, 0]}\nimage: {size: [1, 1]}\nillumination: {model: "
      "phong, "
      "ambient: 0}\nlights: [{directional: {direction: [0, 0, -1]}}]\n";
  const std::string show = "objects: [{name: two, scene: {file: ball.yaml}, transform: {scale: 0.5}}]\n";
  const ScenePtr both = scene(start + show);
  ASSERT_EQ(both->objects.size(), 1u);
  EXPECT_EQ(both->objects[0].name, "two/ball");
  const Image image = render(both).image;
  EXPECT_NEAR(image.pixel(0, 0)[0], 1, 1e-6);
  EXPECT_NEAR(image.pixel(0, 0)[1], 0, 1e-6);
  // A material of the same name stands in for the other scene's.
  const Image green = picture(start + "materials: [{name: red, diffuse: [0, 1, 0]}]\n" + show);
  EXPECT_NEAR(green.pixel(0, 0)[1], 1, 1e-6);
  // Scenes that show each other are an error.
  test::write_text(
      folder.file("loop.yaml"),
      "lambent: 1\ncamera: {eye: [0, 0, 5], target: [0, 0, 0]}\nobjects: [{scene: {file: loop.yaml}}]\n");
  EXPECT_THROW(load_scene(folder.file("loop.yaml")), InputError);
}

// ---- looking up

Texture stripes(int width, int height, bool along_x) {
  Texture texture;
  texture.srgb = false;
  texture.channels = 1;
  texture.levels = {{width, height, 0}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) texture.floats.push_back(float((along_x ? y : x) % 2));
  build_levels(texture);
  return texture;
}
TextureRecord record(const Texture& texture) {
  return {nullptr,
          texture.floats.data(),
          texture.decoded.data(),
          texture.levels.data(),
          int(texture.levels.size()),
          texture.channels};
}

TEST(TextureLookup, AFootprintOfManyTexelsIsTheirMean) {
  const Texture texture = stripes(64, 64, false);
  const TextureMap map;
  for (const double size : {8.0, 16.0, 64.0}) {
    const double half = size / 64 / 2;
    EXPECT_NEAR(look_up(record(texture), {0.41, 0.37}, {{half, 0}, {0, half}}, map).c[0], 0.5, 1e-6);
  }
}

TEST(TextureLookup, ALongFootprintBlursAlongItselfAlone) {
  // Sixteen texels long and one wide: along the stripes they stay, across them they go.
  const TextureMap map;
  const Footprint along_x{{8.0 / 64, 0}, {0, 0.5 / 64}};
  const Texture lie_along = stripes(64, 64, true), stand_across = stripes(64, 64, false);
  EXPECT_NEAR(look_up(record(lie_along), {0.5, 1 - 20.5 / 64}, along_x, map).c[0], 0, 1e-6);
  EXPECT_NEAR(look_up(record(lie_along), {0.5, 1 - 21.5 / 64}, along_x, map).c[0], 1, 1e-6);
  EXPECT_NEAR(look_up(record(stand_across), {0.5, 0.5}, along_x, map).c[0], 0.5, 1e-6);
}

TEST(TextureLookup, GoesOnBeyondTheEdgesAsToldTo) {
  Texture texture = stripes(4, 1, false);
  texture.floats = {0, 1, 2, 3};
  texture.levels.resize(1);
  TextureMap map;
  map.nearest = true;
  const auto at = [&](double u, Wrap wrap) {
    map.wrap_u = map.wrap_v = wrap;
    return look_up(record(texture), {u, 0.5}, {}, map).c[0];
  };
  EXPECT_EQ(at(1.125, Wrap::repeat), 0);
  EXPECT_EQ(at(-0.125, Wrap::repeat), 3);
  EXPECT_EQ(at(1.125, Wrap::mirror), 3);
  EXPECT_EQ(at(-0.375, Wrap::mirror), 1);
  EXPECT_EQ(at(2.125, Wrap::mirror), 0);
  EXPECT_EQ(at(7, Wrap::clamp), 3);
  EXPECT_EQ(at(-7, Wrap::clamp), 0);
}

}  // namespace
}  // namespace lambent
