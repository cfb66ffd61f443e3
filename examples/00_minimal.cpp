// The smallest program that makes a picture: describe a scene, render it, write it down.

#include <lambent/lambent.h>

#include <iostream>

// A scene file's text: here one sphere under one lamp, seen by one camera. It could as well be a file, see
// load_scene().
constexpr const char* text = R"(
lambent: 1
camera: {eye: [0, 0, 4], target: [0, 0, 0], fov: 40}
image: {size: [320, 240], samples: 4}
illumination: {model: phong}
lights:
  - {point: {position: [2, 3, 4], color: [1, 1, 1], intensity: 5}}
materials:
  - {name: red, ambient: [0.1, 0.02, 0.02], diffuse: [0.8, 0.1, 0.1], specular: 0.5, shininess: 32}
objects:
  - {sphere: {center: [0, 0, 0], radius: 1}, material: red}
)";

int main() {
  try {
    // Read the scene. The name stands for the file in messages.
    const lambent::ScenePtr scene = lambent::parse_scene(text, "00_minimal.yaml");

    // Render it, on all processors. The same scene gives the same bits, however many there are.
    const lambent::RenderResult result = lambent::render(scene);

    // Write it: the file's ending says how. A PNG for the eye, an EXR with the linear numbers as they are.
    // The metadata are the settings that made the picture; they travel in the file.
    lambent::write_image("00_minimal.png", result.image, result.metadata);
    lambent::write_image("00_minimal.exr", result.image, result.metadata);

    // Look at one pixel: linear red, green and blue, row 0 at the top.
    const int x = result.image.width / 2;
    const int y = result.image.height / 2;
    const float* color = result.image.pixel(x, y);
    std::cout << "The pixel in the middle, (" << x << ", " << y << "), is " << color[0] << ' ' << color[1]
              << ' ' << color[2] << '\n';
    return 0;
  } catch (const lambent::InputError& error) {
    // The scene is wrong. Each diagnostic says what, where, and the nearest remedy; all of them come at once.
    for (const lambent::Diagnostic& diagnostic : error.diagnostics())
      std::cerr << to_string(diagnostic) << '\n';
    return 2;
  } catch (const std::exception& error) {
    // The scene is right, and still it could not be done: a full disk, say.
    std::cerr << error.what() << '\n';
    return 1;
  }
}
