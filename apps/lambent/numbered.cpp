#include "numbered.h"

#include <fmt/format.h>

#include "files.h"

namespace lambent::app {

NumberedName::NumberedName(const std::string& pattern) {
  const auto fail = [&](const std::string& what) {
    return usage_error(fmt::format("'{}' {}", pattern, what),
                       "a turntable's pictures are numbered: for example -o out/%04d.png");
  };
  constexpr int most_digits = 9;
  bool numbered = false;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    std::string& part = numbered ? after_ : before_;
    if (pattern[i] != '%') {
      part += pattern[i];
      continue;
    }
    if (++i < pattern.size() && pattern[i] == '%') {
      part += '%';
      continue;
    }
    if (numbered) throw fail("has more than one place for a number");
    if (i < pattern.size() && pattern[i] == '0') {
      zeros_ = true;
      ++i;
    }
    for (; i < pattern.size() && pattern[i] >= '0' && pattern[i] <= '9'; ++i)
      if (width_ <= most_digits) width_ = 10 * width_ + (pattern[i] - '0');
    if (i == pattern.size() || pattern[i] != 'd') throw fail("has a % that is not %d, %4d, %04d or %%");
    if (width_ > most_digits) throw fail(fmt::format("wants a number of more than {} digits", most_digits));
    numbered = true;
  }
  if (!numbered) throw fail("has no place for a number");
}

std::string NumberedName::with(int number) const {
  const std::string digits =
      zeros_ ? fmt::format("{:0{}}", number, width_) : fmt::format("{:{}}", number, width_);
  return before_ + digits + after_;
}

}  // namespace lambent::app
