#pragma once
// The commands of the program: for each, what the user may say, and the function that does it.

#include <string>
#include <variant>
#include <vector>

#include "lambent/lambent.h"

namespace lambent::app {

/// What the program tells its caller.
enum ExitCode : int {
  done = 0,
  failed = 1,     ///< The work could not be done, or was interrupted; for `diff`: the pictures differ.
  bad_input = 2,  ///< The input or the command line is wrong.
};

struct RenderCommand {
  std::string input;
  /// Empty: the input's name with .png, in the current folder. Of a turntable patterns: see numbered.h.
  std::vector<std::string> outputs;
  LoadOptions load;
  std::string stats;  ///< Empty: none; "-": standard output.
  std::string isa;
  int turntable = 0;  ///< So many pictures, once around; 0: one, and no turning.
  int threads = 0;
  int tile = 32;
  int bits = 8;
  double time_limit = 0;  ///< Of each picture, in seconds; 0: none.
  bool denoise = false;
  bool quiet = false;
};

struct CompareCommand {
  std::string input;
  std::vector<std::string> models;   ///< Empty: all that there are.
  std::vector<std::string> outputs;  ///< Empty: the input's name with -compare.png, in the current folder.
  LoadOptions load;
  std::string size;  ///< Of each picture, as the scene file says it; empty: the scene's, or smaller.
  int threads = 0;
  int columns = 0;      ///< 0: chosen to suit.
  bool ladder = false;  ///< Every step from Lambert's cosine to the rendering equation, in place of models.
  bool difference = false;
  bool own_attenuation = false;  ///< Each model's, whatever the scene says.
  bool quiet = false;
};

struct CheckCommand {
  std::vector<std::string> inputs;
  LoadOptions load;
};

struct InfoCommand {
  std::string input;
  LoadOptions load;
  bool json = false;
};

struct ListCommand {
  std::string topic, name;  ///< Empty: all.
  bool json = false;
  bool schema = false;
  bool manual = false;
};

struct DiffCommand {
  std::string a, b;
  std::string output;  ///< Where the picture of the difference goes; empty: nowhere.
  double tolerance = 0;
};

struct ConvertCommand {
  std::string from, to;
  LoadOptions load;
  bool force = false;
  int bits = 8;
};

struct ExplainCommand {
  std::string input;
  int x = -1, y = -1;
  int sample = -1;  ///< -1: the central one, or in JSON all.
  std::string format = "text";
  std::string output;  ///< Empty: standard output.
  bool trace = false;
  LoadOptions load;
};

struct RelightCommand {
  std::string input;
  std::vector<std::string> outputs;
  std::vector<std::string> lights, terms, materials;  ///< name=factor
  int bits = 8;
  bool quiet = false;
};

/// Nothing to compute: the text that --help or --version asks for.
struct ShowText {
  std::string text;
};

using Command = std::variant<ShowText, RenderCommand, CompareCommand, CheckCommand, InfoCommand, ListCommand,
                             DiffCommand, ConvertCommand, ExplainCommand, RelightCommand>;

/// Throws InputError where the command line is wrong.
Command parse_command_line(int argc, const char* const* argv);

// Each throws InputError or Failure where it cannot go on; main says so and chooses the exit code.
ExitCode run(const ShowText& command);
ExitCode run(const RenderCommand& command);
ExitCode run(const CompareCommand& command);
ExitCode run(const CheckCommand& command);
ExitCode run(const InfoCommand& command);
ExitCode run(const ListCommand& command);
ExitCode run(const DiffCommand& command);
ExitCode run(const ConvertCommand& command);
ExitCode run(const ExplainCommand& command);
ExitCode run(const RelightCommand& command);

}  // namespace lambent::app
