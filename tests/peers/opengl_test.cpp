// The model opengl against OpenGL itself: Mesa's software renderer with a buffer of floats, no window and no
// screen.

#include <gtest/gtest.h>

#include "peers/conformance.h"

#ifndef LAMBENT_OSMESA

TEST(PeerOpenGl, IsNotHere) {
  lambent::test::not_compared("OpenGL", "lit points and pictures", "OSMesa is not installed");
  GTEST_SKIP() << "OSMesa is not here: script/bootstrap --peers installs it, then configure and build anew";
}

#else

#include <GL/gl.h>
#include <GL/osmesa.h>

#include <cmath>
#include <random>
#include <vector>

#include "illumination/equation.h"
#include "illumination/models.h"
#include "lambent/lambent.h"
#include "lights/lights.h"
#include "support.h"

namespace lambent {
namespace {

using V = Vec3<double>;

class Context {
 public:
  Context(int width, int height) : width_(width), height_(height), pixels_(std::size_t(width) * height * 4) {
    context_ = OSMesaCreateContextExt(OSMESA_RGBA, 24, 0, 0, nullptr);
    if (context_ == nullptr || !OSMesaMakeCurrent(context_, pixels_.data(), GL_FLOAT, width, height))
      throw std::runtime_error("OSMesa gives no context with a buffer of floats");
    glViewport(0, 0, width, height);
    glClearColor(0, 0, 0, 0);
    glEnable(GL_LIGHTING);
    glDisable(GL_DITHER);
  }
  ~Context() { OSMesaDestroyContext(context_); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Row 0 is the top.
  const float* pixel(int x, int y) const { return &pixels_[(std::size_t(height_ - 1 - y) * width_ + x) * 4]; }
  std::string version() const {
    const std::string text = reinterpret_cast<const char*>(glGetString(GL_VERSION));
    const std::size_t mesa = text.find("Mesa");
    return "OpenGL (" + (mesa == std::string::npos ? text : text.substr(mesa)) + ")";
  }

 private:
  int width_, height_;
  std::vector<float> pixels_;
  OSMesaContext context_;
};

void set_matrix(GLenum which, const std::array<double, 16>& columns) {
  glMatrixMode(which);
  glLoadMatrixd(columns.data());
}
constexpr std::array<double, 16> identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

std::array<float, 4> four(const Rgb& c, float last = 1) {
  return {float(c[0]), float(c[1]), float(c[2]), last};
}
std::array<float, 4> four(const V& v, float last) { return {float(v.x), float(v.y), float(v.z), last}; }

/// A light of ours with an attenuation, and the same for OpenGL; in eye space.
struct Lamp {
  AnyLight light;
  Attenuation attenuation;

