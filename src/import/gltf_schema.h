#pragma once
// What may stand in a glTF 2.0 file, and where: types, ranges, references and what must be there (the schema
// of the specification, chapter 5, and those of the extensions that Khronos has ratified).

#include "import/gltf_json.h"

namespace lambent::gltf {

/// Reports everything in the file that does not follow the schema. What is unknown is passed over; `extras`
/// and the inside of unknown extensions too.
void check_schema(const Json& root, Remarks& remarks);

/// Whether an extension is one whose meaning is honoured when a file's scene is read.
bool is_understood(std::string_view extension);

}  // namespace lambent::gltf
