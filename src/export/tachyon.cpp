// Tachyon's scene files. Its world is left-handed: x is turned round in everything, and the picture is ours
// again.

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <optional>

#include "export/finish.h"
#include "export/formats.h"

namespace lambent {
namespace {

// Words stand between blanks, so there are no brackets or commas.
std::string vector(const Vec3<double>& v) { return fmt::format("{} {} {}", -v.x + 0.0, v.y, v.z); }
std::string color(const Rgb& c) { return fmt::format("{} {} {}", c[0], c[1], c[2]); }

/// The factor by which t scales all lengths; nothing where it does not scale all alike.
std::optional<double> uniform_scale(const Transform& t) {
  const double xx = dot(t.x, t.x), tolerance = 1e-9 * xx;
  const auto same = [&](double a, double b) { return std::fabs(a - b) <= tolerance; };
  if (!same(dot(t.y, t.y), xx) || !same(dot(t.z, t.z), xx) || !same(dot(t.x, t.y), 0) ||
      !same(dot(t.y, t.z), 0) || !same(dot(t.z, t.x), 0))
    return {};
  return std::sqrt(xx);
}

class Writer {
 public:
  Writer(const Scene& scene, std::vector<Diagnostic>& to) : scene_(scene), remarks_("Tachyon", to) {}

  std::string write() {
    remark_on_settings(scene_, remarks_);
    const std::vector<bool> used = used_materials(scene_);
    std::vector<Finish> finishes(used.size());
    bool phong = false, blinn = false, fast = false;
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (!used[i]) continue;
      finishes[i] = finish_of(scene_, scene_.materials[i], remarks_);
      phong |= !is_black(finishes[i].phong);
      fast |= finishes[i].fast && !is_black(finishes[i].blinn);
      blinn |= !finishes[i].fast && !is_black(finishes[i].blinn);
    }
    if (phong + blinn + fast > 1)
      remarks_.add(
          {},
          "has one form of highlight for the whole picture; the first of phong, blinn and fast that the "
          "scene uses stands for all");
    settings(phong ? "-shade_phong" : blinn ? "-shade_blinn" : fast ? "-shade_blinn_fast" : "-shade_blinn");
    for (const Light& light : scene_.lights)
      with_light(light.light, [&](const auto& one) { write_light(light, one); });
    for (std::size_t i = 0; i < used.size(); ++i)
      if (used[i]) material(i, finishes[i]);
    for (const Object& object : scene_.objects)
      std::visit([&](const auto& primitives) { shape(object, primitives); },
                 scene_.shapes[object.shape].primitives);
    say("END_SCENE\n");
    return std::move(text_);
  }

 private:
  template <class... T> void say(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<T>(values)...);
  }

  void settings(const char* highlights) {
    const Camera& c = scene_.camera;
    const bool flat = c.projection == Projection::orthographic;
    const auto [sine, cosine] = sincos_degrees(c.fov / 2);
    const bool shadows = scene_.whitted.shadows;
    say("# {}, written by Lambent. Its picture, sampled at the upper right corner of each pixel:\n"
        "#   tachyon THIS.dat {} {} -format PPM48 -o THIS.ppm\n",
        in_comment(scene_.name), shadows ? "-fullshade" : "-mediumshade", highlights);
    if (!shadows) remarks_.add({}, "is told by its command line to leave out shadows: -mediumshade");
    say("BEGIN_SCENE\nRESOLUTION {} {}\nCAMERA\n{}ZOOM {}\nASPECTRATIO 1\nANTIALIASING 0\nRAYDEPTH "
        "{}\nCENTER {}\n"
        "VIEWDIR {}\nUPDIR {}\nEND_CAMERA\nBACKGROUND {}\n",
        scene_.image.width, scene_.image.height, flat ? "PROJECTION ORTHOGRAPHIC\n" : "",
        flat ? 1 / c.height : cosine / (2 * sine), scene_.whitted.max_depth, vector(c.eye),
        vector(normalize(c.target - c.eye)), vector(c.up), color(scene_.background));
  }

  // ---- lights

