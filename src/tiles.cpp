#include "tiles.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "film/adaptive.h"
#include "film/mean.h"

namespace lambent {
namespace {

/// The pixels of a tile, from its corner on, in squares of 4 by 4, and four of these in squares of 8 by 8: so
/// the rays of a packet lie close together, and those of a beam.
std::vector<Pixel> pixels_of_a_tile(int width, int height) {
  std::vector<Pixel> pixels;
  const auto in_squares = [](int step, int left, int top, int right, int bottom, const auto& visit) {
    for (int y = top; y < bottom; y += step)
      for (int x = left; x < right; x += step)
        visit(x, y, std::min(x + step, right), std::min(y + step, bottom));
  };
  in_squares(8, 0, 0, width, height, [&](int left, int top, int right, int bottom) {
    in_squares(4, left, top, right, bottom, [&](int l, int t, int r, int b) {
      in_squares(1, l, t, r, b, [&](int x, int y, int, int) { pixels.push_back({x, y}); });
    });
  });
  return pixels;
}

/// The tiles of a film, row by row.
class Tiles {
 public:
  Tiles(const Film& film, int size)
      : width_(film.width),
        height_(film.height),
        size_(size),
        across_((film.width + size - 1) / size),
        down_((film.height + size - 1) / size),
        of_a_tile_(pixels_of_a_tile(std::min(size, film.width), std::min(size, film.height))) {}

  std::int64_t count() const { return across_ * down_; }
  void list_pixels_of(std::int64_t i, std::vector<Pixel>& pixels) const {
    pixels.clear();
    append_pixels_of(i, pixels);
  }
  void append_pixels_of(std::int64_t i, std::vector<Pixel>& pixels) const {
    const int left = int(i % across_) * size_, top = int(i / across_) * size_;
    const auto first = std::ptrdiff_t(pixels.size());
    pixels.insert(pixels.end(), of_a_tile_.begin(), of_a_tile_.end());
    for (auto p = pixels.begin() + first; p != pixels.end(); ++p) p->x += left, p->y += top;
    if (left + size_ <= width_ && top + size_ <= height_) return;
    const auto is_outside = [&](const Pixel& p) { return p.x >= width_ || p.y >= height_; };
    pixels.erase(std::remove_if(pixels.begin() + first, pixels.end(), is_outside), pixels.end());
  }

 private:
  int width_, height_, size_;
  std::int64_t across_, down_;
  std::vector<Pixel> of_a_tile_;
};

std::uint64_t all_of(const RayCounts& rays) {
  return rays.eye + rays.reflection + rays.refraction + rays.shadow + rays.ambient;
}

/// What a thread keeps from task to task.
struct Worker {
  Scratch scratch;
  RayCounts counts;
  std::vector<Pixel> pixels;
  std::vector<double> sums;
  std::vector<float> least_and_greatest;
  std::vector<double> layer_sums, squares;
  std::vector<FirstHit> first_hits;
  PixelHits hits;
  LayerBook::Work layer_work;
  std::vector<ApportionRoom> apportion_room;
  std::vector<float*> to_pixels;
  std::vector<std::uint8_t> left;

