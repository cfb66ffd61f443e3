#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "console.h"

namespace lambent::app {

namespace {

constexpr std::chrono::milliseconds between_redraws{150};
constexpr int widest_bar = 50;

/// The time left if the rest goes as the work so far; -1 while that says little.
double seconds_left(double share, double elapsed) {
  if (share < 0.005 || elapsed < 0.5) return -1;
  return elapsed * (1 - share) / share;
}

}  // namespace

std::string duration(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
  const long long whole = std::llround(seconds);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
  return fmt::format("{}:{:02} h", whole / 3600, whole % 3600 / 60);
}

std::string progress_bar(double share, double seconds_left, int width) {
  std::string text = fmt::format(" {:3} %", int(share * 100));
  if (seconds_left >= 0) text += fmt::format("  {:>9} left", duration(seconds_left));
  const int room = std::min(widest_bar, width - int(text.size()) - 2);
  if (room < 5) return text.substr(0, std::size_t(std::max(width, 0)));
  const int filled = std::clamp(int(share * room), 0, room);
  return fmt::format("[{}{}]{}", std::string(std::size_t(filled), '#'),
                     std::string(std::size_t(room - filled), '-'), text);
}

Progress::Progress(bool quiet)
    : style_(quiet                        ? Style::none
             : is_terminal(STDERR_FILENO) ? Style::bar
                                          : Style::lines) {}

void Progress::update(double share) {
  if (style_ == Style::none) return;
  share = std::clamp(share, 0.0, 1.0);
  const Clock::time_point now = Clock::now();
  const double left = seconds_left(share, std::chrono::duration<double>(now - start_).count());
  if (style_ == Style::lines) {
    for (; tenths_ < 10 && share * 10 >= tenths_ + 1; ++tenths_)
      print_error(
          fmt::format("{} %{}\n", (tenths_ + 1) * 10, left > 0 ? ", " + duration(left) + " left" : ""));
  } else if (now - drawn_ >= between_redraws) {
    // The last column stays free: some terminals wrap when it is filled.
    print_error(fmt::format("\r{}\033[K", progress_bar(share, left, columns(STDERR_FILENO) - 1)));
    drawn_ = now;
    visible_ = true;
  }
}

void Progress::finish() {
  if (visible_) print_error("\r\033[K");
  visible_ = false;
}

}  // namespace lambent::app
