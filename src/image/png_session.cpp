#include "image/png_session.h"

#include <cstdio>
#include <new>

namespace lambent {
namespace {

[[noreturn]] void give_up(png_structp png, png_const_charp message) {
  std::snprintf(static_cast<PngError*>(png_get_error_ptr(png))->text, sizeof(PngError::text), "%s", message);
  png_longjmp(png, 1);
}

// libpng's warnings are about chunks that it leaves out; the picture is whole.
void ignore(png_structp, png_const_charp) {}

}  // namespace

PngSession::PngSession(Way way) : way(way) {
  png = way == Way::read ? png_create_read_struct(PNG_LIBPNG_VER_STRING, &error, give_up, ignore)
                         : png_create_write_struct(PNG_LIBPNG_VER_STRING, &error, give_up, ignore);
  if (png == nullptr) throw std::bad_alloc();
  info = png_create_info_struct(png);
  if (info == nullptr) {
    if (way == Way::read) png_destroy_read_struct(&png, nullptr, nullptr);
    else png_destroy_write_struct(&png, nullptr);
    throw std::bad_alloc();
  }
}

PngSession::~PngSession() {
  if (way == Way::read) png_destroy_read_struct(&png, &info, nullptr);
  else png_destroy_write_struct(&png, &info);
}

std::string png_keyword(const std::string& key) {
  std::string keyword;
  for (std::size_t i = 0; i < key.size() && keyword.size() < 79; ++i) {
    const unsigned char c = static_cast<unsigned char>(key[i]);
    const auto next = i + 1 < key.size() ? static_cast<unsigned char>(key[i + 1]) : 0;
    if ((c & 0xc0) == 0x80) continue;  // the rest of a character that was dealt with
    char latin = '?';
    if (c >= 0x20 && c < 0x7f) latin = char(c);
    else if ((c == 0xc2 && next > 0xa0 && next <= 0xbf) || (c == 0xc3 && (next & 0xc0) == 0x80))
      latin = char((c & 3) << 6 | (next & 0x3f));
    if (latin == ' ' && (keyword.empty() || keyword.back() == ' ')) continue;
    keyword += latin;
  }
  while (!keyword.empty() && keyword.back() == ' ') keyword.pop_back();
  return keyword.empty() ? "Comment" : keyword;
}

}  // namespace lambent
