#include <fmt/format.h>

#include "commands.h"
#include "console.h"
#include "files.h"
#include "lambent/lambent.h"

namespace lambent::app {

ExitCode run(const DiffCommand& command) {
  if (!command.output.empty()) check_image_output(command.output);
  const Image a = read_image(command.a).image;
  const Image b = read_image(command.b).image;
  const Difference difference = compare_images(a, b);
  if (!command.output.empty()) write_image(command.output, difference.picture);

  if (difference.differing_pixels == 0) {
    print(fmt::format("identical: {} x {} pixels, every bit\n", a.width, a.height));
    return done;
  }
  const std::size_t pixels = std::size_t(a.width) * std::size_t(a.height);
  std::string text = fmt::format("pixels that differ    {} of {} ({:.3g} %)\n", difference.differing_pixels,
                                 pixels, 100 * double(difference.differing_pixels) / double(pixels));
  // Values may differ in their bits and be equal: 0 and -0.
  const std::string where = difference.largest > 0 ? fmt::format(" at pixel {},{} in {}", difference.x,
                                                                 difference.y, difference.channel)
                                                   : "";
  text += fmt::format("largest difference    {:.6g}{}\n", difference.largest, where);
  text += fmt::format("largest relative      {:.6g}\n", difference.largest_relative);
  text += fmt::format("largest of 8 bits     {} of 255\n", difference.largest_8_bit);
  text += fmt::format("mean difference       {:.6g}\n", difference.mean);
  text += fmt::format("root mean square      {:.6g}\n", difference.root_mean_square);
  const bool within = difference.largest <= command.tolerance;  // not so for NaN
  text += fmt::format("{} the tolerance of {:.6g}\n", within ? "within" : "beyond", command.tolerance);
  print(text);
  return within ? done : failed;
}

}  // namespace lambent::app