  /// Room for `columns` columns over `count` pixels, zero. Returns their stride.
  std::size_t clear_layer_sums(std::size_t columns, std::size_t count) {
    // Kernels read a packet beyond the last pixel. And the columns of 1024 pixels, a whole tile, would all
    // meet in the same lines of the cache if nothing were between them.
    const std::size_t stride = (count + 15) / 16 * 16 + 16;
    layer_sums.assign(columns * stride, 0);
    return stride;
  }
  void give_layer_sums(PixelTask& task, std::size_t columns) {
    task.layer_sums_stride = clear_layer_sums(columns, task.count);
    task.layer_sums = layer_sums.data();
  }
  /// Fills the layers of to_pixels, whose colours must be there, from layer_sums.
  void write_layers(const Kernel& kernel, const LayerBook& book, std::size_t stride, int samples) {
    const int layers = book.plan().count();
    left.resize(to_pixels.size());
    apportion_room.resize(std::size_t(layers) * 2);
    kernel.apportion_layers({layer_sums.data(), stride, layers, samples, std::uint32_t(to_pixels.size()),
                             to_pixels.data(), left.data(), apportion_room.data()});
    for (std::size_t p = 0; p < to_pixels.size(); ++p)
      if (left[p]) book.write_layers(&layer_sums[p], stride, samples, layer_work, to_pixels[p]);
  }
};

/// Pixels that are rendered at once where something is noted of each of their samples: so many that the notes
/// take a few megabytes at most.
std::size_t pixels_with_hits(int samples) { return std::size_t(std::max(1, (1 << 16) / samples)); }

/// How many samples the noise lets one expect to be needed.
double samples_expected(const TileRun& run, const PathSettings& settings, int max) {
  const double factor = run.noise / settings.until;
  return std::min(double(max), std::ceil(run.samples * factor * factor));
}

/// How far a pixel's samples lie from its centre, in the frame's order.
std::vector<double> distances_from_centre(const Frame& frame) {
  std::vector<double> result;
  for (int i = 0; i < frame.samples; ++i) {
    const Vec2<double>& sample = frame.pattern[frame.order ? frame.order[i] : i];
    const double x = sample.x - 0.5, y = sample.y - 0.5;
    result.push_back(x * x + y * y);
  }
  return result;
}

/// Threads that share out tasks. Which thread takes which task is chance, and does not matter.
class Crew {
 public:
  Crew(const TileOptions& options, TileRun& run) : options_(options), run_(run) {}

  /// Calls task(i, worker) for each i below `count`. The progress goes from `from` to `to`.
  template <class Task> void share(std::int64_t count, double from, double to, const Task& task) {
    std::atomic<std::int64_t> next{0};
    std::atomic<bool> stop{false};
    std::mutex mutex;  // guards what follows
    std::int64_t done = 0;
    std::exception_ptr failure;
    const auto work = [&] {
      try {
        Worker worker;
        for (std::int64_t i; !stop && (i = next++) < count;) {
          task(i, worker);
          if (!options_.progress) continue;
          const std::lock_guard lock(mutex);
          if (!stop && !options_.progress(from + (to - from) * double(++done) / double(count)))
            stop = run_.cancelled = true;
        }
        const std::lock_guard lock(mutex);
        run_.counts.eye += worker.counts.eye;
        run_.counts.eye_hits += worker.counts.eye_hits;
        run_.counts.reflection += worker.counts.reflection;
        run_.counts.refraction += worker.counts.refraction;
        run_.counts.shadow += worker.counts.shadow;
        run_.counts.ambient += worker.counts.ambient;
      } catch (...) {
        const std::lock_guard lock(mutex);
        failure = std::current_exception();
        stop = true;
      }
    };
    {
      std::vector<std::jthread> crew;
      for (std::int64_t i = 1; i < std::min<std::int64_t>(options_.threads, count); ++i)
        crew.emplace_back(work);
      work();
    }
    if (failure) std::rethrow_exception(failure);
  }

