#pragma once
// Pictures of other renderers beside ours, and where the two may be compared: away from silhouettes and the
// edges of shadows, where a hair decides what a ray meets.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "lambent/lambent.h"
#include "peers/conformance.h"
#include "run_program.h"
#include "support.h"

namespace lambent::test {

/// Where a program is on PATH, or nothing.
inline std::optional<std::string> program_on_path(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((folder + "/" + name).c_str(), X_OK) == 0) return folder + "/" + name;
  return {};
}

/// The command that stands in an exported file's comment, "... PROGRAM THIS.xyz ARGUMENTS", for the file
/// called `stem`.
inline std::string command_in(const std::string& text, const std::string& program, const std::string& stem) {
  const std::size_t begin = text.find("   " + program + " THIS.");
  if (begin == std::string::npos)
    throw std::runtime_error("the exported file does not say how it is rendered");
  std::string command = text.substr(begin + 3, text.find('\n', begin) - begin - 3);
  for (std::size_t at; (at = command.find("THIS")) != std::string::npos;) command.replace(at, 4, stem);
  return command;
}

/// The part of what a program says that begins with `name` and ends with the line or with two blanks:
/// "POV-Ray 3.7.0.10".
inline std::string version_in(const std::string& said, const std::string& name) {
  const std::size_t begin = said.find(name);
  if (begin == std::string::npos) return name;
  return said.substr(begin, std::min(said.find('\n', begin), said.find("  ", begin)) - begin);
}

/// Each pixel of a picture, yes or no.
struct PixelMask {
  int width = 0, height = 0;
  std::vector<bool> yes;
  bool at(int x, int y) const { return yes[std::size_t(y) * width + std::size_t(x)]; }
};

/// The pixels whose neighbours all are like them. like(x, y, x2, y2).
template <class Like> void keep_where_alike(PixelMask& mask, const Like& like) {
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const int x2 = x + dx, y2 = y + dy;
          if (x2 < 0 || y2 < 0 || x2 >= mask.width || y2 >= mask.height || !like(x, y, x2, y2))
            mask.yes[std::size_t(y) * mask.width + std::size_t(x)] = false;
        }
}

/// Where a picture of this scene is smooth: one thing seen, directly or in mirrors, without a jump in depth,
/// and in the same lights' shadows as the pixels around it. `set` goes on top of the scene.
inline PixelMask smooth_pixels(const std::string& yaml, const LoadOptions& set) {
  const auto picture = [&](std::vector<std::pair<std::string, std::string>> more) {
    LoadOptions options = set;
    options.set.insert(options.set.end(), more.begin(), more.end());
    return render(parse_scene(yaml, "scene", options)).image;
  };
  const SceneSummary summary = summarize(parse_scene(yaml, "scene", set));
  const auto intensity = [&](std::size_t light) {
    return "lights." + std::to_string(light) + "." + summary.lights[light].kind + ".intensity";
  };
  PixelMask mask{summary.width, summary.height, {}};
  mask.yes.assign(std::size_t(mask.width) * mask.height, true);
  const auto same_pixel = [](const Image& image, int x, int y, int x2, int y2) {
    for (int c = 0; c < 3; ++c)
      if (std::fabs(image.pixel(x, y)[c] - image.pixel(x2, y2)[c]) > 1e-6) return false;
    return true;
  };

  // What is seen: each material shines in a colour of its own, and nothing else does.
  std::vector<std::pair<std::string, std::string>> ids{{"background", "[0.9, 0.05, 0.4]"}}, depths;
  for (std::size_t l = 0; l < summary.lights.size(); ++l) ids.push_back({intensity(l), "0"});
  depths = ids;
  for (std::size_t m = 0; m < summary.materials.size(); ++m) {
    const std::string at = "materials." + std::to_string(m) + ".";
    const double k = double(m + 1);
    ids.push_back({at + "emission",
                   fmt::format("[{}, {}, {}]", 0.1 * k, std::fmod(0.37 * k, 1), std::fmod(0.71 * k, 1))});
    for (const char* term : {"ambient", "diffuse"}) ids.push_back({at + term, "0"});
    ids.push_back({at + "model", "conventional"}), depths.push_back({at + "model", "conventional"});
    depths.push_back({at + "ambient", "1"});
    for (const char* term : {"reflect", "transmit", "emission"}) depths.push_back({at + term, "0"});
  }
  const Image seen = picture(ids);
  keep_where_alike(mask, [&](int x, int y, int x2, int y2) { return same_pixel(seen, x, y, x2, y2); });

  // How far away: an ambient term of 1/R. A neighbour across a jump is 5 % nearer or farther.
  depths.push_back({"illumination.ambient", "1"}),
      depths.push_back({"illumination.ambient_attenuation", "1/R"});
  const Image depth = picture(depths);
  keep_where_alike(mask, [&](int x, int y, int x2, int y2) {
    const double a = depth.pixel(x, y)[0], b = depth.pixel(x2, y2)[0];
    return std::fabs(a - b) <= 0.05 * std::fmax(a, b);
  });

  // In whose shadow: light by light, with shadows and without.
  for (std::size_t l = 0; l < summary.lights.size(); ++l) {
    std::vector<std::pair<std::string, std::string>> alone{{"illumination.ambient", "0"}};
    for (std::size_t other = 0; other < summary.lights.size(); ++other)
      if (other != l) alone.push_back({intensity(other), "0"});
    const Image shaded = picture(alone);
    alone.push_back({"integrator.whitted.shadows", "false"});
    const Image bare = picture(alone);
    const auto in_shadow = [&](int x, int y) {
      for (int c = 0; c < 3; ++c)
        if (shaded.pixel(x, y)[c] != bare.pixel(x, y)[c]) return true;
      return false;
    };
    keep_where_alike(mask,
                     [&](int x, int y, int x2, int y2) { return in_shadow(x, y) == in_shadow(x2, y2); });
  }
  return mask;
}

