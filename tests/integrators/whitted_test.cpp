// The whole renderer against closed forms: what a pixel must be, computed beside it by the textbook.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "integrators/kernels.h"
#include "lambent/lambent.h"
#include "math/transform.h"

namespace lambent {
namespace {

using V = Vec3<double>;

Image picture(const std::string& yaml, const RenderOptions& options = {}) {
  return render(parse_scene(yaml), options).image;
}

/// The camera ray through the centre of a pixel, by the definition of docs/scene-format.md.
V pixel_ray(int x, int y, int width, int height, double fov) {
  const double k = std::tan(fov / 2 * M_PI / 180), u = (x + 0.5 - width / 2.0) / (height / 2.0),
               v = (height / 2.0 - (y + 0.5)) / (height / 2.0);
  return normalize(V{k * u, k * v, -1});  // looking along -z
}

// ---- one sphere, one light, each model

struct Expected {
  const char* model;
  double (*color)(const V& N, const V& L, const V& V_, double r, double R, double ka, double kd, double ks,
                  double n);
};
double plus(double a) { return a > 0 ? a : 0; }
/// Fresnel's equations for unpolarised light that meets something clear of index n: (rs^2 + rp^2) / 2.
double fresnel(double cosine, double n) {
  const double beyond = std::sqrt(1 - (1 - cosine * cosine) / (n * n)),
               s = (cosine - n * beyond) / (cosine + n * beyond),
               p = (n * cosine - beyond) / (n * cosine + beyond);
  return (s * s + p * p) / 2;
}

const Expected every_model[] = {
    // I = Ka Ia + Il Kd (N.L)+
    {"conventional", [](const V& N, const V& L, const V&, double, double, double ka, double kd, double,
                        double) { return ka + 8 * kd * plus(dot(N, L)); }},
    // I = Ka Ia + Il Kd (N.L)+ / r^2
    {"attenuated", [](const V& N, const V& L, const V&, double r, double, double ka, double kd, double,
                      double) { return ka + 8 / (r * r) * kd * plus(dot(N, L)); }},
    // I = Ka Ia / R + Il / r [ Kd (N.L)+ + Ks ((R.V)+)^n ],  R = 2 (N.L) N - L
    {"phong",
     [](const V& N, const V& L, const V& E, double r, double R, double ka, double kd, double ks, double n) {
       const V mirrored = 2 * dot(N, L) * N - L;
       return ka / R +
              8 / r * (kd * plus(dot(N, L)) + (dot(N, L) > 0 ? ks * std::pow(plus(dot(mirrored, E)), n) : 0));
     }},
    // the same with (N.H)+, H = (L + V) / |L + V|
    {"blinn_phong",
     [](const V& N, const V& L, const V& E, double r, double R, double ka, double kd, double ks, double n) {
       const V H = normalize(L + E);
       return ka / R +
              8 / r * (kd * plus(dot(N, L)) + (dot(N, L) > 0 ? ks * std::pow(plus(dot(N, H)), n) : 0));
     }},
    // the same with H = (L + V) / 2
    {"blinn_phong_halfway",
     [](const V& N, const V& L, const V& E, double r, double R, double ka, double kd, double ks, double n) {
       const V H = 0.5 * (L + E);
       return ka / R +
              8 / r * (kd * plus(dot(N, L)) + (dot(N, L) > 0 ? ks * std::pow(plus(dot(N, H)), n) : 0));
     }},
    // phong's, the highlight times w(N.L); the material has no measured constants, and its ior is 1.5
    {"wavelength_specular",
     [](const V& N, const V& L, const V& E, double r, double R, double ka, double kd, double ks, double n) {
       const V mirrored = 2 * dot(N, L) * N - L;
       return ka / R +
              8 / r *
                  (kd * plus(dot(N, L)) +
                   (dot(N, L) > 0 ? ks * fresnel(dot(N, L), 1.5) * std::pow(plus(dot(mirrored, E)), n) : 0));
     }},
    // I = Ka Ia + Il [ Kd (N.L)+ + Ks (N.H)+^n ], illum 2
    {"mtl",
     [](const V& N, const V& L, const V& E, double, double, double ka, double kd, double ks, double n) {
       const V H = normalize(L + E);
       return ka + 8 * (kd * plus(dot(N, L)) + (dot(N, L) > 0 ? ks * std::pow(plus(dot(N, H)), n) : 0));
     }},
    // the same with the viewer infinitely far behind the camera, which looks along -z
    {"opengl",
     [](const V& N, const V& L, const V&, double, double, double ka, double kd, double ks, double n) {
       const V H = normalize(L + V{0, 0, 1});
       return ka + 8 * (kd * plus(dot(N, L)) + (dot(N, L) > 0 ? ks * std::pow(plus(dot(N, H)), n) : 0));
     }},
    // I = Ka Ia + Il [ Kd (N.L)+ + Ks (R.V)+^n ]: no specular, brilliance 1
    {"povray",
     [](const V& N, const V& L, const V& E, double, double, double ka, double kd, double ks, double n) {
       const V mirrored = 2 * dot(N, L) * N - L;
       return ka +
              8 * (kd * plus(dot(N, L)) + (dot(N, L) > 0 ? ks * std::pow(plus(dot(mirrored, E)), n) : 0));
     }},
    // mtl's, with nothing of a light where N.L <= 1/512
    {"tachyon",
     [](const V& N, const V& L, const V& E, double, double, double ka, double kd, double ks, double n) {
       const V H = normalize(L + E);
       return ka + (dot(N, L) > 1 / 512. ? 8 * (kd * dot(N, L) + ks * std::pow(plus(dot(N, H)), n)) : 0);
     }},
};

TEST(OneSphereOneLight, EveryModelToOneMillionth) {
  for (const Expected& expected : every_model)
    for (double n : {1.0, 32.0, 200.0}) {
      const Image image = picture(fmt::format(R"(
lambent: 1
camera: {{eye: [0, 0, 5], target: [0, 0, 0], fov: 40}}
image: {{size: [64, 48]}}
illumination: {{model: {}}}
lights: [{{point: {{position: [3, 4, 5], intensity: 8}}}}]
materials: [{{name: m, ambient: [0.1, 0.02, 0.05], diffuse: [0.8, 0.1, 0.4], specular: [0.5, 0.6, 0.7], shininess: {}}}]
objects: [{{sphere: {{center: [0.1, 0.2, -0.3], radius: 1.2}}, material: m}}]
)",
                                              expected.model, n));
      const V center{0.1, 0.2, -0.3}, eye{0, 0, 5}, light{3, 4, 5};
      const double ka[] = {0.1, 0.02, 0.05}, kd[] = {0.8, 0.1, 0.4}, ks[] = {0.5, 0.6, 0.7};
      int on_sphere = 0, lit = 0;
      for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
          const V d = pixel_ray(x, y, 64, 48, 40);
          const double b = dot(center - eye, d), disc = b * b - dot(center - eye, center - eye) + 1.2 * 1.2;
          if (disc < 0) {
            EXPECT_EQ(image.pixel(x, y)[0], 0);
            continue;
          }
          if (disc < 1e-3) continue;  // the rim, where the sphere's point is ill-conditioned
          const double R = b - std::sqrt(disc);
          const V P = eye + R * d, N = (P - center) / 1.2, L = normalize(light - P);
          ++on_sphere;
          lit += dot(N, L) > 0;
          for (int c = 0; c < 3; ++c) {
            const double want = expected.color(N, L, -d, length(light - P), R, ka[c], kd[c], ks[c], n);
            EXPECT_NEAR(image.pixel(x, y)[c] / want, 1, 1e-6)
                << expected.model << " at " << x << ", " << y << " n " << n;
          }
        }
      EXPECT_GT(on_sphere, 500);
      EXPECT_GT(lit, 300);
    }
}

