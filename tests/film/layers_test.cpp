// Layers: what a picture's colours are made of.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <random>

#include "film/layer_book.h"
#include "integrators/kernels.h"
#include "lambent/lambent.h"
#include "lambent/relight.h"
#include "random_scene.h"

namespace lambent {
namespace {

RenderResult render_with_layers(const std::string& yaml,
                                const std::vector<std::pair<std::string, std::string>>& set = {}) {
  LoadOptions options;
  options.set = set;
  options.set.emplace_back("film.layers", "true");
  return render(parse_scene(yaml, "scene", options));
}

std::size_t channel(const Image& image, const std::string& name) {
  const auto at = std::find(image.channels.begin(), image.channels.end(), name);
  if (at == image.channels.end()) throw std::runtime_error("no channel " + name);
  return std::size_t(at - image.channels.begin());
}

std::vector<std::size_t> layer_channels(const RenderResult& result, const char* color) {
  std::vector<std::size_t> channels;
  for (const auto& [key, value] : result.metadata) {
    if (key != "lambent:layers") continue;
    std::size_t begin = 0;
    while (begin < value.size()) {
      const std::size_t end = std::min(value.find(' ', begin), value.size());
      channels.push_back(channel(result.image, value.substr(begin, end - begin) + color));
      begin = end + 1;
    }
  }
  return channels;
}

// In float and in double, forwards, backwards and shuffled: always the pixel, in every bit.
void expect_layers_to_add_up(const RenderResult& result, unsigned seed) {
  const char* colors[] = {".R", ".G", ".B"};
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<std::size_t> channels = layer_channels(result, colors[c]);
    ASSERT_FALSE(channels.empty());
    std::mt19937 random(seed);
    for (int order = 0; order < 3; ++order) {
      for (int y = 0; y < result.image.height; ++y)
        for (int x = 0; x < result.image.width; ++x) {
          const float* pixel = result.image.pixel(x, y);
          float sum = 0;
          double exact = 0;
          for (const std::size_t layer : channels) {
            sum += pixel[layer], exact += pixel[layer];
            ASSERT_GE(pixel[layer], 0);
          }
          ASSERT_EQ(pixel[c], sum) << "seed " << seed << " at " << x << "," << y;
          ASSERT_EQ(double(pixel[c]), exact);
        }
      std::shuffle(channels.begin(), channels.end(), random);
    }
  }
}

TEST(Layers, AddUpToThePictureBitForBitInAnyOrder) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const char* samples[] = {"1", "3", "16", "{adaptive: {start: 4, max: 64, error: 1}}"};
    const RenderResult result = render_with_layers(test::random_scene(seed, 33, 21, samples[seed % 4]));
    ASSERT_NO_FATAL_FAILURE(expect_layers_to_add_up(result, seed));
  }
}

TEST(Layers, DoNotChangeThePicture) {
  for (unsigned seed = 50; seed < 70; ++seed) {
    const char* samples[] = {"1", "5", "{adaptive: {start: 4, max: 64, error: 1}}"};
    const std::string yaml = test::random_scene(seed, 33, 21, samples[seed % 3]);
    const Image plain = render(parse_scene(yaml)).image;
    const RenderResult layered = render_with_layers(yaml);
    for (int y = 0; y < plain.height; ++y)
      for (int x = 0; x < plain.width; ++x)
        ASSERT_EQ(0, std::memcmp(plain.pixel(x, y), layered.image.pixel(x, y), 3 * sizeof(float)))
            << "seed " << seed;
  }
}

TEST(Layers, AreTheSameForThreadsTilesAndInstructionSets) {
  const ScenePtr scene =
      parse_scene(test::random_scene(3, 40, 30, "4"), "scene", {{{"film.layers", "true"}}});
  const Image first = render(scene).image;
  for (const std::string& isa : available_isas())
    for (const auto& [threads, tile] : {std::pair{1, 7}, {3, 32}, {2, 1}}) {
      const Image other = render(scene, {threads, tile, isa, {}}).image;
      EXPECT_EQ(0, std::memcmp(first.data.data(), other.data.data(), first.data.size() * sizeof(float)))
          << isa << ", " << threads << " threads, tiles of " << tile;
    }
}

