#include "denoise/open_image_denoise.h"

#include <dlfcn.h>

#include <cstdlib>

#include "lambent/diagnostics.h"

namespace lambent::oidn {
namespace {

/// The newest first. The number is that of the interface.
constexpr const char* names[] = {
#ifdef __APPLE__
    "libOpenImageDenoise.2.dylib", "libOpenImageDenoise.1.dylib", "libOpenImageDenoise.dylib"
#else
    "libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1", "libOpenImageDenoise.so"
#endif
};

[[noreturn]] void refuse(std::string message, std::string hint) {
  Diagnostic diagnostic;
  diagnostic.message = std::move(message);
  diagnostic.hint = std::move(hint);
  throw InputError(diagnostic);
}

struct Loaded {
  void* library = nullptr;
  std::string name;
};

Loaded load() {
  const char* file = std::getenv("LAMBENT_OIDN");
  if (file != nullptr && *file != '\0') {
    if (void* library = ::dlopen(file, RTLD_NOW | RTLD_LOCAL)) return {library, file};
    const char* reason = ::dlerror();
    refuse(std::string("cannot load Open Image Denoise: ") + (reason ? reason : file),
           "LAMBENT_OIDN is to name its library, as /usr/lib/" + std::string(names[0]) +
               ", with those beside it that it came with");
  }
  for (const char* name : names)
    if (void* library = ::dlopen(name, RTLD_NOW | RTLD_LOCAL)) return {library, name};
  refuse("Open Image Denoise is not installed here, and denoising is its work",
         "install it from your system's packages or https://www.openimagedenoise.org, or name the file " +
             std::string(names[0]) + " in the environment variable LAMBENT_OIDN");
}

template <class Function>
void find(const Loaded& loaded, Function*& function, const char* name, const char* older_name = nullptr) {
  void* symbol = ::dlsym(loaded.library, name);
  if (symbol == nullptr && older_name != nullptr) symbol = ::dlsym(loaded.library, older_name);
  if (symbol == nullptr)
    refuse("'" + loaded.name + "' is not a version of Open Image Denoise that we know: it has no " + name,
           "versions 1.4 and 2 will do");
  function = reinterpret_cast<Function*>(symbol);
}

Functions find_all() {
  const Loaded loaded = load();
  Functions f{};
  find(loaded, f.NewDevice, "oidnNewDevice");
  find(loaded, f.SetDeviceInt, "oidnSetDeviceInt",
       "oidnSetDevice1i");  // as version 1 called it; likewise below
  find(loaded, f.GetDeviceInt, "oidnGetDeviceInt", "oidnGetDevice1i");
  find(loaded, f.CommitDevice, "oidnCommitDevice");
  find(loaded, f.GetDeviceError, "oidnGetDeviceError");
  find(loaded, f.ReleaseDevice, "oidnReleaseDevice");
  find(loaded, f.NewFilter, "oidnNewFilter");
  find(loaded, f.SetSharedFilterImage, "oidnSetSharedFilterImage");
  find(loaded, f.SetFilterBool, "oidnSetFilterBool", "oidnSetFilter1b");
  find(loaded, f.CommitFilter, "oidnCommitFilter");
  find(loaded, f.ExecuteFilter, "oidnExecuteFilter");
  find(loaded, f.ReleaseFilter, "oidnReleaseFilter");
  return f;
}

}  // namespace

const Functions& functions() {
  static const Functions found = find_all();  // tried anew where it threw
  return found;
}

}  // namespace lambent::oidn
