// TGA: Truevision TGA File Format Specification, version 2.0, 1991. Colours, palettes and greys, packed or
// not.

#include <algorithm>

#include "image/pixel_formats.h"

namespace lambent {
namespace {

struct Head {
  int id_length = 0;
  bool has_palette = false;
  int kind = 0;  ///< 1 palette, 2 colours, 3 grey.
  bool packed = false;
  int palette_first = 0, palette_count = 0, palette_bits = 0;
  int width = 0, height = 0, bits = 0, alpha_bits = 0;
  bool from_right = false, from_top = false;
};

constexpr std::size_t head_bytes = 18;

int channels_of_color(int bits, int alpha_bits) {
  return bits == 32 || (bits == 16 && alpha_bits == 1) ? 4 : 3;
}

int channels_of(const Head& head) {
  if (head.kind == 3) return head.bits == 16 ? 2 : 1;
  return channels_of_color(head.kind == 1 ? head.palette_bits : head.bits, head.alpha_bits);
}

/// Whether a header is one that a TGA can have; there is no signature to go by.
bool is_consistent(const Head& head, int palette_type, int image_type, int descriptor) {
  const auto is_color = [](int bits) { return bits == 15 || bits == 16 || bits == 24 || bits == 32; };
  if (palette_type > 1 || (image_type & ~8) < 1 || (image_type & ~8) > 3) return false;
  if (head.width == 0 || head.height == 0 || (descriptor & 0xc0) != 0 || head.alpha_bits > 8) return false;
  if (head.has_palette && !is_color(head.palette_bits)) return false;
  switch (head.kind) {
    case 1:
      return head.has_palette && head.palette_count > 0 && (head.bits == 8 || head.bits == 16);
    case 2:
      return is_color(head.bits);
    default:
      return head.bits == 8 || head.bits == 16;
  }
}

bool read_head(std::string_view bytes, Head& head) {
  if (bytes.size() < head_bytes) return false;
  const auto u8 = [&](std::size_t at) { return int(static_cast<unsigned char>(bytes[at])); };
  const auto u16 = [&](std::size_t at) { return u8(at) | u8(at + 1) << 8; };
  head.id_length = u8(0);
  head.has_palette = u8(1) == 1;
  head.kind = u8(2) & ~8;
  head.packed = (u8(2) & 8) != 0;
  head.palette_first = u16(3), head.palette_count = u16(5), head.palette_bits = u8(7);
  head.width = u16(12), head.height = u16(14), head.bits = u8(16);
  const int descriptor = u8(17);
  head.alpha_bits = descriptor & 15;
  head.from_right = (descriptor & 16) != 0, head.from_top = (descriptor & 32) != 0;
  return is_consistent(head, u8(1), u8(2), descriptor);
}

bool is_tga(std::string_view bytes) {
  Head head;
  return read_head(bytes, head);
}

PixelSize checked_size(const Head& head, const PixelInput& input) {
  PixelSize size;
  size.width = head.width, size.height = head.height, size.channels = channels_of(head);
  check_decoded(size, 1, input);
  return size;
}

PixelSize tga_size(const PixelInput& input) {
  Head head;
  read_head(input.bytes, head);
  return checked_size(head, input);
}

/// One colour as it stands in a palette or an image: B, G, R, A, or 5 bits each; `out` has `channels` values.
void unpack_color(const unsigned char* in, int bits, int channels, std::uint8_t* out) {
  if (bits >= 24) {
    out[0] = in[2], out[1] = in[1], out[2] = in[0];
    if (channels == 4) out[3] = in[3];
    return;
  }
  const int word = in[0] | in[1] << 8;
  for (int c = 0; c < 3; ++c) {
    const int five = word >> (10 - 5 * c) & 31;
    out[c] = std::uint8_t((five * 255 + 15) / 31);
  }
  if (channels == 4) out[3] = (word & 0x8000) != 0 ? 255 : 0;
}

class Decoder {
 public:
  explicit Decoder(const PixelInput& input) : input_(input), reader_(input, "TGA") {}