TEST(OneSphereOneLight, EveryModelOfTheRegistryIsAmongThem) {
  for (const ModelInfo& model : model_infos) {
    bool found = false;
    for (const Expected& expected : every_model) found |= std::string(expected.model) == model.name;
    EXPECT_TRUE(found) << "write the closed form of " << model.name << " into this file";
  }
}

// ---- what only some models ask for

/// The eye at the middle of a sphere of radius 2, looking at its inside; a lamp stands halfway on the way
/// there.
Image inside_of_a_sphere(const std::string& material) {
  return picture(R"(
lambent: 1
camera: {eye: [0, 0, 0], target: [0, 0, -1], fov: 1}
image: {size: [1, 1]}
illumination: {model: opengl, ambient: 1}
lights: [{point: {position: [0, 0.01, -1]}}]
materials: [{name: m, ambient: 0.125, diffuse: 0.5, )" +
                 material + R"(}]
objects: [{sphere: {center: [0, 0, 0], radius: 2}, material: m}]
)");
}

TEST(OpenGlInside, IsLitOnlyWithTwoSides) {
  EXPECT_EQ(inside_of_a_sphere("two_sided: 0").pixel(0, 0)[0], 0.125f);
  EXPECT_NEAR(inside_of_a_sphere("two_sided: 1").pixel(0, 0)[0], 0.125 + 0.5 * std::cos(0.01), 1e-4);
}

TEST(TachyonHighlight, DoesNotFade) {
  // The light is 3 above the point, 30 degrees off a spot's axis that fades with the cosine to the 4th, seen
  // from above: N.H = 1.
  const Image image = picture(R"(
lambent: 1
camera: {eye: [0, 5, 0], target: [0, 0, 0], up: [0, 0, -1], fov: 1}
image: {size: [1, 1]}
illumination: {model: tachyon, ambient: 0, attenuation: 1/r^2}
lights: [{spot: {position: [0, 3, 0], target: [1.7320508075688772, 0, 0], angle: 120, softness: 0, exponent: 4, color: [1, 2, 4], intensity: 0.5}}]
materials: [{name: m, ambient: 0, diffuse: [0.5, 0.25, 0.125], specular: 0.25, shininess: 10}]
objects: [{plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: m}]
)");
  for (int c = 0; c < 3; ++c) {
    const double Il = 0.5 * (1 << c), kd = 0.5 / (1 << c);
    EXPECT_NEAR(image.pixel(0, 0)[c], Il * std::pow(0.75, 2) / 9 * kd + Il * 0.25,
                1e-6);  // cos^4 30 = 0.75^2
  }
}

TEST(Mtl, Illum0IsItsColourWhateverTheLight) {
  const Image image = picture(R"(
lambent: 1
camera: {eye: [0, 0, 5], target: [0, 0, 0], fov: 1}
image: {size: [1, 1]}
illumination: {model: mtl}
lights: [{point: {position: [0, 0, 5], intensity: 7}}]
materials: [{name: m, ambient: 0.3, diffuse: [0.5, 0.25, 0.125], specular: 1, illum: 0}]
objects: [{sphere: {center: [0, 0, 0], radius: 1}, material: m}]
)");
  for (int c = 0; c < 3; ++c) EXPECT_EQ(image.pixel(0, 0)[c], 0.5f / float(1 << c));
}

// ---- distances

TEST(Distances, RGrowsOverAllBouncesBetweenTwoMirrors) {
  // Mirrors at z = 0 and z = 4, the eye between them at z = 3, looking at z = 0. Hit k (from 0) lies at R = 3
  // + 4k: I = sum over k < depth of rho^k Ka Ia / (3 + 4k).
  for (int depth : {1, 2, 5, 20}) {
    const Image image = picture(fmt::format(R"(
lambent: 1
camera: {{eye: [0, 0, 3], target: [0, 0, 0], fov: 10}}
image: {{size: [1, 1]}}
illumination: {{model: phong}}
integrator: {{whitted: {{max_depth: {}}}}}
materials: [{{name: mirror, ambient: [0.9, 0.5, 0.2], diffuse: 0, reflect: [0.5, 0.8, 0.9]}}]
objects:
  - {{plane: {{point: [0, 0, 0], normal: [0, 0, 1]}}, material: mirror}}
  - {{plane: {{point: [0, 0, 4], normal: [0, 0, -1]}}, material: mirror}}
)",
                                            depth));
    const double ka[] = {0.9, 0.5, 0.2}, rho[] = {0.5, 0.8, 0.9};
    for (int c = 0; c < 3; ++c) {
      double want = 0;
      for (int k = 0; k < depth; ++k) want += std::pow(rho[c], k) * ka[c] / (3 + 4 * k);
      EXPECT_NEAR(image.pixel(0, 0)[c] / want, 1, 1e-6);
    }
  }
}

