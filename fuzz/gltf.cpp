#include "input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const bool binary = std::string_view(reinterpret_cast<const char*>(data), size).starts_with("glTF");
  lambent::fuzz::run(lambent::import_gltf, binary ? "input.glb" : "input.gltf", data, size);
  return 0;
}
