#pragma once
// Pieces of the kernels, for one instruction set, each as a loop that can be timed.

#include <cstdint>

namespace lambent::bench {

struct Measured {
  const char* name;
  int lanes;  ///< Numbers, or rays, that one step works on.
  void (*run)(std::uint64_t steps);
};

struct MeasuredKernel {
  const char* isa;
  const Measured* pieces;
  int count;
};

}  // namespace lambent::bench
