#pragma once
// A scene that says everything that a scene file can say.

namespace lambent::test {

inline constexpr const char* sample_scene = R"(# every feature
lambent: 1
camera:
  projection: perspective
  eye: [0, 1.4, 5]
  target: [0, 0.6, 0]
  up: [0, 1, 0]
  fov: 40
image:
  size: [64, 48]
  samples: 4
  filter: tent
  pattern: stratified
  encoding: none
illumination:
  model: phong
  attenuation: {constant: 1, linear: 0.5, quadratic: 0.25}
  ambient: [0.2, 0.2, 0.2]
  ambient_attenuation: 1/R
  minimum_distance: 0.01
integrator:
  whitted:
    max_depth: 4
    shadows: true
    colored_shadows: false
background: "#203040"
lights:
  - name: key
    point:
      position: [3, 4, 4]
      color: [1, 1, 1]
      intensity: 8
  - directional:
      direction: [0, -1, -1]
      color: 0.5
      intensity: 0.5
  - name: lamp
    spot:
      position: [0, 5, 0]
      target: [0, 0, 0]
      color: "#ffeecc"
      intensity: 2
      angle: 60
      softness: 0.3
      exponent: 1
materials:
  - name: red
    model: blinn_phong
    ambient: [0.1, 0.02, 0.02]
    diffuse: [0.8, 0.1, 0.1]
    specular: 0.5
    shininess: 32
    reflect: 0.2
    transmit: 0.1
    ior: 1.3
    emission: 0
  - name: floor
    diffuse: 0.5
objects:
  - name: ball
    sphere:
      center: [0, 0.6, 0]
      radius: 0.6
    material: red
    transform:
      - scale: 2
      - scale: [1, 2, 1]
      - rotate:
          axis: y
          degrees: 30
      - rotate:
          axis: [1, 1, 0]
          degrees: -10
      - translate: [1, 0, 0]
      - matrix: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]
  - plane:
      point: [0, 0, 0]
      normal: [0, 1, 0]
    material: floor
  - plane: {point: [0, 0, -3], normal: [0, 0, 1], size: [4, 2]}
  - disc:
      center: [0, 2, 0]
      normal: [0, 1, 0]
      radius: 1
  - box:
      min: [-1, 0, -1]
      max: [1, 1, 1]
    material: {diffuse: 0.3, model: conventional}
  - cylinder:
      from: [0, 0, 0]
      to: [0, 1, 0]
      radius: 0.5
      capped: true
    transform: {translate: [3, 0, 0]}
  - cone:
      from: [0, 0, 0]
      to: [0, 1, 0]
      radius_from: 0.5
      radius_to: 0
      capped: true
  - polygon:
      vertices: [[0, 0, 0], [2, 0, 0], [2, 2, 0], [1, 0.5, 0]]
  - mesh:
      vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
      triangles: [[0, 1, 2]]
      normals: [[0, 0, 1], [0, 0, 2], [0, 0, 0]]
      uvs: [[0, 0], [1, 0], [0, 1]]
)";

}  // namespace lambent::test
