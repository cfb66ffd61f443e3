#pragma once
// What is odd about OBJ and MTL files, beyond what has to be said to read them.

#include <string>
#include <vector>

#include "import/model.h"

namespace lambent {

/// Everything that is odd about an OBJ file and its libraries: the warnings of import_obj, and
///
/// - faces: a corner twice, no area, the same corners as another one, normals of the corners that point to
///   the back, no texture coordinates though the material has images, different forms in one file;
/// - edges of more than two faces, and edges that two faces run along in the same direction;
/// - normals without a direction or far from unit length; what no face uses;
/// - usemtl without faces, materials that no face has; and what lint_mtl says of the libraries.
///
/// Of each kind a few are shown, and how many there are more. In the order of the file, then those of its
/// libraries. Throws InputError where the file cannot be read.
std::vector<Diagnostic> lint_obj(const std::string& path, const ImportOptions& options = {});

/// Everything that is odd about a material library: the warnings of read_material_library, and
///
/// - numbers that come to nothing or contradict each other: illum without the colours that it asks for,
///   colours that illum does not show, Ns without Ks, images that multiply black, keys given twice;
/// - images whose names differ from each other, or from a file, by upper and lower case alone.
std::vector<Diagnostic> lint_mtl(const std::string& path, const ImportOptions& options = {});

}  // namespace lambent
