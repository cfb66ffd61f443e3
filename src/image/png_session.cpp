#include "image/png_session.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <new>

namespace lambent {
namespace {

[[noreturn]] void give_up(png_structp png, png_const_charp message) {
  std::snprintf(static_cast<PngError*>(png_get_error_ptr(png))->text, sizeof(PngError::text), "%s", message);
  png_longjmp(png, 1);
}

// libpng's warnings are about chunks that it leaves out; the picture is whole.
void ignore(png_structp, png_const_charp) {}

void take(png_structp png, png_bytep data, png_size_t size) {
  std::string_view& unread = *static_cast<std::string_view*>(png_get_io_ptr(png));
  if (size > unread.size()) png_error(png, "the file ends too early");
  std::memcpy(data, unread.data(), size);
  unread.remove_prefix(size);
}

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

bool PngSession::read_header(std::string_view bytes) {
  unread = bytes;
  // Unpacked, a text may be larger than the file.
  constexpr std::size_t smallest_limit = std::size_t(1) << 24;
  const std::size_t largest_chunk = std::max(bytes.size(), smallest_limit);
  return run([&] {
    png_set_read_fn(png, &unread, take);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_chunk_malloc_max(png, largest_chunk);
    png_read_info(png, info);
  });
}

bool png_chunks_fit(std::string_view bytes) {
  constexpr std::size_t signature = 8, around = 12;  // length, name and checksum, 4 bytes each
  for (std::size_t at = signature; at < bytes.size();) {
    if (bytes.size() - at < around) return false;
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<unsigned char>(bytes[at + i]);
    if (length > bytes.size() - at - around) return false;
    if (bytes.substr(at + 4, 4) == "IEND") return true;  // what follows is no part of the picture
    at += around + length;
  }
  return false;
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
