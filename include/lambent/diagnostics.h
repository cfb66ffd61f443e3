#pragma once
// What went wrong, and where: the one way in which every part of Lambent speaks of bad input.

#include <stdexcept>
#include <string>
#include <vector>

namespace lambent {

/// A place in an input file. Lines and columns count from 1; 0 means "not known" or "does not apply".
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
};

/// "file:line:col", as far as it is known.
std::string to_string(const Place& place);

enum class Severity { warning, error };

/// One remark about the input.
struct Diagnostic {
  Severity severity = Severity::error;
  Place place;
  std::string message;   ///< What is wrong, one sentence without a final stop.
  std::string hint;      ///< The nearest remedy ("did you mean 'diffuse'?"), or empty.
  std::string excerpt;   ///< The line of the file, or empty.
  int caret_column = 0;  ///< Column of `excerpt` that the caret points at, from 1; 0 for no caret.
};

/// "file:3:7: error: ...", then the excerpt, the caret and the hint where there are any; ends without a
/// newline.
std::string to_string(const Diagnostic& diagnostic);

/// Bad input: everything that was found wrong, in the order of the file.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Diagnostic> diagnostics);
  explicit InputError(Diagnostic diagnostic);
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

/// The input was right, and still the work could not be done: a full disk, a directory that may not be
/// written.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace lambent