// Each light alone, without anything else: its layers are the picture.
TEST(Layers, ALightsLayersAreThePictureUnderThatLightAlone) {
  const std::string head =
      "lambent: 1\ncamera: {eye: [0, 1, 5], target: [0, 0.5, 0]}\nimage: {size: [40, 30]}\n"
      "integrator: {whitted: {max_depth: 4}}\n"
      "materials: [{name: red, ambient: 0, diffuse: [0.8, 0.1, 0.1], specular: 0.5, shininess: 20, reflect: "
      "0.4}]\n"
      "objects: [{sphere: {center: [0, 0.6, 0], radius: 0.6}, material: red}, {plane: {point: [0, 0, 0], "
      "normal: [0, 1, 0]}, material: "
      "red}]\nlights:\n";
  const std::string key = "  - {name: key, point: {position: [3, 4, 4], intensity: 8}}\n",
                    fill = "  - {name: fill, directional: {direction: [1, -1, -1], intensity: 0.3}}\n";
  const RenderResult both = render_with_layers(head + key + fill);
  for (const auto& [name, light] : {std::pair<std::string, std::string>{"key", key}, {"fill", fill}}) {
    const Image alone = render(parse_scene(head + light)).image;
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 40; ++x)
        for (std::size_t c = 0; c < 3; ++c) {
          const char* colors[] = {".R", ".G", ".B"};
          double sum = 0;
          for (const char* way : {"", "reflection."})
            for (const char* term : {".diffuse", ".specular"})
              sum += both.image.pixel(x, y)[channel(both.image, way + ("light." + name) + term + colors[c])];
          EXPECT_NEAR(alone.pixel(x, y)[c], sum, 4e-7 * both.image.pixel(x, y)[c] + 1e-12);
        }
  }
}

TEST(Layers, ApportionedNumbersAreNearTheirOwnAndAddUpExactly) {
  std::mt19937 random(1);
  for (int run = 0; run < 20000; ++run) {
    const int count = std::uniform_int_distribution<int>(1, 30)(random);
    std::vector<double> layers(static_cast<std::size_t>(count));
    double sum = 0;
    for (double& layer : layers) {
      layer = std::uniform_int_distribution<int>(0, 3)(random) == 0
                  ? 0
                  : std::exp2(std::uniform_real_distribution<double>(run % 7 == 0 ? -150 : -30, 5)(random));
      sum += layer;
    }
    const float total = float(sum);
    std::vector<float> floats(layers.size());
    apportion(layers.data(), count, total, floats.data());
    float added = 0;
    const double u = total > 0 ? double(std::nextafter(total, HUGE_VALF)) - double(total) : 0;
    for (std::size_t i = 0; i < layers.size(); ++i) {
      added += floats[i];
      EXPECT_LE(std::fabs(layers[i] - double(floats[i])), u) << "at most one last place of the total";
      if (layers[i] == 0) {
        EXPECT_EQ(0, floats[i]) << "nothing becomes something";
      }
    }
    ASSERT_EQ(total, added);
  }
}

