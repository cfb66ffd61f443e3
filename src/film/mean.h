#pragma once
#include <bit>

#include "math/pack.h"

namespace lambent {
inline namespace LAMBENT_ISA {

/// Divides sums by a number of samples; where that is a power of two by a multiplication, with the same bits:
/// its reciprocal is exact. For one sum or a packet of them.
template <class F> class Mean {
 public:
  explicit Mean(int samples)
      : samples_(double(samples)),
        share_(1.0 / samples),
        is_exact_(std::has_single_bit(static_cast<unsigned>(samples))) {}
  F of(const F& sum) const { return is_exact_ ? sum * share_ : sum / samples_; }

 private:
  F samples_, share_;
  bool is_exact_;
};

}  // namespace LAMBENT_ISA
}  // namespace lambent
