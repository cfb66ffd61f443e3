#include "lambent/relight.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "film/layer_book.h"

namespace lambent {
namespace {

constexpr int channels = 3;

[[noreturn]] void refuse(const std::string& message, const std::string& hint) {
  Diagnostic diagnostic;
  diagnostic.message = message;
  diagnostic.hint = hint;
  throw InputError(diagnostic);
}

/// What a layer's name says.
struct Layer {
  std::string way;    ///< "", "reflection", "refraction".
  std::string light;  ///< Or `surfaces`, `sky`; or empty.
  std::string term;
  std::size_t first_channel = 0;
};

Layer parse(const std::string& name) {
  Layer layer;
  std::string rest = name;
  for (const char* way : {"reflection", "refraction"})
    if (rest.starts_with(std::string(way) + ".")) layer.way = way, rest.erase(0, layer.way.size() + 1);
  const std::string light = "light.";
  for (const std::string& source : {light, std::string("surfaces."), std::string("sky.")})
    if (rest.starts_with(source)) {
      const std::size_t first = source == light ? light.size() : 0, dot = rest.rfind('.');
      layer.light = rest.substr(first, dot - first);
      rest.erase(0, dot + 1);
      break;
    }
  layer.term = rest;
  return layer;
}

std::size_t channel_index(const Image& image, const std::string& name) {
  const auto at = std::find(image.channels.begin(), image.channels.end(), name);
  if (at == image.channels.end())
    refuse("the picture lacks the channel '" + name + "'",
           "layers are made by 'lambent render --layers' and lost in most conversions");
  return std::size_t(at - image.channels.begin());
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::vector<Layer> layers_of(const ReadImage& picture) {
  std::vector<Layer> layers;
  for (const auto& [key, value] : picture.metadata) {
    if (key != "lambent:layers") continue;
    std::istringstream names(value);
    for (std::string name; names >> name;) {
      layers.push_back(parse(name));
      layers.back().first_channel = channel_index(picture.image, name + ".R");
      for (int c = 1; c < channels; ++c)
        if (channel_index(picture.image, name + (c == 1 ? ".G" : ".B")) !=
            layers.back().first_channel + std::size_t(c))
          refuse("the channels of the layer '" + name + "' do not stand together", "");
    }
  }
  if (layers.empty())
    refuse("the picture has no layers", "'lambent render SCENE --layers -o layers.exr' makes one that has");
  return layers;
}

/// A factor on a material's term: by the material's number in the picture.
struct MaterialFactor {
  float id;
  std::string term;
  std::array<double, 3> factor;
};

std::vector<MaterialFactor> material_factors(const ReadImage& picture, const Relighting& relighting) {
  std::vector<MaterialFactor> result;
  nlohmann::json manifest = nlohmann::json::object();
  for (const auto& [key, value] : picture.metadata)
    if (key.ends_with("/name") && value == "CryptoMaterial")
      for (const auto& [other, text] : picture.metadata)
        if (other == key.substr(0, key.size() - 4) + "manifest")
          manifest = nlohmann::json::parse(text, nullptr, false);
  for (const auto& [name, factor] : relighting.materials) {
    const std::size_t dot = name.rfind('.');
    const std::string term = dot == std::string::npos ? "" : name.substr(dot + 1);
    if (term != "ambient" && term != "diffuse" && term != "specular")
      refuse("'" + name + "' does not say which of the material's terms is meant",
             "for example red.diffuse; or .ambient, .specular");
    const std::string material = name.substr(0, dot);
    if (!manifest.is_object() || !manifest.contains(material))
      refuse("the picture shows no material '" + material + "'",
             "'lambent info' of the scene names its materials");
    result.push_back({cryptomatte_id(material), term, factor});
  }
  return result;
}

}  // namespace

Relit relight(const ReadImage& picture, const Relighting& relighting) {
  const Image& from = picture.image;
  const std::vector<Layer> layers = layers_of(picture);
  std::vector<std::string> lights, terms;
  for (const Layer& layer : layers) {
    for (const auto& [list, name] : {std::pair{&lights, layer.light}, std::pair{&terms, layer.term}})
      if (!name.empty() && std::find(list->begin(), list->end(), name) == list->end()) list->push_back(name);
    if (!layer.way.empty() && std::find(terms.begin(), terms.end(), layer.way) == terms.end())
      terms.push_back(layer.way);
  }
  const auto check = [](const std::vector<LayerFactor>& given, const std::vector<std::string>& known,
                        const std::string& what, bool are_lights) {
    for (const auto& [name, factor] : given)
      if (std::find(known.begin(), known.end(), are_lights ? layer_part(name) : name) == known.end())
        refuse("the picture has no " + what + " '" + name + "'",
               known.empty() ? "it has none" : "it has: " + joined(known));
  };
  check(relighting.lights, lights, "light", true);
  check(relighting.terms, terms, "term", false);
  const std::vector<MaterialFactor> materials = material_factors(picture, relighting);
  std::vector<std::size_t> ids;  // channels of an id, its coverage beside it
  if (!materials.empty())
    for (std::size_t c = 0; c + 1 < from.channels.size(); ++c)
      if (from.channels[c].starts_with("CryptoMaterial") &&
          (from.channels[c].ends_with(".R") || from.channels[c].ends_with(".B")))
        ids.push_back(c);

  std::vector<std::array<double, 3>> factors;
  for (const Layer& layer : layers) {
    std::array<double, 3> factor{1, 1, 1};
    const auto times = [&](const std::array<double, 3>& by) {
      for (std::size_t c = 0; c < channels; ++c) factor[c] *= by[c];
    };
    for (const auto& [name, by] : relighting.lights)
      if (!layer.light.empty() && layer_part(name) == layer.light) times(by);
    for (const auto& [name, by] : relighting.terms)
      if (name == layer.term || name == layer.way) times(by);
    factors.push_back(factor);
  }

  Relit result;
  result.image.width = from.width, result.image.height = from.height;
  result.image.data.resize(std::size_t(from.width) * std::size_t(from.height) * channels);
  for (int y = 0; y < from.height; ++y)
    for (int x = 0; x < from.width; ++x) {
      const float* pixel = from.pixel(x, y);
      double sum[channels] = {};
      bool mirrors = false, mixed = false;
      for (const MaterialFactor& material : materials)
        for (const std::size_t c : ids)
          mixed |= pixel[c] == material.id && pixel[c + 1] > 0 && pixel[c + 1] < 1;
      for (std::size_t l = 0; l < layers.size(); ++l) {
        const Layer& layer = layers[l];
        for (int c = 0; c < channels; ++c) {
          double value = double(pixel[layer.first_channel + std::size_t(c)]) * factors[l][std::size_t(c)];
          if (layer.way.empty()) {
            for (const MaterialFactor& material : materials)
              if (material.term == layer.term)
                for (const std::size_t id : ids)
                  if (pixel[id] == material.id)
                    value *= 1 + pixel[id + 1] * (material.factor[std::size_t(c)] - 1);
          } else {
            mirrors |= value != 0;
          }
          sum[c] += value;
        }
      }
      for (int c = 0; c < channels; ++c) result.image.pixel(x, y)[c] = float(sum[c]);
      result.mixed_pixels += mixed;
      result.mirroring_pixels += mirrors && !materials.empty();
    }
  return result;
}

}  // namespace lambent
