#include "film/film.h"

#include <utility>

namespace lambent {

Film::Film(const ImageSettings& settings, const LayerBook* book)
    : width(settings.width + (settings.pattern == Pattern::corners)),
      height(settings.height + (settings.pattern == Pattern::corners)),
      layers(book),
      channels(book ? int(book->channels().size()) : color_channels),
      values(std::size_t(width) * height * channels) {}

Image develop(Film film, const ImageSettings& settings) {
  Image image;
  image.width = settings.width;
  image.height = settings.height;
  if (film.layers) image.channels = film.layers->channels();
  if (settings.pattern != Pattern::corners) {
    image.data = std::move(film.values);
    return image;
  }
  image.data.resize(std::size_t(image.width) * image.height * film.channels);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float* const corners[] = {film.pixel(x, y), film.pixel(x + 1, y), film.pixel(x, y + 1),
                                      film.pixel(x + 1, y + 1)};
      float* pixel = image.pixel(x, y);
      for (int c = 0; c < color_channels; ++c)
        pixel[c] = float((double(corners[0][c]) + corners[1][c] + corners[2][c] + corners[3][c]) / 4);
      if (film.layers) film.layers->merge(corners, pixel);
    }
  return image;
}

}  // namespace lambent
