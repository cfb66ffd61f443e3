// JPEG by libjpeg-turbo: grey, colour and CMYK, sequential and progressive, 8 bits.

#include <cstddef>
#include <cstdio>
// jpeglib.h wants the two above.
#include <jerror.h>
#include <jpeglib.h>

#include <csetjmp>
#include <cstring>

#include "image/pixel_formats.h"

namespace lambent {
namespace {

/// libjpeg's C ways, kept in one place: its records are released, and its long jumps become return values.
class JpegSession {
 public:
  JpegSession() {
    jpeg.err = jpeg_std_error(&errors_);
    jpeg.client_data = this;
    errors_.error_exit = give_up;
    errors_.emit_message = heed;
    errors_.output_message = [](j_common_ptr) {};
    progress_.progress_monitor = watch;
  }
  ~JpegSession() { jpeg_destroy_decompress(&jpeg); }
  JpegSession(const JpegSession&) = delete;
  JpegSession& operator=(const JpegSession&) = delete;

  /// Call `action`, which calls libjpeg. false where libjpeg gave up; error() then says why. The long jump
  /// skips destructors: `action` must not create anything that has one.
  template <class Action> bool run(const Action& action) {
    if (setjmp(jump_) != 0) return false;
    action();
    return true;
  }
  bool read_header(std::string_view bytes) {
    return run([&] {
      jpeg_create_decompress(&jpeg);
      jpeg.progress = &progress_;
      jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()),
                   static_cast<unsigned long>(bytes.size()));
      jpeg_read_header(&jpeg, TRUE);
    });
  }
  const char* error() const { return text_; }

  jpeg_decompress_struct jpeg{};

 private:
  static JpegSession& of(j_common_ptr jpeg) { return *static_cast<JpegSession*>(jpeg->client_data); }

  [[noreturn]] static void give_up(j_common_ptr jpeg) {
    JpegSession& session = of(jpeg);
    jpeg->err->format_message(jpeg, session.text_);
    std::longjmp(session.jump_, 1);
  }

  /// libjpeg makes up what is missing, and warns. Here that is an error, but for what costs no pixel.
  static void heed(j_common_ptr jpeg, int level) {
    if (level >= 0) return;
    switch (jpeg->err->msg_code) {
      case JWRN_EXTRANEOUS_DATA:
      case JWRN_ADOBE_XFORM:
      case JWRN_JFIF_MAJOR:
      case JWRN_BOGUS_PROGRESSION:
      case JWRN_TOO_MUCH_DATA:
        return;
      default:
        give_up(jpeg);
    }
  }

  /// A small file may ask for any number of scans over a large image. No encoder makes so many.
  static void watch(j_common_ptr jpeg) {
    constexpr int most_scans = 100;
    JpegSession& session = of(jpeg);
    if (session.jpeg.input_scan_number <= most_scans) return;
    std::snprintf(session.text_, sizeof session.text_, "it has more than %d scans", most_scans);
    std::longjmp(session.jump_, 1);
  }

  jpeg_error_mgr errors_{};
  jpeg_progress_mgr progress_{};
  std::jmp_buf jump_{};
  char text_[JMSG_LENGTH_MAX] = "";
};

bool is_jpeg(std::string_view bytes) { return bytes.substr(0, 3) == "\xff\xd8\xff"; }

bool is_cmyk(const jpeg_decompress_struct& jpeg) {
  return jpeg.jpeg_color_space == JCS_CMYK || jpeg.jpeg_color_space == JCS_YCCK;
}

PixelSize open_jpeg(JpegSession& session, const PixelInput& input) {
  if (!session.read_header(input.bytes)) throw damaged_image(input, "JPEG", session.error());
  PixelSize size;
  size.width = int(session.jpeg.image_width);
  size.height = int(session.jpeg.image_height);
  size.channels = session.jpeg.jpeg_color_space == JCS_GRAYSCALE ? 1 : 3;
  // CMYK is decoded as four values before it becomes three.
  PixelSize decoded = size;
  if (is_cmyk(session.jpeg)) decoded.channels = 4;
  check_decoded(decoded, 1, input);
  return size;
}

PixelSize jpeg_size(const PixelInput& input) {
  JpegSession session;
  return open_jpeg(session, input);
}

/// Four inks to three lights, in place. Adobe's programs, and nearly everybody since, write 255 - ink.
void colors_of_inks(std::vector<std::uint8_t>& bytes, bool inverted) {
  const std::size_t pixels = bytes.size() / 4;
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto paper = [&](std::size_t c) { return inverted ? bytes[4 * i + c] : 255 - bytes[4 * i + c]; };
    const int black = paper(3);
    for (std::size_t c = 0; c < 3; ++c) bytes[3 * i + c] = std::uint8_t((paper(c) * black + 127) / 255);
  }
  bytes.resize(3 * pixels);
}

Pixels decode(const PixelInput& input) {
  JpegSession session;
  const PixelSize size = open_jpeg(session, input);
  jpeg_decompress_struct& jpeg = session.jpeg;
  const bool cmyk = is_cmyk(jpeg);
  jpeg.out_color_space = cmyk ? JCS_CMYK : size.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
  const std::size_t row_bytes = std::size_t(size.width) * std::size_t(cmyk ? 4 : size.channels);
  Pixels pixels;
  pixels.width = size.width, pixels.height = size.height, pixels.channels = size.channels;
  pixels.bytes.resize(row_bytes * std::size_t(size.height));
  unsigned char* const first = pixels.bytes.data();
  if (!session.run([&] {
        jpeg_start_decompress(&jpeg);
        while (jpeg.output_scanline < jpeg.output_height) {
          JSAMPROW row = first + std::size_t(jpeg.output_scanline) * row_bytes;
          jpeg_read_scanlines(&jpeg, &row, 1);
        }
        jpeg_finish_decompress(&jpeg);
      }))
    throw damaged_image(input, "JPEG", session.error());
  if (cmyk) colors_of_inks(pixels.bytes, jpeg.saw_Adobe_marker != FALSE);
  return pixels;
}

}  // namespace

const PixelFormat jpeg_pixels{"JPEG", is_jpeg, jpeg_size, decode};

}  // namespace lambent
