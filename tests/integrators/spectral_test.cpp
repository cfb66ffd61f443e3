// The spectral integrator: pictures against closed forms and against sums over wavelengths.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "lambent/explain.h"
#include "lambent/lambent.h"
#include "scene/scene.h"

namespace lambent {
namespace {

Image picture(const std::string& yaml, const RenderOptions& options = {}) {
  return render(parse_scene(yaml), options).image;
}
std::size_t channel(const Image& image, const std::string& name) {
  for (std::size_t c = 0; c < image.channels.size(); ++c)
    if (image.channels[c] == name) return c;
  ADD_FAILURE() << "no channel " << name;
  return 0;
}

/// Matt, glossy, mirroring and clear things under a light.
std::string world(const std::string& integrator, const std::string& red, const std::string& image,
                  const std::string& more = "") {
  return fmt::format(R"(
lambent: 1
camera: {{eye: [0, 1.4, 5], target: [0, 0.6, 0], fov: 40}}
image: {{{}}}
illumination: {{model: phong}}
integrator: {{{}: {{{}}}}}
background: 0.3
lights: [{{name: key, point: {{position: [3, 4, 4], intensity: 8}}}}]
materials:
  - {{name: ball, ambient: 0.1, diffuse: {}, specular: 0.5, reflect: 0.25}}
  - {{name: clear, ambient: 0, diffuse: 0.05, transmit: 0.75, ior: 1.25}}
  - {{name: floor, diffuse: 0.6}}
objects:
  - {{sphere: {{center: [0.7, 0.6, 0], radius: 0.6}}, material: ball}}
  - {{sphere: {{center: [-0.7, 0.6, 0.4], radius: 0.5}}, material: clear}}
  - {{plane: {{point: [0, 0, 0], normal: [0, 1, 0]}}, material: floor}}
)",
                     image, integrator, more, red);
}

TEST(Spectral, AGreyWorldStaysGreyAndIsTheOneOfThreeColours) {
  const std::string size = "size: [48, 36], samples: 2";
  const Image colours = picture(world("whitted", "0.5", size));
  for (const char* wavelengths :
       {"wavelengths: 1", "wavelengths: 4", "wavelengths: 12", "wavelengths: [500, 610]"}) {
    const Image spectral = picture(world("spectral", "0.5", size, wavelengths));
    for (std::size_t i = 0; i < spectral.data.size(); ++i)
      ASSERT_NEAR(spectral.data[i], colours.data[i], 1e-5 * colours.data[i])
          << wavelengths << ", value " << i;
  }
}

TEST(Spectral, ColoursComeNearTheOnesOfThree) {
  // One bounce on a colour is what it is in D65; the more wavelengths, the nearer.
  const std::string size = "size: [48, 36]";
  const Image colours = picture(world("whitted", "[0.7, 0.3, 0.1]", size));
  const Image spectral = picture(world("spectral", "[0.7, 0.3, 0.1]", size, "wavelengths: 36"));
  for (std::size_t i = 0; i < spectral.data.size(); ++i) ASSERT_NEAR(spectral.data[i], colours.data[i], 5e-3);
}

TEST(Spectral, WhiteIsWhiteWhateverTheWavelengths) {
  const char* sets[] = {"1", "2", "3", "7", "50", "[560]", "[400, 650]", "[365, 470, 480, 700]"};
  for (const char* set : sets) {
    const Image image = picture(fmt::format(R"(
lambent: 1
camera: {{eye: [0, 0, 5], target: [0, 0, 0], fov: 10}}
image: {{size: [1, 1]}}
illumination: {{model: conventional, ambient: 0}}
integrator: {{spectral: {{wavelengths: {}}}}}
lights: [{{directional: {{direction: [0, 0, -1]}}}}]
objects: [{{plane: {{point: [0, 0, 0], normal: [0, 0, 1]}}, material: {{diffuse: 1}}}}]
)",
                                            set));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.pixel(0, 0)[c], 1, 1e-6) << set;
  }
}

