#include "film/film.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <thread>
#include <utility>

namespace lambent {
namespace {

/// So many zeros. The system hands out memory when it is first written to, page by page; that of a film of
/// layers takes longer than to trace its rays, so all threads ask for it, and for many pages at once.
std::vector<float> zeros(std::size_t count, [[maybe_unused]] int threads) {
  std::vector<float> values;
  values.reserve(count);
#ifdef MADV_POPULATE_WRITE
  const std::size_t page = std::size_t(::sysconf(_SC_PAGESIZE)), bytes = count * sizeof(float);
  // Up to the first page that is its own; then how many these are.
  const std::size_t skipped = (page - std::uintptr_t(values.data()) % page) % page,
                    pages = bytes > skipped ? (bytes - skipped) / page : 0;
  char* const first = reinterpret_cast<char*>(values.data()) + (pages > 0 ? skipped : 0);
  constexpr std::size_t worth_a_thread = 1024;
  const std::size_t crew = std::min(std::size_t(threads), pages / worth_a_thread);
  const auto ask = [&](std::size_t i) {
    const std::size_t from = pages * i / crew, to = pages * (i + 1) / crew;
    // A wish: where the system does not know it, the pages come later.
    ::madvise(first + from * page, (to - from) * page, MADV_POPULATE_WRITE);
  };
  std::vector<std::jthread> others;
  for (std::size_t i = 1; i < crew; ++i) others.emplace_back(ask, i);
  if (crew > 0) ask(0);
  others.clear();
#endif
  values.resize(count);
  return values;
}

}  // namespace

void GuideSums::add(const FirstHit* hits, std::size_t count) {
  for (std::size_t s = 0; s < count; ++s)
    for (int c = 0; c < 3; ++c) albedo[c] += hits[s].albedo[c], normal[c] += hits[s].N[c];
  samples += std::uint32_t(count);
}

Film::Film(const ImageSettings& settings, const LayerBook* book, int threads)
    : width(settings.width + (settings.pattern == Pattern::corners)),
      height(settings.height + (settings.pattern == Pattern::corners)),
      layers(book),
      channels(book ? int(book->channels().size()) : color_channels),
      values(zeros(std::size_t(width) * height * channels, threads)) {}

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

Image develop_guides(const Film& film, const ImageSettings& settings) {
  Image image;
  image.width = settings.width;
  image.height = settings.height;
  image.channels = {"albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z"};
  image.data.reserve(std::size_t(image.width) * std::size_t(image.height) * image.channels.size());
  const int reach = settings.pattern == Pattern::corners ? 1 : 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      GuideSums sum;
      for (int j = y; j <= y + reach; ++j)
        for (int i = x; i <= x + reach; ++i) {
          const GuideSums& one = film.guides[film.index(i, j)];
          for (int c = 0; c < 3; ++c) sum.albedo[c] += one.albedo[c], sum.normal[c] += one.normal[c];
          sum.samples += one.samples;
        }
      const double samples = std::max(1u, sum.samples);
      for (const double a : sum.albedo) image.data.push_back(float(a / samples));
      for (const double n : sum.normal) image.data.push_back(float(n / samples));
    }
  return image;
}

}  // namespace lambent
