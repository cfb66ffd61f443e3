#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "commands.h"
#include "console.h"
#include "lambent/lambent.h"

namespace lambent::app {

namespace {

constexpr std::size_t all = std::numeric_limits<std::size_t>::max();

ExitCode check(const std::string& input) {
  try {
    const ScenePtr scene = load_scene(input);
    const SceneSummary summary = summarize(scene);
    const std::vector<Diagnostic>& odd = warnings(scene);
    report(odd, all);
    print(fmt::format("{}: ok, {}, {}{}\n", input, counted(summary.objects.size(), "object"),
                      counted(summary.lights.size(), "light"),
                      odd.empty() ? "" : ", " + counted(odd.size(), "warning")));
    return done;
  } catch (const InputError& error) {
    const std::vector<Diagnostic>& wrong = error.diagnostics();
    report(wrong, all);
    const auto errors = std::size_t(std::count_if(
        wrong.begin(), wrong.end(), [](const Diagnostic& d) { return d.severity == Severity::error; }));
    print(fmt::format("{}: {}{}\n", input, counted(errors, "error"),
                      errors == wrong.size() ? "" : ", " + counted(wrong.size() - errors, "warning")));
    return bad_input;
  }
}

}  // namespace

ExitCode run(const CheckCommand& command) {
  ExitCode worst = done;
  for (const std::string& input : command.inputs) worst = std::max(worst, check(input));
  return worst;
}

}  // namespace lambent::app
