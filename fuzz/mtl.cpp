// By way of an OBJ file that names the library and a few likely materials of it, so that the target stays the
// same whatever the reader of libraries is called.

#include "input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string obj =
      "mtllib input.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
      "usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 2/2 3/3\nusemtl default\nf 1/1 2/2 3/3\n";
  lambent::fuzz::folder().file("input.mtl", data, size);
  lambent::fuzz::run(lambent::import_obj, "input.obj", reinterpret_cast<const std::uint8_t*>(obj.data()),
                     obj.size());
  return 0;
}
