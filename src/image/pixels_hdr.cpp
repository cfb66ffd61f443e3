// Radiance HDR: four bytes a pixel, three mantissas that share an exponent; Ward, Real pixels, Graphics Gems
// II, 1991, and Radiance's picture format (File Formats, chapter 4).

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "image/formats.h"
#include "image/pixel_formats.h"

namespace lambent {
namespace {

bool is_hdr(std::string_view bytes) {
  return bytes.substr(0, 10) == "#?RADIANCE" || bytes.substr(0, 6) == "#?RGBE";
}

/// One axis of the resolution line: "-Y 512".
struct Axis {
  bool reversed = false;
  char letter = 0;
  int length = 0;
};

struct Head {
  PixelSize size;
  Axis slow, fast;         ///< Scan lines follow each other along `slow` and run along `fast`.
  std::size_t pixels = 0;  ///< Where they begin.
};

/// The next line without its end, which is taken from `rest`; nothing where there is none.
std::optional<std::string_view> next_line(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

/// Takes " -Y 512" from the start of `line`.
std::optional<Axis> next_axis(std::string_view& line) {
  while (!line.empty() && line[0] == ' ') line.remove_prefix(1);
  if (line.size() < 4 || (line[0] != '-' && line[0] != '+') || (line[1] != 'X' && line[1] != 'Y') ||
      line[2] != ' ')
    return std::nullopt;
  Axis axis;
  axis.letter = line[1];
  axis.reversed = line[0] == '-';
  const char* const end = line.data() + line.size();
  const auto [rest, error] = std::from_chars(line.data() + 3, end, axis.length);
  if (error != std::errc() || axis.length <= 0) return std::nullopt;
  line.remove_prefix(std::size_t(rest - line.data()));
  return axis;
}

Head read_head(const PixelInput& input) {
  std::string_view rest = input.bytes;
  const auto line_or_throw = [&] {
    const auto line = next_line(rest);
    if (!line) throw damaged_image(input, "HDR", "the file ends within its header");
    return *line;
  };
  for (std::string_view line = line_or_throw(); !line.empty(); line = line_or_throw())
    if (line.substr(0, 7) == "FORMAT=" && line != "FORMAT=32-bit_rle_rgbe")
      throw picture_error(input.name,
                          "the HDR holds values of another kind: " + std::string(line.substr(0, 60)),
                          "convert it to red, green and blue, FORMAT=32-bit_rle_rgbe");
  std::string_view line = line_or_throw();
  const auto slow = next_axis(line), fast = next_axis(line);
  if (!slow || !fast || slow->letter == fast->letter)
    throw damaged_image(input, "HDR", "its resolution line is not like '-Y 512 +X 1024'");
  Head head;
  head.slow = *slow, head.fast = *fast;
  head.size.width = slow->letter == 'X' ? slow->length : fast->length;
  head.size.height = slow->letter == 'Y' ? slow->length : fast->length;
  head.size.channels = 3;
  head.pixels = input.bytes.size() - rest.size();
  check_decoded(head.size, 4, input);
  return head;
}

PixelSize hdr_size(const PixelInput& input) { return read_head(input).size; }

/// The newer packing: the four bytes of all pixels apart, each in runs and literal stretches.
void unpack_apart(ByteReader& reader, const PixelInput& input, std::vector<unsigned char>& line) {
  const std::size_t width = line.size() / 4;
  for (std::size_t part = 0; part < 4; ++part) {
    for (std::size_t x = 0; x < width;) {
      int count = reader.u8();
      const bool run = count > 128;
      if (run) count -= 128;
      if (count == 0 || std::size_t(count) > width - x)
        throw damaged_image(input, "HDR", "a run leads beyond its scan line");
      const int value = run ? reader.u8() : 0;
      for (; count > 0; --count, ++x)
        line[4 * x + part] = static_cast<unsigned char>(run ? value : reader.u8());
    }
  }
}

/// No packing, or the older one, where (1, 1, 1, n) repeats the pixel before n times; several such in a row
/// are the digits of one number, the lowest first, to the base 256. `pixel` is the first, read already.
void unpack_together(ByteReader& reader, const PixelInput& input, const unsigned char* pixel,
                     std::vector<unsigned char>& line) {
  const std::size_t width = line.size() / 4;
  int shift = 0;
  for (std::size_t x = 0;; pixel = reader.take(4)) {
    if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
      const std::size_t count = shift < 32 ? std::size_t(pixel[3]) << shift : width + 1;
      if (x == 0 || count > width - x) throw damaged_image(input, "HDR", "a run leads beyond its scan line");
      for (std::size_t i = 0; i < count; ++i, ++x)
        for (std::size_t part = 0; part < 4; ++part) line[4 * x + part] = line[4 * (x - 1) + part];
      shift += 8;
    } else {
      for (std::size_t part = 0; part < 4; ++part) line[4 * x + part] = pixel[part];
      ++x;
      shift = 0;
    }
    if (x == width) return;
  }
}

Pixels decode(const PixelInput& input) {
  const Head head = read_head(input);
  Pixels pixels;
  pixels.width = head.size.width, pixels.height = head.size.height, pixels.channels = 3;
  pixels.linear = true;
  pixels.floats.resize(std::size_t(pixels.width) * std::size_t(pixels.height) * 3);

  std::array<float, 256> scales{};  // an exponent of 0 means black
  for (int e = 1; e < 256; ++e) scales[std::size_t(e)] = std::ldexp(1.0f, e - (128 + 8));

  ByteReader reader(input, "HDR", head.pixels);
  const std::size_t lines = std::size_t(head.slow.length), length = std::size_t(head.fast.length);
  std::vector<unsigned char> line(4 * length);
  for (std::size_t s = 0; s < lines; ++s) {
    const unsigned char* first = reader.take(4);
    // Only lines of 8 to 32767 pixels are packed in the newer way; these four bytes announce it.
    if (length >= 8 && length < 32768 && first[0] == 2 && first[1] == 2 && first[2] < 128) {
      if ((std::size_t(first[2]) << 8 | first[3]) != length)
        throw damaged_image(input, "HDR", "a scan line has another length than the image");
      unpack_apart(reader, input, line);
    } else {
      unpack_together(reader, input, first, line);
    }
    for (std::size_t f = 0; f < length; ++f) {
      // Y grows upwards in Radiance: -Y runs from the top, as rows do here.
      const bool lines_are_rows = head.slow.letter == 'Y';
      const std::size_t along_y = lines_are_rows ? s : f, along_x = lines_are_rows ? f : s;
      const Axis& y_axis = lines_are_rows ? head.slow : head.fast;
      const Axis& x_axis = lines_are_rows ? head.fast : head.slow;
      const std::size_t y = y_axis.reversed ? along_y : std::size_t(pixels.height) - 1 - along_y;
      const std::size_t x = x_axis.reversed ? std::size_t(pixels.width) - 1 - along_x : along_x;
      const unsigned char* in = &line[4 * f];
      float* out = &pixels.floats[(y * std::size_t(pixels.width) + x) * 3];
      const float scale = scales[in[3]];
      for (int c = 0; c < 3; ++c) out[c] = scale * float(in[c]);
    }
  }
  return pixels;
}

}  // namespace

const PixelFormat hdr_pixels{"Radiance HDR", is_hdr, hdr_size, decode};

}  // namespace lambent
