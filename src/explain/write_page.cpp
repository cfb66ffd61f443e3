#include <fmt/format.h>

#include <cmath>

#include "explain/terms.h"
#include "explain/write.h"
#include "film/layer_book.h"

namespace lambent {
namespace {

std::string text_of(const Vec3<double>& v) {
  return fmt::format("({}, {}, {})", short_number(v.x), short_number(v.y), short_number(v.z));
}
/// " (scene.yaml:7)": without folders, which would make lines of what should be read at a glance.
std::string place_of(const Place& place) {
  return place.line > 0 ? fmt::format(" ({}:{})", place.file.substr(place.file.rfind('/') + 1), place.line)
                        : "";
}

class Telling {
 public:
  Telling(const Derivation& derivation, Page& page)
      : d_(derivation),
        scene_(*derivation.scene),
        page_(page),
        objects_(object_names(scene_)),
        materials_(material_names(scene_)) {}

  void tell(int number) {
    const DerivedSample& sample = d_.samples[std::size_t(number)];
    page_.title(fmt::format("{}, pixel {},{} of {} x {}", scene_.name, d_.x, d_.y, scene_.image.width,
                            scene_.image.height));
    page_.line(fmt::format("Sample {} of {}, at {}, {}{}.", number, d_.samples.size(), short_number(sample.x),
                           short_number(sample.y),
                           number == d_.central ? ", the nearest to the pixel's centre" : ""));
    if (is_moving(scene_))
      page_.line(
          fmt::format("It is taken at {} of the time that the shutter is open.", short_number(sample.time)));
    if (const auto lens = d_.lens_of(sample))
      page_.line(fmt::format("It goes through the lens at ({}, {}) from its centre, and is in focus at {}.",
                             short_number(lens->at.x), short_number(lens->at.y), text_of(lens->focus)));
    if (d_.passes.empty()) {
      tell_rays(sample);
    } else {
      page_.line(fmt::format("Made of {} wavelengths, each of which follows the equation by itself.",
                             scene_.spectral.wavelengths.size()));
      for (const Derivation& pass : d_.passes) {
        page_.heading(wavelengths_of(pass));
        Telling(pass, page_).tell_rays(pass.samples[std::size_t(number)]);
      }
      tell_wavelengths(std::size_t(number));
    }
    tell_pixel();
  }

 private:
  void tell_rays(const DerivedSample& sample) {
    if (scene_.integrator == Integrator::path) tell_path(sample.eye_ray);
    else tell_ray(sample.eye_ray);
    tell_sums(sample);
  }

  static std::string wavelengths_of(const Derivation& pass) {
    std::string text = pass.wavelengths.size() == 1 ? "Wavelength " : "Wavelengths ";
    for (std::size_t i = 0; i < pass.wavelengths.size(); ++i)
      text += (i ? ", " : "") + short_number(pass.wavelengths[i]);
    return text + (pass.wavelengths.size() == 1 ? " nm, alike in all channels"
                                                : " nm, in place of red, green and blue");
  }

  /// What the wavelengths come to in sRGB.
  void tell_wavelengths(std::size_t number) {
    page_.heading("The sample's colour in sRGB");
    page_.line(
        "Each wavelength counts what the CIE 1931 observer sees of D65 there, so that white is 1 1 1.");
    for (const Derivation& pass : d_.passes)
      for (int i = 0; i < pass.pass.count; ++i) {
        const double value = pass.samples[number].color[i];
        page_.equation(short_number(pass.wavelengths[std::size_t(i)]) + " nm",
                       {written(grey(value), page_.notation()) + times() +
                            written(pass.pass.weights[i], page_.notation()),
                        written(value * pass.pass.weights[i], page_.notation())},
                       "");
      }
    page_.equation("sum", {written(d_.samples[number].color, page_.notation())}, "");
  }

