#pragma once
// The formats of read_pixels: each one tells an image's size from its header, and decodes it.

#include <string>
#include <string_view>

#include "image/pixels.h"
#include "lambent/diagnostics.h"

namespace lambent {

/// One image to read.
struct PixelInput {
  std::string_view bytes;
  const std::string& name;  ///< For messages.
  const Limits& limits;
};

/// Both throw InputError. `decode` has called check_decoded() before it sets up anything of the image's size.
struct PixelFormat {
  const char* name;  ///< "PNG".
  bool (*recognises)(std::string_view bytes);
  PixelSize (*size)(const PixelInput& input);
  Pixels (*decode)(const PixelInput& input);
};

extern const PixelFormat png_pixels, jpeg_pixels, hdr_pixels, exr_pixels, bmp_pixels, tga_pixels;

/// Throws InputError where the image is larger than the limits, or than its file can plausibly hold: when
/// decoded, with `bytes_per_value` for each channel of each pixel, it takes more than 64 MiB and more than
/// 2000 times the file's size. No format needs that for anything but wide empty areas.
void check_decoded(const PixelSize& size, int bytes_per_value, const PixelInput& input);

/// "cannot read the PNG: ...", with the remedy that damage has.
InputError damaged_image(const PixelInput& input, const char* format, const std::string& why);

/// The bytes of a file one after the other; beyond the end stands the InputError "the file ends too early".
class ByteReader {
 public:
  ByteReader(const PixelInput& input, const char* format, std::size_t position = 0)
      : input_(input), format_(format), position_(position) {}
  std::size_t position() const { return position_; }
  std::size_t left() const { return position_ < input_.bytes.size() ? input_.bytes.size() - position_ : 0; }
  void skip(std::size_t count) {
    need(count);
    position_ += count;
  }
  int u8() {
    need(1);
    return static_cast<unsigned char>(input_.bytes[position_++]);
  }
  /// The lowest byte first.
  int u16() {
    const int low = u8();
    return low | u8() << 8;
  }
  std::uint32_t u32() {
    const std::uint32_t low = std::uint32_t(u16());
    return low | std::uint32_t(u16()) << 16;
  }
  /// `count` bytes at once.
  const unsigned char* take(std::size_t count) {
    need(count);
    const auto* here = reinterpret_cast<const unsigned char*>(input_.bytes.data()) + position_;
    position_ += count;
    return here;
  }

 private:
  void need(std::size_t count) const {
    if (count > left()) throw damaged_image(input_, format_, "the file ends too early");
  }
  const PixelInput& input_;
  const char* format_;
  std::size_t position_;
};

}  // namespace lambent
