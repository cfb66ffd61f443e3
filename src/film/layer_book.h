#pragma once
// The channels that a picture with layers has beside R, G and B, and how a pixel's values for them are made.

#include <string>
#include <utility>
#include <vector>

#include "film/layers.h"
#include "lambent/image.h"
#include "scene/scene.h"

namespace lambent {

/// What the samples of one pixel have met.
class PixelHits {
 public:
  void clear();
  /// `distance`: how far the sample lies from the pixel's centre.
  void add(const FirstHit& hit, double distance);

  using Shares = std::vector<std::pair<std::int32_t, std::uint32_t>>;  ///< Index, and how many samples.
  FirstHit central;                    ///< Of the sample nearest the centre; of equals, the first.
  double albedo[color_channels] = {};  ///< Sums.
  Shares objects, materials;           ///< In the order in which they were met.
  std::uint32_t samples = 0;

 private:
  double nearest_ = 0;
};

/// Channels, in this order: for each layer R, G, B; then the wavelengths, where the picture is made of them;
/// then Z, N, P, albedo, UV; then Cryptomatte's. What they mean is in docs/layers.md.
class LayerBook {
 public:
  /// `samples`: the most that a pixel may get.
  LayerBook(const Scene& scene, const LayerPlan& plan, int samples);

  const LayerPlan& plan() const { return plan_; }
  /// Names, from R, G, B on.
  const std::vector<std::string>& channels() const { return channels_; }
  /// Cryptomatte's names and manifests; which light and what each layer is.
  const Metadata& metadata() const { return metadata_; }

  using Shares = std::vector<std::pair<float, double>>;  ///< Ids, and how much of the pixel.
  /// Memory to work in, for one thread.
  struct Work {
    std::vector<double> layers;
    std::vector<float> floats;
    Shares shares;
  };
  /// Fills a pixel's channels of layers. They add up to its R, G, B exactly (`apportion`), which must be
  /// there.
  ///   sums  of each layer's channels over `samples` samples, `stride` numbers from one to the next
  void write_layers(const double* sums, std::size_t stride, double samples, Work& work, float* pixel) const;
  /// Fills the channels after them, of a pixel of one sample, or of more.
  ///   sums  plan().columns() sums, likewise
  void write_data(const double* sums, std::size_t stride, const FirstHit& hit, float* pixel) const;
  void write_data(const double* sums, std::size_t stride, double samples, const PixelHits& hits, Work& work,
                  float* pixel) const;
  /// A pixel that is the mean of four others, which `write` has made of one sample each.
  void merge(const float* const corners[4], float* pixel) const;

 private:
  /// Returns the names' ids.
  std::vector<float> add_cryptomatte(const std::string& name, const std::vector<std::string>& names);
  /// All but Cryptomatte's. Returns where these go.
  float* write_data(const double* sums, std::size_t stride, double samples, const FirstHit& central,
                    const double* albedo_sums, float* pixel) const;
  void write_shares(Shares& shares, float* to) const;

  LayerPlan plan_;
  int crypto_levels_;  ///< Each holds two ids and their coverage.
  std::vector<std::string> channels_;
  Metadata metadata_;
  std::vector<float> object_ids_, material_ids_;
};

/// A name as it stands in a layer's: what is not a letter, a digit, a dash or an underscore would take the
/// name of a channel apart, and is an underscore there.
std::string layer_part(const std::string& name);
/// The name of a layer: "light.key.diffuse", "reflection.ambient".
std::string layer_name(const LayerPlan& plan, int layer, const std::vector<Light>& lights);
/// What people call the scene's objects and materials: their names, or kind and number where they have none;
/// no two alike. After them come the lights that stand in the world.
std::vector<std::string> object_names(const Scene& scene);
std::vector<std::string> material_names(const Scene& scene);

/// Makes floats of the layers of one channel that add up to `total` exactly, as apportion_plainly does, in
/// any order, in float or double.
/// Where a layer is negative (light of few wavelengths lies outside of sRGB), layers may cancel, and no float
/// may hold what a sum on its way comes to: there the sum in double, in any order, rounds to the pixel's
/// float.
void apportion(const double* layers, int count, float total, float* floats);

/// MurmurHash3 (Austin Appleby, public domain), 32 bits with seed 0, which Cryptomatte prescribes.
std::uint32_t murmur3(const std::string& text);
/// The float by which Cryptomatte stores a hash: its bits, with an exponent that is neither zero nor
/// infinite.
float cryptomatte_id(const std::string& name);

}  // namespace lambent