  void tell_ray(std::uint32_t number) {
    const DerivedRay& ray = d_.rays[number];
    const std::string name = ray.seen.parent == no_ray ? "from the eye"
                             : ray.seen.way == Way::reflection
                                 ? (ray.seen.total ? "totally reflected" : "mirrored")
                                 : "refracted";
    page_.heading(fmt::format("Ray {}, {}", number, name));
    page_.line(fmt::format("starts at {}, goes along {}", text_of(ray.seen.o), text_of(ray.seen.d)));
    if (ray.seen.parent != no_ray)
      page_.line(fmt::format("counts {} of what it brings; {} in the sample", short_color(ray.seen.factor),
                             short_color(ray.seen.weight)));
    if (ray.fog) tell_fog(*ray.fog);
    if (!ray.hits) {
      page_.line(fmt::format("meets nothing: the background, {}", short_color(ray.color)));
      return;
    }
    tell_hit(ray);
    tell_terms(ray);
    for (const std::uint32_t child : ray.children) {
      page_.begin();
      tell_ray(child);
      page_.end();
    }
  }

  void tell_fog(const SeenFog& fog) {
    const Fog& scene = scene_.fog;
    page_.line(
        fmt::format("goes through fog{}: exp(-{} t) is left of a colour",
                    fog.way < 1e300 ? fmt::format(" for t = {}", short_number(fog.way)) : " without end",
                    short_number(scene.density)));
    page_.equation("share", {written(grey(fog.share), page_.notation())}, "left of what the ray brings");
    equation_of_colors("fog", {fog.brings}, "the rest of the fog's " + short_color(scene.color));
  }

  // ---- a path, ray by ray

  void tell_path(std::uint32_t number) {
    for (;;) {
      const DerivedRay& ray = d_.rays[number];
      page_.heading(fmt::format("Ray {}{}", number, ray.seen.parent == no_ray ? ", from the eye" : ""));
      page_.line(fmt::format("starts at {}, goes along {}", text_of(ray.seen.o), text_of(ray.seen.d)));
      if (ray.seen.parent != no_ray) tell_choice(ray);
      if (ray.fog) tell_fog(*ray.fog);
      if (ray.hits) tell_surface(ray);
      else page_.line("meets nothing: the background");
      if (ray.find) tell_find(ray, *ray.find);
      if (ray.search) tell_search(*ray.search);
      if (ray.children.empty()) return;
      number = ray.children[0];
    }
  }

  void tell_choice(const DerivedRay& ray) {
    const DerivedRay& parent = d_.rays[ray.seen.parent];
    if (ray.seen.factor == grey(1.0) && ray.seen.density == parent.seen.density &&
        ray.seen.weight == parent.seen.weight)
      return page_.line("goes on through what is not wholly there, as if there were nothing");
    if (ray.seen.density > 0)
      page_.equation("p", {written(grey(ray.seen.density), page_.notation())},
                     "density of this direction, as the material chooses");
    equation_of_colors(
        "f |N.L| / p", {ray.seen.factor},
        ray.seen.density > 0 ? "" : "the only direction of its kind; over the chance of choosing it");
    if (ray.seen.survival < 1)
      page_.equation("q", {written(grey(ray.seen.survival), page_.notation())},
                     "the chance with which the path went on; it counts 1/q more");
    equation_of_colors("throughput", {ray.seen.weight}, "what it brings counts so much");
  }

  void tell_surface(const DerivedRay& ray) {
    tell_where(ray);
    const Material& material = d_.given_material(ray.hit.material);
    page_.line(fmt::format("material {}{}: {}", materials_[ray.hit.material], place_of(material.place),
                           scattering_of(d_.material_of(ray))));
    equation("P", text_of(ray.hit.P));
    equation("N", text_of(ray.hit.N));
    equation("V", text_of(ray.hit.V));
  }
  std::string scattering_of(const Material& material) const {
    if (const auto& m = material.metallic_roughness)
      return fmt::format("base color {}, metallic {}, roughness {}", short_color(m->base_color),
                         short_number(m->metallic), short_number(m->roughness));
    return fmt::format("Kd {}, Ks {}, n {}", short_color(material.diffuse), short_color(material.specular),
                       short_number(material.shininess));
  }

