#include "film/film.h"

namespace lambent {

Image develop(const std::vector<float>& film, const ImageSettings& settings) {
  Image image;
  image.width = settings.width;
  image.height = settings.height;
  if (settings.pattern != Pattern::corners) {
    image.data = film;
    return image;
  }
  image.data.resize(std::size_t(image.width) * image.height * color_channels);
  const std::size_t row = std::size_t(image.width + 1) * color_channels;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float* corner = &film[y * row + std::size_t(x) * color_channels];
      for (int c = 0; c < color_channels; ++c)
        image.pixel(x, y)[c] = float((double(corner[c]) + corner[c + color_channels] + corner[c + row] +
                                      corner[c + row + color_channels]) /
                                     4);
    }
  return image;
}

}  // namespace lambent