  void give_to(GLenum number) const {
    glEnable(number);
    const std::array<float, 4> black{0, 0, 0, 1};
    glLightfv(number, GL_AMBIENT, black.data());
    std::array<float, 4> color{}, position{};
    float cutoff = 180, exponent = 0;
    std::array<float, 4> direction{0, 0, -1, 0};
    if (const auto* one = std::get_if<PointLight>(&light)) {
      color = four(one->intensity * one->color), position = four(one->position, 1);
    } else if (const auto* sun = std::get_if<DirectionalLight>(&light)) {
      color = four(sun->intensity * sun->color), position = four(-sun->direction, 0);
    } else if (const auto* spot = std::get_if<SpotLight>(&light)) {
      color = four(spot->intensity * spot->color), position = four(spot->position, 1);
      direction = four(spot->target - spot->position, 0);
      cutoff = float(spot->angle / 2), exponent = float(spot->exponent);
    }
    glLightfv(number, GL_DIFFUSE, color.data());
    glLightfv(number, GL_SPECULAR, color.data());
    glLightfv(number, GL_POSITION, position.data());
    glLightfv(number, GL_SPOT_DIRECTION, direction.data());
    glLightf(number, GL_SPOT_CUTOFF, cutoff);
    glLightf(number, GL_SPOT_EXPONENT, exponent);
    glLightf(number, GL_CONSTANT_ATTENUATION, float(attenuation.constant));
    glLightf(number, GL_LINEAR_ATTENUATION, float(attenuation.linear));
    glLightf(number, GL_QUADRATIC_ATTENUATION, float(attenuation.quadratic));
  }
};

void give_material(const Rgb& ka, const Rgb& kd, const Rgb& ks, const Rgb& emission, double n) {
  glMaterialfv(GL_FRONT_AND_BACK, GL_AMBIENT, four(ka).data());
  glMaterialfv(GL_FRONT_AND_BACK, GL_DIFFUSE, four(kd).data());
  glMaterialfv(GL_FRONT_AND_BACK, GL_SPECULAR, four(ks).data());
  glMaterialfv(GL_FRONT_AND_BACK, GL_EMISSION, four(emission).data());
  glMaterialf(GL_FRONT_AND_BACK, GL_SHININESS, float(n));
}

TEST(PeerOpenGl, LitPointsAgree) {
  const Context gl(1, 1);
  // Whatever is drawn falls into the middle of the picture; light is reckoned before, in eye space.
  set_matrix(GL_PROJECTION, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1});
  set_matrix(GL_MODELVIEW, identity);
  std::mt19937 random(1992);
  std::uniform_real_distribution<double> u(0, 1);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return normalize(V{normal(random), normal(random), normal(random)}); };
  const auto color = [&](double most) { return Rgb{{most * u(random), most * u(random), most * u(random)}}; };