  void tell_find(const DerivedRay& ray, const SeenFind& seen) {
    page_.line("");
    page_.line(fmt::format("It has come upon light: {}", source_name(d_, seen.source)));
    page_.begin();
    equation_of_colors("Le", {seen.radiance}, "");
    if (ray.seen.density > 0)
      tell_weight("p", ray.seen.density, "s", seen.searched, seen.weight,
                  "s: the density with which a search finds it");
    equation_of_colors("brings", {seen.brings}, "");
    page_.end();
  }

  void tell_search(const SeenSearch& seen) {
    page_.line("");
    page_.line(fmt::format("Light is looked for: {}", source_name(d_, seen.source)));
    page_.begin();
    std::string where = "L = " + text_of(seen.L);
    if (seen.r < 1e300) where += fmt::format(", r = {}", short_number(seen.r));
    page_.line(where);
    equation_of_colors("arrives", {seen.arriving},
                       seen.density > 0 ? "radiance over s" : "pi Il / r^2 over the chance of its choice");
    equation_of_colors("f |N.L|", {seen.scattered}, "");
    if (seen.density > 0)
      tell_weight("s", seen.density, "p", seen.followed, seen.weight,
                  "p: the density with which the path goes that way");
    if (seen.open && seen.share < 1)
      page_.equation("share", {written(grey(seen.share), page_.notation())},
                     "what surfaces leave of it that are not wholly there");
    if (!seen.asked) page_.line("nothing of it is scattered to where the ray came from");
    else if (!seen.open) page_.line("blocked");
    else equation_of_colors("brings", {seen.brings}, "");
    page_.end();
  }

  /// a^2 / (a^2 + b^2), or 1 where the other way was closed.
  void tell_weight(const std::string& a, double found, const std::string& b, double other, double weight,
                   const std::string& remark) {
    page_.equation(a, {written(grey(found), page_.notation())}, "");
    page_.equation(b, {written(grey(other), page_.notation())},
                   remark.substr(0, 2) == b + ":" ? remark.substr(3) : "");
    page_.equation("w", {written(grey(weight), page_.notation())},
                   weight == 1 ? "no other way finds it" : a + "^2 / (" + a + "^2 + " + b + "^2)");
  }

  void equation_of_colors(const std::string& name, const std::vector<Rgb>& colors,
                          const std::string& remark) {
    std::vector<std::string> sides;
    for (const Rgb& color : colors) sides.push_back(written(color, page_.notation()));
    page_.equation(name, sides, remark);
  }

  // ---- a tree of rays

  /// What a ray meets, and where.
  void tell_where(const DerivedRay& ray) {
    page_.line(fmt::format("meets {}{}, primitive {}, after {}{}", objects_[ray.object],
                           place_of(d_.place_of_object(ray.object)), ray.primitive, short_number(ray.hit.t),
                           ray.hit.outside ? "" : ", from inside"));
  }

  void tell_hit(const DerivedRay& ray) {
    tell_where(ray);
    const Material& material = d_.material_of(ray);
    page_.line(fmt::format("material {}{}: Ka {}, Kd {}, Ks {}, n {}", materials_[ray.hit.material],
                           place_of(material.place), short_color(material.ambient),
                           short_color(material.diffuse), short_color(material.specular),
                           short_number(material.shininess)));
    tell_substance(ray);
    if (const std::string how = how_painted(material); !how.empty()) page_.line(how);
    equation("P", text_of(ray.hit.P));
    equation("N", text_of(ray.hit.N));
    equation("V", text_of(ray.hit.V));
    page_.equation("R", {written(grey(ray.hit.R), page_.notation())}, "the way from the eye");
    const ModelInfo& model = info(d_.model_of(ray));
    page_.line(fmt::format(
        "model {}: Ka Ia{} + sum over the lights of {}", model.name,
        ambient_attenuation_of(d_.illumination, d_.model_of(ray)) == AmbientAttenuation::none ? "" : " / R",
        model.equation));
  }

