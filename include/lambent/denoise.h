#pragma once
// Pictures without noise, by Open Image Denoise (https://www.openimagedenoise.org), where that library is
// installed.

#include <memory>
#include <string>

#include "lambent/image.h"

namespace lambent {

/// Open Image Denoise, loaded when one of these is made and not before: neither building nor running anything
/// else needs it. What it answers may differ in its last digits from version to version and from machine to
/// machine.
class Denoiser {
 public:
  /// Finds the library: the file that the environment variable LAMBENT_OIDN names, or, where that is not set,
  /// the system's. Throws InputError where there is none or it does not work.
  ///   threads  0: as many as the library finds good
  explicit Denoiser(int threads = 0);
  ~Denoiser();
  Denoiser(Denoiser&&) noexcept;
  Denoiser& operator=(Denoiser&&) noexcept;

  /// "2.3.0": the library's.
  const std::string& version() const;

  /// R, G, B of `picture`, linear, without noise: the library's filter for ray tracing, for pictures of any
  /// brightness. Negative values count as 0. `guides` are RenderResult::guides, by which edges and textures
  /// are told from noise; without pixels there are none. Throws InputError where `picture` lacks R, G or B,
  /// `guides` one of their channels, or the sizes differ; Failure where the library cannot do its work.
  Image denoise(const Image& picture, const Image& guides = {}) const;

 private:
  struct Library;
  std::unique_ptr<Library> library_;
};

}  // namespace lambent
