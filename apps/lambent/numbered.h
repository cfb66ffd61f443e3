#pragma once
// The names of pictures that belong together: "out/%04d.png".

#include <string>

namespace lambent::app {

/// A name with a place for a number, as printf writes it: %d, %4d or %04d, once; %% is a per cent sign.
class NumberedName {
 public:
  /// Throws InputError where `pattern` has no such place, several, or another one.
  explicit NumberedName(const std::string& pattern);
  std::string with(int number) const;

 private:
  std::string before_, after_;
  int width_ = 0;
  bool zeros_ = false;
};

}  // namespace lambent::app
