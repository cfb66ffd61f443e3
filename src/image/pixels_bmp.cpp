// BMP as Windows and OS/2 write it: 1 to 32 bits a pixel, runs of 4 and 8 bits, masks. Microsoft, Bitmap
// Storage (BITMAPFILEHEADER to BITMAPV5HEADER).

#include <algorithm>
#include <array>
#include <bit>

#include "image/formats.h"
#include "image/pixel_formats.h"

namespace lambent {
namespace {

bool is_bmp(std::string_view bytes) { return bytes.substr(0, 2) == "BM"; }

enum Packing : std::uint32_t { plain = 0, runs_of_8 = 1, runs_of_4 = 2, masks = 3, masks_with_alpha = 6 };

struct Head {
  std::size_t pixels = 0;  ///< Where they begin.
  int width = 0, height = 0, bits = 0;
  bool from_top = false;
  std::uint32_t packing = plain;
  std::array<std::uint32_t, 4> mask{};  ///< R G B A.
  std::size_t palette = 0;              ///< Where it begins.
  int colors = 0, bytes_of_color = 4;
  int channels() const { return mask[3] != 0 ? 4 : 3; }
};

Head read_head(const PixelInput& input) {
  ByteReader reader(input, "BMP");
  const auto damaged = [&](const std::string& why) { return damaged_image(input, "BMP", why); };
  Head head;
  reader.skip(10);
  head.pixels = reader.u32();
  const std::size_t info = reader.position(), info_bytes = reader.u32();
  const bool old = info_bytes == 12;
  if (!old && (info_bytes < 40 || info_bytes > 1024)) throw damaged("its header has an unknown size");
  std::uint32_t colors = 0;
  if (old) {
    head.width = reader.u16(), head.height = reader.u16();
    reader.skip(2);
    head.bits = reader.u16();
    head.bytes_of_color = 3;
  } else {
    const auto width = std::int32_t(reader.u32()), height = std::int32_t(reader.u32());
    if (width <= 0 || height == 0 || height < -0x7fffffff) throw damaged("it has no pixels");
    head.width = width, head.height = height < 0 ? -height : height;
    head.from_top = height < 0;
    reader.skip(2);
    head.bits = reader.u16();
    head.packing = reader.u32();
    reader.skip(12);
    colors = reader.u32();
    reader.skip(4);
  }
  const auto wants_bits = [&](std::initializer_list<int> wanted) {
    if (std::find(wanted.begin(), wanted.end(), head.bits) == wanted.end())
      throw damaged(std::to_string(head.bits) + " bits a pixel do not go with its packing");
  };
  std::size_t after = info + info_bytes;
  switch (head.packing) {
    case plain:
      wants_bits({1, 4, 8, 16, 24, 32});
      break;
    case runs_of_8:
      wants_bits({8});
      break;
    case runs_of_4:
      wants_bits({4});
      break;
    case masks:
    case masks_with_alpha: {
      wants_bits({16, 32});
      // In headers of 40 bytes they follow, in longer ones they are a part.
      const int count = head.packing == masks_with_alpha || info_bytes >= 56 ? 4 : 3;
      for (int c = 0; c < count; ++c) head.mask[std::size_t(c)] = reader.u32();
      after = std::max(after, reader.position());
      break;
    }
    default:
      throw picture_error(input.name,
                          "the BMP is packed in a way that is not read: " + std::to_string(head.packing),
                          "convert it to PNG");
  }
  if (head.packing == plain && head.bits == 16) head.mask = {0x7c00, 0x03e0, 0x001f, 0};
  if (head.packing == plain && head.bits == 32) head.mask = {0xff0000, 0x00ff00, 0x0000ff, 0};
  for (const std::uint32_t mask : head.mask) {
    const std::uint32_t run = mask == 0 ? 0 : mask >> std::countr_zero(mask);
    if ((run & (run + 1)) != 0) throw damaged("a mask has gaps");
  }
  if (head.bits <= 8) {
    const std::uint32_t most = 1u << head.bits;
    if (colors > most) throw damaged("its palette is too large");
    head.palette = after;
    head.colors = int(colors == 0 ? most : colors);
    // Old files have fewer colours than the header lets one expect.
    if (head.pixels > after)
      head.colors =
          int(std::min(std::size_t(head.colors), (head.pixels - after) / std::size_t(head.bytes_of_color)));
  }
  PixelSize size;
  size.width = head.width, size.height = head.height, size.channels = head.channels();
  check_decoded(size, 1, input);
  return head;
}

PixelSize bmp_size(const PixelInput& input) {
  const Head head = read_head(input);
  PixelSize size;
  size.width = head.width, size.height = head.height, size.channels = head.channels();
  return size;
}

/// What stands under `mask`, stretched to 0..255.
std::uint8_t masked(std::uint32_t word, std::uint32_t mask) {
  if (mask == 0) return 0;
  const int low = std::countr_zero(mask);
  const std::uint64_t most = mask >> low, value = (word & mask) >> low;
  return std::uint8_t((value * 255 + most / 2) / most);
}

class Decoder {
 public:
  explicit Decoder(const PixelInput& input)
      : input_(input), head_(read_head(input)), reader_(input, "BMP", head_.pixels) {}

