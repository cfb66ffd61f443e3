// POV-Ray's scene language, version 3.7. Right-handed with `right` pointing to -x; transforms by `matrix`,
// which any object takes.

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "export/finish.h"
#include "export/formats.h"

namespace lambent {
namespace {

std::string vector(const Vec3<double>& v) { return fmt::format("<{}, {}, {}>", v.x, v.y, v.z); }
std::string rgb(const Rgb& c) { return fmt::format("rgb <{}, {}, {}>", c[0], c[1], c[2]); }

class Writer {
 public:
  Writer(const Scene& scene, std::vector<Diagnostic>& to) : scene_(scene), remarks_("POV-Ray", to) {}

  std::string write() {
    remark_on_settings(scene_, remarks_);
    settings();
    camera();
    for (const Light& light : scene_.lights)
      with_light(light.light, [&](const auto& one) { write_light(light, one); });
    const std::vector<bool> used = used_materials(scene_);
    for (std::size_t i = 0; i < used.size(); ++i)
      if (used[i]) material(i);
    for (const Object& object : scene_.objects)
      std::visit([&](const auto& primitives) { shape(object, primitives); },
                 scene_.shapes[object.shape].primitives);
    return std::move(text_);
  }

 private:
  template <class... T> void say(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<T>(values)...);
  }

  void settings() {
    const ImageSettings& image = scene_.image;
    say("// {}, written by Lambent. Its picture, with linear values as everywhere in Lambent:\n"
        "//   povray THIS.pov +W{} +H{} +FN16 File_Gamma=1.0 -A\n",
        in_comment(scene_.name), image.width, image.height);
    // adc_bailout 0: rays are followed to the full depth however little they count.
    say("#version 3.7;\nglobal_settings {{ assumed_gamma 1 ambient_light rgb 1 adc_bailout 0 max_trace_level "
        "{} }}\n"
        "#default {{ finish {{ ambient 0 diffuse 1 }} }}\nbackground {{ {} }}\n",
        scene_.whitted.max_depth, rgb(scene_.background));
  }

  void camera() {
    const Camera& c = scene_.camera;
    const double aspect = double(scene_.image.width) / scene_.image.height;
    if (c.projection == Projection::orthographic) {
      say("camera {{ orthographic location {} sky {} up {}*y right -{}*x look_at {} }}\n", vector(c.eye),
          vector(c.up), c.height, c.height * aspect, vector(c.target));
      return;
    }
    const auto [sine, cosine] = sincos_degrees(c.fov / 2);
    const double horizontal = 2 * std::atan(aspect * sine / cosine) * 180 / M_PI;
    say("camera {{ perspective location {} sky {} up y right -{}*x angle {} look_at {} }}\n", vector(c.eye),
        vector(c.up), aspect, horizontal, vector(c.target));
  }

  // ---- lights

  /// POV-Ray's light is divided by (1 + (d / fade_distance)^fade_power) / 2; ours by constant + linear d +
  /// quadratic d^2.
  struct Fade {
    double factor = 1;  ///< On the colour.
    std::string words;
  };
  Fade fade(const Light& light) {
    const Attenuation a = fading_of(scene_);
    if (a.linear == 0 && a.quadratic == 0) return {1 / a.constant, ""};
    if (a.linear != 0 && a.quadratic != 0)
      remarks_.add(light.place, "lets light fade by one power of the distance; of the attenuation of " +
                                    called("light", light.name) + " the linear part is left out");
    const int power = a.quadratic != 0 ? 2 : 1;
    const double strength = power == 2 ? a.quadratic : a.linear;
    // Without a constant the distance would be 0. At this one, far below any in the scene, the 1 beside (d /
    // distance)^power no longer counts.
    const double distance = a.constant == 0 ? std::pow(1e-7, 1.0 / power) * reach()
                                            : std::pow(a.constant / strength, 1.0 / power);
    return {0.5 / (strength * std::pow(distance, power)),
            fmt::format(" fade_distance {} fade_power {}", distance, power)};
  }

