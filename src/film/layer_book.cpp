#include "film/layer_book.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "film/apportion.h"
#include "scene/standing_lights.h"

namespace lambent {
namespace {

/// "wavelength.550nm".
std::string wavelength_name(double wavelength) { return fmt::format("wavelength.{}nm", wavelength); }

constexpr int most_crypto_levels = 3;  // six ids a pixel, the usual number
// Z, N, P, albedo, UV
constexpr const char* data_names[] = {"Z",   "N.X",      "N.Y",      "N.Z",      "P.X",  "P.Y",
                                      "P.Z", "albedo.R", "albedo.G", "albedo.B", "UV.U", "UV.V"};
constexpr int data_count = int(std::size(data_names)), first_albedo = 7;

std::string hex(std::uint32_t number) { return fmt::format("{:08x}", number); }

void add_share(PixelHits::Shares& shares, std::int32_t index) {
  for (auto& [known, samples] : shares)
    if (known == index) return void(++samples);
  shares.emplace_back(index, 1);
}

std::vector<std::string> made_unique(std::vector<std::string> names) {
  std::set<std::string> taken(names.begin(), names.end());
  std::map<std::string, int> seen;
  for (std::string& name : names) {
    if (++seen[name] == 1) continue;
    int number = seen[name];
    std::string other;
    do other = name + " " + std::to_string(number++);
    while (!taken.insert(other).second);
    name = other;
  }
  return names;
}

}  // namespace

std::uint32_t murmur3(const std::string& text) {
  const auto mix = [](std::uint32_t k) { return std::rotl(k * 0xcc9e2d51u, 15) * 0x1b873593u; };
  std::uint32_t h = 0;
  const std::size_t whole = text.size() / 4 * 4;
  for (std::size_t i = 0; i < whole; i += 4) {
    std::uint32_t k = 0;
    for (std::size_t b = 0; b < 4; ++b)
      k |= std::uint32_t(static_cast<unsigned char>(text[i + b])) << (8 * b);
    h = std::rotl(h ^ mix(k), 13) * 5 + 0xe6546b64u;
  }
  std::uint32_t rest = 0;
  for (std::size_t i = text.size(); i > whole; --i)
    rest = rest << 8 | static_cast<unsigned char>(text[i - 1]);
  if (whole < text.size()) h ^= mix(rest);
  h ^= std::uint32_t(text.size());
  h = (h ^ h >> 16) * 0x85ebca6bu;
  h = (h ^ h >> 13) * 0xc2b2ae35u;
  return h ^ h >> 16;
}

std::string layer_part(const std::string& name) {
  std::string result = name;
  for (char& c : result)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_' && !(c & 0x80)) c = '_';
  return result;
}

float cryptomatte_id(const std::string& name) {
  std::uint32_t bits = murmur3(name);
  const std::uint32_t exponent = bits >> 23 & 255;
  if (exponent == 0 || exponent == 255) bits ^= 1u << 23;
  return std::bit_cast<float>(bits);
}

void PixelHits::clear() {
  central = {};
  std::fill_n(albedo, color_channels, 0.0);
  objects.clear(), materials.clear();
  samples = 0;
}

void PixelHits::add(const FirstHit& hit, double distance) {
  if (samples++ == 0 || distance < nearest_) nearest_ = distance, central = hit;
  if (hit.object < 0) return;
  for (int c = 0; c < color_channels; ++c) albedo[c] += hit.albedo[c];
  add_share(objects, hit.object);
  add_share(materials, hit.material);
}

namespace {

/// Where light of some wavelengths lies outside of sRGB, layers are negative, and may take each other away.
/// What is missing goes to them from the largest to the smallest, to each as much as its last place can take.
void apportion_signed(const double* layers, int count, float total, float* floats) {
  double largest = std::abs(double(total)), missing = total;
  for (int i = 0; i < count; ++i) largest = std::max(largest, std::abs(layers[i]));
  // All become multiples of u, so that a double holds every sum of them: 44 bits below the largest.
  int exponent = 0;
  std::frexp(largest, &exponent);
  const double u = std::ldexp(1.0, exponent - 44);
  std::vector<int> by_size;
  for (int i = 0; i < count; ++i) {
    floats[i] = float(std::round(layers[i] / u) * u);
    missing -= floats[i];
    by_size.push_back(i);
  }
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](int a, int b) { return std::abs(floats[a]) > std::abs(floats[b]); });
  for (const int i : by_size) {
    const float more = float(floats[i] + missing);
    missing -= double(more) - double(floats[i]);
    floats[i] = more;
  }
}

}  // namespace

