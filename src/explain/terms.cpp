#include "explain/terms.h"

namespace lambent {
namespace {

Surface<Traced, Color<Traced>> surface_symbols(const Derivation& derivation, const DerivedRay& ray) {
  const Material& material = derivation.material_of(ray);
  const ModelInfo& model = info(derivation.model_of(ray));
  Surface<Traced, Color<Traced>> s;
  s.N = vector_symbol("N", ray.hit.N);
  s.V = vector_symbol("V", ray.hit.V);
  s.ka = color_symbol("Ka", material.ambient);
  s.kd = color_symbol("Kd", material.diffuse);
  s.ks = color_symbol("Ks", material.specular);
  s.n = Traced::symbol("n", material.shininess);
  s.outside = Traced::symbol("side", ray.hit.outside ? 1 : -1);
  s.to_camera = vector_symbol("E", -camera_record(derivation.scene->camera).forward);
  const SeenMaterial& seen = ray.hit.numbers;
  s.eta = color_symbol("eta", seen.eta);
  s.k = color_symbol("k", seen.k);
  if (seen.boundary == Boundary::glass && !ray.hit.outside)
    for (int c = 0; c < color_channels; ++c) s.eta[c] = Traced(1) / s.eta[c];
  for (int i = 0; i < max_model_parameters; ++i) {
    if (!model.parameters[i].name) {
      s.own[i] = Traced(0);
      continue;
    }
    s.own[i] = Traced::symbol(model.parameters[i].name, own_number(material, model.parameters[i]));
  }
  return s;
}

}  // namespace

MathTerm ambient_formula(const Derivation& derivation, const DerivedRay& ray) {
  Formulas formulas;
  const Illumination& illumination = derivation.illumination;
  const ModelId model = derivation.model_of(ray);
  const auto s = surface_symbols(derivation, ray);
  const Traced faded = attenuate(ambient_attenuation_of(illumination, model), Traced::symbol("R", ray.hit.R),
                                 Traced(illumination.minimum_distance));
  Color<Traced> Ia = color_symbol("Ia", illumination.ambient) * faded;
  if (illumination.occlusion) Ia = Ia * Traced::symbol("A", ray.hit.open);
  return with_model(model, [&]<class Model>() { return simplified(formulas, ambient_term<Model>(s, Ia)); });
}

LightFormulas light_formulas(const Derivation& derivation, const DerivedRay& ray,
                             const DerivedLight& derived) {
  const SeenLight& light = derived.seen;
  LightFormulas result;
  {
    Formulas formulas;
    const Traced faded =
        attenuate(attenuation_of(derivation.illumination, derivation.model_of(ray)),
                  Traced::symbol("r", light.r), Traced(derivation.illumination.minimum_distance));
    Color<Traced> I = faded * color_symbol("Il", light.I);
    // 1 where nothing is in the way.
    if (!(light.share == grey(1.0))) I = color_symbol("T", light.share) * I;
    result.arriving = simplified(formulas, I);
  }
  Formulas formulas;
  const auto s = surface_symbols(derivation, ray);
  const Rgb& Il = derived.Il;
  const Arriving<Traced, Color<Traced>> arriving{vector_symbol("L", light.L),
                                                 color_symbol("I", light.arriving), color_symbol("Il", Il),
                                                 Traced::symbol("fade", light.faded * share_of(light.I, Il))};
  with_model(derivation.model_of(ray), [&]<class Model>() {
    const auto terms = Model::evaluate(s, arriving);
    result.diffuse = simplified(formulas, terms.diffuse);
    result.specular = simplified(formulas, terms.specular);
  });
  result.definitions = formulas.definitions;
  return result;
}

}  // namespace lambent