  bool light_fades() const {
    bool spots = false;
    for (const Light& light : scene_.lights) spots |= std::holds_alternative<SpotLight>(light.light);
    return spots || !(fading_of(scene_) == attenuation_none);
  }

  /// How far the scene reaches, roughly: from its middle, and from the eye.
  double reach() const {
    const Bounds box = bounds(scene_);
    const double size = box.empty() ? 1 : length(box.upper - box.lower) / 2;
    return max(size, length(scene_.camera.eye - scene_.camera.target));
  }

  void write_light(const Light& light, const PointLight& one) {
    const Fade f = fade(light);
    say("light_source {{ {}, {}{} }}\n", vector(one.position), rgb(f.factor * one.intensity * one.color),
        f.words);
  }
  void write_light(const Light&, const DirectionalLight& one) {
    // From so far away that all shadows lie on its way.
    const Bounds box = bounds(scene_);
    const Vec3<double> middle = box.empty() ? scene_.camera.target : 0.5 * (box.lower + box.upper);
    const Vec3<double> from = middle - 1000 * reach() * normalize(one.direction);
    say("light_source {{ {}, {} parallel point_at {} }}\n", vector(from), rgb(one.intensity * one.color),
        vector(middle));
  }
  void write_light(const Light& light, const SpotLight& one) {
    const Fade f = fade(light);
    const double falloff = one.angle / 2;
    say("light_source {{ {}, {} spotlight point_at {} radius {} falloff {} tightness {}{} }}\n",
        vector(one.position), rgb(f.factor * one.intensity * one.color), vector(one.target),
        (1 - one.softness) * falloff, falloff, one.exponent, f.words);
  }

  template <HasExtent L> void write_light(const Light& light, const L& one) {
    const Fade f = fade(light);
    const LightBody body = body_of(one);
    const bool flat = body.kind == LightBody::Kind::parallelogram;
    // A grid of about as many points.
    const int side = max(1, int(std::lround(std::sqrt(double(one.samples)))));
    const Axes<double> axes =
        axes_around(flat || body.kind == LightBody::Kind::disc ? body.normal : Vec3<double>{0, 0, 1});
    const Vec3<double> u = flat ? body.u : 2 * body.radius * axes.x,
                       v = flat ? body.v : 2 * body.radius * axes.y;
    std::string points;
    if (side > 1)
      points = fmt::format(" area_light {}, {}, {}, {}{}", vector(u), vector(v), side, side,
                           flat                                   ? ""
                           : body.kind == LightBody::Kind::sphere ? " circular orient"
                                                                  : " circular");
    say("light_source {{ {}, {}{}{} }}\n", vector(body.center), rgb(f.factor * one.intensity * one.color),
        points, f.words);
    if (body.kind != LightBody::Kind::sphere)
      remarks_.add(light.place, "lets every light shine alike in all directions; " +
                                    called("light", light.name) +
                                    " is meant to shine by the cosine to its normal" +
                                    (body.two_sided ? "" : ", and on one side alone"));
    if (one.visible) write_body(body, radiance(one));
  }
  /// The light as a thing. It casts no shadow, or it would stand in its own light.
  void write_body(const LightBody& body, const Rgb& radiance) {
    const std::string look =
        fmt::format("pigment {{ rgb 1 }} finish {{ emission {} diffuse 0 }} no_shadow", rgb(radiance));
    if (body.kind == LightBody::Kind::sphere) {
      say("sphere {{ {}, {} {} }}\n", vector(body.center), body.radius, look);
    } else if (body.kind == LightBody::Kind::disc) {
      say("disc {{ {}, {}, {} {} }}\n", vector(body.center), vector(body.normal), body.radius, look);
    } else {
      std::string corners;
      for (const auto& [u, v] :
           {Vec2<double>{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}})
        corners += ", " + vector(body.center + u * body.u + v * body.v);
      say("polygon {{ 5{} {} }}\n", corners, look);
    }
  }

  template <class L> void write_light(const Light& light, const L&) {
    remarks_.add(light.place, std::string("has no light of the kind ") + L::info.name + "; " +
                                  called("light", light.name) + " is left out");
  }

