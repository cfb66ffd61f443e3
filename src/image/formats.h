#pragma once
// The picture formats: each one encodes a picture into bytes and decodes bytes into a picture. Files are
// file.h's.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lambent/diagnostics.h"
#include "lambent/image.h"

namespace lambent {

/// Pictures with more samples (width * height * channels) than this are refused: 4 GiB of floats.
inline constexpr std::uint64_t largest_sample_count = std::uint64_t(1) << 30;

/// R, G, B, and A if it is there; a picture with one channel (and perhaps A) becomes grey. Colours are
/// sRGB-encoded, A is not; A is taken as it is, neither multiplied into the colours nor divided out. Other
/// channels are left out. Keys that PNG does not allow as keywords are kept whole in iTXt's translated
/// keyword. `path` is for messages only. Throws InputError where the picture has no colours.
std::string encode_png(const Image& image, const Metadata& metadata, const WriteOptions& options,
                       const std::string& path);

/// Every channel as 32-bit float, ZIP-compressed scan lines; nothing in the file changes from run to run. Of
/// metadata with equal keys the last stays. `threads` as in WriteOptions. Throws InputError where a channel's
/// name or a key cannot be EXR's.
std::string encode_exr(const Image& image, const Metadata& metadata, const std::string& path,
                       int threads = 0);

/// Every kind of PNG, as R, G, B and A where the file has transparency. The values are taken as sRGB,
/// whatever gAMA or iCCP say.
ReadImage decode_png(std::string_view bytes, const std::string& path);

/// The first flat part, scan lines or tiles (their finest level), all channels as float; the data window is
/// the picture. Channels are ordered layer by layer, in each R, G, B, A first.
ReadImage decode_exr(std::string_view bytes, const std::string& path);

/// What decode_exr would give, by the header alone. Throws likewise.
struct PictureHead {
  int width = 0, height = 0;
  std::vector<std::string> channels;
};
PictureHead exr_head(std::string_view bytes, const std::string& path);

bool is_png(std::string_view bytes);
bool is_exr(std::string_view bytes);

/// An error about the whole file.
InputError picture_error(const std::string& path, const std::string& message, const std::string& hint = "");

/// Throws InputError where a picture of this size is not to be had from `file_size` bytes: too many samples,
/// or more of them than `samples_per_byte` allows, which is what the format's best compression can do. So a
/// damaged header costs no memory.
void check_size(std::uint64_t width, std::uint64_t height, std::uint64_t channels, std::uint64_t file_size,
                std::uint64_t samples_per_byte, const std::string& path);

}  // namespace lambent
