#pragma once
// Scenes of every kind, by chance: for properties that must hold for all of them.

#include <fmt/format.h>

#include <random>
#include <string>

namespace lambent::test {

/// YAML of a small scene with every kind of light, shape, model and material now and then. `samples` as in
/// image.samples.
inline std::string random_scene(unsigned seed, int width, int height, const std::string& samples) {
  std::mt19937 random(seed);
  const auto number = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  const auto chance = [&](double share) { return number(0, 1) < share; };
  const auto point = [&](double reach) {
    return fmt::format("[{:.3f}, {:.3f}, {:.3f}]", number(-reach, reach), number(-reach, reach),
                       number(-reach, reach));
  };
  const auto color = [&](double most) {
    return fmt::format("[{:.3f}, {:.3f}, {:.3f}]", number(0, most), number(0, most), number(0, most));
  };
  const char* models[] = {"conventional", "attenuated", "phong",  "blinn_phong", "blinn_phong_halfway",
                          "mtl",          "opengl",     "povray", "tachyon"};
  const auto model = [&] { return models[std::uniform_int_distribution<int>(0, 8)(random)]; };

  std::string text = fmt::format(
      "lambent: 1\ncamera: {{eye: [{:.3f}, {:.3f}, 6], target: [0, 0, 0], fov: 40}}\n"
      "image: {{size: [{}, {}], samples: {}, pattern: {}}}\n"
      "illumination: {{model: {}, ambient: {}{}}}\n"
      "integrator: {{whitted: {{max_depth: {}, colored_shadows: {}}}}}\nbackground: {}\nlights:\n",
      number(-1, 1), number(-1, 1), width, height, samples, chance(0.1) ? "corners" : "stratified", model(),
      color(1), chance(0.3) ? ", ambient_occlusion: {rays: 2, distance: 3}" : "",
      std::uniform_int_distribution<int>(1, 6)(random), chance(0.7), color(0.5));
  const int lights = std::uniform_int_distribution<int>(1, 4)(random);
  for (int i = 0; i < lights; ++i) {
    if (chance(0.5))
      text += fmt::format(
          "  - {{name: \"l {}\", point: {{position: {}, color: {}, intensity: {:.3f}, max_distance: {}}}}}\n",
          i, point(5), color(1), number(0, 6), chance(0.2) ? "4" : "0");
    else if (chance(0.3))
      text +=
          chance(0.4)
              ? fmt::format(
                    "  - {{name: l{}, rectangle: {{center: {}, u: [{:.3f}, 0, 1], v: [0, {:.3f}, 1], color: "
                    "{}, intensity: 4, samples: {}, two_sided: {}}}}}\n",
                    i, point(4), number(0.1, 2), number(0.1, 2), color(1),
                    std::uniform_int_distribution<int>(1, 5)(random), chance(0.5))
          : chance(0.5)
              ? fmt::format(
                    "  - {{name: l{}, disc: {{center: {}, normal: {}, radius: {:.3f}, intensity: 5, samples: "
                    "{}, visible: {}}}}}\n",
                    i, point(4), point(1), number(0.1, 1), std::uniform_int_distribution<int>(1, 5)(random),
                    chance(0.7))
              : fmt::format(
                    "  - {{name: l{}, sphere: {{center: {}, radius: {:.3f}, intensity: 5, samples: {}}}}}\n",
                    i, point(4), number(0.1, 1), std::uniform_int_distribution<int>(1, 5)(random));
    else if (chance(0.5))
      text += fmt::format(
          "  - {{name: l{}, spot: {{position: {}, target: {}, angle: {:.1f}, exponent: 2, intensity: 5}}}}\n",
          i, point(5), point(1), number(10, 120));
    else
      text += fmt::format("  - {{name: l{}, directional: {{direction: {}, color: {}}}}}\n", i, point(1),
                          color(1));
  }
  text += "materials:\n";
  const int materials = 4;
  for (int i = 0; i < materials; ++i) {
    if (chance(0.15)) {
      text += fmt::format(
          "  - {{name: m{}, model: {}, opacity: {:.2f}, one_sided: {}, metallic_roughness: {{base_color: {}, "
          "metallic: {:.2f}, roughness: {:.2f}, transmission: {}, clearcoat: {}}}}}\n",
          i, model(), chance(0.5) ? 1.0 : number(0, 1), chance(0.3), color(1), number(0, 1), number(0, 1),
          chance(0.3) ? "0.6" : "0", chance(0.3) ? "0.8" : "0");
      continue;
    }
    text += fmt::format(
        "  - {{name: m{}, model: {}, ambient: {}, diffuse: {}, specular: {}, shininess: {:.2f}, reflect: {}, "
        "transmit: {}, "
        "ior: {:.2f}, emission: {}, opacity: {:.2f}, one_sided: {}}}\n",
        i, model(), color(0.3), color(1), color(1), number(1, 100), chance(0.4) ? color(0.6) : "0",
        chance(0.3) ? color(0.9) : "0", number(1, 2), chance(0.2) ? color(0.5) : "0",
        chance(0.8) ? 1.0 : number(0, 1), chance(0.1));
  }
  text += "objects:\n";
  const auto material = [&] { return std::uniform_int_distribution<int>(0, materials - 1)(random); };
  const int objects = std::uniform_int_distribution<int>(2, 8)(random);
  for (int i = 0; i < objects; ++i) {
    std::string shape;
    switch (std::uniform_int_distribution<int>(0, 5)(random)) {
      case 0:
      case 1:
        shape = fmt::format("sphere: {{center: {}, radius: {:.3f}}}", point(2), number(0.2, 1));
        break;
      case 2:
        shape = fmt::format("plane: {{point: [0, {:.3f}, 0], normal: [{:.3f}, 1, 0.1]}}", number(-3, -1),
                            number(-0.2, 0.2));
        break;
      case 3:
        shape = fmt::format("cylinder: {{from: {}, to: {}, radius: {:.3f}, capped: true}}", point(2),
                            point(2), number(0.1, 0.6));
        break;
      case 4:
        shape = fmt::format("disc: {{center: {}, normal: {}, radius: {:.3f}}}", point(2), point(1),
                            number(0.3, 1.5));
        break;
      default:
        shape =
            fmt::format("mesh: {{vertices: [{}, {}, {}, {}], triangles: [[0, 1, 2], [0, 2, 3], [0, 3, 1]]}}",
                        point(2), point(2), point(2), point(2));
    }
    text += fmt::format("  - {{{}, material: m{}}}\n", shape, material());
  }
  return text;
}

}  // namespace lambent::test
