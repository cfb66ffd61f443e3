#include "console.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace lambent::app {

namespace {

/// Write all of `text`; the error number, or 0.
int write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(fd, text.data(), text.size());
    if (written >= 0) text.remove_prefix(std::size_t(written));
    else if (errno != EINTR) return errno;
  }
  return 0;
}

bool colors(int fd) {
  const char* no_color = std::getenv("NO_COLOR");
  return is_terminal(fd) && !(no_color && *no_color);
}

/// Columns that UTF-8 text takes, counting one for each character.
int width_of(std::string_view text) {
  return int(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

}  // namespace

void guard_standard_streams() {
  for (int fd = 0; fd <= 2; ++fd)
    if (::fcntl(fd, F_GETFD) == -1 && errno == EBADF) {
      // The lowest free number is `fd` itself. Open the wrong way round for its use, so that writing still
      // fails.
      [[maybe_unused]] const int opened = ::open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY);
    }
}

bool is_terminal(int fd) {
  const char* term = std::getenv("TERM");
  return ::isatty(fd) == 1 && term && std::strcmp(term, "dumb") != 0;
}

int columns(int fd) {
  winsize size{};
  if (::ioctl(fd, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return 80;
}

void print(std::string_view text) {
  const int error = write_all(STDOUT_FILENO, text);
  if (error != 0 && error != EPIPE)
    throw Failure(fmt::format("cannot write to standard output: {}", std::strerror(error)));
}

void print_error(std::string_view text) { write_all(STDERR_FILENO, text); }

void report(const Diagnostic& diagnostic) {
  std::string text = to_string(diagnostic) + "\n";
  if (colors(STDERR_FILENO)) {
    const bool error = diagnostic.severity == Severity::error;
    const std::string word = error ? "error:" : "warning:";
    // A file may be named "error:", so look behind the place.
    const std::size_t at = text.find(word, to_string(diagnostic.place).size());
    if (at != std::string::npos) {
      text.insert(at + word.size(), "\033[0m");
      text.insert(at, error ? "\033[1;31m" : "\033[1;35m");
    }
  }
  print_error(text);
}

void report(const std::vector<Diagnostic>& diagnostics, std::size_t limit) {
  const std::size_t shown = std::min(limit, diagnostics.size());
  for (std::size_t i = 0; i < shown; ++i) report(diagnostics[i]);
  if (shown < diagnostics.size())
    print_error(fmt::format("... and {} more; 'lambent check' shows them all\n", diagnostics.size() - shown));
}

std::string wrapped(std::string_view text, int width, int indent) {
  std::string result;
  int column = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(" \n"), text.size());
    const std::string_view word = text.substr(0, end);
    const bool line_ends = end < text.size() && text[end] == '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!word.empty()) {
      if (column > 0 && column + 1 + width_of(word) > width) {
        result += '\n';
        column = 0;
      }
      if (column == 0) {
        result.append(std::size_t(indent), ' ');
        column = indent;
      } else {
        result += ' ';
        ++column;
      }
      result += word;
      column += width_of(word);
    }
    if (line_ends) {
      result += '\n';
      column = 0;
    }
  }
  if (column > 0) result += '\n';
  return result;
}

std::string harmless(std::string text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0;
    const bool is_control = (c < 0x20 && c != '\n' && c != '\t') || c == 0x7f;
    const bool is_control_of_two_bytes = c == 0xc2 && next >= 0x80 && next < 0xa0;  // U+0080 to U+009F
    if (is_control || is_control_of_two_bytes) text[i] = '?';
    if (is_control_of_two_bytes) text[i + 1] = '?';
  }
  return text;
}

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

}  // namespace lambent::app