TEST(Distances, MinimumKeepsTheAmbientTermFinite) {
  const Image image = picture(R"(
lambent: 1
camera: {eye: [0, 0, 0.25], target: [0, 0, 0], fov: 10}
image: {size: [1, 1]}
illumination: {model: phong, minimum_distance: 0.5}
materials: [{name: m, ambient: 0.3, diffuse: 0}]
objects: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: m}]
)");
  EXPECT_NEAR(image.pixel(0, 0)[0], 0.3 / 0.5, 1e-7);  // R = 0.25 counts as 0.5
}

// ---- refraction

TEST(Refraction, AGlassSlabShiftsTheRay) {
  // A slab of thickness d and index n shifts a ray by d sin(a) (1 - cos a / sqrt(n^2 - sin^2 a)), without
  // turning it. Behind it a matt wall lit by a lamp nearby says where the ray has gone: I = Kd N.L there.
  const double d = 0.5, n = 1.5, a = 40 * M_PI / 180;
  const Image image = picture(fmt::format(R"(
lambent: 1
camera: {{projection: orthographic, eye: [{}, 0, {}], target: [0, 0, 0], height: 0.01}}
image: {{size: [1, 1]}}
illumination: {{model: conventional}}
integrator: {{whitted: {{shadows: false}}}}
lights: [{{point: {{position: [0.3, 0, -0.4]}}}}]
materials:
  - {{name: glass, ambient: 0, diffuse: 0, transmit: 1, ior: 1.5}}
  - {{name: wall, ambient: 0, diffuse: 1}}
objects:
  - {{box: {{min: [-5, -5, 0], max: [5, 5, {}]}}, material: glass}}
  - {{plane: {{point: [0, 0, -1], normal: [0, 0, 1]}}, material: wall}}
)",
                                          5 * std::sin(a), 5 * std::cos(a), d));
  const double shift = d * std::sin(a) * (1 - std::cos(a) / std::sqrt(n * n - std::sin(a) * std::sin(a)));
  // Without glass the ray meets the wall at x = -tan(a); the shift moves it towards +x by shift / cos(a).
  const double x = -std::tan(a) + shift / std::cos(a);
  const double want = 0.6 / std::hypot(0.3 - x, 0.6);  // N.L = height / distance
  EXPECT_NEAR(image.pixel(0, 0)[0] / want, 1, 1e-6);
}

