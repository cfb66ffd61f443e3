#include "integrators/spectral.h"

#include <algorithm>

namespace lambent {
namespace {

/// The wavelength of a channel: with one in all, that one.
double wavelength_of(const Scene& scene, const Pass& pass, int channel) {
  return scene.spectral.wavelengths[std::size_t(pass.first + std::min(channel, pass.count - 1))];
}

/// Puts every colour of S's table into the pass.
template <class S>
void put_in_pass(const Scene& scene, const Pass& pass, const std::map<std::string, Spectrum>& spectra,
                 S& of) {
  for (const Parameter<S>& parameter : parameters_of<S>) {
    const auto* member = std::get_if<Rgb S::*>(&parameter.member);
    if (!member) continue;
    const auto given = spectra.find(parameter.name);
    Rgb& color = of.*(*member);
    color = given == spectra.end() ? in_pass(pass, color) : in_pass(scene, pass, given->second);
  }
}

bool disperses(const Scene& scene) {
  const auto& wavelengths = scene.spectral.wavelengths;
  const auto does = [&](const Material& material) {
    const auto* glass = material.substance ? std::get_if<Glass>(&*material.substance) : nullptr;
    return glass && std::any_of(wavelengths.begin(), wavelengths.end(), [&](double wavelength) {
             return index_at(glass->index, wavelength) != index_at(glass->index, wavelengths[0]);
           });
  };
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
    return std::any_of(object.materials.begin(), object.materials.end(),
                       [&](std::uint32_t m) { return does(scene.materials[m]); });
  });
}

}  // namespace

std::vector<Pass> passes_of(const Scene& scene) {
  const WavelengthSet set = wavelength_set(scene.spectral.wavelengths);
  const int count = int(set.wavelengths.size()), together = disperses(scene) ? 1 : color_channels;
  std::vector<Pass> passes;
  for (int first = 0; first < count; first += together) {
    Pass pass{};
    pass.first = first;
    pass.count = std::min(together, count - first);
    for (int c = 0; c < color_channels; ++c) {
      const int which = first + std::min(c, pass.count - 1);
      if (c < pass.count) pass.weights[c] = set.weights[std::size_t(which)];
      pass.basis[c] = basis_at(set.wavelengths[std::size_t(which)]);
    }
    passes.push_back(pass);
  }
  return passes;
}

Rgb in_pass(const Scene& scene, const Pass& pass, const Spectrum& spectrum) {
  Rgb result;
  for (int c = 0; c < color_channels; ++c) result[c] = at(spectrum, wavelength_of(scene, pass, c));
  return result;
}

AnyLight light_in_pass(const Scene& scene, const Pass& pass, const Light& light) {
  AnyLight result = light.light;
  std::visit(
      [&](auto& one) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(one)>, std::monostate>)
          put_in_pass(scene, pass, light.spectra, one);
      },
      result);
  return result;
}

Material material_in_pass(const Scene& scene, const Pass& pass, const Material& material) {
  Material result = material;
  put_in_pass(scene, pass, material.spectra, result);
  return result;
}

Rgb ambient_in_pass(const Scene& scene, const Pass& pass) {
  Illumination illumination = scene.illumination;
  put_in_pass(scene, pass, illumination.spectra, illumination);
  return illumination.ambient;
}

ChannelIndex index_of(const Substance& substance, const Scene& scene, const Pass* pass) {
  ChannelIndex result{};
  const auto* metal = std::get_if<Metal>(&substance);
  if (metal && !pass) {
    const RgbConstants rgb = rgb_constants(metal->constants);
    return {rgb.n, rgb.k};
  }
  for (int c = 0; c < color_channels; ++c) {
    const double wavelength = pass ? wavelength_of(scene, *pass, c) : line_d;
    if (metal) {
      result.eta[c] = at(metal->constants.n, wavelength);
      result.k[c] = at(metal->constants.k, wavelength);
    } else {
      result.eta[c] = index_at(std::get<Glass>(substance).index, wavelength);
    }
  }
  return result;
}

}  // namespace lambent
