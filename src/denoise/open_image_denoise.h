#pragma once
// What we call of Open Image Denoise, found in its shared library while the program runs. Declared here by
// its manual (https://www.openimagedenoise.org/documentation.html), so that no header is needed to build;
// versions 1.4 and 2.

#include <cstddef>
#include <string>

namespace lambent::oidn {

using Device = struct DeviceHandle*;
using Filter = struct FilterHandle*;

constexpr int device_type_cpu = 1, format_float3 = 3, error_none = 0;

/// The library's functions, without the `oidn` before their names. Enumerations of C are int.
struct Functions {
  Device (*NewDevice)(int type);
  void (*SetDeviceInt)(Device, const char* name, int value);
  int (*GetDeviceInt)(Device, const char* name);
  void (*CommitDevice)(Device);
  int (*GetDeviceError)(Device, const char** message);
  void (*ReleaseDevice)(Device);
  Filter (*NewFilter)(Device, const char* type);
  void (*SetSharedFilterImage)(Filter, const char* name, void* pixels, int format, std::size_t width,
                               std::size_t height, std::size_t offset, std::size_t pixel_stride,
                               std::size_t row_stride);
  void (*SetFilterBool)(Filter, const char* name, bool value);
  void (*CommitFilter)(Filter);
  void (*ExecuteFilter)(Filter);
  void (*ReleaseFilter)(Filter);
};

/// Loads the library from the file that LAMBENT_OIDN names, else by the names that systems know it by, once;
/// it stays until the program ends, as its threads may. Throws InputError where there is none.
const Functions& functions();

}  // namespace lambent::oidn
