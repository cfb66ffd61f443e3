#pragma once
// What the reader of OBJ files and its linter share.

#include <string>
#include <vector>

#include "import/model.h"

namespace lambent {

/// As import_obj; `libraries` gets the paths of the material libraries that were read, in order.
Model read_obj(const std::string& path, const ImportOptions& options, std::vector<std::string>* libraries);

/// `options` with a root: where none is given, the folder of the model, from which what its libraries name
/// counts, too.
ImportOptions within_folder_of(const std::string& path, const ImportOptions& options);

}  // namespace lambent