/// The eye below the surface of glass, a white floor further down, a blue sky above; looking up at `angle`
/// from the vertical.
Image looking_out(double angle) {
  return picture(fmt::format(R"(
lambent: 1
camera: {{eye: [0, -1, 0], target: [{}, 0, 0], fov: 1}}
image: {{size: [1, 1]}}
background: [0, 0, 1]
materials:
  - {{name: glass, ambient: 0, diffuse: 0, reflect: 0.125, transmit: 0.5, ior: 1.5}}
  - {{name: floor, ambient: 0, diffuse: 0, emission: [1, 0.5, 0]}}
objects:
  - {{plane: {{point: [0, 0, 0], normal: [0, 1, 0]}}, material: glass}}
  - {{plane: {{point: [0, -2, 0], normal: [0, 1, 0]}}, material: floor}}
)",
                             std::tan(angle * M_PI / 180)));
}

TEST(Refraction, TotalBeyondTheCriticalAngle) {
  // Critical angle: asin(1 / 1.5) = 41.81 degrees.
  const Image before = looking_out(41.7), beyond = looking_out(41.9);
  EXPECT_FLOAT_EQ(before.pixel(0, 0)[0], 0.125f);         // reflect * floor
  EXPECT_FLOAT_EQ(before.pixel(0, 0)[2], 0.5f);           // transmit * sky
  EXPECT_FLOAT_EQ(beyond.pixel(0, 0)[0], 0.125f + 0.5f);  // what cannot leave goes with the mirror ray
  EXPECT_FLOAT_EQ(beyond.pixel(0, 0)[1], 0.5f * (0.125f + 0.5f));
  EXPECT_FLOAT_EQ(beyond.pixel(0, 0)[2], 0);
}

TEST(Whitted, NothingIsTakenFromTheLocalColour) {
  // I + reflect * mirror + transmit * refracted: 0.25 (emission) + 0.5 * sky + 0.75 * sky behind, ior 1.
  const Image image = picture(R"(
lambent: 1
camera: {eye: [0, 0, 3], target: [0, 0, 0]}
image: {size: [1, 1]}
background: [1, 2, 4]
materials: [{name: m, ambient: 0, diffuse: 0, emission: 0.25, reflect: 0.5, transmit: 0.75, ior: 1}]
objects: [{disc: {center: [0, 0, 0], normal: [0, 0, 1], radius: 1}, material: m}]
)");
  for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(image.pixel(0, 0)[c], 0.25f + 1.25f * float(1 << c));
}

// ---- shadows

/// Brightness of the floor below something at height 1, the light at height 3.
Image shadow_of(const std::string& thing, const std::string& whitted = "") {
  return picture(R"(
lambent: 1
camera: {eye: [5, 2, 0], target: [0, 0, 0], fov: 1}
image: {size: [1, 1]}
illumination: {model: conventional}
integrator: {whitted: {)" +
                 whitted + R"(}}
lights: [{point: {position: [0, 3, 0]}}]
materials:
  - {name: floor, ambient: 0, diffuse: 1}
  - {name: opaque}
  - {name: glass, transmit: [1, 0.5, 0.25]}
  - {name: dark, transmit: [1, 0, 0]}
objects:
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: floor}
)" + thing);
}

