#include "lambent/explain.h"

#include <unistd.h>

#include <cstdlib>

#include "commands.h"
#include "console.h"
#include "files.h"

namespace lambent::app {

namespace {

constexpr std::size_t most_warnings = 20;

ExplainFormat format_of(const std::string& name) {
  return name == "json"     ? ExplainFormat::json
         : name == "mathml" ? ExplainFormat::mathml
         : name == "latex"  ? ExplainFormat::latex
                            : ExplainFormat::text;
}

}  // namespace

ExitCode run(const ExplainCommand& command) {
  if (!command.output.empty()) check_output(command.output);
  const ScenePtr scene = load_scene(command.input, command.load);
  report(warnings(scene), most_warnings);
  const DerivationPtr derivation = explain(scene, command.x, command.y);
  std::string text;
  if (command.trace) {
    text = ray_trace(derivation);
  } else {
    ExplainText options;
    options.format = format_of(command.format);
    options.color =
        command.output.empty() && is_terminal(STDOUT_FILENO) && std::getenv("NO_COLOR") == nullptr;
    if (command.sample >= 0) options.sample = command.sample;
    text = explanation(derivation, options);
  }
  if (command.output.empty()) print(text);
  else write_text_file(command.output, text);
  if (!adds_up(derivation)) throw Failure("the terms do not add up to the rendered pixel");
  return done;
}

}  // namespace lambent::app
