#include <cmath>
#include <nlohmann/json.hpp>

#include "explain/terms.h"
#include "explain/write.h"
#include "film/layer_book.h"
#include "lambent/lambent.h"

namespace lambent {
namespace {

using Json = nlohmann::ordered_json;

Json json(const Rgb& color) {
  Json list = Json::array();
  for (int c = 0; c < color_channels; ++c) list.push_back(color[c]);
  return list;
}
Json json(const Vec3<double>& v) { return {v.x, v.y, v.z}; }
/// JSON has no infinity: null.
Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json json(const Place& place) {
  if (place.line == 0) return nullptr;
  return {{"file", place.file}, {"line", place.line}, {"column", place.column}};
}

class Telling {
 public:
  explicit Telling(const Derivation& derivation)
      : d_(derivation),
        scene_(*derivation.scene),
        objects_(object_names(scene_)),
        materials_(material_names(scene_)) {}

  Json pixel(std::optional<int> only) const {
    Json result;
    result["lambent"] = version();
    result["scene"] = scene_.name;
    result["size"] = {scene_.image.width, scene_.image.height};
    result["pixel"] = {d_.x, d_.y};
    result["ambient"] = json(d_.illumination.ambient);
    result["background"] = json(d_.background);
    result["minimum_distance"] = d_.illumination.minimum_distance;
    result["sample_count"] = d_.samples.size();
    result["central_sample"] = d_.central;
    result["samples"] = samples(only);
    if (!d_.passes.empty()) {
      result["wavelengths"] = scene_.spectral.wavelengths;
      result["passes"] = Json::array();
      for (const Derivation& pass : d_.passes) {
        Json one;
        one["wavelengths"] = pass.wavelengths;
        one["weights"] = Json::array();
        for (int i = 0; i < pass.pass.count; ++i) one["weights"].push_back(json(pass.pass.weights[i]));
        one["samples"] = Telling(pass).samples(only);
        result["passes"].push_back(std::move(one));
      }
    }
    result["sum"] = json(d_.sum);
    Rgb linear;
    Json code = Json::array();
    for (int c = 0; c < color_channels; ++c) linear[c] = d_.pixel[c], code.push_back(d_.code(c));
    result["linear"] = json(linear);
    result["encoding"] = scene_.image.encoding == Encoding::srgb ? "srgb" : "none";
    result["code"] = code;
    result["adds_up"] = d_.adds_up();
    return result;
  }

 private:
  Json samples(std::optional<int> only) const {
    Json list = Json::array();
    for (std::size_t i = 0; i < d_.samples.size(); ++i)
      if (!only || std::size_t(*only) == i) list.push_back(sample(i));
    return list;
  }

  Json sample(std::size_t number) const {
    const DerivedSample& sample = d_.samples[number];
    Json result;
    result["sample"] = number;
    result["position"] = {sample.x, sample.y};
    if (is_moving(scene_)) result["time"] = sample.time;
    if (const auto lens = d_.lens_of(sample))
      result["lens"] = {{"at", {lens->at.x, lens->at.y}}, {"focus", json(lens->focus)}};
    result["weight"] = 1.0 / double(d_.samples.size());
    result["color"] = json(sample.color);
    if (!d_.passes.empty()) return result;  // its rays are those of the passes
    result["order"] = Json::array();
    for (const DerivedSummand& summand : sample.order) result["order"].push_back(summand.ray);
    result["ray"] = ray(sample.eye_ray);
    return result;
  }

  Json ray(std::uint32_t number) const {
    const DerivedRay& ray = d_.rays[number];
    Json result;
    result["ray"] = number;
    result["way"] = ray.seen.parent == no_ray         ? "eye"
                    : ray.seen.way == Way::reflection ? "reflection"
                                                      : "refraction";
    if (ray.seen.total) result["total_reflection"] = true;
    result["origin"] = json(ray.seen.o);
    result["direction"] = json(ray.seen.d);
    result["factor"] = json(ray.seen.factor);
    result["weight"] = json(ray.seen.weight);
    if (ray.fog)
      result["fog"] = {{"way", finite(ray.fog->way)},
                       {"share", ray.fog->share},
                       {"brings", json(ray.fog->brings)},
                       {"weight", json(ray.fog->weight)}};
    result["color"] = json(ray.color);
    const bool is_path = scene_.integrator == Integrator::path;
    result["hit"] = !ray.hits ? Json(nullptr) : is_path ? surface(ray) : hit(ray);
    if (is_path) {
      result["density"] = ray.seen.density;
      result["survival"] = ray.seen.survival;
      result["find"] = ray.find ? find(*ray.find) : Json(nullptr);
      result["search"] = ray.search ? search(*ray.search) : Json(nullptr);
    }
    result["rays"] = Json::array();
    for (const std::uint32_t child : ray.children) result["rays"].push_back(this->ray(child));
    return result;
  }