 private:
  const TileOptions& options_;
  TileRun& run_;
};

/// The colours of pixels, whose samples' sums stand one after the other.
void write_colors(const Mean<double>& mean, const Pixel* pixels, std::size_t count, const double* sums,
                  Film& film) {
  for (std::size_t p = 0, end = 0; p < count; p = end) {
    // Neighbours in a row lie side by side in the film too, where it holds nothing but colours.
    const auto goes_on = [&] {
      return pixels[end].y == pixels[p].y && pixels[end].x == pixels[end - 1].x + 1;
    };
    for (end = p + 1; film.channels == color_channels && end < count && goes_on();) ++end;
    float* to = film.pixel(pixels[p].x, pixels[p].y);
    for (std::size_t k = p * color_channels; k < end * color_channels; ++k) *to++ = float(mean.of(sums[k]));
  }
}

/// The layers of the pixels of a task that is done, and what their samples met; their colours must be in the
/// film.
void write_layers_and_data(const Kernel& kernel, const PixelTask& task, const std::vector<double>& distances,
                           Film& film, Worker& worker) {
  const LayerBook& book = *film.layers;
  const int samples = int(distances.size());
  const std::size_t stride = task.layer_sums_stride;
  worker.to_pixels.clear();
  for (std::uint32_t p = 0; p < task.count; ++p)
    worker.to_pixels.push_back(film.pixel(task.pixels[p].x, task.pixels[p].y));
  worker.write_layers(kernel, book, stride, samples);
  for (std::uint32_t p = 0; p < task.count; ++p) {
    const FirstHit* hits = task.first_hits + std::size_t(p) * distances.size();
    if (samples == 1) {
      book.write_data(task.layer_sums + p, stride, hits[0], worker.to_pixels[p]);
      continue;
    }
    worker.hits.clear();
    for (std::size_t s = 0; s < distances.size(); ++s) worker.hits.add(hits[s], distances[s]);
    book.write_data(task.layer_sums + p, stride, samples, worker.hits, worker.layer_work,
                    worker.to_pixels[p]);
  }
}

}  // namespace

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

int thread_count(int wanted) {
  return wanted > 0 ? wanted : std::max(1, int(std::thread::hardware_concurrency()));
}

TileRun render_tiles(const Frame& frame, const Kernel& kernel, Film& film, const TileOptions& options) {
  TileRun run;
  const Tiles tiles(film, options.tile_size);
  const std::size_t columns = film.layers ? std::size_t(frame.layers.columns()) : 0;
  const std::vector<double> distances = distances_from_centre(frame);
  const Mean<double> mean(frame.samples);
  const bool noisy = frame.tracing == Tracing::path;
  // Added up tile by tile, so that the noise does not depend on who was first.
  std::vector<NoiseSum> noise(noisy ? std::size_t(tiles.count()) : 0);
  Crew(options, run).share(tiles.count(), 0, 1, [&](std::int64_t i, Worker& worker) {
    tiles.list_pixels_of(i, worker.pixels);
    const std::size_t at_a_time = film.wants_hits() ? pixels_with_hits(frame.samples) : worker.pixels.size();
    for (std::size_t first = 0; first < worker.pixels.size(); first += at_a_time) {
      const Pixel* pixels = &worker.pixels[first];
      const std::size_t count = std::min(at_a_time, worker.pixels.size() - first);
      worker.sums.assign(count * color_channels, 0);
      PixelTask task{pixels, std::uint32_t(count), 0, frame.samples, worker.sums.data(), nullptr};
      if (film.layers) worker.give_layer_sums(task, columns);
      if (film.wants_hits()) {
        worker.first_hits.resize(count * distances.size());
        task.first_hits = worker.first_hits.data();
      }
      if (noisy) {
        worker.squares.assign(count, 0);
        task.squares = worker.squares.data();
      }
      kernel.render(frame, task, worker.scratch, worker.counts);
      write_colors(mean, pixels, count, worker.sums.data(), film);
      if (noisy)
        for (std::size_t p = 0; p < count; ++p)
          noise[std::size_t(i)].add(&worker.sums[p * color_channels], worker.squares[p], frame.samples);
      if (!film.guides.empty())
        for (std::size_t p = 0; p < count; ++p)
          film.guides[film.index(pixels[p].x, pixels[p].y)].add(&worker.first_hits[p * distances.size()],
                                                                distances.size());
      if (film.layers) write_layers_and_data(kernel, task, distances, film, worker);
    }
  });
  NoiseSum sum;
  for (const NoiseSum& tile : noise) sum.add(tile);
  run.noise = sum.noise();
  run.samples = frame.samples;
  return run;
}

namespace {

/// Samples taken in several goes, and what they have brought so far.
class Goes {
 public:
  /// Of the frame counts what all slices have in common.
  Goes(const Frame& frame, const Kernel& kernel, const ImageSettings& settings, Film& film,
       const TileOptions& options)
      : kernel_(kernel),
        film_(film),
        options_(options),
        columns_(film.layers ? std::size_t(frame.layers.columns()) : 0),
        distances_(distances_from_centre(frame)),
        samples(film, settings) {
    const Tiles tiles(film, options.tile_size);
    for (std::int64_t i = 0; i < tiles.count(); ++i) tiles.append_pixels_of(i, wanted);
  }