void apportion(const double* layers, int count, float total, float* floats) {
  if (std::isfinite(total) && std::any_of(layers, layers + count, [](double one) { return one < 0; }))
    return apportion_signed(layers, count, total, floats);
  std::vector<double> plain(static_cast<std::size_t>(count));
  const bool possible = apportion_plainly(layers, count, double(total), plain.data());
  for (int i = 0; i < count; ++i) floats[i] = float(possible ? plain[std::size_t(i)] : layers[i]);
}

std::string layer_name(const LayerPlan& plan, int layer, const std::vector<Light>& lights) {
  const int term = layer % plan.per_way();
  const Way way = plan.way_of(layer);
  std::string name = way == Way::direct ? "" : way == Way::reflection ? "reflection." : "refraction.";
  if (term == LayerPlan::ambient) return name + "ambient";
  if (term == LayerPlan::emission) return name + "emission";
  if (term == LayerPlan::background) return name + "background";
  if (plan.fog && term == plan.fog_layer()) return name + "fog";
  const int light = (term - LayerPlan::first_light) / 2;
  const int count = int(lights.size());
  name += light == surfaces_source(count)     ? "surfaces"
          : light == background_source(count) ? "sky"
                                              : "light." + layer_part(lights[std::size_t(light)].name);
  if (plan.paths) return name + (term == LayerPlan::direct(light) ? ".direct" : ".indirect");
  return name + (term == LayerPlan::diffuse(light) ? ".diffuse" : ".specular");
}

std::vector<std::string> object_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Object& object : scene.objects)
    names.push_back(object.name.empty() ? scene.shapes[object.shape].name : object.name);
  for (const StandingLight& light : standing_lights(scene)) names.push_back(light.material.name);
  return made_unique(std::move(names));
}
std::vector<std::string> material_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Material& material : scene.materials)
    names.push_back(material.name.empty() ? "material" : material.name);
  for (const StandingLight& light : standing_lights(scene)) names.push_back(light.material.name);
  return made_unique(std::move(names));
}

LayerBook::LayerBook(const Scene& scene, const LayerPlan& plan, int samples)
    : plan_(plan),
      crypto_levels_(std::clamp((samples + 1) / 2, 1, most_crypto_levels)),
      channels_{"R", "G", "B"} {
  std::vector<std::string> names;
  for (int layer = 0; layer < plan_.count(); ++layer) names.push_back(layer_name(plan_, layer, scene.lights));
  std::string list;
  for (const std::string& name : made_unique(std::move(names))) {
    for (const char* channel : {".R", ".G", ".B"}) channels_.push_back(name + channel);
    list += (list.empty() ? "" : " ") + name;
  }
  metadata_.emplace_back("lambent:layers", list);
  if (plan_.wavelengths > 0)
    for (const double wavelength : scene.spectral.wavelengths)
      channels_.push_back(wavelength_name(wavelength));
  channels_.insert(channels_.end(), std::begin(data_names), std::end(data_names));
  object_ids_ = add_cryptomatte("CryptoObject", object_names(scene));
  material_ids_ = add_cryptomatte("CryptoMaterial", material_names(scene));
}