  Json find(const SeenFind& seen) const {
    Json result;
    result["source"] = source_name(d_, seen.source);
    result["radiance"] = json(seen.radiance);
    result["searched_density"] = seen.searched;
    result["mis_weight"] = seen.weight;
    result["brings"] = json(seen.brings);
    return result;
  }
  Json search(const SeenSearch& seen) const {
    Json result;
    result["source"] = source_name(d_, seen.source);
    result["L"] = json(seen.L);
    result["r"] = finite(seen.r);
    result["arriving"] = json(seen.arriving);
    result["density"] = seen.density;
    result["scattered"] = json(seen.scattered);
    result["followed_density"] = seen.followed;
    result["mis_weight"] = seen.weight;
    result["state"] = seen.open ? "visible" : seen.asked ? "blocked" : "dark";
    result["share"] = seen.share;
    result["brings"] = json(seen.brings);
    return result;
  }

  Json hit(const DerivedRay& ray) const {
    Json result = surface(ray);
    const ModelInfo& model = info(d_.model_of(ray));
    result["model"] = model.name;
    result["equation"] = model.equation;
    result["Ia_over_R"] = json(ray.hit.Ia);
    result["ambient"] = formula(ambient_formula(d_, ray), ray.ambient);
    result["lights"] = Json::array();
    for (const DerivedLight& light : ray.lights) result["lights"].push_back(this->light(ray, light));
    return result;
  }

  /// What the ray has met.
  Json surface(const DerivedRay& ray) const {
    const Material& material = d_.material_of(ray);
    Json result;
    result["object"] = objects_[ray.object];
    result["object_place"] = json(d_.place_of_object(ray.object));
    result["primitive"] = ray.primitive;
    result["material"] = materials_[ray.hit.material];
    result["material_place"] = json(material.place);
    result["t"] = ray.hit.t;
    result["R"] = ray.hit.R;
    result["P"] = json(ray.hit.P);
    result["N"] = json(ray.hit.N);
    result["geometric_N"] = json(ray.hit.G);
    result["V"] = json(ray.hit.V);
    result["outside"] = ray.hit.outside;
    result["Ka"] = json(material.ambient);
    result["Kd"] = json(material.diffuse);
    result["Ks"] = json(material.specular);
    result["n"] = material.shininess;
    result["emission"] = json(scene_.integrator == Integrator::path ? material.emission : ray.emission);
    if (ray.hit.numbers.boundary != Boundary::none) {
      result["eta"] = json(ray.hit.numbers.eta);
      result["k"] = json(ray.hit.numbers.k);
    }
    return result;
  }

  static const char* word_for(LightState state) {
    switch (state) {
      case LightState::out_of_reach:
        return "out of reach";
      case LightState::behind:
        return "behind";
      case LightState::dark:
        return "dark";
      case LightState::blocked:
        return "blocked";
      case LightState::visible:
        break;
    }
    return "visible";
  }

  Json light(const DerivedRay& ray, const DerivedLight& light) const {
    const std::size_t source = std::size_t(light.point.source);
    const bool is_given = source < scene_.lights.size();
    Json result;
    result["light"] = is_given ? scene_.lights[source].name : source_name(d_, int(source));
    result["kind"] = light.kind;
    result["place"] = json(is_given ? scene_.lights[source].place : Place{});
    if (!is_given) result["stands_for_it"] = light.number;
    if (light.point.extended) {
      result["point"] = {light.point.u, light.point.v};
      result["counts"] = light.point.share;
    }
    result["state"] = word_for(light.state);
    if (light.state == LightState::out_of_reach) return result;
    const SeenLight& seen = light.seen;
    result["L"] = json(seen.L);
    result["r"] = finite(seen.r);
    result["N.L"] = light.NL;
    result["Il"] = json(seen.I);
    result["attenuation"] = seen.faded;
    result["share"] = json(seen.share);
    result["I"] = json(seen.arriving);
    result["on_the_way"] = Json::array();
    for (const Obstacle& obstacle : light.obstacles)
      result["on_the_way"].push_back({{"object", objects_[obstacle.object]},
                                      {"material", materials_[obstacle.material]},
                                      {"distance", obstacle.distance},
                                      {"blocks", obstacle.blocks},
                                      {"transmit", json(obstacle.leaves)}});
    if (is_black(seen.arriving)) {
      result["diffuse"] = result["specular"] = nullptr;
      return result;
    }
    const LightFormulas formulas = light_formulas(d_, ray, light);
    result["vectors"] = Json::object();
    for (const auto& definition : formulas.definitions)
      result["vectors"][definition.name] = {{"equation", definition.formula},
                                            {"value", json(definition.value)}};
    result["diffuse"] = formula(formulas.diffuse, light.diffuse);
    result["specular"] = formula(formulas.specular, light.specular);
    return result;
  }

  static Json formula(const MathTerm& term, const Rgb& value) {
    Json result;
    result["equation"] = written(term, Notation::text, Filled::symbols);
    result["symbols"] = Json::object();
    for (const MathTerm* symbol : symbols_of(term)) {
      const Rgb& v = symbol->value;
      result["symbols"][symbol->name] = v == grey(v[0]) ? finite(v[0]) : json(v);
    }
    result["value"] = json(value);
    return result;
  }

  const Derivation& d_;
  const Scene& scene_;
  std::vector<std::string> objects_, materials_;
};

}  // namespace

std::string json_of(const Derivation& derivation, std::optional<int> sample) {
  return Telling(derivation).pixel(sample).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) +
         "\n";
}

}  // namespace lambent