/// A mirror of a metal, seen at `degrees` from its normal, in a white world.
std::string metal_mirror(const std::string& integrator, double degrees, const std::string& material) {
  const double a = degrees * M_PI / 180;
  return fmt::format(R"(
lambent: 1
camera: {{eye: [{}, 0, {}], target: [0, 0, 0], fov: 1}}
image: {{size: [1, 1]}}
illumination: {{ambient: 0}}
integrator: {{{}}}
background: 1
objects: [{{plane: {{point: [0, 0, 0], normal: [0, 0, 1]}}, material: {{{}}}}}]
)",
                     5 * std::sin(a), 5 * std::cos(a), integrator, material);
}

TEST(Spectral, GoldHasTheColourOfItsTable) {
  // Reflected head on in white light: the sum over the tables' wavelengths of ((n - 1)^2 + k^2) / ((n + 1)^2
  // + k^2) times what each adds to sRGB. With more wavelengths the picture comes to it.
  for (const NamedMetal& metal : metals()) {
    const Rgb expected = rgb_of([&](double nm) {
      const double n = at(metal.constants.n, nm), k = at(metal.constants.k, nm);
      return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
    });
    for (const auto& [count, tolerance] : {std::pair{12, 6e-3}, {36, 1e-3}}) {
      const Image image = picture(metal_mirror(fmt::format("spectral: {{wavelengths: {}}}", count), 0,
                                               fmt::format("metal: {}", metal.name)));
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(image.pixel(0, 0)[c], expected[c], tolerance) << metal.name << ", " << count;
    }
  }
}

TEST(Whitted, MetalsOfThreeColoursComeNearTheirSpectra) {
  for (const NamedMetal& metal : metals()) {
    const Image three = picture(metal_mirror("whitted: {}", 0, fmt::format("metal: {}", metal.name)));
    const Rgb expected = rgb_of(
        [&](double nm) { return normal_reflectance(at(metal.constants.n, nm), at(metal.constants.k, nm)); });
    // Gold's red lies outside of sRGB, and beyond what any wavelength reflects.
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(three.pixel(0, 0)[c], std::min(expected[c], 0.98), 0.02) << metal.name;
  }
}

/// What unpolarised light loses to a metal of n + i k, by complex numbers.
double conductor(double cosine, double n, double k) {
  const double s2 = 1 - cosine * cosine, re = n * n - k * k, im = 2 * n * k, x = re - s2,
               size = std::hypot(x, im), qr = std::sqrt((size + x) / 2), qi = std::sqrt((size - x) / 2);
  const double s = ((cosine - qr) * (cosine - qr) + qi * qi) / ((cosine + qr) * (cosine + qr) + qi * qi),
               p = ((re * cosine - qr) * (re * cosine - qr) + (im * cosine - qi) * (im * cosine - qi)) /
                   ((re * cosine + qr) * (re * cosine + qr) + (im * cosine + qi) * (im * cosine + qi));
  return (s + p) / 2;
}

TEST(Spectral, MetalsFollowFresnelAtEveryAngleAndWavelength) {
  // One wavelength is grey: the pixel is the reflectance itself.
  for (const char* name : {"gold", "copper"})
    for (const double degrees : {0.0, 30.0, 60.0, 80.0})
      for (const double nm : {450.0, 550.0, 650.0}) {
        const MetalConstants& metal = std::find_if(metals().begin(), metals().end(), [&](const auto& one) {
                                        return std::string(one.name) == name;
                                      })->constants;
        const Image image = picture(metal_mirror(fmt::format("spectral: {{wavelengths: [{}]}}", nm), degrees,
                                                 fmt::format("metal: {}", name)));
        EXPECT_NEAR(image.pixel(0, 0)[1],
                    conductor(std::cos(degrees * M_PI / 180), at(metal.n, nm), at(metal.k, nm)), 1e-6)
            << name << " at " << degrees << " degrees, " << nm << " nm";
      }
}