  constexpr int wanted = 2000;
  double largest = 0;
  int points = 0, highlights = 0, unclamped = 0, spots = 0;
  while (points < wanted) {
    const V P{4 * u(random) - 2, 4 * u(random) - 2, -1 - 4 * u(random)};
    Surface<double, Rgb> s{};
    s.V = normalize(-P);
    const V outside = direction();  // what OpenGL is given
    s.outside = dot(outside, s.V) >= 0 ? 1 : -1;
    s.N = s.outside * outside;
    s.to_camera = {0, 0, 1};
    s.ka = color(0.3), s.kd = color(0.8), s.ks = color(0.8);
    // Not 0: there Mesa 22.3 departs from the specification, which has (n.h)^0 = 1.
    s.n = 1 + std::floor(128 * u(random) * u(random));
    s.own[0] = double(random() % 2);
    s.own[1] = 0;  // two sides: a point has only one
    const Rgb emission = color(0.1), Ia = color(0.5);

    std::vector<Lamp> lamps(1 + random() % 3);
    bool near_an_edge = false;
    for (Lamp& lamp : lamps) {
      const V position{6 * u(random) - 3, 6 * u(random) - 3, 6 * u(random) - 5};
      const Rgb shines = color(0.6);
      lamp.attenuation = {0.5 + u(random), 0.3 * u(random), 0.1 * u(random)};
      switch (random() % 3) {
        case 0:
          lamp.light = PointLight{position, shines, 1, 0};
          break;
        case 1:
          lamp.light = DirectionalLight{direction(), shines, 1};
          break;
        default: {
          const V target = P + 0.8 * direction();
          const double cutoff = 5 + 80 * u(random);
          lamp.light = SpotLight{position, target, shines, 1, 2 * cutoff, 0, std::floor(20 * u(random)), 0};
          const double cosine = dot(normalize(P - position), normalize(target - position));
          near_an_edge |= std::fabs(cosine - std::cos(cutoff * M_PI / 180)) < 1e-4;
          spots += cosine > std::cos(cutoff * M_PI / 180);
        }
      }
      const auto L = with_light(lamp.light, [&](const auto& one) { return sample(one, P, 0.5, 0.5).L; });
      near_an_edge |= std::fabs(dot(s.N, L)) < 1e-4;  // where rounding decides whether there is a highlight
    }
    if (near_an_edge) continue;

    const Rgb I =
        emission + illuminate<OpenGl>(s, Ia, int(lamps.size()), [&](int l) {
          const auto of_light = with_light(lamps[std::size_t(l)].light,
                                           [&](const auto& one) { return sample(one, P, 0.5, 0.5); });
          return Arriving<double, Rgb>{
              of_light.L, attenuate(lamps[std::size_t(l)].attenuation, of_light.r, 1e-9) * of_light.I};
        });

    glClear(GL_COLOR_BUFFER_BIT);
    for (int l = 0; l < 8; ++l) glDisable(GLenum(GL_LIGHT0 + l));
    for (std::size_t l = 0; l < lamps.size(); ++l) lamps[l].give_to(GLenum(GL_LIGHT0 + l));
    glLightModelfv(GL_LIGHT_MODEL_AMBIENT, four(Ia).data());
    glLightModeli(GL_LIGHT_MODEL_LOCAL_VIEWER, s.own[0] > 0);
    give_material(s.ka, s.kd, s.ks, emission, s.n);
    glBegin(GL_POINTS);
    glNormal3d(outside.x, outside.y, outside.z);
    glVertex3d(P.x, P.y, P.z);
    glEnd();
    glFinish();

    ++points;
    bool highlight = false;
    for (const Lamp& lamp : lamps) {
      const auto of_light = with_light(lamp.light, [&](const auto& one) { return sample(one, P, 0.5, 0.5); });
      highlight |= OpenGl::evaluate(s, Arriving<double, Rgb>{of_light.L, of_light.I}).specular[0] > 1e-3;
    }
    highlights += highlight;
    for (int c = 0; c < 3; ++c) {
      unclamped += I[c] < 1;
      largest = max(largest, std::fabs(gl.pixel(0, 0)[c] - min(I[c], 1.0)));
    }
  }
  EXPECT_GT(highlights, 200);
  EXPECT_GT(spots, 200);
  EXPECT_GT(unclamped, 3 * wanted / 2);
  test::conform(gl.version(),
                "lit points: 1 to 3 lights (points, suns, spots) with attenuation, both viewers",
                fmt::format("{} points", points), 1e-5, largest);
}

// ---- a whole picture

/// A torus about the z axis as a grid, closed both ways.
struct Torus {
  static constexpr int along = 400, around = 200;
  std::vector<V> points, normals;
  Torus() {
    for (int i = 0; i < along; ++i)
      for (int j = 0; j < around; ++j) {
        const double a = 2 * M_PI * i / along, b = 2 * M_PI * j / around;
        const V out{std::cos(a), std::sin(a), 0}, n = std::cos(b) * out + std::sin(b) * V{0, 0, 1};
        points.push_back(out + 0.45 * n);
        normals.push_back(n);
      }
  }
  template <class Visit> void quads(const Visit& visit) const {
    for (int i = 0; i < along; ++i)
      for (int j = 0; j < around; ++j) {
        const int k = (i + 1) % along, m = (j + 1) % around;
        visit(i * around + j, k * around + j, k * around + m, i * around + m);
      }
  }
};

TEST(PeerOpenGl, AFineMeshAgrees) {
  constexpr int width = 320, height = 240;
  constexpr double fov = 40, tilt = 55, distance = 5;
  const Torus torus;
  const test::TemporaryDirectory folder;
  std::string obj;
  for (const V& p : torus.points) obj += fmt::format("v {:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.z);
  for (const V& n : torus.normals) obj += fmt::format("vn {:.9g} {:.9g} {:.9g}\n", n.x, n.y, n.z);
  torus.quads([&](int a, int b, int c, int d) {
    obj += fmt::format("f {0}//{0} {1}//{1} {2}//{2} {3}//{3}\n", a + 1, b + 1, c + 1, d + 1);
  });
  test::write_text(folder.file("torus.obj"), obj);
  test::write_text(folder.file("scene.yaml"), fmt::format(R"(
lambent: 1
camera: {{eye: [0, 0, {}], target: [0, 0, 0], fov: {}}}
image: {{size: [{}, {}]}}
illumination: {{model: opengl, ambient: 0.2, attenuation: {{constant: 1, linear: 0.05, quadratic: 0.01}}}}
integrator: {{whitted: {{shadows: false}}}}
lights:
  - {{point: {{position: [2, 3, 4], color: [0.9, 0.8, 0.7]}}}}
  - {{point: {{position: [-3, 1, 2], color: [0.1, 0.2, 0.5]}}}}
materials: [{{name: m, ambient: [0.5, 0.3, 0.2], diffuse: [0.7, 0.4, 0.3], specular: 0.4, shininess: 20}}]
objects: [{{mesh: {{file: torus.obj}}, material: m, transform: {{rotate: {{axis: x, degrees: {}}}}}}}]
)",
                                                          distance, fov, width, height, -tilt));
  const Image ours = render(load_scene(folder.file("scene.yaml"))).image;

  const Context gl(width, height);
  glEnable(GL_DEPTH_TEST);
  glClear(GLbitfield(GL_COLOR_BUFFER_BIT) | GLbitfield(GL_DEPTH_BUFFER_BIT));
  constexpr double near = 1, far = 20;
  const double f = 1 / std::tan(fov / 2 * M_PI / 180);
  set_matrix(GL_PROJECTION, {f * height / width, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1,
                             0, 0, 2 * far * near / (near - far), 0});
  set_matrix(GL_MODELVIEW, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -distance, 1});
  const Attenuation fading{1, 0.05, 0.01};
  Lamp{PointLight{{2, 3, 4}, {{0.9, 0.8, 0.7}}, 1, 0}, fading}.give_to(GL_LIGHT0);
  Lamp{PointLight{{-3, 1, 2}, {{0.1, 0.2, 0.5}}, 1, 0}, fading}.give_to(GL_LIGHT1);
  glLightModelfv(GL_LIGHT_MODEL_AMBIENT, four(grey(0.2)).data());
  give_material({{0.5, 0.3, 0.2}}, {{0.7, 0.4, 0.3}}, grey(0.4), {}, 20);
  glRotated(-tilt, 1, 0, 0);
  glBegin(GL_QUADS);
  torus.quads([&](int a, int b, int c, int d) {
    for (const int v : {a, b, c, d}) {
      const V& n = torus.normals[std::size_t(v)];
      const V& p = torus.points[std::size_t(v)];
      glNormal3d(n.x, n.y, n.z);
      glVertex3d(p.x, p.y, p.z);
    }
  });
  glEnd();
  glFinish();
  std::vector<float> depth(std::size_t(width) * height);
  glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
  const auto way = [&](int x, int y) {
    const double z = 2.0 * depth[std::size_t(height - 1 - y) * width + std::size_t(x)] - 1;
    return 2 * far * near / (far + near - z * (far - near));
  };

  // Away from silhouettes: where no neighbour is much nearer or farther.
  int compared = 0, within = 0;
  double largest = 0;
  for (int y = 1; y + 1 < height; ++y)
    for (int x = 1; x + 1 < width; ++x) {
      bool smooth = way(x, y) < 0.9 * far;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) smooth &= std::fabs(way(x + dx, y + dy) - way(x, y)) < 0.1;
      if (!smooth) continue;
      double difference = 0;
      for (int c = 0; c < 3; ++c)
        difference = max(difference, std::fabs(double(gl.pixel(x, y)[c]) - min(ours.pixel(x, y)[c], 1.f)));
      ++compared;
      within += difference <= 1 / 255.;
      largest = max(largest, difference);
    }
  EXPECT_GT(compared, 8000);
  const double beyond = 1 - double(within) / compared;
  SCOPED_TRACE(fmt::format("largest difference {}", largest));
  test::conform(
      gl.version(),
      fmt::format(
          "a picture of a torus of {} quads: share of the pixels, away from silhouettes, that differ by "
          "more than 1/255 (the largest difference is {:.2g})",
          Torus::along * Torus::around, largest),
      fmt::format("{} pixels", compared), 1e-3, beyond);
}

}  // namespace
}  // namespace lambent

#endif