  void tell_substance(const DerivedRay& ray) {
    const SeenMaterial& seen = ray.hit.numbers;
    if (seen.boundary == Boundary::none) return;
    const Substance& substance = *scene_.materials[ray.hit.material].substance;
    const bool metal = seen.boundary == Boundary::metal;
    const std::string name = metal ? std::get<Metal>(substance).name : std::get<Glass>(substance).name;
    page_.line(fmt::format("{}{}{}: eta {}{}; w by Fresnel's equations", metal ? "metal" : "glass",
                           name.empty() ? "" : " ", name, short_color(seen.eta),
                           metal ? ", k " + short_color(seen.k) : ""));
  }

  /// Where the numbers come from, if not from the material alone.
  static std::string how_painted(const Material& material) {
    std::string text;
    if (const auto& m = material.metallic_roughness)
      text = fmt::format("which are made of base color {}, metallic {}, roughness {}",
                         short_color(m->base_color), short_number(m->metallic), short_number(m->roughness));
    if (!material.maps.empty())
      text += fmt::format("{}{} {} at this point", text.empty() ? "painted by " : ", with ",
                          material.maps.size(), material.maps.size() == 1 ? "map" : "maps");
    return text;
  }

  void tell_terms(const DerivedRay& ray) {
    page_.line("");
    term("ambient", ambient_formula(d_, ray), ray.ambient);
    Rgb so_far = ray.ambient;
    for (const DerivedLight& light : ray.lights) {
      tell_light(ray, light);
      so_far = so_far + light.diffuse;
      so_far = so_far + light.specular;
      if (shines(light)) {
        page_.begin();
        page_.equation("sum", {written(so_far, page_.notation())}, "so far");
        page_.end();
      }
    }
    if (!is_black(ray.emission)) {
      page_.equation("emission", {written(ray.emission, page_.notation())},
                     place_of(d_.material_of(ray).place));
      so_far = ray.emission + so_far;
    }
    page_.line("");
    page_.equation("I", {written(so_far, page_.notation())}, "what this surface sends back");
  }

  static bool shines(const DerivedLight& light) { return !is_black(light.seen.arriving); }

  void tell_light(const DerivedRay& ray, const DerivedLight& light) {
    std::string name = "Light " + source_name(d_, light.point.source);
    if (std::size_t(light.point.source) >= scene_.lights.size())
      name = fmt::format("Of {}, light {}, {} {}", source_name(d_, light.point.source), light.number + 1,
                         std::string_view(light.kind) == "directional" ? "a" : "as a", light.kind);
    if (light.point.share < 1)
      name += fmt::format(", at u {}, v {}, which counts 1/{}", short_number(light.point.u),
                          short_number(light.point.v), std::lround(1 / light.point.share));
    page_.line("");
    if (light.state == LightState::out_of_reach) return page_.line(name + ": does not reach this far");
    const SeenLight& seen = light.seen;
    std::string where = fmt::format("{}: L = {}", name, text_of(seen.L));
    if (seen.r < 1e300) where += fmt::format(", r = {}", short_number(seen.r));
    page_.line(where);
    page_.begin();
    if (light.state == LightState::behind)
      page_.line(fmt::format("behind the surface: N.L = {}", short_number(light.NL)));
    else if (light.state == LightState::dark) page_.line("dark in this direction");
    tell_obstacles(light);
    if (shines(light)) {
      const LightFormulas formulas = light_formulas(d_, ray, light);
      term("I", formulas.arriving, seen.arriving);
      for (const auto& definition : formulas.definitions)
        page_.equation(definition.name,
                       {written(definition.formula, page_.notation()), text_in(definition.value)}, "");
      term("diffuse", formulas.diffuse, light.diffuse);
      term("specular", formulas.specular, light.specular);
    }
    page_.end();
  }

  void tell_obstacles(const DerivedLight& light) {
    for (const Obstacle& obstacle : light.obstacles) {
      page_.line(fmt::format("{} {}{}, {} away{}", obstacle.blocks ? "blocked by" : "through",
                             objects_[obstacle.object], place_of(d_.place_of_object(obstacle.object)),
                             short_number(obstacle.distance),
                             obstacle.blocks ? "" : ", which leaves " + short_color(obstacle.leaves)));
    }
  }