  std::string attenuation() const {
    const Attenuation a = fading_of(scene_);
    if (a == attenuation_none) return "";
    return fmt::format(" ATTENUATION CONSTANT {} LINEAR {} QUADRATIC {}", a.constant, a.linear, a.quadratic);
  }
  void write_light(const Light&, const PointLight& one) {
    say("LIGHT CENTER {} RAD 0{} COLOR {}\n", vector(one.position), attenuation(),
        color(one.intensity * one.color));
  }
  void write_light(const Light&, const DirectionalLight& one) {
    say("DIRECTIONAL_LIGHT DIRECTION {} COLOR {}\n", vector(normalize(one.direction)),
        color(one.intensity * one.color));
  }
  void write_light(const Light& light, const SpotLight& one) {
    if (one.softness > 0 || one.exponent != 0)
      remarks_.add(light.place, "lets spots fade in proportion to the angle; that of " +
                                    called("light", light.name) +
                                    " fades over the same angles, by another curve");
    say("SPOTLIGHT CENTER {} RAD 0 DIRECTION {} FALLOFF_START {} FALLOFF_END {}{} COLOR {}\n",
        vector(one.position), vector(normalize(one.target - one.position)),
        (1 - one.softness) * one.angle / 2, one.angle / 2, attenuation(), color(one.intensity * one.color));
  }

  template <HasExtent L> void write_light(const Light& light, const L& one) {
    remarks_.add(light.place,
                 "has no lights with extent; " + called("light", light.name) +
                     " is a point, its centre, which shines alike in all directions and is not seen");
    say("LIGHT CENTER {} RAD 0{} COLOR {}\n", vector(one.center), attenuation(),
        color(one.intensity * one.color));
  }

  template <class L> void write_light(const Light& light, const L&) {
    remarks_.add(light.place, std::string("has no light of the kind ") + L::info.name + "; " +
                                  called("light", light.name) + " is left out");
  }

  // ---- materials

  void material(std::size_t index, const Finish& finish) {
    const Material& m = scene_.materials[index];
    const std::string who = called("material", m.name);
    const auto remark = [&](const std::string& rest) { remarks_.add(m.place, rest); };
    const auto amount = [&](const Rgb& c, const char* what) {
      if (!is_grey(c))
        remark(std::string("has one number for ") + what + "; that of " + who + " is its strongest channel");
      return strongest(c);
    };
    // One colour for the diffuse and the ambient term.
    const double diffuse = strongest(finish.diffuse), constant = strongest(finish.constant);
    const bool by_diffuse = diffuse > 0;
    const double largest = by_diffuse ? diffuse : constant;
    const Rgb one = largest > 0 ? (1 / largest) * (by_diffuse ? finish.diffuse : finish.constant) : grey(1.0);
    double ambient = 0;
    for (int c = 0; c < color_channels; ++c)
      if (one[c] > 0) ambient = max(ambient, finish.constant[c] / one[c]);
    bool proportional = true;
    for (int c = 0; c < color_channels; ++c)
      proportional &= std::fabs(finish.constant[c] - ambient * one[c]) <= 1e-9 * constant;
    if (!proportional)
      remark("has one colour for all terms; the ambient term of " + who + " takes that of the diffuse");

    const bool phong = !is_black(finish.phong);
    const Rgb& highlight = phong ? finish.phong : finish.blinn;
    if (phong && !is_black(finish.blinn)) remark("has one highlight; of " + who + " the second is left out");
    const ModelId model = model_of(scene_, m);
    if (!is_black(highlight) && model != ModelId::tachyon) {
      const bool fades = !(fading_of(scene_) == attenuation_none);
      bool spots = false;
      for (const Light& light : scene_.lights) spots |= std::holds_alternative<SpotLight>(light.light);
      if (fades || spots)
        remark("does not let highlights fade with distance or in a spot's edge; that of " + who +
               " is brighter than here");
    }
    if (finish.brilliance != 1)
      remark("knows Lambert's cosine only; the brilliance of " + who + " is left out");
    if (!is_black(finish.reflect) && !is_black(scene_.background))
      remark("adds the whole background where it follows a mirror ray no further; " + who +
             " is brighter there");
    const double transmit = amount(finish.transmit, "transmission");
    if (transmit > 0 && finish.ior != 1) remark("does not refract; light goes straight on through " + who);
    if (transmit > 0 && !scene_.whitted.colored_shadows && scene_.whitted.shadows)
      remark("lets light through what transmits; " + who +
             " is meant to cast a full shadow (colored_shadows: false)");
    if (transmit > 1) remark("transmits 1 at the most; so does " + who);
    say("TEXDEF m{} AMBIENT {} DIFFUSE {} SPECULAR {} OPACITY {} PHONG PLASTIC {} PHONG_SIZE {} COLOR {} "
        "TEXFUNC 0\n",
        index, ambient, by_diffuse ? diffuse : 0, amount(finish.reflect, "reflection"),
        1 - min(transmit, 1.0), amount(highlight, "highlights"),
        phong ? finish.phong_power : finish.blinn_power, color(one));
  }

