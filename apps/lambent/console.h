#pragma once
// The program's mouth: standard output for what was asked for, standard error for remarks.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "lambent/diagnostics.h"

namespace lambent::app {

/// If a standard stream was closed by the caller, put a stand-in there. Otherwise the next file opened would
/// take its number, and what is printed would land in a picture.
void guard_standard_streams();

/// Whether `fd` (1 or 2) is a terminal that can move its cursor.
bool is_terminal(int fd);
/// The terminal's width in columns; 80 where there is none.
int columns(int fd);

/// Write to standard output at once. A reader that has gone (a broken pipe) is no error: it has seen enough.
/// Throws Failure where writing fails otherwise.
void print(std::string_view text);

/// Write to standard error at once. Nobody is left to complain to if that fails.
void print_error(std::string_view text);

/// "error: ..." and "warning: ..." on standard error, coloured where that suits; at most `limit`, then how
/// many more.
void report(const Diagnostic& diagnostic);
void report(const std::vector<Diagnostic>& diagnostics, std::size_t limit);

/// `text` broken at spaces to lines of at most `width` columns, each after `indent` spaces; ends with a
/// newline. A word that is longer than a line stays whole.
std::string wrapped(std::string_view text, int width, int indent);

/// `text` without what a terminal would obey: names and metadata come from files by anybody. Newlines and
/// tabs stay.
std::string harmless(std::string text);

/// "1 light", "2 lights", "0 lights".
std::string counted(std::size_t count, std::string_view noun);

}  // namespace lambent::app