  void term(const std::string& name, const MathTerm& formula, const Rgb& value) {
    const std::string symbols = written(formula, page_.notation(), Filled::symbols),
                      numbers = written(formula, page_.notation(), Filled::numbers),
                      result = written(value, page_.notation());
    std::vector<std::string> sides;
    for (const std::string& side : {symbols, numbers, result})
      if (sides.empty() || sides.back() != side) sides.push_back(side);
    page_.equation(name, sides, "");
  }
  void equation(const std::string& name, const std::string& value) {
    page_.equation(name, {in_notation(value)}, "");
  }
  std::string in_notation(const std::string& vector) const {
    return page_.notation() == Notation::mathml ? "<mtext>" + vector + "</mtext>" : vector;
  }
  std::string text_in(const Vec3<double>& v) const { return in_notation(text_of(v)); }

  void tell_sums(const DerivedSample& sample) {
    page_.heading("The sample's colour");
    Rgb sum{};
    for (const DerivedSummand& summand : sample.order) {
      Rgb brings;
      for (int c = 0; c < color_channels; ++c) brings[c] = summand.weight[c] * summand.color[c];
      sum = sum + brings;
      std::vector<std::string> sides{written(brings, page_.notation())};
      if (!(summand.weight == grey(1.0)))
        sides.insert(sides.begin(), written(summand.weight, page_.notation()) + times() +
                                        written(summand.color, page_.notation()));
      page_.equation(fmt::format("ray {}", summand.ray), sides, summand.is_fog ? "the fog before it" : "");
    }
    page_.equation("sum", {written(sum, page_.notation())}, "");
  }
  std::string times() const {
    return page_.notation() == Notation::mathml  ? "<mo>&#8901;</mo>"
           : page_.notation() == Notation::latex ? " \\cdot "
                                                 : " * ";
  }

  void tell_pixel() {
    page_.heading("The pixel");
    constexpr std::size_t most = 16;
    const std::size_t count = d_.samples.size();
    if (count > 1) {
      page_.line(fmt::format("Every sample counts 1/{}: they lie where the filter wants them.", count));
      for (std::size_t i = 0; i < std::min(count, most); ++i)
        page_.equation(fmt::format("sample {}", i), {written(d_.samples[i].color, page_.notation())}, "");
      if (count > most) page_.line(fmt::format("... and {} more; --json has them all.", count - most));
    }
    Rgb linear;
    int code[color_channels];
    const bool encoded = scene_.image.encoding == Encoding::srgb;
    std::string codes;
    for (int c = 0; c < color_channels; ++c) {
      linear[c] = d_.pixel[c];
      code[c] = d_.code(c);
      codes += fmt::format("{}{}", c ? " " : "", code[c]);
    }
    page_.equation("mean", {written(linear, page_.notation())}, "as the EXR holds it, linear");
    page_.swatch(fmt::format("in a PNG{}: {}  (#{:02x}{:02x}{:02x})", encoded ? ", sRGB-encoded" : "", codes,
                             code[0], code[1], code[2]),
                 code);
    page_.line(d_.adds_up() ? "The terms add up to the rendered pixel, bit for bit."
                            : "The terms do NOT add up to the rendered pixel: please report this.");
  }

  const Derivation& d_;
  const Scene& scene_;
  Page& page_;
  std::vector<std::string> objects_, materials_;
};

}  // namespace

std::string source_name(const Derivation& derivation, int source) {
  const int lights = int(derivation.scene->lights.size());
  if (source == surfaces_source(lights)) return "surfaces that shine";
  if (source == background_source(lights)) return "the background";
  const Light& light = derivation.scene->lights[std::size_t(source)];
  return light.name + place_of(light.place);
}

std::string page_of(const Derivation& derivation, int sample, Page& page) {
  Telling(derivation, page).tell(sample);
  return page.finish();
}

}  // namespace lambent
