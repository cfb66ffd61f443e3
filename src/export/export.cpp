// The public API's way to the formats of others.

#include "export/formats.h"
#include "lambent/lambent.h"

namespace lambent {

std::string export_scene(const ScenePtr& scene, ExportFormat format, std::vector<Diagnostic>& remarks) {
  switch (format) {
    case ExportFormat::povray:
      return povray_text(*scene, remarks);
    case ExportFormat::tachyon:
      return tachyon_text(*scene, remarks);
  }
  __builtin_unreachable();
}

}  // namespace lambent