std::vector<float> LayerBook::add_cryptomatte(const std::string& name,
                                              const std::vector<std::string>& names) {
  for (int level = 0; level < crypto_levels_; ++level)
    for (const char* channel : {".R", ".G", ".B", ".A"})
      channels_.push_back(name + "0" + std::to_string(level) + channel);
  std::vector<float> ids;
  nlohmann::ordered_json::object_t manifest;
  for (const std::string& one : names) {
    ids.push_back(cryptomatte_id(one));
    // No two names are alike: there is none to look for before this one is added.
    manifest.emplace_back(one, hex(std::bit_cast<std::uint32_t>(ids.back())));
  }
  const std::string key = "cryptomatte/" + hex(murmur3(name)).substr(0, 7) + "/";
  metadata_.emplace_back(key + "name", name);
  metadata_.emplace_back(key + "hash", "MurmurHash3_32");
  metadata_.emplace_back(key + "conversion", "uint32_to_float32");
  metadata_.emplace_back(key + "manifest",
                         nlohmann::ordered_json(std::move(manifest))
                             .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  return ids;
}

void LayerBook::write_shares(Shares& shares, float* to) const {
  if (shares.size() > 1)
    std::stable_sort(shares.begin(), shares.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
  const std::size_t room = std::size_t(crypto_levels_) * 2;
  for (std::size_t i = 0; i < room; ++i) {
    const bool there = i < shares.size();
    to[2 * i] = there ? shares[i].first : 0.0f;
    to[2 * i + 1] = there ? float(shares[i].second) : 0.0f;
  }
}

void LayerBook::write_layers(const double* sums, std::size_t stride, double samples, Work& work,
                             float* pixel) const {
  const int count = plan_.count();
  work.layers.resize(std::size_t(count));
  work.floats.resize(std::size_t(count));
  for (int c = 0; c < color_channels; ++c) {
    for (int i = 0; i < count; ++i)
      work.layers[std::size_t(i)] = sums[std::size_t(i * color_channels + c) * stride] / samples;
    apportion(work.layers.data(), count, pixel[c], work.floats.data());
    for (int i = 0; i < count; ++i) pixel[(i + 1) * color_channels + c] = work.floats[std::size_t(i)];
  }
}

float* LayerBook::write_data(const double* sums, std::size_t stride, double samples, const FirstHit& central,
                             const double* albedo_sums, float* pixel) const {
  float* to = pixel + (plan_.count() + 1) * color_channels;
  for (int i = 0; i < plan_.wavelengths; ++i)
    *to++ = float(sums[std::size_t(plan_.count() * color_channels + i) * stride] / samples);
  *to++ = central.object < 0 ? std::numeric_limits<float>::infinity() : central.R;
  for (const float n : central.N) *to++ = n;
  for (const float p : central.P) *to++ = p;
  for (int c = 0; c < color_channels; ++c) *to++ = float(albedo_sums[c] / samples);
  for (const float t : central.uv) *to++ = t;
  return to;
}

void LayerBook::write_data(const double* sums, std::size_t stride, const FirstHit& hit, float* pixel) const {
  const double albedo[] = {hit.albedo[0], hit.albedo[1], hit.albedo[2]};
  float* to = write_data(sums, stride, 1, hit, albedo, pixel);
  std::fill_n(to, crypto_levels_ * 8, 0.0f);
  if (hit.object < 0) return;
  to[0] = object_ids_[std::size_t(hit.object)];
  to[crypto_levels_ * 4] = material_ids_[std::size_t(hit.material)];
  to[1] = to[crypto_levels_ * 4 + 1] = 1;
}

void LayerBook::write_data(const double* sums, std::size_t stride, double samples, const PixelHits& hits,
                           Work& work, float* pixel) const {
  float* to = write_data(sums, stride, samples, hits.central, hits.albedo, pixel);
  for (const auto& [met, ids] :
       {std::pair{&hits.objects, &object_ids_}, std::pair{&hits.materials, &material_ids_}}) {
    work.shares.clear();
    for (const auto& [index, share] : *met)
      work.shares.emplace_back((*ids)[std::size_t(index)], double(share) / hits.samples);
    write_shares(work.shares, to);
    to += crypto_levels_ * 4;
  }
}

void LayerBook::merge(const float* const corners[4], float* pixel) const {
  const auto mean = [&](std::size_t channel) {
    return (double(corners[0][channel]) + corners[1][channel] + corners[2][channel] + corners[3][channel]) /
           4;
  };
  Work work;
  std::vector<double> layers;
  const std::size_t after_layers = std::size_t(plan_.count() + 1) * color_channels,
                    data = after_layers + std::size_t(plan_.wavelengths);
  for (std::size_t i = color_channels; i < after_layers; ++i) layers.push_back(mean(i));
  write_layers(layers.data(), 1, 1, work, pixel);
  for (std::size_t i = after_layers; i < data; ++i) pixel[i] = float(mean(i));
  for (std::size_t i = data; i < data + data_count; ++i)
    pixel[i] =
        i >= data + first_albedo && i < data + first_albedo + color_channels ? float(mean(i)) : corners[0][i];
  for (std::size_t at = data + data_count; at < channels_.size(); at += std::size_t(crypto_levels_) * 4) {
    Shares shares;
    for (int corner = 0; corner < 4; ++corner) {
      const float id = corners[corner][at], covered = corners[corner][at + 1] / 4;
      if (covered == 0) continue;
      const auto known =
          std::find_if(shares.begin(), shares.end(), [&](const auto& share) { return share.first == id; });
      if (known == shares.end()) shares.emplace_back(id, covered);
      else known->second += covered;
    }
    write_shares(shares, pixel + at);
  }
}

}  // namespace lambent
