#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "commands.h"
#include "console.h"
#include "lambent/lambent.h"

namespace lambent::app {

namespace {

constexpr std::size_t all = std::numeric_limits<std::size_t>::max();

/// What is odd about a model file, and what of a scene's warnings is not among that.
std::vector<Diagnostic> all_remarks(std::vector<Diagnostic> of_model,
                                    const std::vector<Diagnostic>& of_scene) {
  std::set<std::string> said;
  for (const Diagnostic& diagnostic : of_model) said.insert(to_string(diagnostic));
  for (const Diagnostic& diagnostic : of_scene)
    if (!said.count(to_string(diagnostic))) of_model.push_back(diagnostic);
  return of_model;
}

ExitCode check(const std::string& input, const LoadOptions& options) {
  try {
    if (is_material_library(input)) {
      const std::vector<Diagnostic> odd = lint(input, options.limits);
      report(odd, all);
      print(fmt::format("{}: ok{}\n", input, odd.empty() ? "" : ", " + counted(odd.size(), "warning")));
      return done;
    }
    const ScenePtr scene = load_scene(input, options);
    const SceneSummary summary = summarize(scene);
    const std::vector<Diagnostic> odd = all_remarks(lint(input, options.limits), warnings(scene));
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
  for (const std::string& input : command.inputs) worst = std::max(worst, check(input, command.load));
  return worst;
}

}  // namespace lambent::app
