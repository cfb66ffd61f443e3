// glTF 2.0, as JSON with files beside it (.gltf) or in one piece (.glb); the specification is Khronos', also
// known as ISO/IEC 12113:2022. docs/gltf.md says what becomes of what.
//
// First everything in the file is checked, also what is not shown: against the schema, against the rules that
// no schema can say, then the numbers themselves. What is read after that can rely on it.

#include "import/gltf_accessors.h"
#include "import/gltf_file.h"
#include "import/gltf_json.h"
#include "import/gltf_materials.h"
#include "import/gltf_pose.h"
#include "import/gltf_rules.h"
#include "import/gltf_scene.h"
#include "import/gltf_schema.h"
#include "import/model.h"

namespace lambent {

Model import_gltf(const std::string& path, const ImportOptions& options) {
  const gltf::Container container = gltf::read_container(path, options.limits);
  const gltf::Json root = gltf::parse_json(path, container.json(), container.binary);
  gltf::Remarks remarks(path);
  gltf::check_schema(root, remarks);
  remarks.throw_errors();
  gltf::check_rules(root, remarks);
  remarks.throw_errors();
  gltf::Buffers buffers(root, container, options, remarks);
  gltf::check_data(root, buffers, remarks);
  gltf::check_animations(root, buffers, remarks);
  gltf::check_images(root, buffers, options, remarks);
  remarks.throw_errors();

  Model model;
  model.illumination = ModelId::blinn_phong;
  model.z_up = false;
  gltf::Materials materials(root, buffers, options, remarks, model);
  materials.read();
  gltf::read_scene(root, buffers, options, materials, remarks, model);
  if (model.materials.empty()) materials.of(gltf::Json::object());
  model.warnings = remarks.take_warnings();
  return model;
}

}  // namespace lambent