/// How far apart two pictures are where the mask says yes. `theirs(x, y)` gives three values, up to 1, for
/// our pixel; null where they have none.
struct Apart {
  int compared = 0;
  double largest = 0;
  int x = 0, y = 0;
  double darkest = 1, brightest = 0;  ///< Of what was compared.
};
template <class Theirs> Apart how_far_apart(const Image& ours, const PixelMask& mask, const Theirs& theirs) {
  Apart apart;
  for (int y = 0; y < ours.height; ++y)
    for (int x = 0; x < ours.width; ++x) {
      const float* const other = theirs(x, y);
      if (!mask.at(x, y) || other == nullptr) continue;
      ++apart.compared;
      for (int c = 0; c < 3; ++c) {
        const double value = std::fmin(ours.pixel(x, y)[c], 1), difference = std::fabs(value - other[c]);
        apart.darkest = std::fmin(apart.darkest, value), apart.brightest = std::fmax(apart.brightest, value);
        if (difference > apart.largest) apart.largest = difference, apart.x = x, apart.y = y;
      }
    }
  return apart;
}

/// A scene that is compared.
struct Compared {
  const char* name;  ///< Of the test.
  const char* what;  ///< For people.
  const char* yaml;
};
/// Exports a scene into `folder` as scene.ENDING and renders it there with the command that the file names.
/// Remarks of the export fail the test, but for those that hold one of `expected`.
inline ProgramResult render_exported(const ScenePtr& scene, ExportFormat format, const std::string& program,
                                     const std::string& ending, const std::string& arguments,
                                     const std::vector<std::string>& expected,
                                     const TemporaryDirectory& folder) {
  std::vector<Diagnostic> remarks;
  const std::string text = export_scene(scene, format, remarks);
  for (const Diagnostic& remark : remarks)
    if (std::none_of(expected.begin(), expected.end(),
                     [&](const std::string& part) { return remark.message.find(part) != std::string::npos; }))
      ADD_FAILURE() << to_string(remark);
  write_text(folder.file("scene." + ending), text);
  return RunningProgram({"/bin/sh", "-c", command_in(text, program, "scene") + arguments}, folder.path())
      .wait();
}

/// Whether enough of a picture was compared, and enough was in it.
inline void expect_telling(const Apart& apart, const Image& ours) {
  EXPECT_GT(apart.compared, ours.width * ours.height / 2);
  EXPECT_GT(apart.brightest - apart.darkest, 0.3);
}

inline void PrintTo(const Compared& one, std::ostream* out) { *out << one.name; }

}  // namespace lambent::test
