#include "import/paths.h"

#include <algorithm>
#include <filesystem>

namespace lambent {

namespace fs = std::filesystem;

bool lies_below(const std::string& root, const std::string& path) {
  std::error_code error;
  const fs::path top = fs::weakly_canonical(root.empty() ? fs::path(".") : fs::path(root), error);
  if (error) return false;
  const fs::path file = fs::weakly_canonical(path, error);
  if (error) return false;
  const auto [end_of_top, in_file] = std::mismatch(top.begin(), top.end(), file.begin(), file.end());
  // "folder/" ends with an empty part.
  return end_of_top == top.end() || (std::next(end_of_top) == top.end() && end_of_top->empty());
}

NamedFile find_named_file(const std::string& from, std::string_view name, const ImportOptions& options) {
  std::string slashes(name);
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  const fs::path folder = fs::path(from).parent_path();
  const std::string root = options.root.empty() ? folder.string() : options.root;
  NamedFile result;
  for (const fs::path& candidate :
       {fs::path(std::string(name)), fs::path(slashes), fs::path(slashes).filename()}) {
    if (candidate.empty()) continue;
    std::error_code ignored;
    const fs::path path = (folder / candidate).lexically_normal();
    if (!fs::is_regular_file(path, ignored)) continue;
    if (options.limits.allow_outside || lies_below(root, path.string())) return {path.string(), false};
    result.outside = true;
  }
  return result;
}

}  // namespace lambent
