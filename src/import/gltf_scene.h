#pragma once
// The scene of a glTF file: what its nodes show, cameras and lights.

#include "import/gltf_json.h"
#include "import/gltf_meshes.h"

namespace lambent::gltf {

/// Reads the file's own scene (else its first; else all nodes; where there are none, all meshes) into the
/// model, but for what materials need.
void read_scene(const Json& root, Buffers& buffers, const ImportOptions& options, Materials& materials,
                Remarks& remarks, Model& model);

}  // namespace lambent::gltf
