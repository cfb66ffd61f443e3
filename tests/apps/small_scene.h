#pragma once
// What the tests of the program render: small, and different in every pixel.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "run_program.h"

namespace lambent::test {

inline const std::string small_scene =
    "lambent: 1\n"
    "camera: {eye: [0, 1, 5], target: [0, 0.5, 0], fov: 40}\n"
    "image: {size: [8, 6], samples: 1}\n"
    "lights:\n"
    "  - {name: key, point: {position: [3, 4, 4], color: [1, 1, 1], intensity: 2}}\n"
    "materials:\n"
    "  - {name: red, diffuse: [0.8, 0.1, 0.1], specular: 0.5, shininess: 32, reflect: 0.2}\n"
    "objects:\n"
    "  - {sphere: {center: [0, 0.6, 0], radius: 0.6}, material: red}\n"
    "  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: red}\n";

/// One triangle, as a model file.
inline const std::string small_model = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A folder with scene.yaml in it, and a picture that must survive what goes wrong.
class SceneFolder : public ::testing::Test {
 protected:
  SceneFolder() {
    write_text(folder.file("scene.yaml"), small_scene);
    write_text(folder.file("old.png"), "precious");
  }
  /// `lambent COMMAND WORDS ...` there.
  ProgramResult run(const std::string& command, std::vector<std::string> words) const {
    words.insert(words.begin(), command);
    return run_program(words, folder.path());
  }
  bool old_is_untouched() const { return read_text(folder.file("old.png")) == "precious"; }
  std::size_t files() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++count;
    return count;
  }
  TemporaryDirectory folder;
};

}  // namespace lambent::test
