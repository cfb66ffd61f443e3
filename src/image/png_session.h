#pragma once
// libpng's C ways, kept in one place: its records are released, and its long jumps become return values.

#include <png.h>

#include <csetjmp>
#include <string>
#include <string_view>

namespace lambent {

/// What libpng said when it gave up.
struct PngError {
  char text[200] = "";
};

struct PngSession {
  enum class Way { read, write };
  explicit PngSession(Way way);
  ~PngSession();
  PngSession(const PngSession&) = delete;
  PngSession& operator=(const PngSession&) = delete;

  /// Call `action`, which calls libpng. false where libpng gave up; `error` then says why. libpng leaves by a
  /// long jump, which skips destructors: `action` must not create anything that has one.
  template <class Action> bool run(const Action& action) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    action();
    return true;
  }

  /// Read what stands before the pixels, with limits on what chunks may cost: false as for run(). `bytes` has
  /// to stay until the session ends, and its chunks must fit (png_chunks_fit).
  bool read_header(std::string_view bytes);

  Way way;
  PngError error;
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string_view unread;  ///< The bytes that libpng has not asked for yet.
};

/// Whether every chunk ends within the file. libpng believes the lengths that the chunks claim, and would set
/// up a gigabyte for a text in a file of 57 bytes.
bool png_chunks_fit(std::string_view bytes);

/// A key as PNG wants its keywords: 1 to 79 printable Latin-1 characters, without spaces at the ends or two
/// in a row. What is not Latin-1 becomes '?', what is too long is cut, an empty key becomes "Comment".
std::string png_keyword(const std::string& key);

}  // namespace lambent
