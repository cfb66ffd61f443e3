#pragma once
// The rules of glTF 2.0 that a schema cannot say: which members need or exclude each other, what fits into
// what, and which formats numbers may have. Nothing here looks at the numbers themselves.

#include "import/gltf_accessors.h"
#include "import/gltf_json.h"

namespace lambent::gltf {

/// Reports everything that breaks a rule. The file must follow the schema; where this adds no error, all
/// offsets and lengths lie within their buffers, and nodes make a tree.
void check_rules(const Json& root, Remarks& remarks);
/// The part of it about meshes, nodes, skins and animations.
void check_scene_rules(const Json& root, Remarks& remarks);
/// What images say of themselves against their first bytes, as far as they are there.
void check_images(const Json& root, Buffers& buffers, const ImportOptions& options, Remarks& remarks);

/// Whether extensionsUsed names it.
bool is_used(const Json& root, std::string_view extension);

}  // namespace lambent::gltf