TEST(Spectral, GlassReflectsAndLetsThroughAllThereIs) {
  // A pane of no thickness would be one surface: seen from outside, what is mirrored is white and so is what
  // lies behind, and R + (1 - R) = 1. With a black world behind it is R alone.
  const double n = 1.5;
  for (const double degrees : {0.0, 45.0, 56.309932474020215, 80.0}) {
    const auto glass = [&](const std::string& more) {
      return picture(metal_mirror("whitted: {max_depth: 2}", degrees, "glass: {ior: 1.5}" + more))
          .pixel(0, 0)[0];
    };
    const double c = std::cos(degrees * M_PI / 180), beyond = std::sqrt(1 - (1 - c * c) / (n * n)),
                 s = (c - n * beyond) / (c + n * beyond), p = (n * c - beyond) / (n * c + beyond),
                 R = (s * s + p * p) / 2;
    EXPECT_NEAR(glass(""), 1, 1e-6) << degrees;
    EXPECT_NEAR(glass(", transmit: 0"), R, 1e-6) << degrees;
    EXPECT_NEAR(glass(", reflect: 0"), 1 - R, 1e-6) << degrees;
  }
}

TEST(Spectral, APrismBendsEachWavelengthBySnell) {
  // Its edge has 30 degrees, and its first face lies across the view: light enters straight, and leaves at an
  // angle of asin(n sin 30) with the second face's normal, which is 30 degrees more than before. A small disc
  // far behind it, where that leads for one wavelength, is seen at that wavelength and at no other.
  const GlassIndex& glass = std::find_if(glasses().begin(), glasses().end(), [](const auto& one) {
                              return std::string(one.name) == "sf11";
                            })->index;
  const double tan30 = std::tan(M_PI / 6), x = 0.05, depth = x * tan30;
  const double all[] = {400, 500, 600, 700};
  for (const double wanted : all) {
    const double bend = std::asin(index_at(glass, wanted) / 2) - M_PI / 6;
    const Image image = picture(fmt::format(R"(
lambent: 1
camera: {{projection: orthographic, eye: [{0}, 0, 5], target: [{0}, 0, 0], height: 0.0001}}
image: {{size: [1, 1]}}
film: {{layers: true}}
illumination: {{ambient: 1, ambient_attenuation: none}}
integrator: {{spectral: {{wavelengths: [400, 500, 600, 700]}}}}
materials:
  - {{name: prism, glass: sf11, reflect: 0}}
  - {{name: target, ambient: 1, diffuse: 0}}
objects:
  - mesh:
      vertices: [[0, -1, 0], [1, -1, 0], [1, -1, {1}], [0, 1, 0], [1, 1, 0], [1, 1, {1}]]
      triangles: [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5], [3, 4, 5], [0, 2, 1]]
    material: prism
  - {{disc: {{center: [{2}, 0, -10], normal: [0, 0, 1], radius: 0.001}}, material: target}}
)",
                                            x, -tan30, x + (10 - depth) * std::tan(bend)));
    for (const double nm : all) {
      const float value = image.pixel(0, 0)[channel(image, fmt::format("wavelength.{}nm", nm))];
      if (nm == wanted) EXPECT_GT(value, 0.5f) << nm;
      else EXPECT_EQ(value, 0) << nm << " seen where only " << wanted << " should be";
    }
  }
}

std::string colourful(const std::string& more) {
  return R"(
lambent: 1
camera: {eye: [0, 1.4, 5], target: [0, 0.6, 0], fov: 40}
image: {size: [40, 30], samples: 3}
illumination: {model: phong}
integrator: {spectral: {wavelengths: 5}}
background: [0.1, 0.2, 0.4]
lights:
  - {name: key, point: {position: [3, 4, 4], color: {blackbody: 3000}, intensity: 8}}
  - {name: fill, point: {position: [-3, 2, 4], color: {wavelengths: [500, 510, 520], power: [0, 1, 0]}, intensity: 2}}
materials:
  - {name: gold, metal: gold, roughness: 0.3}
  - {name: glass, )" +
         more + R"(}
  - {name: floor, diffuse: {wavelengths: [420, 600, 640], values: [0.2, 0.1, 0.9]}}
objects:
  - {sphere: {center: [0.7, 0.6, 0], radius: 0.6}, material: gold}
  - {sphere: {center: [-0.7, 0.6, 0.4], radius: 0.5}, material: glass}
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: floor}
)";
}