  Pixels run() {
    pixels_.width = head_.width, pixels_.height = head_.height, pixels_.channels = head_.channels();
    channels_ = std::size_t(pixels_.channels);
    pixels_.bytes.resize(std::size_t(head_.width) * std::size_t(head_.height) * channels_);
    if (head_.bits <= 8) read_palette();
    if (head_.packing == runs_of_8 || head_.packing == runs_of_4) read_runs();
    else
      for (int row = 0; row < head_.height; ++row) read_row(row);
    return std::move(pixels_);
  }

 private:
  InputError damaged(const std::string& why) const { return damaged_image(input_, "BMP", why); }

  void read_palette() {
    ByteReader reader(input_, "BMP", head_.palette);
    for (int i = 0; i < head_.colors; ++i) {
      const unsigned char* in = reader.take(std::size_t(head_.bytes_of_color));
      palette_.push_back({in[2], in[1], in[0]});
    }
  }

  /// `row` counts as the file does.
  std::uint8_t* at(int x, int row) {
    const int y = head_.from_top ? row : head_.height - 1 - row;
    return &pixels_.bytes[(std::size_t(y) * std::size_t(head_.width) + std::size_t(x)) * channels_];
  }

  void set_color(int x, int row, int index) {
    if (std::size_t(index) >= palette_.size())
      throw damaged("a pixel asks for a colour that the palette does not have");
    std::copy_n(palette_[std::size_t(index)].begin(), 3, at(x, row));
  }

  void read_row(int row) {
    // Rows begin at multiples of four bytes.
    const std::size_t bytes = (std::size_t(head_.width) * std::size_t(head_.bits) + 31) / 32 * 4;
    const unsigned char* in = reader_.take(bytes);
    for (int x = 0; x < head_.width; ++x) {
      if (head_.bits <= 8) {
        const std::size_t bit = std::size_t(x) * std::size_t(head_.bits);
        set_color(x, row, in[bit / 8] >> (8 - head_.bits - int(bit % 8)) & ((1 << head_.bits) - 1));
        continue;
      }
      const std::size_t step = std::size_t(head_.bits) / 8;
      const unsigned char* p = in + std::size_t(x) * step;
      std::uint8_t* out = at(x, row);
      if (step == 3) {
        out[0] = p[2], out[1] = p[1], out[2] = p[0];
        continue;
      }
      std::uint32_t word = 0;
      for (std::size_t i = 0; i < step; ++i) word |= std::uint32_t(p[i]) << (8 * i);
      for (std::size_t c = 0; c < channels_; ++c) out[c] = masked(word, head_.mask[c]);
    }
  }

  /// Pairs of a count and a colour; a count of 0 announces something else.
  void read_runs() {
    if (palette_.empty()) throw damaged("it has no palette");
    // What no run touches has the first colour.
    for (int row = 0; row < head_.height; ++row)
      for (int x = 0; x < head_.width; ++x) set_color(x, row, 0);
    const bool nibbles = head_.packing == runs_of_4;
    int x = 0, row = 0;
    const auto put = [&](int index) {
      if (x >= head_.width || row >= head_.height) throw damaged("a run leads beyond the image");
      set_color(x++, row, index);
    };
    for (;;) {
      const int count = reader_.u8(), value = reader_.u8();
      if (count > 0) {
        for (int i = 0; i < count; ++i) put(!nibbles ? value : i % 2 == 0 ? value >> 4 : value & 15);
      } else if (value == 0) {  // the row ends
        x = 0;
        if (++row > head_.height) throw damaged("a run leads beyond the image");
      } else if (value == 1) {  // the image ends
        return;
      } else if (value == 2) {  // go on somewhere else
        x += reader_.u8(), row += reader_.u8();
        if (x > head_.width || row > head_.height) throw damaged("a run leads beyond the image");
      } else {  // `value` pixels as they are, filled up to an even number of bytes
        const int bytes = nibbles ? (value + 1) / 2 : value;
        const unsigned char* in = reader_.take(std::size_t(bytes + bytes % 2));
        for (int i = 0; i < value; ++i) put(!nibbles ? in[i] : i % 2 == 0 ? in[i / 2] >> 4 : in[i / 2] & 15);
      }
    }
  }

  const PixelInput& input_;
  Head head_;
  ByteReader reader_;
  Pixels pixels_;
  std::size_t channels_ = 0;
  std::vector<std::array<std::uint8_t, 3>> palette_;
};

Pixels decode(const PixelInput& input) { return Decoder(input).run(); }

}  // namespace

const PixelFormat bmp_pixels{"BMP", is_bmp, bmp_size, decode};

}  // namespace lambent
