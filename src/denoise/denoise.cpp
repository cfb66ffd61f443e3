#include "lambent/denoise.h"

#include <algorithm>
#include <array>
#include <vector>

#include "denoise/open_image_denoise.h"
#include "lambent/diagnostics.h"

namespace lambent {
namespace {

/// Three channels of a picture by themselves, as the library wants them.
using Planes = std::vector<float>;

Planes channels_of(const Image& image, const std::array<const char*, 3>& names) {
  std::array<std::size_t, 3> at{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto found = std::find(image.channels.begin(), image.channels.end(), names[c]);
    if (found == image.channels.end()) {
      Diagnostic diagnostic;
      diagnostic.message = std::string("to be denoised, a picture needs the channel ") + names[c];
      throw InputError(diagnostic);
    }
    at[c] = std::size_t(found - image.channels.begin());
  }
  const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
  Planes values(pixels * 3);
  for (std::size_t p = 0; p < pixels; ++p)
    for (std::size_t c = 0; c < 3; ++c) values[p * 3 + c] = image.data[p * image.channels.size() + at[c]];
  return values;
}

}  // namespace

struct Denoiser::Library {
  const oidn::Functions& functions = oidn::functions();
  oidn::Device device = functions.NewDevice(oidn::device_type_cpu);
  std::string version;

  explicit Library(int threads) {
    if (device != nullptr) {
      if (threads > 0) functions.SetDeviceInt(device, "numThreads", threads);
      functions.CommitDevice(device);
    }
    if (const std::string problem = error(); !problem.empty() || device == nullptr) {
      if (device != nullptr) functions.ReleaseDevice(device);
      Diagnostic diagnostic;
      diagnostic.message = "Open Image Denoise does not work here: " + problem;
      diagnostic.hint = "it wants its libraries for the CPU beside it, and SSE4.1 or NEON";
      throw InputError(diagnostic);
    }
    for (const char* part : {"versionMajor", "versionMinor", "versionPatch"})
      version += (version.empty() ? "" : ".") + std::to_string(functions.GetDeviceInt(device, part));
  }
  ~Library() { functions.ReleaseDevice(device); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  /// What went wrong since we last asked; empty: nothing.
  std::string error() const {
    const char* message = nullptr;
    if (functions.GetDeviceError(device, &message) == oidn::error_none) return "";
    return message != nullptr ? message : "it does not say why";
  }

  using Images = std::vector<std::pair<const char*, float*>>;
  void run(const Images& images, const Image& size, bool is_beauty) const {
    const auto filter = functions.NewFilter(device, "RT");
    if (filter == nullptr) throw Failure("Open Image Denoise has failed: " + error());
    for (const auto& [name, pixels] : images)
      functions.SetSharedFilterImage(filter, name, pixels, oidn::format_float3, std::size_t(size.width),
                                     std::size_t(size.height), 0, 0, 0);
    functions.SetFilterBool(filter, "hdr", is_beauty);
    if (is_beauty) functions.SetFilterBool(filter, "cleanAux", images.size() > 2);
    functions.CommitFilter(filter);
    functions.ExecuteFilter(filter);
    const std::string problem = error();
    functions.ReleaseFilter(filter);
    if (!problem.empty()) throw Failure("Open Image Denoise has failed: " + problem);
  }
};

Denoiser::Denoiser(int threads) : library_(std::make_unique<Library>(threads)) {}
Denoiser::~Denoiser() = default;
Denoiser::Denoiser(Denoiser&&) noexcept = default;
Denoiser& Denoiser::operator=(Denoiser&&) noexcept = default;

const std::string& Denoiser::version() const { return library_->version; }

Image Denoiser::denoise(const Image& picture, const Image& guides) const {
  const bool guided = !guides.data.empty();
  if (guided && (guides.width != picture.width || guides.height != picture.height)) {
    Diagnostic diagnostic;
    diagnostic.message = "the guides of a denoiser must have the picture's size";
    throw InputError(diagnostic);
  }
  Planes color = channels_of(picture, {"R", "G", "B"}), albedo, normal;
  Image result;
  result.width = picture.width, result.height = picture.height;
  result.data.resize(color.size());
  Library::Images images{{"color", color.data()}, {"output", result.data.data()}};
  if (guided) {
    // They have noise of their own, where edges or textures are sampled, or the lens is open: first without
    // that, as the library's manual advises for final pictures.
    albedo = channels_of(guides, {"albedo.R", "albedo.G", "albedo.B"});
    normal = channels_of(guides, {"N.X", "N.Y", "N.Z"});
    library_->run({{"albedo", albedo.data()}, {"output", albedo.data()}}, picture, false);
    library_->run({{"normal", normal.data()}, {"output", normal.data()}}, picture, false);
    images.insert(images.end(), {{"albedo", albedo.data()}, {"normal", normal.data()}});
  }
  library_->run(images, picture, true);
  return result;
}

}  // namespace lambent
