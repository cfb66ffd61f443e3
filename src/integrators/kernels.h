#pragma once
#include <string>
#include <vector>

#include "integrators/frame.h"

namespace lambent {

/// The kernels that this machine can run, the widest instruction set first.
const std::vector<const Kernel*>& kernels();

/// The kernel named `isa`, or the best one if `isa` is empty. Throws InputError naming the ones there are.
const Kernel& choose_kernel(const std::string& isa);

}  // namespace lambent
