#pragma once
// Names that no two have.

#include <string>
#include <unordered_map>
#include <unordered_set>

namespace lambent {

/// Numbers what would be called alike: "lamp", "lamp 2", "lamp 3".
class UniqueNames {
 public:
  std::string operator()(const std::string& wanted) {
    std::string name = wanted;
    while (!taken_.insert(name).second)
      name = wanted + " " + std::to_string(++count_.try_emplace(wanted, 1).first->second);
    return name;
  }

 private:
  std::unordered_set<std::string> taken_;
  std::unordered_map<std::string, int> count_;
};

}  // namespace lambent