  // ---- materials

  void material(std::size_t index) {
    const Material& m = scene_.materials[index];
    const Finish finish = finish_of(scene_, m, remarks_);
    const std::string who = called("material", m.name);
    const auto remark = [&](const std::string& rest) { remarks_.add(m.place, rest); };

    // What shines through takes from the rest: colour = (1 - t) (diffuse + emission) + highlights + t behind.
    const double t = min(strongest(finish.transmit), 1.0), left = 1 - t;
    if (!is_grey(finish.transmit) || strongest(finish.transmit) > 1)
      remark("tints what shines through by the pigment; " + who +
             " transmits its strongest channel in all, 1 at the most");
    if (t > 0 && finish.ior != 1)
      remark("has a rule of its own for light that is reflected totally; " + who + " looks different there");
    if (t > 0 && !scene_.whitted.colored_shadows && scene_.whitted.shadows)
      remark("lets light through what transmits; " + who +
             " is meant to cast a full shadow (colored_shadows: false)");
    if (left == 0 && !(is_black(finish.diffuse) && is_black(finish.constant)))
      remark("gives no colour of its own to what transmits all; that of " + who + " is left out");

    // A pigment's colour is a factor on everything, so it must not be 0 where the surface shines by itself.
    Rgb pigment{}, emission{};
    for (int c = 0; c < color_channels && left > 0; ++c) {
      pigment[c] = finish.diffuse[c] / left;
      if (finish.constant[c] == 0) continue;
      pigment[c] = max(pigment[c], 1e-9);
      emission[c] = finish.constant[c] / (left * pigment[c]);
    }
    const auto amount = [&](const Rgb& color, const char* what) {
      if (!is_grey(color))
        remark(std::string("gives ") + what + " the light's colour; that of " + who +
               " is as strong as its strongest channel");
      return strongest(color);
    };
    say("#declare M{} = texture {{  // {}\n  pigment {{ color {} transmit {} }}\n  finish {{ emission {} "
        "brilliance {}",
        index, in_comment(m.name), rgb(pigment), t, rgb(emission), finish.brilliance);
    if (!is_black(finish.phong))
      say(" phong {} phong_size {}", amount(finish.phong, "highlights"), finish.phong_power);
    if (!is_black(finish.blinn)) {
      if (finish.fast) remark("has no fast highlights; that of " + who + " is a power of N.H");
      // A power of 0 is out of reach of 1/roughness; this one is as good as 0.
      say(" specular {} roughness {}", amount(finish.blinn, "highlights"), 1 / max(finish.blinn_power, 1e-6));
    }
    const bool unfaded = model_of(scene_, m) == ModelId::tachyon;
    if (unfaded && !(is_black(finish.phong) && is_black(finish.blinn)) && light_fades())
      remark("lets highlights fade as all light; that of " + who + " is meant to stay (model tachyon)");
    if (!is_black(finish.reflect)) say(" reflection {{ {} }}", rgb(finish.reflect));
    say(" }}\n}}\n");
    if (t > 0) say("#declare I{} = interior {{ ior {} }}\n", index, finish.ior);
    transmits_.resize(scene_.materials.size());
    transmits_[index] = t > 0;
  }

  /// What stands at the end of an object.
  std::string look(std::size_t material) const {
    std::string words = fmt::format(" texture {{ M{} }}", material);
    if (transmits_[material]) words += fmt::format(" interior {{ I{} }}", material);
    if (!scene_.whitted.shadows) words += " no_shadow";
    return words;
  }
  static std::string placing(const Transform& t) {
    if (is_identity(t)) return "";
    return fmt::format(" matrix <{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}>", t.x.x, t.x.y, t.x.z, t.y.x,
                       t.y.y, t.y.z, t.z.x, t.z.y, t.z.z, t.translation.x, t.translation.y, t.translation.z);
  }

  // ---- shapes

