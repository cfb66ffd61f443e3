// The whole way, from a file to its picture: what `lambent render`, `info`, `check` and `convert` do with it.

#include <cmath>

#include "input.h"
#include "lambent/lambent.h"

namespace {

/// Files are known by their ending; the input has none, so that seeds of all kinds may be changed into
/// others.
std::string ending_for(std::string_view bytes) {
  const auto holds = [&](std::string_view word) { return bytes.substr(0, 4096).find(word) != bytes.npos; };
  const std::size_t first = bytes.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (bytes.starts_with("glTF")) return ".glb";
  if (bytes.starts_with("ply")) return ".ply";
  if (first != bytes.npos && bytes[first] == '{') return ".gltf";
  if (bytes.starts_with("solid") || holds(std::string_view("\0\0\0", 3))) return ".stl";
  if (holds("\nat ") || holds("\nf 0") || holds("\nf 1.") || holds("\np 3") || holds("\ns 0")) return ".nff";
  if (holds("lambent:") || holds("objects:") || holds("camera:")) return ".yaml";
  return ".obj";
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::string path = lambent::fuzz::folder().file("input" + ending_for(bytes), data, size);
  lambent::LoadOptions options;
  options.limits = lambent::fuzz::small_options().limits;
  options.set = {{"image.size", "[16, 12]"}, {"image.samples", "1"}};
  try {
    lambent::lint(path, options.limits);
    const lambent::ScenePtr scene = lambent::load_scene(path, options);
    lambent::summarize(scene);
    std::vector<lambent::Diagnostic> remarks;
    lambent::export_scene(scene, lambent::ExportFormat::povray, remarks);
    lambent::export_scene(scene, lambent::ExportFormat::tachyon, remarks);
    lambent::RenderOptions render;
    render.threads = 1;
    const lambent::RenderResult result = lambent::render(scene, render);
    for (const float x : result.image.data) lambent::fuzz::check(!std::isnan(x), "a pixel is a number");
  } catch (const lambent::InputError& error) {
    lambent::fuzz::check(error);
  } catch (const lambent::Failure&) {
  }
  return 0;
}