  /// The frame's samples from `first` up to `end`, in its order, of all wanted pixels. The progress goes from
  /// `from` to `to`.
  void go(const Frame& frame, int first, int end, double from, double to, TileRun& run) {
    const std::int64_t at_a_time = film_.wants_hits() ? std::int64_t(pixels_with_hits(end - first))
                                                      : std::int64_t(options_.tile_size) * options_.tile_size;
    const std::int64_t tasks = (std::int64_t(wanted.size()) + at_a_time - 1) / at_a_time;
    Crew(options_, run).share(tasks, from, to, [&](std::int64_t i, Worker& worker) {
      const std::int64_t begin = i * at_a_time;
      take(frame, &wanted[std::size_t(begin)],
           std::size_t(std::min<std::int64_t>(at_a_time, std::int64_t(wanted.size()) - begin)), first, end,
           worker);
    });
  }

  /// Fills the film with the means, row by row.
  void develop(TileRun& run) {
    TileOptions quiet = options_;
    quiet.progress = nullptr;
    const auto width = std::size_t(film_.width);
    Crew(quiet, run).share(film_.height, 0, 1, [&](std::int64_t y, Worker& worker) {
      worker.to_pixels.clear();
      for (int x = 0; x < film_.width; ++x) {
        float* to = film_.pixel(x, int(y));
        const Rgb mean = samples.mean(samples.index(x, int(y)));
        for (int c = 0; c < color_channels; ++c) to[c] = float(mean[c]);
        worker.to_pixels.push_back(to);
      }
      if (!film_.layers) return;
      const LayerBook& book = *film_.layers;
      const std::size_t stride = worker.clear_layer_sums(columns_, width), first = std::size_t(y) * width;
      for (std::size_t x = 0; x < width; ++x)
        for (std::size_t c = 0; c < columns_; ++c)
          worker.layer_sums[c * stride + x] = samples.layer_sums(first + x)[c] / samples.samples(first + x);
      worker.write_layers(kernel_, book, stride, 1);
      for (std::size_t x = 0; x < width; ++x)
        book.write_data(samples.layer_sums(first + x), 1, samples.samples(first + x), samples.hits(first + x),
                        worker.layer_work, worker.to_pixels[x]);
    });
  }

 private:
  const Kernel& kernel_;
  Film& film_;
  const TileOptions& options_;
  std::size_t columns_;  ///< Of layers.
  std::vector<double> distances_;

 public:
  AdaptiveFilm samples;
  std::vector<Pixel> wanted;

