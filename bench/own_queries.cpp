#include "own_queries.h"

#include "compiled_sets.h"

LAMBENT_COMPILED_SETS(const bench::OwnQueries, bench_queries)

namespace lambent::bench {

const OwnQueries& own_queries(const std::string& isa) {
  return compiled_for<OwnQueries>(isa, LAMBENT_ALL_COMPILED(bench_queries));
}

}  // namespace lambent::bench
