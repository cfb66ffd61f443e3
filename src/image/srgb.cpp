#include "image/srgb.h"

#include <bit>
#include <cmath>
#include <limits>

#include "lambent/image.h"
#include "math/functions.h"

namespace lambent {

// lambent::pow and not std::pow: the C library's last bit differs between machines, and pictures would with
// it.

double srgb_from_linear(double linear) {
  if (!(linear > 0)) return 0;  // NaN, too
  if (linear >= 1) return 1;
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * lambent::pow(linear, 1 / 2.4) - 0.055;
}

double linear_from_srgb(double encoded) {
  if (!(encoded > 0)) return 0;
  if (encoded >= 1) return 1;
  return encoded <= 0.04045 ? encoded / 12.92 : lambent::pow((encoded + 0.055) / 1.055, 2.4);
}

int quantize(double value, int maximum) {
  if (!(value > 0)) return 0;
  if (value >= 1) return maximum;
  return int(value * maximum + 0.5);
}

namespace {
// All thresholds lie above: the smallest, for 16 bits, is 0.5 / 65535 / 12.92 = 5.9e-7.
constexpr std::uint32_t lowest = std::bit_cast<std::uint32_t>(0x1p-21f);
constexpr std::uint32_t one = std::bit_cast<std::uint32_t>(1.0f);
}  // namespace

SrgbQuantizer::SrgbQuantizer(int bits)
    : maximum_((1 << bits) - 1), shift_(bits == 8 ? 16 : 11), thresholds_(std::size_t(maximum_) + 1) {
  // Neighbouring floats differ by far more than the error of pow in double: the formula never falls from one
  // float to the next, so the thresholds say all of it.
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto reaches = [&](float x, int code) {
    return quantize(srgb_from_linear(double(x)), maximum_) >= code;
  };
  for (int code = 1; code <= maximum_; ++code) {
    float x = float(linear_from_srgb((code - 0.5) / maximum_));
    while (reaches(x, code)) x = std::nextafter(x, 0.0f);
    while (!reaches(x, code)) x = std::nextafter(x, infinity);
    thresholds_[std::size_t(code)] = x;
  }
  int code = 0;
  for (std::uint32_t start = lowest; start < one; start += 1u << shift_) {
    while (code < maximum_ && thresholds_[std::size_t(code) + 1] <= std::bit_cast<float>(start)) ++code;
    first_.push_back(std::uint16_t(code));
  }
}

int SrgbQuantizer::operator()(float linear) const {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return maximum_;
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(linear);
  if (bits < lowest) return 0;
  int code = first_[(bits - lowest) >> shift_];
  while (code < maximum_ && linear >= thresholds_[std::size_t(code) + 1]) ++code;
  return code;
}

const SrgbQuantizer& srgb_quantizer(int bits) {
  if (bits == 8) {
    static const SrgbQuantizer eight(8);
    return eight;
  }
  static const SrgbQuantizer sixteen(16);
  return sixteen;
}

const std::vector<float>& linear_from_srgb_table(int bits) {
  const auto table = [](int maximum) {
    std::vector<float> values;
    for (int code = 0; code <= maximum; ++code)
      values.push_back(float(linear_from_srgb(double(code) / maximum)));
    return values;
  };
  if (bits == 8) {
    static const std::vector<float> eight = table(255);
    return eight;
  }
  static const std::vector<float> sixteen = table(65535);
  return sixteen;
}

}  // namespace lambent
