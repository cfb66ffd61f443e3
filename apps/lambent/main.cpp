// lambent, the program: reads the command line, runs the command, and turns what went wrong into words and an
// exit code.

#include <csignal>
#include <exception>
#include <new>

#include "commands.h"
#include "console.h"
#include "interrupt.h"

int main(int argc, char** argv) {
  using namespace lambent;
  using namespace lambent::app;
  constexpr std::size_t most_errors = 50;
  guard_standard_streams();
  std::signal(SIGPIPE, SIG_IGN);  // a reader that goes away must not end a render; print() looks after it
  watch_for_interrupts();
  const auto say = [](const char* message) {
    Diagnostic diagnostic;
    diagnostic.message = message;
    report(diagnostic);
  };
  try {
    return std::visit([](const auto& command) { return run(command); }, parse_command_line(argc, argv));
  } catch (const InputError& error) {
    report(error.diagnostics(), most_errors);
    return bad_input;
  } catch (const std::bad_alloc&) {
    say("there is not enough memory for this");
  } catch (const std::exception& error) {
    say(error.what());
  }
  return failed;
}
