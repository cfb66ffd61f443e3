#include "film/film.h"

#include <utility>

namespace lambent {

Film::Film(const ImageSettings& settings)
    : width(settings.width + (settings.pattern == Pattern::corners)),
      height(settings.height + (settings.pattern == Pattern::corners)),
      colors(std::size_t(width) * height * color_channels) {}

Image develop(Film film, const ImageSettings& settings) {
  Image image;
  image.width = settings.width;
  image.height = settings.height;
  if (settings.pattern != Pattern::corners) {
    image.data = std::move(film.colors);
    return image;
  }
  image.data.resize(std::size_t(image.width) * image.height * color_channels);
  const std::size_t row = std::size_t(image.width + 1) * color_channels;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float* corner = &film.colors[y * row + std::size_t(x) * color_channels];
      for (int c = 0; c < color_channels; ++c)
        image.pixel(x, y)[c] = float((double(corner[c]) + corner[c + color_channels] + corner[c + row] +
                                      corner[c + row + color_channels]) /
                                     4);
    }
  return image;
}

}  // namespace lambent
