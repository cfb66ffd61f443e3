#pragma once
// Files that the program writes, and what can be said of them before the work is done.

#include <string>
#include <string_view>

#include "lambent/diagnostics.h"

namespace lambent::app {

/// An error about the command line, which has no place in a file.
InputError usage_error(std::string message, std::string hint = "");

/// The ending with its dot, in lower case: ".png"; empty where there is none.
std::string ending(const std::string& path);

/// Whether `path` ends like a picture that write_image knows.
bool is_image_file(const std::string& path);

/// Whether `path` ends like a picture that read_image knows.
bool is_readable_picture(const std::string& path);

/// Throws Failure where a file could not be put at `path`: no such folder, a folder or file that may not be
/// written.
void check_output(const std::string& path);

/// The same, and InputError where `path` does not end like a picture.
void check_image_output(const std::string& path);

/// Write `text` to `path`, whole or not at all. Throws Failure.
void write_text_file(const std::string& path, std::string_view text);

}  // namespace lambent::app