TEST(Mirrors, SmoothTrianglesReflectFromTheLiftedPoint) {
  // A triangle that stands for a bulge, and in its mirror ray a lit sphere. The mirror ray starts at P lifted
  // to the tangent planes of the corners, and there the point on the sphere must be looked for, too.
  const V p[] = {{-1, -1, 0}, {1.5, -0.5, 0}, {0, 1.25, 0}}, center{2.4, 0.3, 4.2}, light{-4, 3, 1};
  V n[3];
  std::string vertices, normals;
  for (int i = 0; i < 3; ++i) {
    n[i] = normalize(V{p[i].x + 0.6, p[i].y, 2});
    vertices += fmt::format("[{}, {}, {}], ", p[i].x, p[i].y, p[i].z);
    normals += fmt::format("[{}, {}, {}], ", n[i].x, n[i].y, n[i].z);
  }
  const Image image = picture(fmt::format(R"(
lambent: 1
camera: {{eye: [0, 0, 5], target: [0, 0, 0], fov: 10}}
image: {{size: [1, 1]}}
illumination: {{model: conventional, ambient: 0}}
lights: [{{point: {{position: [-4, 3, 1]}}}}]
materials:
  - {{name: mirror, diffuse: 0, reflect: 1}}
  - {{name: matt, diffuse: 1}}
objects:
  - {{mesh: {{vertices: [{}], normals: [{}], triangles: [[0, 1, 2]]}}, material: mirror}}
  - {{sphere: {{center: [2.4, 0.3, 4.2], radius: 1.2}}, material: matt}}
)",
                                          vertices, normals));
  // The eye ray meets the triangle at the origin: sum b_i p_i = 0, the b_i in the ratio of the areas
  // opposite.
  double b[3];
  for (int i = 0; i < 3; ++i) b[i] = cross(p[(i + 1) % 3], p[(i + 2) % 3]).z;
  const double area = b[0] + b[1] + b[2];
  V N{}, lift{};
  for (int i = 0; i < 3; ++i) {
    N = N + b[i] / area * n[i];
    lift = lift + b[i] / area * plus(dot(p[i], n[i])) * n[i];  // p_i is 0 - P away from P
  }
  N = normalize(N);
  const V mirror = 2 * N.z * N - V{0, 0, 1};
  const auto brightness = [&](const V& start) {
    const V f = start - center;
    const double middle = -dot(f, mirror);
    const V q = start + (middle - std::sqrt(1.2 * 1.2 - dot(f, f) + middle * middle)) * mirror;
    return plus(dot(normalize(q - center), normalize(light - q)));
  };
  EXPECT_GT(std::fabs(brightness(lift) - brightness({})), 0.02);  // else this would show nothing
  EXPECT_NEAR(image.pixel(0, 0)[0], brightness(lift), 1e-6);
}

TEST(Shadows, AreHardAndTintedByWhatTransmits) {
  const auto expect = [](const Image& image, double r, double g, double b) {
    EXPECT_FLOAT_EQ(image.pixel(0, 0)[0], float(r));
    EXPECT_FLOAT_EQ(image.pixel(0, 0)[1], float(g));
    EXPECT_FLOAT_EQ(image.pixel(0, 0)[2], float(b));
  };
  const std::string sphere = "  - {sphere: {center: [0, 1, 0], radius: 0.3}, material: ",
                    disc = "  - {disc: {center: [0, 1.5, 0], normal: [0, 1, 0], radius: 0.3}, material: ";
  expect(shadow_of(""), 1, 1, 1);
  expect(shadow_of(sphere + "opaque}\n"), 0, 0, 0);
  expect(shadow_of(sphere + "opaque}\n", "shadows: false"), 1, 1, 1);
  expect(shadow_of(disc + "glass}\n"), 1, 0.5, 0.25);
  expect(shadow_of(sphere + "glass}\n"), 1, 0.25, 0.0625);  // in and out: transmit twice
  expect(shadow_of(sphere + "glass}\n" + disc + "dark}\n"), 1, 0, 0);
  expect(shadow_of(sphere + "glass}\n" + disc + "opaque}\n"), 0, 0, 0);
  expect(shadow_of(sphere + "glass}\n", "colored_shadows: false"), 0, 0, 0);
  expect(shadow_of("  - {disc: {center: [0, 4, 0], normal: [0, 1, 0], radius: 9}, material: opaque}\n"), 1, 1,
         1);  // behind the light
}

TEST(Shadows, NoRayTowardsALightBehindTheSurface) {
  const auto scene = [](double height) {
    return parse_scene(fmt::format(R"(
lambent: 1
camera: {{projection: orthographic, eye: [0, 5, 0], target: [0, 0, 0], up: [0, 0, -1], height: 1}}
image: {{size: [8, 8]}}
lights: [{{point: {{position: [0, {}, 0]}}}}]
objects: [{{plane: {{point: [0, 0, 0], normal: [0, 1, 0]}}}}]
)",
                                   height));
  };
  EXPECT_EQ(render(scene(1)).stats.rays.shadow, 64u);
  EXPECT_EQ(render(scene(-1)).stats.rays.shadow, 0u);
}

