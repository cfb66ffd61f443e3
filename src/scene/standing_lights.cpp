#include "scene/standing_lights.h"

namespace lambent {
namespace {

Primitives primitives_of(const LightBody& body) {
  switch (body.kind) {
    case LightBody::Kind::sphere:
      return std::vector<Sphere>{{body.center, body.radius}};
    case LightBody::Kind::disc:
      return std::vector<Disc>{{body.center, body.normal, body.radius}};
    case LightBody::Kind::parallelogram:
      break;
  }
  Mesh mesh;
  for (const auto& [u, v] : {Vec2<double>{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
    mesh.vertices.push_back(cast<float>(body.center + u * body.u + v * body.v));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

}  // namespace

std::vector<StandingLight> standing_lights(const Scene& scene) {
  std::vector<StandingLight> result;
  if (scene.integrator == Integrator::ambient_occlusion) return result;  // it shows surfaces alone
  for (std::size_t l = 0; l < scene.lights.size(); ++l)
    with_light(scene.lights[l].light, [&]<class L>(const L& light) {
      if constexpr (HasExtent<L>) {
        if (!light.visible) return;
        const LightBody body = body_of(light);
        Material material;
        material.name = scene.lights[l].name;
        material.place = scene.lights[l].place;
        material.ambient = material.diffuse = material.specular = Rgb{};
        material.emission = radiance(light);
        material.model = ModelId::phong;  // under which black stays black
        result.push_back(
            {std::uint32_t(l), {L::info.name, primitives_of(body), {}}, material, body.two_sided});
      }
    });
  return result;
}

}  // namespace lambent
