#include "scenefile/nearest.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace lambent {

int edit_distance(std::string_view a, std::string_view b) {
  // Optimal string alignment, three rows of the table at a time.
  const auto lower = [](char c) { return char(std::tolower(static_cast<unsigned char>(c))); };
  std::vector<int> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = int(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(above);
    above.swap(row);
    row[0] = int(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]))
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::string nearest(std::string_view name, const std::vector<std::string>& known) {
  if (name.size() > 100) return {};  // nobody misspells a name into that, and the table grows with its square
  std::string best;
  int best_distance = 1 << 20;
  for (const std::string& candidate : known) {
    const int distance = edit_distance(name, candidate);
    const int limit = std::max(1, int(std::max(name.size(), candidate.size()) + 1) / 3);
    // A name with every letter changed resembles nothing.
    if (distance <= limit && distance < int(candidate.size()) && distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string join(const std::vector<std::string>& words, std::string_view separator) {
  std::string result;
  for (const std::string& word : words) {
    if (!result.empty()) result += separator;
    result += word;
  }
  return result;
}

std::string suggestion(std::string_view name, const std::vector<std::string>& known) {
  if (const std::string best = nearest(name, known); !best.empty()) return "did you mean '" + best + "'?";
  if (known.empty()) return {};
  constexpr std::size_t shown = 20;  // enough for every table; a scene may have thousands of materials
  if (known.size() > shown)
    return "known are: " + join({known.begin(), known.begin() + shown}) + ", and " +
           std::to_string(known.size() - shown) + " more";
  return "known are: " + join(known);
}

std::string suggest_file(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path wanted(path);
  const fs::path folder = wanted.has_parent_path() ? wanted.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) {
    return fs::exists(folder, error) ? "" : "the folder '" + folder.string() + "' does not exist";
  }
  std::vector<std::string> names;
  fs::directory_iterator it(folder, error), end;
  for (; !error && it != end; it.increment(error)) names.push_back(it->path().filename().string());
  std::sort(names.begin(), names.end());
  const std::string best = nearest(wanted.filename().string(), names);
  return best.empty() ? "" : "did you mean '" + best + "'?";
}

}  // namespace lambent
