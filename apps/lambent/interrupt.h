#pragma once
// Ctrl-C, and a polite `kill`.

namespace lambent::app {

/// From here on, Ctrl-C ends the program with exit code 1: at once, or, while an Interruptible stands, as
/// soon as that work has stopped. A second Ctrl-C always ends it at once.
void watch_for_interrupts();

/// Whether the user has asked to stop.
bool interrupted();

/// While it stands, Ctrl-C is only noted, for `interrupted` to say.
class Interruptible {
 public:
  Interruptible();
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;
};

}  // namespace lambent::app
