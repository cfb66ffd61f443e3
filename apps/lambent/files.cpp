#include "files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace lambent::app {

namespace fs = std::filesystem;

InputError usage_error(std::string message, std::string hint) {
  Diagnostic diagnostic;
  diagnostic.message = std::move(message);
  diagnostic.hint = std::move(hint);
  return InputError(std::move(diagnostic));
}

std::string ending(const std::string& path) {
  std::string result = fs::path(path).extension().string();
  std::transform(result.begin(), result.end(), result.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return result;
}

bool is_image_file(const std::string& path) { return ending(path) == ".png" || ending(path) == ".exr"; }

bool is_readable_picture(const std::string& path) {
  const std::string end = ending(path);
  return is_image_file(path) || end == ".jpg" || end == ".jpeg" || end == ".hdr" || end == ".tga" ||
         end == ".bmp";
}

void check_output(const std::string& path) {
  const auto fail = [&](const std::string& why) {
    throw Failure(fmt::format("cannot write '{}': {}", path, why));
  };
  std::error_code ignored;
  const fs::file_status target = fs::status(path, ignored);
  if (fs::is_directory(target)) fail("it is a folder");
  if (fs::exists(target) && ::access(path.c_str(), W_OK) != 0) fail(std::strerror(errno));
  if (fs::exists(target) && !fs::is_regular_file(target))
    return;  // a device or a pipe is written to as it stands

  const fs::path parent = fs::path(path).parent_path();
  const std::string folder = parent.empty() ? "." : parent.string();
  const fs::file_status status = fs::status(folder, ignored);
  if (!fs::exists(status)) fail(fmt::format("there is no folder '{}'", folder));
  if (!fs::is_directory(status)) fail(fmt::format("'{}' is not a folder", folder));
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    fail(fmt::format("the folder '{}': {}", folder, std::strerror(errno)));
}

void check_image_output(const std::string& path) {
  if (!is_image_file(path))
    throw usage_error(fmt::format("cannot tell the format of '{}' from its ending", path),
                      "pictures are written as .png or .exr");
  check_output(path);
}

void write_text_file(const std::string& path, std::string_view text) {
  const auto fail = [&] { throw Failure(fmt::format("cannot write '{}': {}", path, std::strerror(errno))); };
  const auto write_to = [&](const std::string& name) {
    std::FILE* file = std::fopen(name.c_str(), "wb");
    if (!file) fail();
    const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    const int error = errno;
    if (std::fclose(file) == 0 && written) return true;
    if (!written) errno = error;
    return false;
  };

  std::error_code ignored;
  const fs::file_status target = fs::status(path, ignored);
  if (fs::exists(target) && !fs::is_regular_file(target)) {  // never rename over a device or a pipe
    if (!write_to(path)) fail();
    return;
  }
  const std::string temporary = fmt::format("{}.{}.tmp", path, ::getpid());
  if (!write_to(temporary) || std::rename(temporary.c_str(), path.c_str()) != 0) {
    const int error = errno;
    std::remove(temporary.c_str());
    errno = error;
    fail();
  }
}

}  // namespace lambent::app
