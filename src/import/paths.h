#pragma once
// Files that model files name.

#include <optional>
#include <string>
#include <string_view>

#include "import/model.h"

namespace lambent {

/// Where the name of a file leads that stands in another one.
struct NamedFile {
  std::string path;      ///< Empty where there is none.
  bool outside = false;  ///< There is one, but outside of what may be read.
};

/// Looks for `name`, written in the file `from`: beside it as it stands, then with slashes for the
/// backslashes that Windows writes, last by its bare name, for paths of the machine it was made on. Only
/// regular files count. A file outside of options.root (or of the folder of `from`, where that is empty) is
/// not told of, unless options.limits.allow_outside; symbolic links count by where they lead.
NamedFile find_named_file(const std::string& from, std::string_view name, const ImportOptions& options);

/// What to do about a file that lies outside.
inline constexpr const char* hint_for_outside = "--allow-outside lets files name files that lie elsewhere";

/// Whether the file `path` lies in the folder `root` or below it, symbolic links resolved.
bool lies_below(const std::string& root, const std::string& path);

}  // namespace lambent
