#include "input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const char* const name = bytes.starts_with("glTF") ? "input.glb" : "input.gltf";
  lambent::ImportOptions options = lambent::fuzz::small_options();
  lambent::fuzz::run(lambent::import_gltf, name, data, size, options);
  if (bytes.find("animations") == bytes.npos) return 0;
  options.time = 0.7;  // in the pose that animations give
  lambent::fuzz::run(lambent::import_gltf, name, data, size, options);
  return 0;
}
