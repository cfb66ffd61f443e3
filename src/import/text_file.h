#pragma once
// A text file in memory, read line by line, with words and numbers taken from it and errors that name the place.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lambent/diagnostics.h"

namespace lambent {

/// The whole file. Throws InputError ("cannot open ...: No such file or directory").
std::string read_file(const std::string& path);

}  // namespace lambent
