// Path tracing in passes: to a number of samples, for a time, until the noise is low.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "apps/small_scene.h"
#include "integrators/kernels.h"
#include "lambent/lambent.h"
#include "tiles.h"

namespace lambent::test {
namespace {

std::string room(const std::string& path, bool moving = false) {
  return "lambent: 1\ncamera: {eye: [0, 1, 5], target: [0, 0.5, 0], fov: 40}\n"
         "image: {size: [12, 9], samples: 8, shutter_slices: 4}\nintegrator: {path: {max_depth: 3, " +
         path +
         "}}\nbackground: 0.2\n"
         "lights: [{rectangle: {center: [0, 3, 2], u: [1, 0, 0], v: [0, 0, 1], intensity: 4}}]\n"
         "objects:\n"
         "  - {sphere: {center: [0, 0.6, 0], radius: 0.6}, material: {diffuse: [0.8, 0.1, 0.1]}" +
         (moving ? ", motion: {translate: [0.5, 0, 0]}" : "") +
         "}\n"
         "  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: {diffuse: 0.5}}\n";
}
bool same_bits(const Image& a, const Image& b) {
  return a.data.size() == b.data.size() &&
         std::memcmp(a.data.data(), b.data.data(), a.data.size() * sizeof(float)) == 0;
}

struct Passes {
  Image image;
  TileRun run;
  std::vector<int> ends;  ///< Of the first slice's passes.
};
/// With a clock by which every pass takes a second, however many samples it has.
Passes in_passes_of_a_second(const std::string& yaml, double time_limit) {
  const ScenePtr scene = parse_scene(yaml);
  Exposure exposure(*scene);
  Film film(scene->image);
  double seconds = 100;
  TileOptions options;
  options.threads = 2;
  options.time_limit = time_limit;
  options.seconds = [&seconds] { return seconds++; };
  Passes passes;
  passes.run = render_until(exposure, choose_kernel(""), scene->path, scene->image, film, options);
  for (const Portion& portion : passes.run.portions)
    if (portion.slice == 0) passes.ends.push_back(portion.end);
  passes.image = develop(std::move(film), scene->image);
  return passes;
}

TEST(Progressive, GoesOnToTheMostSamples) {
  const RenderResult result = render(parse_scene(room("progressive: true, max_samples: 100")));
  EXPECT_EQ(result.stats.samples_per_pixel, 100);
  // Fewer than the first pass would have.
  EXPECT_EQ(render(parse_scene(room("progressive: true, max_samples: 3"))).stats.samples_per_pixel, 3);
  // Of what moves, each of the four slices gets as many.
  EXPECT_EQ(render(parse_scene(room("progressive: true, max_samples: 99", true))).stats.samples_per_pixel,
            96);
}

// From one sample on, each pass has as many as all before it, as long as that many fit by what a sample took
// last: after k passes k seconds are spent, and a sample took 1 / 2^(k - 2) s. With 10 s the 10th pass may
// have 128, half of what it would, and then the time is spent.
TEST(Progressive, PassesFitTheTime) {
  const Passes passes = in_passes_of_a_second(room("progressive: true"), 10);
  EXPECT_EQ(passes.ends, (std::vector<int>{1, 2, 4, 8, 16, 32, 64, 128, 256, 384}));
  EXPECT_EQ(passes.run.samples, 384);
  EXPECT_FALSE(passes.run.cancelled);
  // Where nothing fits, there is one sample all the same.
  EXPECT_EQ(in_passes_of_a_second(room("progressive: true"), 0.5).ends, (std::vector<int>{1}));
  // Enough samples, or so little noise: whichever comes first.
  EXPECT_EQ(in_passes_of_a_second(room("progressive: true, max_samples: 20"), 10).ends,
            (std::vector<int>{1, 2, 4, 8, 16, 20}));
  const Passes good = in_passes_of_a_second(room("until: 0.9"), 10);
  EXPECT_EQ(good.ends, (std::vector<int>{1, 2, 4, 8})) << "noise is not looked at before image.samples";
}

TEST(SameBits, OfPathsThatATimeHasEnded) {
  for (const bool moving : {false, true})
    for (const double limit : {0.5, 4.0, 6.0}) {
      const Passes timed = in_passes_of_a_second(room("progressive: true", moving), limit);
      const std::string samples = std::to_string(timed.run.samples);
      const RenderResult counted =
          render(parse_scene(room("progressive: true, max_samples: " + samples, moving)));
      EXPECT_EQ(counted.stats.samples_per_pixel, timed.run.samples);
      EXPECT_TRUE(same_bits(counted.image, timed.image))
          << samples << " samples" << (moving ? ", moving" : "");
    }
}

TEST(Progressive, ATimeIsNoLimitWhereSamplesDoNotGoOn) {
  RenderOptions options;
  options.time_limit = 1;
  try {
    render(parse_scene(room("seed: 4")), options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics()[0].message, "a limit in time is for pictures whose samples go on");
  }
}

class Until : public SceneFolder {
 protected:
  /// What the statistics say of "render scene.yaml --samples 4" with these words and the rest.
  nlohmann::json stats_of(std::vector<std::string> words) const {
    words.insert(words.begin(), {"scene.yaml", "--samples", "4", "-q", "--stats", "-"});
    const ProgramResult result = run("render", words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  }
  std::string error_of(const std::string& command, const std::vector<std::string>& words) const {
    const ProgramResult result = run(command, words);
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  }
};

TEST_F(Until, ATimeIsReproducedByTheSamplesThatItTook) {
  const int samples = stats_of({"--until", "1e-3s", "-o", "timed.exr"})["samples_per_pixel"].get<int>();
  ASSERT_GE(samples, 1);
  const auto counted = stats_of({"--until", std::to_string(samples) + "spp", "-o", "counted.exr"});
  EXPECT_EQ(counted["samples_per_pixel"], samples);
  EXPECT_TRUE(
      same_bits(read_image(folder.file("timed.exr")).image, read_image(folder.file("counted.exr")).image));
}

TEST_F(Until, WhicheverComesFirst) {
  EXPECT_EQ(
      stats_of({"--until", "24spp", "--until", "1e-9", "--until", "1h", "-o", "a.exr"})["samples_per_pixel"],
      24);
  const auto stats = stats_of({"--until", "0.5", "--until", "2min", "-o", "a.exr"});
  EXPECT_LE(stats["noise"], 0.5);
}

TEST_F(Until, WrongLimits) {
  for (const char* wrong : {"5x", "0", "2", "1.5spp", "2000000spp", "s", "infs", "nan"})
    EXPECT_EQ(error_of("render", {"scene.yaml", "-o", "old.png", "--until", wrong}),
              std::string("error: --until wants a share of noise, a time or a number of samples, not '") +
                  wrong +
                  "'\n    hint: for example 0.01 (the noise is 1 %), 30s, 5min, 2h, or 256spp (samples per "
                  "pixel)\n");
  EXPECT_TRUE(old_is_untouched());
  EXPECT_EQ(error_of("explain", {"scene.yaml", "--pixel", "1,1", "--until", "1s"})
                .find("error: a time is no limit for 'explain'"),
            0u);
}

}  // namespace
}  // namespace lambent::test
