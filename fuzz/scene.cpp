#include "input.h"
#include "lambent/lambent.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string name = lambent::fuzz::folder().path() + "/input.yaml";
    const lambent::ScenePtr scene =
        lambent::parse_scene(std::string_view(reinterpret_cast<const char*>(data), size), name);
    lambent::fuzz::check(scene != nullptr, "what is read is there");
  } catch (const lambent::InputError& error) {
    lambent::fuzz::check(error);
  }
  return 0;
}