  template <class P> void shape(const Object& object, const std::vector<P>& primitives) {
    for (std::size_t i = 0; i < primitives.size(); ++i)
      say("{}{}{} }}\n", words_of(primitives[i]), look(material_of(scene_.shapes[object.shape], object, i)),
          placing(object.world_from_object));
  }
  static std::string words_of(const Sphere& s) {
    return fmt::format("sphere {{ {}, {}", vector(s.center), s.radius);
  }
  static std::string words_of(const Plane& p) {
    const Vec3<double> n = normalize(p.normal);
    return fmt::format("plane {{ {}, {}", vector(n), dot(n, p.point));
  }
  static std::string words_of(const Disc& d) {
    return fmt::format("disc {{ {}, {}, {}", vector(d.center), vector(normalize(d.normal)), d.radius);
  }
  static std::string words_of(const Cone& c) {
    if (c.radius_from == c.radius_to)
      return fmt::format("cylinder {{ {}, {}, {} open", vector(c.from), vector(c.to), c.radius_from);
    return fmt::format("cone {{ {}, {}, {}, {} open", vector(c.from), c.radius_from, vector(c.to),
                       c.radius_to);
  }

  /// One mesh for each of the materials, where it stands in the world: our normals are blended there, and
  /// POV-Ray would blend them before it stretches the mesh.
  void shape(const Object& object, const Mesh& mesh) {
    std::vector<std::vector<std::size_t>> of_material(scene_.materials.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      of_material[material_of(scene_.shapes[object.shape], object, i)].push_back(i);
    for (std::size_t m = 0; m < of_material.size(); ++m)
      if (!of_material[m].empty()) write_mesh(object, mesh, of_material[m], look(m));
  }

  void write_mesh(const Object& object, const Mesh& mesh, const std::vector<std::size_t>& triangles,
                  const std::string& look) {
    // Each vertex that these triangles use once, in the order in which they do. Normals likewise, and one
    // more for each flat face.
    constexpr std::size_t none = std::size_t(-1);
    std::vector<std::size_t> number(mesh.vertices.size(), none), number_of_normal(mesh.vertices.size(), none);
    std::size_t vertex_count = 0, normal_count = 0, face_count = 0;
    std::string vertices, normals, faces, faces_normals;
    for (const std::size_t i : triangles) {
      const PlacedTriangle triangle = placed_triangle(mesh, object, i);
      if (!triangle.smooth && triangle.normal[0] == Vec3<double>{}) continue;  // without area: seen by nobody
      ++face_count;
      std::size_t v[3], n[3];
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t corner = mesh.triangles[i][k];
        if (number[corner] == none) {
          number[corner] = vertex_count++;
          vertices += ",\n" + vector(triangle.corner[k]);
        }
        v[k] = number[corner];
        if (mesh.normals.empty()) continue;
        if (triangle.smooth ? number_of_normal[corner] == none : k == 0) {
          if (triangle.smooth) number_of_normal[corner] = normal_count;
          ++normal_count;
          normals += ",\n" + vector(triangle.normal[k]);
        }
        n[k] = triangle.smooth ? number_of_normal[corner] : normal_count - 1;
      }
      faces += fmt::format(",\n<{}, {}, {}>", v[0], v[1], v[2]);
      if (!mesh.normals.empty()) faces_normals += fmt::format(",\n<{}, {}, {}>", n[0], n[1], n[2]);
    }
    if (face_count == 0) return;
    say("mesh2 {{ vertex_vectors {{ {}{} }}\n", vertex_count, vertices);
    if (normal_count > 0) say("normal_vectors {{ {}{} }}\n", normal_count, normals);
    say("face_indices {{ {}{} }}\n", face_count, faces);
    if (normal_count > 0) say("normal_indices {{ {}{} }}\n", face_count, faces_normals);
    say("{} }}\n", look);
  }

  const Scene& scene_;
  Remarks remarks_;
  std::string text_;
  std::vector<bool> transmits_;
};

}  // namespace

std::string povray_text(const Scene& scene, std::vector<Diagnostic>& remarks) {
  return Writer(scene, remarks).write();
}

}  // namespace lambent
