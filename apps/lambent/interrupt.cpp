#include "interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>

#include "commands.h"

namespace lambent::app {

namespace {

std::atomic<bool> noted{false};
std::atomic<bool> only_note{false};
static_assert(std::atomic<bool>::is_always_lock_free, "signal handlers may touch nothing else");

extern "C" void on_interrupt(int) {
  const bool again = noted.exchange(true);
  if (only_note && !again) return;
  constexpr char text[] = "interrupted\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, sizeof text - 1);
  ::_exit(failed);
}

}  // namespace

void watch_for_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return noted; }

Interruptible::Interruptible() { only_note = true; }
Interruptible::~Interruptible() { only_note = false; }

}  // namespace lambent::app
