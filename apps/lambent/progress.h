#pragma once
// How far the work is: a bar with the time left on a terminal, a line per ten percent elsewhere. On standard
// error.

#include <chrono>
#include <string>

namespace lambent::app {

class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Called with the share that is done, 0 to 1, from one thread at a time.
  void update(double share);

  /// Take the bar away.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  enum class Style { none, lines, bar };
  Style style_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_;  ///< Long ago at first, so that the bar appears at once.
  int tenths_ = 0;           ///< Lines said so far.
  bool visible_ = false;
};

/// "[########------------]  40 %  1:05 left", at most `width` columns. `seconds_left` below 0: not known yet.
std::string progress_bar(double share, double seconds_left, int width);

/// "45 s", "1:05 min", "2:03 h": a time for people.
std::string duration(double seconds);

}  // namespace lambent::app
