#include "integrators/kernels.h"

#include "lambent/diagnostics.h"

namespace lambent {

// One definition of each stands in the same source file, compiled under another name (see math/isa.h).
#define LAMBENT_KERNEL(isa)                                                         \
  namespace isa_##isa {                                                             \
    RenderPixels render_whitted, render_path;                                       \
    ApportionLayers apportion_layers;                                               \
    constexpr Kernel kernel{#isa, {render_whitted, render_path}, apportion_layers}; \
  }
#ifdef LAMBENT_KERNELS_baseline
LAMBENT_KERNEL(baseline)
#endif
#ifdef LAMBENT_KERNELS_avx2
LAMBENT_KERNEL(avx2)
#endif
#ifdef LAMBENT_KERNELS_avx512
LAMBENT_KERNEL(avx512)
#endif

const std::vector<const Kernel*>& kernels() {
  static const std::vector<const Kernel*> all = [] {
    std::vector<const Kernel*> result;
#if defined(__x86_64__)
    [[maybe_unused]] const bool avx2 =
        __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma");
    [[maybe_unused]] const bool avx512 =
        avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl");
#endif
#ifdef LAMBENT_KERNELS_avx512
    if (avx512) result.push_back(&isa_avx512::kernel);
#endif
#ifdef LAMBENT_KERNELS_avx2
    if (avx2) result.push_back(&isa_avx2::kernel);
#endif
#ifdef LAMBENT_KERNELS_baseline
    result.push_back(&isa_baseline::kernel);
#endif
    return result;
  }();
  return all;
}

const Kernel& choose_kernel(const std::string& isa) {
  if (isa.empty()) return *kernels().front();
  std::string known;
  for (const Kernel* kernel : kernels()) {
    if (isa == kernel->isa) return *kernel;
    known += (known.empty() ? "" : ", ") + std::string(kernel->isa);
  }
  Diagnostic diagnostic;
  diagnostic.message = "no kernels for the instruction set '" + isa + "' on this machine";
  diagnostic.hint = "there are: " + known;
  throw InputError(diagnostic);
}

}  // namespace lambent