  Pixels run() {
    read_head(input_.bytes, head_);
    const PixelSize size = checked_size(head_, input_);
    channels_ = size.channels;
    reader_.skip(head_bytes + std::size_t(head_.id_length));
    if (head_.has_palette) read_palette();
    Pixels pixels;
    pixels.width = size.width, pixels.height = size.height, pixels.channels = channels_;
    const std::size_t values = std::size_t(channels_),
                      count = std::size_t(size.width) * std::size_t(size.height);
    pixels.bytes.resize(count * values);
    std::uint8_t* const out = pixels.bytes.data();
    if (head_.packed) {
      for (std::size_t i = 0; i < count;) {
        const int code = reader_.u8();
        const std::size_t length = std::size_t(code & 127) + 1;
        if (length > count - i) throw damaged_image(input_, "TGA", "a run leads beyond the image");
        for (std::size_t k = 0; k < length; ++k, ++i) {
          if (k == 0 || code < 128) read_pixel(out + i * values);
          else std::copy_n(out + (i - 1) * values, values, out + i * values);
        }
      }
    } else {
      for (std::size_t i = 0; i < count; ++i) read_pixel(out + i * values);
    }
    turn(pixels);
    if (channels_ == 4) show_where_alpha_is_unused(pixels);
    return pixels;
  }

 private:
  static std::size_t bytes_of(int bits) { return std::size_t(bits + 7) / 8; }

  void read_palette() {
    const std::size_t step = bytes_of(head_.palette_bits), count = std::size_t(head_.palette_count);
    const unsigned char* in = reader_.take(step * count);
    if (head_.kind != 1) return;  // there is one, but no pixel asks for it
    palette_.resize(count * std::size_t(channels_));
    for (std::size_t i = 0; i < count; ++i)
      unpack_color(in + i * step, head_.palette_bits, channels_, &palette_[i * std::size_t(channels_)]);
  }

  void read_pixel(std::uint8_t* out) {
    if (head_.kind == 2) {
      unpack_color(reader_.take(bytes_of(head_.bits)), head_.bits, channels_, out);
    } else if (head_.kind == 3) {
      std::copy_n(reader_.take(std::size_t(channels_)), channels_, out);
    } else {
      const int index = (head_.bits == 16 ? reader_.u16() : reader_.u8()) - head_.palette_first;
      if (index < 0 || index >= head_.palette_count)
        throw damaged_image(input_, "TGA", "a pixel asks for a colour that the palette does not have");
      std::copy_n(&palette_[std::size_t(index) * std::size_t(channels_)], channels_, out);
    }
  }

  /// The file's rows run from the bottom to the top where it does not say otherwise.
  void turn(Pixels& pixels) const {
    const std::size_t row = std::size_t(pixels.width) * std::size_t(channels_);
    const auto begin = pixels.bytes.begin();
    const std::size_t height = std::size_t(pixels.height);
    if (!head_.from_top)
      for (std::size_t y = 0; y < height / 2; ++y)
        std::swap_ranges(begin + std::ptrdiff_t(y * row), begin + std::ptrdiff_t((y + 1) * row),
                         begin + std::ptrdiff_t((height - 1 - y) * row));
    if (!head_.from_right) return;
    for (std::size_t y = 0; y < height; ++y)
      for (std::size_t left = 0, right = std::size_t(pixels.width) - 1; left < right; ++left, --right)
        std::swap_ranges(begin + std::ptrdiff_t(y * row + left * std::size_t(channels_)),
                         begin + std::ptrdiff_t(y * row + (left + 1) * std::size_t(channels_)),
                         begin + std::ptrdiff_t(y * row + right * std::size_t(channels_)));
  }

  /// Programs that have no use for the fourth byte leave it 0; nobody keeps an image that is invisible.
  void show_where_alpha_is_unused(Pixels& pixels) const {
    for (std::size_t i = 3; i < pixels.bytes.size(); i += 4)
      if (pixels.bytes[i] != 0) return;
    for (std::size_t i = 3; i < pixels.bytes.size(); i += 4) pixels.bytes[i] = 255;
  }

  const PixelInput& input_;
  ByteReader reader_;
  Head head_;
  int channels_ = 0;
  std::vector<std::uint8_t> palette_;
};

Pixels decode(const PixelInput& input) { return Decoder(input).run(); }

}  // namespace

const PixelFormat tga_pixels{"TGA", is_tga, tga_size, decode};

}  // namespace lambent