TEST(Spectral, TheSameBitsForThreadsTilesAndInstructionSets) {
  for (const char* material : {"glass: {ior: 1.5}", "glass: sf11"}) {
    const std::string scene = colourful(material);
    const Image expected = picture(scene);
    for (const std::string& isa : available_isas())
      for (const int tile : {1, 7, 64})
        for (const int threads : {1, 3}) {
          RenderOptions options;
          options.isa = isa, options.tile_size = tile, options.threads = threads;
          EXPECT_EQ(picture(scene, options).data, expected.data) << isa << ", tiles of " << tile;
        }
  }
}

TEST(Spectral, LayersAddUpAndWavelengthsToo) {
  for (const char* material : {"glass: {ior: 1.5}", "glass: sf11"}) {
    const std::string scene = colourful(material);
    const Image plain = picture(scene);
    const Image image = picture(scene + "film: {layers: true}\n");
    const auto wavelengths = even_wavelengths(5);
    const WavelengthSet set = wavelength_set(wavelengths);
    const std::size_t first_wavelength = channel(image, "wavelength.411nm");
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        for (std::size_t c = 0; c < 3; ++c) {
          const float* pixel = image.pixel(x, y);
          ASSERT_EQ(pixel[c], plain.pixel(x, y)[c]);
          double sum = 0, of_wavelengths = 0;
          for (std::size_t layer = 3 + c; layer < first_wavelength; layer += 3) sum += pixel[layer];
          ASSERT_EQ(float(sum), pixel[c]) << x << ", " << y;
          for (std::size_t i = 0; i < wavelengths.size(); ++i)
            of_wavelengths += set.weights[i][int(c)] * pixel[first_wavelength + i];
          ASSERT_NEAR(of_wavelengths, pixel[c], 1e-6 + 1e-5 * std::abs(pixel[c]));
        }
  }
}

TEST(Spectral, ALampThatIsSeenShinesInItsOwnSpectrum) {
  // A ball of radius 1 has the radiance Il. At 1500 K its light lies outside of sRGB: less than no blue.
  const Image image = picture(R"(
lambent: 1
camera: {eye: [0, 0, 5], target: [0, 0, 0], fov: 1}
image: {size: [1, 1]}
integrator: {spectral: {wavelengths: 36}}
lights: [{sphere: {center: [0, 0, 0], radius: 1, color: {blackbody: 1500}}}]
)");
  const RelativeLight body{Blackbody{1500}};
  const WavelengthSet set = wavelength_set(even_wavelengths(36));
  Rgb expected{};
  for (std::size_t i = 0; i < set.wavelengths.size(); ++i)
    expected = expected + body.at(set.wavelengths[i]) * set.weights[i];
  EXPECT_LT(expected[2], 0);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.pixel(0, 0)[c], expected[c], 1e-6);
}

TEST(Spectral, AdaptiveSamplesAreTakenAsOfAnyPicture) {
  std::string scene = colourful("glass: sf11");
  scene.replace(scene.find("samples: 3"), 10, "samples: {adaptive: {start: 4, max: 16}}");
  const RenderResult result = render(parse_scene(scene));
  EXPECT_GT(result.stats.samples_per_pixel, 4);
  EXPECT_LT(result.stats.samples_per_pixel, 16);
}

TEST(Spectral, ExplainsEachWavelengthAndAddsUp) {
  for (const char* material : {"glass: {ior: 1.5}", "glass: sf11"}) {
    const auto scene = parse_scene(colourful(material));
    const Image image = render(scene).image;
    for (const auto& [x, y] : {std::pair{26, 16}, {14, 17}, {20, 25}, {3, 2}}) {
      const auto derivation = explain(scene, x, y);
      EXPECT_TRUE(adds_up(derivation)) << x << ", " << y;
      const std::vector<float> pixel = pixel_of(derivation);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(pixel[c], image.pixel(x, y)[c]) << x << ", " << y;
    }
    const std::string page = explanation(explain(scene, 26, 16));
    EXPECT_NE(page.find("Made of 5 wavelengths"), std::string::npos) << page;
    EXPECT_NE(page.find("metal gold: eta "), std::string::npos) << page;
    EXPECT_NE(page.find("411 nm"), std::string::npos) << page;
  }
}

}  // namespace
}  // namespace lambent