 private:
  void take(const Frame& frame, const Pixel* pixels, std::size_t count, int first, int end, Worker& worker) {
    worker.sums.resize(count * color_channels);
    worker.squares.resize(count);
    worker.least_and_greatest.resize(count * 2 * color_channels);
    const auto exchange = [&](const auto& each) {
      for (std::size_t p = 0; p < count; ++p)
        for (int c = 0; c < color_channels; ++c) {
          float* least = &worker.least_and_greatest[p * 2 * color_channels + c];
          each(samples.at(pixels[p].x, pixels[p].y), c, worker.sums[p * color_channels + c],
               worker.squares[p], least[0], least[color_channels]);
        }
    };
    using Known = AdaptiveFilm::Pixel;
    exchange([](const Known& from, int c, double& sum, double& squares, float& least, float& greatest) {
      sum = from.sum[c], squares = from.squares, least = from.least[c], greatest = from.greatest[c];
    });
    PixelTask task{pixels, std::uint32_t(count), first,
                   end,    worker.sums.data(),   worker.least_and_greatest.data()};
    if (frame.tracing == Tracing::path) task.squares = worker.squares.data();
    const auto taken = std::size_t(end - first);
    if (film_.wants_hits()) {
      worker.first_hits.resize(count * taken);
      task.first_hits = worker.first_hits.data();
    }
    if (film_.layers) {
      worker.give_layer_sums(task, columns_);
      for (std::size_t p = 0; p < count; ++p) {
        const double* from = samples.layer_sums(samples.index(pixels[p].x, pixels[p].y));
        for (std::size_t c = 0; c < columns_; ++c)
          worker.layer_sums[c * task.layer_sums_stride + p] = from[c];
      }
    }
    kernel_.render(frame, task, worker.scratch, worker.counts);
    if (!film_.guides.empty())
      for (std::size_t p = 0; p < count; ++p)
        film_.guides[film_.index(pixels[p].x, pixels[p].y)].add(&worker.first_hits[p * taken], taken);
    if (film_.layers)
      for (std::size_t p = 0; p < count; ++p) {
        const std::size_t index = samples.index(pixels[p].x, pixels[p].y);
        double* to = samples.layer_sums(index);
        for (std::size_t c = 0; c < columns_; ++c) to[c] = worker.layer_sums[c * task.layer_sums_stride + p];
        for (std::size_t s = 0; s < taken; ++s)
          samples.hits(index).add(worker.first_hits[p * taken + s], distances_[std::size_t(first) + s]);
      }
    exchange([&](Known& to, int c, double sum, double squares, float least, float greatest) {
      to.sum[c] = sum, to.squares = squares, to.least[c] = least, to.greatest[c] = greatest;
      if (c == 0) to.samples += int(taken);
    });
  }
};

}  // namespace

TileRun render_adaptively(const Frame& frame, const Kernel& kernel, const ImageSettings& settings, Film& film,
                          const TileOptions& options, std::vector<int>* sample_counts) {
  TileRun run;
  Goes goes(frame, kernel, settings, film, options);
  const int start = settings.adaptive->start, max = settings.adaptive->max;
  double progress = 0;
  for (int first = 0, end = start; !goes.wanted.empty() && !run.cancelled;) {
    // How many goes there will be is not known: each counts as half of what is left.
    const double progress_then = end == max ? 1 : (1 + progress) / 2;
    goes.go(frame, first, end, progress, progress_then, run);
    if (end == max) break;
    std::erase_if(goes.wanted,
                  [&](const Pixel& pixel) { return !goes.samples.needs_more(pixel.x, pixel.y); });
    first = end;
    end = std::min(end * 4, max);
    progress = progress_then;
  }
  goes.develop(run);
  if (sample_counts)
    for (int y = 0; y < film.height; ++y)
      for (int x = 0; x < film.width; ++x) sample_counts->push_back(goes.samples.at(x, y).samples);
  return run;
}

TileRun render_slices(Exposure& exposure, const Kernel& kernel, const ImageSettings& settings, Film& film,
                      const TileOptions& options) {
  TileRun run;
  Goes goes(exposure.at(0).frame, kernel, settings, film, options);
  const std::vector<Portion> portions = exposure.portions();
  for (std::size_t i = 0; i < portions.size() && !run.cancelled; ++i) {
    const Frame& frame = exposure.at(portions[i].slice).frame;
    goes.go(frame, portions[i].first, portions[i].end, double(i) / double(portions.size()),
            double(i + 1) / double(portions.size()), run);
    run.samples = frame.samples;
    if (frame.tracing == Tracing::path) run.noise = goes.samples.noise();
  }
  goes.develop(run);
  return run;
}

TileRun render_until(Exposure& exposure, const Kernel& kernel, const PathSettings& settings,
                     const ImageSettings& image, Film& film, const TileOptions& options) {
  TileRun run;
  const double begun = options.seconds();
  Goes goes(exposure.at(0).frame, kernel, image, film, options);
  const std::vector<Slice>& slices = exposure.slices();
  const auto count = int(slices.size());
  // As many samples for each slice.
  const int max =
      std::max(std::min(exposure.at(0).frame.samples, settings.max_samples) / count * count, count);
  const auto rounded = [&](double samples) {
    return int(std::min(std::ceil(samples / count) * count, double(max)));
  };
  const int start = rounded(image.samples);
  const bool limited = options.time_limit > 0;
  // How long a sample takes is not known at first. But of what moves, a pass of few samples costs as many
  // trees as one of many.
  int first = 0, end = limited && count == 1 ? 1 : start;
  double before = begun, seconds_each = 0;
  bool is_last = false;
  for (double progress = 0; !run.cancelled;) {
    double done = double(end) / max;
    // Noise falls with the square root of the samples, so this is about how much is done by then.
    if (settings.until > 0)
      done = std::max(
          done, run.noise > 0 ? std::min(1.0, double(end) / samples_expected(run, settings, max)) : 0.5);
    if (limited)
      done =
          std::max(done, std::min(1.0, (before - begun + seconds_each * (end - first)) / options.time_limit));
    const double from = progress, to = std::max(progress, done);
    for (int k = 0; k < count && !run.cancelled; ++k) {
      const int begin = slices[std::size_t(k)].first;
      run.portions.push_back({k, begin + first / count, begin + end / count});
      goes.go(exposure.at(k).frame, run.portions.back().first, run.portions.back().end,
              from + (to - from) * k / count, from + (to - from) * (k + 1) / count, run);
    }
    progress = to;
    run.samples = end;
    run.noise = goes.samples.noise();
    const bool is_good = settings.until > 0 && end >= start && run.noise <= settings.until;
    if (is_good || is_last || end == max) break;
    // No more than three times as many again: the estimate of the noise is rough where samples are few.
    const double wanted = end < start          ? std::min(2.0 * end, double(start))
                          : settings.until > 0 ? std::clamp(samples_expected(run, settings, max), end + 1.0,
                                                            std::min(4.0 * end, double(max)))
                                               : 2.0 * end;
    int next = rounded(wanted);
    if (limited) {
      const double now = options.seconds(), left = options.time_limit - (now - begun);
      seconds_each = (now - before) / (end - first);
      before = now;
      const double at_most = end + std::floor(left / seconds_each / count) * count;
      if (!(left > 0) || at_most <= end) break;
      if (at_most < next) {
        next = int(at_most);
        is_last = count > 1;  // passes that end elsewhere would add up the slices in another order
      }
    }
    first = end;
    end = next;
  }
  goes.develop(run);
  return run;
}

ViewRun render_view(const Frame& frame, const Kernel& kernel, const ViewRecord& view, int samples, Film& film,
                    const TileOptions& options) {
  ViewRun run;
  const Tiles tiles(film, options.tile_size);
  const Frame asked = frame_for(frame, view.show);
  const auto task_of = [&](const Pixel* pixels, std::size_t count, Worker& worker) {
    worker.sums.assign(count * color_channels, 0);
    return PixelTask{pixels, std::uint32_t(count), 0, samples, worker.sums.data(), nullptr};
  };

  if (view.show != View::rays) {
    const std::size_t at_a_time = pixels_with_hits(samples);
    Crew(options, run.tiles).share(tiles.count(), 0, 1, [&](std::int64_t i, Worker& worker) {
      tiles.list_pixels_of(i, worker.pixels);
      for (std::size_t first = 0; first < worker.pixels.size(); first += at_a_time) {
        const std::size_t count = std::min(at_a_time, worker.pixels.size() - first);
        PixelTask task = task_of(&worker.pixels[first], count, worker);
        worker.first_hits.resize(count * std::size_t(samples));
        task.first_hits = worker.first_hits.data();
        kernel.render(asked, task, worker.scratch, worker.counts);
        for (std::size_t p = 0; p < count; ++p) {
          Rgb sum{};
          for (int s = 0; s < samples; ++s)
            sum = sum + view_color(view, worker.first_hits[p * std::size_t(samples) + std::size_t(s)]);
          float* to = film.pixel(worker.pixels[first + p].x, worker.pixels[first + p].y);
          for (int c = 0; c < color_channels; ++c) to[c] = float(sum[c] / samples);
        }
      }
    });
    return run;
  }

  // Rays are counted by the task, so that each pixel is one; and none has its colour before all are counted.
  std::vector<std::uint64_t> rays(std::size_t(film.width) * std::size_t(film.height));
  Crew(options, run.tiles).share(tiles.count(), 0, 1, [&](std::int64_t i, Worker& worker) {
    tiles.list_pixels_of(i, worker.pixels);
    for (const Pixel& pixel : worker.pixels) {
      const std::uint64_t before = all_of(worker.counts);
      kernel.render(asked, task_of(&pixel, 1, worker), worker.scratch, worker.counts);
      rays[std::size_t(pixel.y) * std::size_t(film.width) + std::size_t(pixel.x)] =
          all_of(worker.counts) - before;
    }
  });
  run.most_rays = *std::max_element(rays.begin(), rays.end());
  for (std::size_t p = 0; p < rays.size(); ++p) {
    const Rgb color = color_of_ray_count(rays[p], run.most_rays);
    for (int c = 0; c < color_channels; ++c)
      film.values[p * color_channels + std::size_t(c)] = float(color[c]);
  }
  return run;
}

}  // namespace lambent