// Packets of pixels, on every instruction set of this machine, get the bits that each pixel gets by itself;
// and those that packets cannot do are all named, and no others.
TEST(Layers, ManyPixelsAreApportionedAsEachAlone) {
  std::mt19937 random(2);
  const auto chance = [&](int one_in) { return std::uniform_int_distribution<int>(1, one_in)(random) == 1; };
  for (int run = 0; run < 60; ++run) {
    const int layers = std::uniform_int_distribution<int>(1, 20)(random),
              samples = std::uniform_int_distribution<int>(1, 9)(random),
              channels = (layers + 1) * color_channels;
    const auto pixels = std::uniform_int_distribution<std::uint32_t>(1, 100)(random);
    const std::size_t stride = pixels + 16;
    std::vector<double> sums(stride * std::size_t(layers * color_channels), 0.0);
    std::vector<float> film(pixels * std::size_t(channels));
    std::vector<std::uint8_t> must_be_left(pixels, 0);
    for (std::uint32_t p = 0; p < pixels; ++p)
      for (int c = 0; c < color_channels; ++c) {
        const bool is_black = chance(5), is_odd = chance(30);
        double total = 0;
        for (int i = 0; i < layers; ++i) {
          double& sum = sums[std::size_t(i * color_channels + c) * stride + p];
          if (!is_black && !chance(3))
            sum = std::exp2(std::uniform_real_distribution<double>(run % 7 == 0 ? -150 : -30, 5)(random));
          if (is_odd && i == 0) sum = chance(2) ? -1 : HUGE_VAL;
          total += sum / samples;
        }
        film[p * std::size_t(channels) + std::size_t(c)] = float(total);
        must_be_left[p] |= is_odd;
      }
    std::vector<float> expected = film;
    for (std::uint32_t p = 0; p < pixels; ++p)
      for (int c = 0; c < color_channels; ++c) {
        std::vector<double> means(static_cast<std::size_t>(layers));
        for (int i = 0; i < layers; ++i)
          means[std::size_t(i)] = sums[std::size_t(i * color_channels + c) * stride + p] / samples;
        std::vector<float> floats(means.size());
        float* pixel = &expected[p * std::size_t(channels)];
        apportion(means.data(), layers, pixel[c], floats.data());
        for (int i = 0; i < layers; ++i) pixel[(i + 1) * color_channels + c] = floats[std::size_t(i)];
      }
    for (const Kernel* kernel : kernels()) {
      std::vector<float> found = film;
      std::vector<float*> to;
      for (std::uint32_t p = 0; p < pixels; ++p) to.push_back(&found[p * std::size_t(channels)]);
      std::vector<std::uint8_t> left(pixels, 77);
      std::vector<ApportionRoom> room(std::size_t(layers) * 2);
      kernel->apportion_layers(
          {sums.data(), stride, layers, samples, pixels, to.data(), left.data(), room.data()});
      for (std::uint32_t p = 0; p < pixels; ++p) {
        ASSERT_EQ(must_be_left[p], left[p]) << kernel->isa << ", pixel " << p;
        if (left[p]) continue;
        ASSERT_EQ(0, std::memcmp(to[p], &expected[p * std::size_t(channels)],
                                 std::size_t(channels) * sizeof(float)))
            << kernel->isa << ", pixel " << p << " of " << pixels << ", " << layers << " layers";
      }
    }
  }
}

TEST(Layers, FirstHitsAreThoseOfTheScene) {
  // A unit ball at the origin seen from z = 5: depth 4 in the middle, N towards us, P its pole.
  const std::string yaml =
      "lambent: 1\ncamera: {eye: [0, 0, 5], target: [0, 0, 0]}\nimage: {size: [21, 21]}\n"
      "materials: [{name: red, diffuse: [0.8, 0.1, 0.2]}]\n"
      "objects: [{name: ball, sphere: {center: [0, 0, 0], radius: 1}, material: red}]\n";
  const RenderResult result = render_with_layers(yaml);
  const auto at = [&](int x, int y, const char* name) {
    return result.image.pixel(x, y)[channel(result.image, name)];
  };
  EXPECT_FLOAT_EQ(4, at(10, 10, "Z"));
  EXPECT_FLOAT_EQ(1, at(10, 10, "N.Z"));
  EXPECT_FLOAT_EQ(1, at(10, 10, "P.Z"));
  EXPECT_FLOAT_EQ(0.8f, at(10, 10, "albedo.R"));
  EXPECT_TRUE(std::isinf(at(0, 0, "Z")));
  EXPECT_EQ(cryptomatte_id("ball"), at(10, 10, "CryptoObject00.R"));
  EXPECT_EQ(1, at(10, 10, "CryptoObject00.G"));
  EXPECT_EQ(cryptomatte_id("red"), at(10, 10, "CryptoMaterial00.R"));
  EXPECT_EQ(0, at(0, 0, "CryptoObject00.G"));
  // |N| = 1 and P on the ball wherever it is hit
  for (int y = 0; y < 21; ++y)
    for (int x = 0; x < 21; ++x) {
      if (std::isinf(at(x, y, "Z"))) continue;
      EXPECT_NEAR(1, std::hypot(at(x, y, "N.X"), at(x, y, "N.Y"), at(x, y, "N.Z")), 1e-6);
      EXPECT_NEAR(1, std::hypot(at(x, y, "P.X"), at(x, y, "P.Y"), at(x, y, "P.Z")), 1e-6);
    }
}

