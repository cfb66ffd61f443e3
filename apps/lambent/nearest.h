#pragma once
// The known name that the user may have meant.

#include <string>
#include <string_view>
#include <vector>

namespace lambent::app {

/// The one of `known` that the fewest typing slips lead away from; empty where none is near.
std::string nearest(std::string_view name, const std::vector<std::string>& known);

/// "did you mean 'render'?", or empty.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known);

}  // namespace lambent::app
