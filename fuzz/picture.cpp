// PNG and EXR as whole pictures: what `lambent diff` and `lambent relight` read.

#include "image/formats.h"
#include "input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const lambent::ReadImage read =
        lambent::is_exr(bytes) ? lambent::decode_exr(bytes, "input") : lambent::decode_png(bytes, "input");
    lambent::fuzz::check(
        read.image.data.size() ==
            std::size_t(read.image.width) * std::size_t(read.image.height) * read.image.channels.size(),
        "every pixel has every channel");
  } catch (const lambent::InputError& error) {
    lambent::fuzz::check(error);
  }
  return 0;
}
