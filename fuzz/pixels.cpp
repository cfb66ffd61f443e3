// Images of every kind, as textures want them.

#include "image/pixels.h"

#include "input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const lambent::Limits limits = lambent::fuzz::small_options().limits;
  try {
    const lambent::PixelSize before = lambent::pixel_size(bytes, "input", limits);
    const lambent::Pixels pixels = lambent::read_pixels(bytes, "input", limits);
    lambent::fuzz::check(before.width == pixels.width && before.height == pixels.height,
                         "the size told before decoding is the one after it");
    const std::size_t count =
        std::size_t(pixels.width) * std::size_t(pixels.height) * std::size_t(pixels.channels);
    lambent::fuzz::check(pixels.bytes.size() + pixels.floats.size() == count &&
                             (pixels.bytes.empty() || pixels.floats.empty()),
                         "every pixel has every channel");
  } catch (const lambent::InputError& error) {
    lambent::fuzz::check(error);
  }
  return 0;
}
