// Open Image Denoise is a network: what it answers is its affair. What we hand it, and what comes of that, is
// ours.

#include "lambent/denoise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>

#include "apps/small_scene.h"
#include "lambent/lambent.h"

namespace lambent::test {
namespace {

/// Tests that need the library look for it as the program does.
class Denoising : public SceneFolder {
 protected:
  void SetUp() override {
    try {
      denoiser.emplace(2);
    } catch (const InputError& error) {
      GTEST_SKIP() << error.what() << "\nset LAMBENT_OIDN to the library's file to run this test";
    }
  }
  std::optional<Denoiser> denoiser;
};

Image picture_of(int width, int height, const std::vector<std::string>& channels,
                 const std::function<float(int x, int y, int channel)>& value) {
  Image image;
  image.width = width, image.height = height, image.channels = channels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < int(channels.size()); ++c) image.data.push_back(value(x, y, c));
  return image;
}
double error_of(const Image& a, const Image& b) { return compare_images(a, b).root_mean_square; }

TEST_F(Denoising, LeavesAnEvenPictureAsItIs) {
  // Brighter than 1, too: the picture is light, not a screen's.
  for (const float bright : {0.1f, 1.0f, 50.0f}) {
    const float color[] = {0.5f * bright, 1.0f * bright, 0.2f * bright};
    const Image even = picture_of(64, 48, {"R", "G", "B"}, [&](int, int, int c) { return color[c]; });
    const Image denoised = denoiser->denoise(even);
    // At the picture's borders a network guesses: a corner pixel is a third off. But scale, encoding and
    // channels stay.
    constexpr int border = 16;
    for (int y = border; y < even.height - border; ++y)
      for (int x = border; x < even.width - border; ++x)
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(denoised.pixel(x, y)[c], color[c], 0.01 * color[c]);
  }
}

TEST_F(Denoising, BringsACornellBoxNearerToTheTruth) {
  // Without the lamp itself: few samples of its bright edge are off, too, but that is no noise.
  const auto rendered = [](const char* samples) {
    RenderOptions options;
    options.guides = true;
    return render(load_scene(LAMBENT_SOURCE_DIR "/scenes/cornell.yaml",
                             {{{"image.size", "[64, 64]"},
                               {"image.samples", samples},
                               {"lights.ceiling.rectangle.visible", "false"}}}),
                  options);
  };
  const RenderResult noisy = rendered("4");
  const Image truth = rendered("128").image;
  EXPECT_LT(error_of(denoiser->denoise(noisy.image, noisy.guides), truth), 0.5 * error_of(noisy.image, truth))
      << "four times as many samples would do as much";
}

TEST_F(Denoising, IsGuidedByAlbedoAndByNormals) {
  // Tiles that differ by less than the noise: nobody can see them, unless told.
  constexpr int size = 96;
  const auto tile = [](int x, int y) { return (x / 6 + y / 6) % 2; };
  std::mt19937 random(1);
  const auto noise = [&random] { return 0.2f + 1.6f * float(random()) * 0x1p-32f; };
  const std::vector<std::string> names{"albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z"};
  const Image truth = picture_of(size, size, {"R", "G", "B"},
                                 [&](int x, int y, int) { return 0.4f + 0.1f * tile(x, y); }),
              noisy = picture_of(size, size, {"R", "G", "B"},
                                 [&](int x, int y, int) { return (0.4f + 0.1f * tile(x, y)) * noise(); }),
              albedo = picture_of(size, size, names,
                                  [&](int x, int y, int c) {
                                    return c < 3 ? 0.4f + 0.1f * tile(x, y) : c == 5 ? 1.0f : 0.0f;
                                  }),
              normals = picture_of(size, size, names, [&](int x, int y, int c) {
                return c < 3 ? 0.5f : c == 3 ? 0.0f : (c == 4) == (tile(x, y) == 0) ? 0.8f : 0.6f;
              });
  const double alone = error_of(denoiser->denoise(noisy), truth);
  EXPECT_LT(error_of(denoiser->denoise(noisy, albedo), truth), 0.7 * alone);
  EXPECT_LT(error_of(denoiser->denoise(noisy, normals), truth), alone);
}

TEST_F(Denoising, SaysWhatItIsNotGiven) {
  const auto message = [&](const Image& picture, const Image& guides) -> std::string {
    try {
      denoiser->denoise(picture, guides);
    } catch (const InputError& error) {
      return error.diagnostics()[0].message;
    }
    return "";
  };
  const auto zero = [](int, int, int) { return 0.0f; };
  const Image picture = picture_of(4, 3, {"R", "G", "B"}, zero);
  EXPECT_EQ(message(picture_of(4, 3, {"Y"}, zero), {}), "to be denoised, a picture needs the channel R");
  EXPECT_EQ(message(picture, picture), "to be denoised, a picture needs the channel albedo.R");
  EXPECT_EQ(message(picture, picture_of(3, 4, {"albedo.R"}, zero)),
            "the guides of a denoiser must have the picture's size");
}

TEST_F(Denoising, OfTheProgramLeavesWhatWasRenderedInTheEXR) {
  const std::vector<std::string> scene{"scene.yaml", "--integrator", "path", "--size",
                                       "32x24",      "--samples",    "4",    "-q"};
  const auto render_to = [&](std::vector<std::string> words) {
    words.insert(words.begin(), scene.begin(), scene.end());
    const ProgramResult result = run("render", words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  };
  render_to({"--layers", "-o", "plain.exr"});
  render_to({"--layers", "--denoise", "-o", "both.exr", "-o", "shown.png", "--bits", "16"});
  const ReadImage plain = read_image(folder.file("plain.exr")), both = read_image(folder.file("both.exr"));
  const Image shown = read_image(folder.file("shown.png")).image;
  const auto values = [](const Image& image, const std::string& name) {
    const auto at = std::find(image.channels.begin(), image.channels.end(), name);
    EXPECT_NE(at, image.channels.end()) << name;
    std::vector<float> result;
    for (std::size_t i = std::size_t(at - image.channels.begin()); i < image.data.size();
         i += image.channels.size())
      result.push_back(image.data[i]);
    return result;
  };
  for (const std::string& name : plain.image.channels)
    EXPECT_EQ(values(plain.image, name), values(both.image, name)) << name;
  EXPECT_EQ(both.image.channels.size(), plain.image.channels.size() + 3);
  for (const char* name : {"R", "G", "B"}) {
    const std::vector<float> denoised = values(both.image, std::string("denoised.") + name),
                             coded = values(shown, name);
    EXPECT_NE(denoised, values(both.image, name));
    for (std::size_t i = 0; i < coded.size(); ++i)
      ASSERT_NEAR(coded[i], std::clamp(denoised[i], 0.0f, 1.0f),
                  2.4 * 0.5 / 65535);  // half a step of 16 bits
  }
  const auto remark = std::find_if(both.metadata.begin(), both.metadata.end(),
                                   [](const auto& entry) { return entry.first == "lambent:denoised"; });
  ASSERT_NE(remark, both.metadata.end());
  EXPECT_EQ(remark->second, "Open Image Denoise " + denoiser->version());
}

// ---- without the library

class DenoisingWithoutLibrary : public SceneFolder {
 protected:
  ProgramResult denoise_with(const std::string& library) const {
    return run_shell("LAMBENT_OIDN=" + library + " \"$LAMBENT\" render scene.yaml --denoise -o old.png",
                     folder.path());
  }
};

TEST_F(DenoisingWithoutLibrary, SaysSoBeforeTheWorkBegins) {
  const ProgramResult result = denoise_with("no/such/library.so");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err.find("error: cannot load Open Image Denoise: no/such/library.so"), 0u) << result.err;
  EXPECT_NE(result.err.find("hint: LAMBENT_OIDN is to name its library"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find('%'), std::string::npos) << "it had begun to render";
  EXPECT_TRUE(old_is_untouched());
}

TEST_F(DenoisingWithoutLibrary, AnotherLibraryIsRefused) {
  const ProgramResult result = denoise_with("libm.so.6");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err.find("error: 'libm.so.6' is not a version of Open Image Denoise that we know"), 0u)
      << result.err;
  EXPECT_TRUE(old_is_untouched());
}

TEST_F(DenoisingWithoutLibrary, EverythingElseWorks) {
  const ProgramResult result = run_shell(
      "LAMBENT_OIDN=no/such/library.so \"$LAMBENT\" render scene.yaml -q -o new.png", folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(DenoisingWithoutLibrary, AViewIsRefused) {
  EXPECT_EQ(run("render", {"scene.yaml", "--view", "normals", "--denoise", "-o", "old.png"}).exit_code, 2);
  EXPECT_TRUE(old_is_untouched());
}

}  // namespace
}  // namespace lambent::test