TEST(Layers, CoverageOfAnEdgeIsTheShareOfItsSamples) {
  // The plane z = 0 fills the lower half of the one pixel: half of its 16 samples.
  const std::string yaml =
      "lambent: 1\ncamera: {projection: orthographic, eye: [0, 0, 5], target: [0, 0, 0], height: 2}\n"
      "image: {size: [1, 1], samples: 16}\n"
      "objects: [{name: lower, polygon: {vertices: [[-2, -2, 0], [2, -2, 0], [2, 0, 0], [-2, 0, 0]]}}]\n";
  const RenderResult result = render_with_layers(yaml);
  EXPECT_EQ(0.5f, result.image.data[channel(result.image, "CryptoObject00.G")]);
}

TEST(Layers, TextureCoordinatesAreInterpolated) {
  const std::string yaml =
      "lambent: 1\ncamera: {projection: orthographic, eye: [0.5, 0.5, 5], target: [0.5, 0.5, 0], height: 1}\n"
      "image: {size: [8, 8]}\n"
      "objects: [{mesh: {vertices: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "
      "uvs: [[0, 0], [2, 0], [2, 3], [0, 3]], triangles: [[0, 1, 2], [0, 2, 3]]}}]\n";
  const RenderResult result = render_with_layers(yaml);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      const float* pixel = result.image.pixel(x, y);
      EXPECT_NEAR(2 * (x + 0.5) / 8, pixel[channel(result.image, "UV.U")], 1e-6);
      EXPECT_NEAR(3 * (1 - (y + 0.5) / 8), pixel[channel(result.image, "UV.V")], 1e-6);
    }
}

// Vectors of the hash's public reference implementation.
TEST(Layers, HashIsMurmur3) {
  EXPECT_EQ(0u, murmur3(""));
  EXPECT_EQ(0x248bfa47u, murmur3("hello"));
  EXPECT_EQ(0x149bbb7fu, murmur3("hello, world"));
  EXPECT_EQ(0x2e4ff723u, murmur3("The quick brown fox jumps over the lazy dog"));
  for (int i = 0; i < 10000; ++i) EXPECT_TRUE(std::isnormal(cryptomatte_id("object " + std::to_string(i))));
}

// ---- relighting

void expect_relit(const ReadImage& layers, const Relighting& relighting, const Image& anew,
                  const std::string& what) {
  const Image relit = relight(layers, relighting).image;
  for (int y = 0; y < anew.height; ++y)
    for (int x = 0; x < anew.width; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        // Layers are whole multiples of the old pixel's last place: what is left of a bright pixel has its
        // rounding.
        const double rounding = 1e-6 * layers.image.pixel(x, y)[c];
        ASSERT_NEAR(anew.pixel(x, y)[c], relit.pixel(x, y)[c], 1e-5 * anew.pixel(x, y)[c] + rounding) << what;
      }
}