// ---- cameras

TEST(Cameras, OrthographicSeesHeightAndKeepsSizes) {
  // A disc of radius 0.25 in a view of height 1 and 100 pixels: its area is pi 25^2 pixels, wherever it
  // stands.
  for (double z : {0.0, -7.0}) {
    const auto result = render(parse_scene(fmt::format(R"(
lambent: 1
camera: {{projection: orthographic, eye: [0, 0, 3], target: [0, 0, 0], height: 1}}
image: {{size: [100, 100]}}
objects: [{{disc: {{center: [0, 0, {}], normal: [0, 0, 1], radius: 0.25}}}}]
)",
                                                       z)));
    EXPECT_NEAR(double(result.stats.rays.eye_hits), M_PI * 25 * 25, 30);
  }
}

TEST(Cameras, RowZeroIsTheTopAndRightIsRight) {
  const Image image = picture(R"(
lambent: 1
camera: {eye: [0, 0, 5], target: [0, 0, 0], fov: 40}
image: {size: [3, 3]}
materials:
  - {name: red, ambient: 0, diffuse: 0, emission: [1, 0, 0]}
  - {name: green, ambient: 0, diffuse: 0, emission: [0, 1, 0]}
objects:
  - {sphere: {center: [0, 1.2, 0], radius: 0.3}, material: red}
  - {sphere: {center: [1.2, 0, 0], radius: 0.3}, material: green}
)");
  EXPECT_EQ(image.pixel(1, 0)[0], 1);
  EXPECT_EQ(image.pixel(2, 1)[1], 1);
  EXPECT_EQ(image.pixel(0, 1)[1], 0);
  EXPECT_EQ(image.pixel(1, 2)[0], 0);
}

// ---- the same bits

const char* everything = R"(
lambent: 1
camera: {eye: [0, 2.5, 6], target: [0, 0.6, 0], fov: 40}
image: {size: [97, 61], samples: 3, filter: tent}
illumination: {model: phong}
background: [0.2, 0.3, 0.5]
lights:
  - {point: {position: [3, 4, 4], intensity: 4}}
  - {spot: {position: [-3, 5, 1], target: [0, 0, 0], intensity: 6, angle: 50}}
  - {directional: {direction: [1, -2, -1], intensity: 0.2}}
materials:
  - {name: floor, diffuse: [0.6, 0.6, 0.5], reflect: 0.1}
  - {name: red, diffuse: [0.8, 0.1, 0.1], specular: 0.5, reflect: 0.2}
  - {name: glass, ambient: 0, diffuse: 0.05, specular: 0.8, shininess: 200, reflect: 0.1, transmit: [0.8, 0.9, 0.8], ior: 1.5}
  - {name: blinn, model: blinn_phong, diffuse: [0.1, 0.3, 0.8], specular: 0.4}
  - {name: matt, model: attenuated, diffuse: [0.8, 0.8, 0.2]}
objects:
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: floor}
  - {sphere: {center: [-1.2, 0.6, 0], radius: 0.6}, material: red}
  - {sphere: {center: [0.3, 0.7, 1], radius: 0.7}, material: glass}
  - {box: {min: [-0.4, 0, -0.4], max: [0.4, 0.8, 0.4]}, material: blinn, transform: [{rotate: {axis: y, degrees: 30}}, {translate: [1.5, 0, -0.5]}]}
  - {cone: {from: [-0.3, 0, -1.5], to: [-0.3, 1.6, -1.5], radius_from: 0.5, radius_to: 0.1, capped: true}, material: matt}
  - {sphere: {center: [0, 0, 0], radius: 0.5}, material: matt, transform: [{scale: [1, 0.4, 0.6]}, {translate: [2.2, 0.3, 1]}]}
)";

TEST(SameBits, WhateverTheThreadsTilesAndInstructionSet) {
  const ScenePtr scene = parse_scene(everything);
  const RenderResult reference =
      render(scene, {.threads = 1, .tile_size = 32, .isa = "baseline", .progress = {}});
  const auto expect_same = [&](const RenderOptions& options) {
    const RenderResult result = render(scene, options);
    ASSERT_EQ(result.image.data.size(), reference.image.data.size());
    EXPECT_EQ(std::memcmp(result.image.data.data(), reference.image.data.data(),
                          result.image.data.size() * sizeof(float)),
              0)
        << options.threads << " threads, tiles of " << options.tile_size << ", " << result.stats.isa;
    EXPECT_EQ(result.metadata, reference.metadata);
    EXPECT_EQ(result.stats.rays.shadow, reference.stats.rays.shadow);
    EXPECT_EQ(result.stats.rays.refraction, reference.stats.rays.refraction);
  };
  for (int threads : {1, 2, 3, 7})
    for (int tile : {1, 5, 16, 64, 1000}) expect_same({threads, tile, "", {}});
  for (const std::string& isa : available_isas()) expect_same({2, 32, isa, {}});
}

