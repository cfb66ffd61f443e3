#pragma once
// From linear light to the whole numbers of a PNG, and back.

#include <cstdint>
#include <vector>

namespace lambent {

/// value in [0, 1] to the nearest of 0..maximum; clamps, and NaN is 0.
int quantize(double value, int maximum);

/// quantize(srgb_from_linear(x), 2^bits - 1) for every float x, at the price of a look into two tables.
class SrgbQuantizer {
 public:
  explicit SrgbQuantizer(int bits);  ///< 8 or 16.
  int operator()(float linear) const;

 private:
  int maximum_;
  int shift_;                      ///< Bits of a float that `first_` does not look at.
  std::vector<float> thresholds_;  ///< [code]: the smallest float that becomes this code or a higher one.
  std::vector<std::uint16_t>
      first_;  ///< By the float's leading bits: the code of the smallest float that has them.
};

/// The one for 8 or 16 bits, made at the first call.
const SrgbQuantizer& srgb_quantizer(int bits);

/// The linear value of each code of 8 or 16 bits.
const std::vector<float>& linear_from_srgb_table(int bits);

}  // namespace lambent
