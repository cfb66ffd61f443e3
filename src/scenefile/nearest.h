#pragma once
// The nearest known name to one that is not known: what "did you mean" is made of.

#include <string>
#include <string_view>
#include <vector>

namespace lambent {

/// How many letters must be added, left out, changed or swapped with their neighbour to make b of a; capitals
/// do not count.
int edit_distance(std::string_view a, std::string_view b);

/// The one of `known` that is nearest to `name` and near enough to be meant; empty where none is. Of two
/// equally near ones the first.
std::string nearest(std::string_view name, const std::vector<std::string>& known);

/// "did you mean 'diffuse'?", or "known are: a, b, c", or empty where nothing is known.
std::string suggestion(std::string_view name, const std::vector<std::string>& known);

/// "a, b, c".
std::string join(const std::vector<std::string>& words, std::string_view separator = ", ");

/// The hint of a file that is not there: the nearest name among the files of its folder, or empty.
std::string suggest_file(const std::string& path);

}  // namespace lambent
