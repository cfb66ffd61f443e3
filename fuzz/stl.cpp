#include "input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lambent::fuzz::run(lambent::import_stl, "input.stl", data, size);
  return 0;
}