TEST(Relight, EqualsANewRender) {
  for (unsigned seed = 100; seed < 130; ++seed) {
    const std::string yaml =
        "lambent: 1\ncamera: {eye: [0, 1, 5], target: [0, 0.5, 0]}\nimage: {size: [40, 30], samples: 4}\n"
        "integrator: {whitted: {max_depth: 5}}\nbackground: [0.1, 0.2, 0.3]\n"
        "materials: [{name: red, ambient: 0.1, diffuse: [0.8, 0.1, 0.1], specular: 0.5, reflect: 0.4},"
        "{name: glass, diffuse: 0, transmit: 0.8, reflect: 0.1}]\n"
        "objects: [{sphere: {center: [0, 0.6, 0], radius: 0.6}, material: red}, {plane: {point: [0, 0, 0], "
        "normal: [0, 1, 0]}, material: red},"
        "{sphere: {center: [1, 0.5, 1], radius: 0.5}, material: glass}]\nlights:\n"
        "  - {name: key, point: {position: [3, 4, 4], intensity: 8}}\n"
        "  - {name: fill light, directional: {direction: [1, -1, -1], intensity: 0.3}}\n";
    std::mt19937 random(seed);
    const auto factor = [&] { return std::uniform_real_distribution<double>(0, 2)(random); };
    const double key = factor();
    const std::array<double, 3> fill{factor(), factor(), factor()};
    const RenderResult layered = render_with_layers(yaml);
    const Image anew = render(parse_scene(yaml, "scene",
                                          {{{"lights.key.point.intensity", std::to_string(8 * key)},
                                            {"lights.fill light.directional.color",
                                             "[" + std::to_string(fill[0]) + "," + std::to_string(fill[1]) +
                                                 "," + std::to_string(fill[2]) + "]"}}}))
                           .image;
    Relighting relighting;
    relighting.lights = {{"key", {key, key, key}}, {"fill light", fill}};
    ASSERT_NO_FATAL_FAILURE(expect_relit({layered.image, layered.metadata}, relighting, anew, "lights"));
  }
}

TEST(Relight, ChangesAMaterialWhereTheEyeSeesIt) {
  const auto yaml = [](const std::string& diffuse) {
    return "lambent: 1\ncamera: {eye: [0, 1, 5], target: [0, 0.5, 0]}\nimage: {size: [40, 30]}\n"
           "materials: [{name: red, diffuse: " +
           diffuse +
           ", specular: 0.2}, {name: floor, diffuse: 0.5}]\n"
           "objects: [{sphere: {center: [0, 0.6, 0], radius: 0.6}, material: red}, {plane: {point: [0, 0, "
           "0], normal: [0, 1, 0]}, material: "
           "floor}]\n"
           "lights: [{name: key, point: {position: [3, 4, 4], intensity: 8}}]\n";
  };
  const RenderResult layered = render_with_layers(yaml("[0.8, 0.1, 0.1]"));
  Relighting relighting;
  relighting.materials = {{"red.diffuse", {0.5, 2, 4}}};
  expect_relit({layered.image, layered.metadata}, relighting,
               render(parse_scene(yaml("[0.4, 0.2, 0.4]"))).image, "Kd");
  EXPECT_EQ(0u, relight({layered.image, layered.metadata}, relighting).mixed_pixels)
      << "one sample, one material";
}

TEST(Relight, RefusesWhatIsNotThere) {
  const RenderResult layered = render_with_layers(test::random_scene(5, 8, 8, "1"));
  const ReadImage layers{layered.image, layered.metadata};
  Relighting relighting;
  relighting.lights = {{"sun", {1, 1, 1}}};
  EXPECT_THROW(relight(layers, relighting), InputError);
  relighting = {};
  relighting.terms = {{"shine", {1, 1, 1}}};
  EXPECT_THROW(relight(layers, relighting), InputError);
  relighting = {};
  relighting.materials = {{"m0", {1, 1, 1}}};
  EXPECT_THROW(relight(layers, relighting), InputError);
  EXPECT_THROW(relight({render(parse_scene(test::random_scene(5, 8, 8, "1"))).image, {}}, {}), InputError);
}

}  // namespace
}  // namespace lambent