TEST(SameBits, APixelDoesNotDependOnTheOthers) {
  // The same rays in a picture of another width would differ; but what a pixel shows does not depend on who
  // is beside it in a packet. Where there is one sample, pixels go on their way by runs.
  for (const std::string samples : {"1", "3"}) {
    const ScenePtr scene = parse_scene(everything, "scene", {{{"image.samples", samples}}});
    const Image whole = render(scene).image;
    for (const int tile : {1, 3, 50})
      EXPECT_EQ(whole.data, render(scene, {2, tile, "", {}}).image.data) << tile;
  }
}

TEST(SameBits, WithAdaptiveSamplesToo) {
  const ScenePtr scene =
      parse_scene(everything, "scene", {{{"image.samples", "{adaptive: {start: 4, max: 64, error: 2}}"}}});
  const RenderResult reference = render(scene, {1, 32, "baseline", {}});
  for (const RenderOptions& options : {RenderOptions{2, 7, "", {}}, RenderOptions{3, 1000, "baseline", {}}}) {
    const RenderResult result = render(scene, options);
    EXPECT_EQ(result.image.data, reference.image.data) << options.tile_size;
    EXPECT_EQ(result.stats.rays.eye, reference.stats.rays.eye);
  }
}

// ---- samples where the picture needs them

/// The 8-bit value of a linear one, by the sRGB standard.
int eight_bits(double a) {
  a = std::min(std::max(a, 0.0), 1.0);
  return int(255 * (a <= 0.0031308 ? 12.92 * a : 1.055 * std::pow(a, 1 / 2.4) - 0.055) + 0.5);
}

TEST(AdaptiveSamples, AreWithinTheirErrorOfAllSamples) {
  // Of 1000 pixels 999 are within `error` steps of 8 bits of what all samples give, with a fraction of the
  // rays.
  const auto with = [](const std::string& samples) {
    return render(
        parse_scene(everything, "scene",
                    {{{"image.samples", samples}, {"image.size", "[194, 122]"}, {"image.filter", "box"}}}));
  };
  const RenderResult all = with("{adaptive: {start: 256, max: 256}}");
  EXPECT_EQ(all.stats.rays.eye, 194u * 122 * 256);
  std::uint64_t rays = all.stats.rays.eye / 2;
  for (const int error : {1, 2, 4}) {
    const RenderResult some = with(fmt::format("{{adaptive: {{start: 4, max: 256, error: {}}}}}", error));
    EXPECT_LT(some.stats.rays.eye, rays) << error;
    rays = some.stats.rays.eye;
    int beyond = 0;
    for (std::size_t i = 0; i < all.image.data.size(); i += 3) {
      int worst = 0;
      for (int c = 0; c < 3; ++c)
        worst =
            std::max(worst, std::abs(eight_bits(all.image.data[i + c]) - eight_bits(some.image.data[i + c])));
      beyond += worst > error;
    }
    EXPECT_LE(beyond, 194 * 122 / 1000) << "of " << 194 * 122 << " at error " << error;
  }
}

TEST(AdaptiveSamples, TakeNoMoreThanTheStartWhereNothingDiffers) {
  const ScenePtr scene = parse_scene(
      "lambent: 1\ncamera: {eye: [0, 0, 5], target: [0, 0, 0]}\nimage: {size: [20, 10], samples: {adaptive: "
      "{}}}\nbackground: [0.5, 0.5, 0.5]\n");
  const RenderResult result = render(scene);
  EXPECT_EQ(result.stats.rays.eye, 20u * 10 * 4);
  EXPECT_EQ(result.image.pixel(3, 3)[0], 0.5f);
}

TEST(AdaptiveSamples, AllOfThemWhereNoErrorIsAllowed) {
  // Three columns see an edge in their pixel or a neighbour's: with error 0 these get `max`.
  const ScenePtr scene = parse_scene(R"(
lambent: 1
camera: {eye: [0, 0, 5], target: [0, 0, 0], projection: orthographic, height: 8}
image: {size: [8, 8], samples: {adaptive: {start: 4, max: 100, error: 0}}}
materials: [{name: white, ambient: 0, diffuse: 0, emission: 1}]
objects: [{polygon: {vertices: [[-9, -9, 0], [0.3, -9, 0], [0.3, 9, 0], [-9, 9, 0]]}, material: white}]
)");
  const RenderResult result = render(scene);
  EXPECT_EQ(result.stats.rays.eye, 8u * (3 * 100 + 5 * 4));
  EXPECT_NEAR(result.image.pixel(4, 4)[0], 0.3, 0.011);  // the share of the pixel that is covered
}

