#include "own_queries.h"

#include "lambent/diagnostics.h"

namespace lambent {
namespace isa_baseline {
extern const bench::OwnQueries bench_queries;
}
#ifdef LAMBENT_X86_KERNELS
namespace isa_avx2 {
extern const bench::OwnQueries bench_queries;
}
namespace isa_avx512 {
extern const bench::OwnQueries bench_queries;
}
#endif

namespace bench {

const OwnQueries& own_queries(const std::string& isa) {
#ifdef LAMBENT_X86_KERNELS
  for (const OwnQueries* queries : {&isa_avx512::bench_queries, &isa_avx2::bench_queries})
    if (isa == queries->isa) return *queries;
#endif
  if (isa == isa_baseline::bench_queries.isa) return isa_baseline::bench_queries;
  throw Failure("no queries are compiled for the instruction set '" + isa + "'");
}

}  // namespace bench
}  // namespace lambent
