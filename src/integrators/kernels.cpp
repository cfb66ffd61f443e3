#include "integrators/kernels.h"

#include "lambent/diagnostics.h"

namespace lambent {

// One definition of each stands in the same source file, compiled under another name (see math/isa.h).
namespace isa_baseline {
extern const Kernel whitted_kernel;
}
#ifdef LAMBENT_X86_KERNELS
namespace isa_avx2 {
extern const Kernel whitted_kernel;
}
namespace isa_avx512 {
extern const Kernel whitted_kernel;
}
#endif

const std::vector<const Kernel*>& kernels() {
  static const std::vector<const Kernel*> all = [] {
    std::vector<const Kernel*> result;
#ifdef LAMBENT_X86_KERNELS
    const bool avx2 =
        __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma");
    const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                        __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                        __builtin_cpu_supports("avx512vl");
    if (avx512) result.push_back(&isa_avx512::whitted_kernel);
    if (avx2) result.push_back(&isa_avx2::whitted_kernel);
#endif
    result.push_back(&isa_baseline::whitted_kernel);
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