// ---- many lights

TEST(ManyLights, ThoseThatCannotReachChangeNothing) {
  // Lamps all over a floor, each with a short reach or a narrow cone: what is left out for a tile must not
  // matter.
  std::string lights;
  for (int i = 0; i < 200; ++i) {
    const double x = -5 + 10 * ((i * 37) % 200) / 200.0, z = -5 + 10 * ((i * 91) % 200) / 200.0;
    lights +=
        i % 2 ? fmt::format("  - {{point: {{position: [{}, 0.5, {}], max_distance: 0.9, intensity: 0.3}}}}\n",
                            x, z)
              : fmt::format(
                    "  - {{spot: {{position: [{}, 2, {}], target: [{}, 0, {}], angle: 20, "
                    "intensity: 0.3}}}}\n",
                    x, z, x + 0.3, z);
  }
  const std::string scene = R"(
lambent: 1
camera: {eye: [0, 4, 7], target: [0, 0, 0]}
image: {size: [96, 54]}
illumination: {model: phong, attenuation: none, ambient: 0}
objects:
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}}
  - {sphere: {center: [0, 0.5, 0], radius: 0.5}}
lights:
)" + lights;
  const Image tiles = picture(scene, {2, 8, "", {}}), whole = picture(scene, {1, 1000, "", {}});
  EXPECT_EQ(tiles.data, whole.data);
  // Against the sum over lamps of pictures with one lamp each, where nothing can be left out wrongly: light
  // adds up.
  std::vector<double> sum(whole.data.size());
  std::size_t at = 0;
  for (int i = 0; i < 200; ++i) {
    const std::size_t end = lights.find('\n', at) + 1;
    const std::string one = scene.substr(0, scene.size() - lights.size()) + lights.substr(at, end - at);
    at = end;
    const Image image = picture(one);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += image.data[k];
  }
  double brightest = 0;
  for (std::size_t k = 0; k < sum.size(); ++k) {
    EXPECT_NEAR(whole.data[k], sum[k], 1e-6 * (1 + sum[k]));
    brightest = std::max(brightest, sum[k]);
  }
  EXPECT_GT(brightest, 0.3);
}

/// What the shadow rays find out of the first lights is kept for the equation, of others it is found again.
TEST(ManyLights, ALightGivesTheSameWhereverItStandsInTheList) {
  for (const std::string light : {"point: {position: [1, 2, 3]}",
                                  "rectangle: {center: [1, 2, 3], u: [1, 0, 0], v: [0, 1, 0], samples: 9}",
                                  "spot: {position: [1, 2, 3], target: [0, 0, 0], angle: 60}"})
    for (const char* transmit : {"0", "0.5"}) {
      const auto among_dark_ones = [&](int place) {
        std::string scene = fmt::format(
            "{{lambent: 1, camera: {{eye: [0, 0, 5], target: [0, 0, 0]}}, image: {{size: [24, 16]}}, "
            "materials: [{{name: a, diffuse: 0.5, specular: 0.5, shininess: 9, transmit: {}}}], "
            "objects: [{{sphere: {{center: [0, 0, 0], radius: 1}}, material: a}}, "
            "{{sphere: {{center: [0.4, 0.8, 1.2], radius: 0.3}}, material: a}}], lights: [",
            transmit);
        for (int i = 0; i < 7; ++i)
          scene += i == place ? "{" + light + "}, " : "{point: {position: [3, 1, 4], intensity: 0}}, ";
        return picture(scene + "]}").data;
      };
      const std::vector<float> first = among_dark_ones(0);
      EXPECT_GT(*std::ranges::max_element(first), 0.02) << light;
      for (const int place : {3, 4, 6})
        EXPECT_EQ(among_dark_ones(place), first) << light << ", place " << place;
    }
}

TEST(Cancelling, StopsAndSaysSo) {
  int calls = 0;
  const RenderResult result =
      render(parse_scene(everything),
             {.threads = 2, .tile_size = 8, .isa = "", .progress = [&](double) { return ++calls < 3; }});
  EXPECT_TRUE(result.cancelled);
  EXPECT_EQ(calls, 3);
}

TEST(Isa, AnUnknownNameListsTheKnown) {
  try {
    render(parse_scene(everything), {.threads = 1, .tile_size = 32, .isa = "mmx", .progress = {}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics()[0].message, "no kernels for the instruction set 'mmx' on this machine");
    EXPECT_NE(error.diagnostics()[0].hint.find("baseline"), std::string::npos);
  }
}

}  // namespace
}  // namespace lambent
