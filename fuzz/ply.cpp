#include "input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lambent::fuzz::run(lambent::import_ply, "input.ply", data, size);
  return 0;
}