  // ---- shapes

  template <class P> void shape(const Object& object, const std::vector<P>& primitives) {
    const std::optional<double> scale = uniform_scale(object.world_from_object);
    bool left_out = false;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      const std::string words = words_of(primitives[i], object.world_from_object, scale);
      left_out |= words.empty();
      if (!words.empty()) say("{} m{}\n", words, material_of(scene_.shapes[object.shape], object, i));
    }
    if (left_out)
      remarks_.add(object.place,
                   std::string(std::is_same_v<P, Cone> ? "has no cones but cylinders, and stretches nothing; "
                                                       : "stretches nothing into ellipses; ") +
                       called("object", object.name) + " is left out, as far as it is such");
  }
  static std::string words_of(const Sphere& s, const Transform& t, const std::optional<double>& scale) {
    if (!scale) return "";
    return fmt::format("SPHERE CENTER {} RAD {}", vector(transform_point(t, s.center)), *scale * s.radius);
  }
  static std::string words_of(const Plane& p, const Transform& t, const std::optional<double>&) {
    return fmt::format("PLANE CENTER {} NORMAL {}", vector(transform_point(t, p.point)),
                       vector(normalize(transform_normal(inverse(t), p.normal))));
  }
  static std::string words_of(const Disc& d, const Transform& t, const std::optional<double>& scale) {
    if (!scale) return "";
    return fmt::format("RING CENTER {} NORMAL {} INNER 0 OUTER {}", vector(transform_point(t, d.center)),
                       vector(normalize(transform_normal(inverse(t), d.normal))), *scale * d.radius);
  }
  static std::string words_of(const Cone& c, const Transform& t, const std::optional<double>& scale) {
    if (!scale || c.radius_from != c.radius_to) return "";
    return fmt::format("FCYLINDER BASE {} APEX {} RAD {}", vector(transform_point(t, c.from)),
                       vector(transform_point(t, c.to)), *scale * c.radius_from);
  }

  void shape(const Object& object, const Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const auto [v, n, smooth] = placed_triangle(mesh, object, i);
      if (!smooth && n[0] == Vec3<double>{}) continue;  // a triangle without area is seen by nobody
      const std::uint32_t m = material_of(scene_.shapes[object.shape], object, i);
      // Tachyon takes the normals for those of the side from which the corners run counter-clockwise; turning
      // x round has turned that, too.
      const bool turned = dot(cross(v[1] - v[0], v[2] - v[0]), n[0] + n[1] + n[2]) > 0;
      const int b = turned ? 2 : 1, c = turned ? 1 : 2;
      if (smooth)
        say("STRI V0 {} V1 {} V2 {} N0 {} N1 {} N2 {} m{}\n", vector(v[0]), vector(v[b]), vector(v[c]),
            vector(n[0]), vector(n[b]), vector(n[c]), m);
      else say("TRI V0 {} V1 {} V2 {} m{}\n", vector(v[0]), vector(v[b]), vector(v[c]), m);
    }
  }

  const Scene& scene_;
  Remarks remarks_;
  std::string text_;
};

}  // namespace

std::string tachyon_text(const Scene& scene, std::vector<Diagnostic>& remarks) {
  return Writer(scene, remarks).write();
}

}  // namespace lambent
