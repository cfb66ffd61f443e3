// What scene files say of wavelengths: metals, glasses, spectra, and the integrator that follows them.

#include <gtest/gtest.h>

#include "lambent/lambent.h"
#include "scene/scene.h"

namespace lambent {
namespace {

ScenePtr with_material(const std::string& material, const std::string& more = "") {
  return parse_scene("lambent: 1\ncamera: {eye: [0, 0, 5], target: [0, 0, 0]}\n" + more +
                     "materials: [{name: m, " + material + "}]\n");
}
const Material& material(const ScenePtr& scene) { return scene->materials.at(0); }
/// "message | hint" of the first error.
std::string error_of(const std::string& material_text, const std::string& more = "") {
  try {
    with_material(material_text, more);
  } catch (const InputError& error) {
    const Diagnostic& first = error.diagnostics().at(0);
    return first.message + (first.hint.empty() ? "" : " | " + first.hint);
  }
  return "no error";
}

TEST(Metals, NameTheirModelAndReflectByTheirRoughness) {
  const auto scene = with_material("metal: gold");
  const Material& gold = material(scene);
  EXPECT_EQ(std::get<Metal>(*gold.substance).name, "gold");
  EXPECT_EQ(gold.model, ModelId::wavelength_specular);
  EXPECT_EQ(gold.reflect[0], 1);
  EXPECT_EQ(gold.ambient[0], 0);  // the mirror ray brings all there is
  EXPECT_EQ(gold.diffuse[0], 0);
  const auto rough = with_material("metal: gold, roughness: 1");
  EXPECT_EQ(material(rough).diffuse[0], 1);  // a lobe as wide as Lambert's is Lambert's
  EXPECT_EQ(material(rough).reflect[0], 0);
}

TEST(Metals, LeaveAloneWhatTheFileSays) {
  const auto scene = with_material("metal: copper, model: phong, specular: 0.25, shininess: 7, reflect: 0.5");
  EXPECT_EQ(material(scene).model, ModelId::phong);
  EXPECT_EQ(material(scene).specular[0], 0.25);
  EXPECT_EQ(material(scene).shininess, 7);
  EXPECT_EQ(material(scene).reflect[0], 0.5);
}

TEST(Metals, MayHaveATableOfTheirOwn) {
  const auto scene = with_material("metal: {wavelengths: [400, 700], n: [1, 0.5], k: [2, 4]}");
  const auto& constants = std::get<Metal>(*material(scene).substance).constants;
  EXPECT_EQ(at(constants.n, 550), 0.75);
  EXPECT_EQ(at(constants.k, 550), 3);
}

TEST(Glasses, AreNamedOrGivenByNumbers) {
  EXPECT_NEAR(index_at(std::get<Glass>(*material(with_material("glass: bk7")).substance).index, line_d),
              1.5168, 1e-4);
  EXPECT_NEAR(
      abbe_of(std::get<Glass>(*material(with_material("glass: {ior: 1.7, abbe: 30}")).substance).index), 30,
      1e-9);
  EXPECT_EQ(
      index_at(std::get<Glass>(
                   *material(with_material("glass: {wavelengths: [400, 600], n: [1.6, 1.5]}")).substance)
                   .index,
               500),
      1.55);
}

TEST(Substances, WhatIsWrongWithThem) {
  EXPECT_EQ(error_of("metal: glod"), "there is no metal 'glod' | did you mean 'gold'?");
  EXPECT_EQ(error_of("glass: bk8"), "there is no glass 'bk8' | did you mean 'bk7'?");
  EXPECT_EQ(error_of("metal: gold, glass: bk7"), "'glass' stands beside 'metal' | a surface is one of them");
  EXPECT_EQ(error_of("metal: gold, ior: 1.5"),
            "'ior' stands beside 'metal' | which says what reflects and refracts");
  EXPECT_EQ(error_of("metal: {wavelengths: [400, 500], n: [1], k: [2, 3]}"),
            "'n' has 1 numbers, 'wavelengths' 2 | there is one for each wavelength");
  EXPECT_EQ(
      error_of("metal: {wavelengths: [500, 400], n: [1, 1], k: [2, 3]}"),
      "number 2 of 'wavelengths' is not more than the one before it | wavelengths stand in growing order, "
      "each once");
  EXPECT_EQ(error_of("metal: {wavelengths: [200], n: [1], k: [2]}"),
            "number 1 of 'wavelengths' is 200, but must be at least 360");
  EXPECT_EQ(error_of("glass: {n: [1.5]}"),
            "'n' needs 'wavelengths' | a glass is a name, {ior, abbe}, or {wavelengths: [...], n: [...]}");
  EXPECT_EQ(error_of("metal: gold, roughness: 2"), "'roughness' is 2, but must be 0 to 1");
}

TEST(Spectra, AreColoursToo) {
  const auto scene =
      with_material("diffuse: {wavelengths: [400, 700], values: [0.5, 0.5]}, emission: {blackbody: 3000}");
  const Material& m = material(scene);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(m.diffuse[c], 0.5, 1e-13);
  EXPECT_GT(m.emission[0], m.emission[1]);
  EXPECT_GT(m.emission[1], m.emission[2]);
  EXPECT_EQ(m.spectra.size(), 2u);
}

TEST(Spectra, WhatIsWrongWithThem) {
  EXPECT_EQ(
      error_of("diffuse: {wavelengths: [400, 700]}"),
      "'diffuse' is a mapping that gives no spectrum | a spectrum is {blackbody: KELVIN}, {wavelengths: "
      "[...], values: [...]} or {wavelengths: [...], power: [...]}");
  EXPECT_EQ(error_of("emission: {blackbody: 3000, values: [1]}").substr(0, 40),
            "'emission' gives more than one spectrum ");
  EXPECT_EQ(error_of("emission: {power: [1, 2]}"),
            "'power' needs 'wavelengths' | as many, in nm: at which these numbers hold");
  EXPECT_EQ(error_of("diffuse: {wavelengths: [400, 700], values: [1]}"),
            "'values' has 1 numbers, 'wavelengths' 2 | there is one for each wavelength");
  EXPECT_EQ(error_of("emission: {blackbody: 100}"), "'blackbody' is 100, but must be at least 500");
  EXPECT_EQ(error_of("emission: {blackbdy: 3000}"),
            "unknown key 'blackbdy' in a spectrum | did you mean 'blackbody'?");
}

TEST(Spectral, HasTwelveWavelengthsOrThoseThatAreGiven) {
  const auto usual = with_material("diffuse: 1", "integrator: {spectral: {}}\n");
  EXPECT_EQ(usual->spectral.wavelengths, even_wavelengths(12));
  const auto list =
      with_material("diffuse: 1", "integrator: {spectral: {wavelengths: [450, 550, 650], max_depth: 2}}\n");
  EXPECT_EQ(list->spectral.wavelengths, (std::vector<double>{450, 550, 650}));
  EXPECT_EQ(list->whitted.max_depth, 2);
  EXPECT_EQ(error_of("diffuse: 1", "integrator: {spectral: {wavelengths: 0}}\n"),
            "'wavelengths' is 0, but must be 1 to 360");
  EXPECT_EQ(
      error_of("diffuse: 1", "integrator: {spectral: {wavelengths: [450, 450]}}\n"),
      "number 2 of 'wavelengths' is not more than the one before it | wavelengths stand in growing order, "
      "each once");
}

TEST(Spectral, FromOutsideTakesThePlaceOfTheFiles) {
  LoadOptions options;
  options.set = {{"integrator.spectral.wavelengths", "6"}};
  const auto scene = parse_scene(
      "lambent: 1\ncamera: {eye: [0, 0, 5], target: [0, 0, 0]}\nintegrator: {whitted: {max_depth: 3}}\n",
      "scene", options);
  ASSERT_EQ(scene->integrator, Integrator::spectral);
  EXPECT_EQ(scene->spectral.wavelengths.size(), 6u);
}

}  // namespace
}  // namespace lambent
