#pragma once
// What bench compiles once for each instruction set, found by the set's name.
//
//   LAMBENT_COMPILED_SETS(const OwnQueries, bench_queries)      at file scope, outside of lambent
//   ... compiled_for(isa, LAMBENT_ALL_COMPILED(bench_queries))

#include <initializer_list>
#include <string>

#include "lambent/diagnostics.h"

#define LAMBENT_COMPILED_SET(set, Type, name) \
  namespace lambent::set {                    \
  extern Type name;                           \
  }

#ifdef LAMBENT_X86_KERNELS
#define LAMBENT_COMPILED_SETS(Type, name)        \
  LAMBENT_COMPILED_SET(isa_baseline, Type, name) \
  LAMBENT_COMPILED_SET(isa_avx2, Type, name)     \
  LAMBENT_COMPILED_SET(isa_avx512, Type, name)
#define LAMBENT_ALL_COMPILED(name) \
  { &isa_baseline::name, &isa_avx2::name, &isa_avx512::name }
#else
#define LAMBENT_COMPILED_SETS(Type, name) LAMBENT_COMPILED_SET(isa_baseline, Type, name)
#define LAMBENT_ALL_COMPILED(name) \
  { &isa_baseline::name }
#endif

namespace lambent::bench {

/// The one whose `isa` is this name. Throws Failure where none is.
template <class T> const T& compiled_for(const std::string& isa, std::initializer_list<const T*> all) {
  for (const T* one : all)
    if (isa == one->isa) return *one;
  throw Failure("nothing is compiled for the instruction set '" + isa + "'");
}

}  // namespace lambent::bench
