#include "image/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "image/formats.h"
#include "lambent/diagnostics.h"

namespace lambent {
namespace {

namespace fs = std::filesystem;

std::string reason(int error) { return std::generic_category().message(error); }

Failure cannot_write(const std::string& path, const std::string& why) {
  return Failure("cannot write " + path + ": " + why);
}

/// A file descriptor that closes itself.
struct Descriptor {
  int fd;
  explicit Descriptor(int fd) : fd(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
  /// Some file systems report only now that the disk is full. The error, or 0.
  int close() {
    const int result = ::close(fd);
    fd = -1;
    return result == 0 ? 0 : errno;
  }
};

/// The error, or 0.
int write_all(int fd, const std::string& bytes) {
  constexpr std::size_t most = std::size_t(1) << 30;  // Linux writes less than 2 GiB in one call
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t written = ::write(fd, bytes.data() + done, std::min(bytes.size() - done, most));
    if (written < 0 && errno != EINTR) return errno;
    if (written > 0) done += std::size_t(written);
  }
  return 0;
}

/// A new, empty file in `folder` with a name that nobody else has; `name` receives it.
int open_temporary(const fs::path& folder, fs::path& name) {
  static std::atomic<unsigned> counter{0};
  for (;;) {
    name = folder / (".lambent-" + std::to_string(::getpid()) + "-" + std::to_string(counter++));
    const int fd = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd >= 0 || errno != EEXIST) return fd;
  }
}

}  // namespace

std::string read_bytes(const std::string& path) {
  const auto fail = [&](const std::string& why) {
    return picture_error(path, "cannot open the picture: " + why);
  };
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.fd < 0) throw fail(reason(errno));
  struct stat status {};
  if (::fstat(file.fd, &status) != 0) throw fail(reason(errno));
  if (S_ISDIR(status.st_mode)) throw fail("it is a folder");
  if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode))
    throw fail("it is not a file");  // /dev/zero has no end
  std::string bytes;
  std::size_t size = 0;
  const std::size_t expected = S_ISREG(status.st_mode) ? std::size_t(status.st_size) : 0;
  constexpr std::size_t most = std::size_t(1) << 33;  // twice the largest picture that is read, uncompressed
  for (;;) {
    if (std::max(size, expected) > most) throw fail("it is larger than 8 GiB");
    // One byte more than expected, so that the end shows without another round.
    if (size == bytes.size()) bytes.resize(size == 0 ? expected + 1 : size + size / 2 + 65536);
    const ssize_t count = ::read(file.fd, bytes.data() + size, bytes.size() - size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw fail(reason(errno));
    if (count == 0) break;
    size += std::size_t(count);
  }
  bytes.resize(size);
  return bytes;
}

void write_bytes(const std::string& path, const std::string& bytes) {
  std::error_code error;
  fs::path target = path;
  const fs::path linked = fs::canonical(target, error);  // fails where nothing stands there yet
  if (!error) target = linked;
  const fs::file_status status = fs::status(target, error);
  if (fs::is_directory(status)) throw cannot_write(path, "it is a folder");

  if (fs::exists(status) && !fs::is_regular_file(status)) {
    Descriptor device(::open(target.c_str(), O_WRONLY | O_CLOEXEC));
    if (device.fd < 0) throw cannot_write(path, reason(errno));
    if (const int failed = write_all(device.fd, bytes)) throw cannot_write(path, reason(failed));
    if (const int failed = device.close()) throw cannot_write(path, reason(failed));
    return;
  }

  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (!fs::exists(folder, error) && !error)
    throw cannot_write(path, "the folder " + folder.string() + " does not exist");
  fs::path temporary;
  Descriptor file(open_temporary(folder, temporary));
  if (file.fd < 0) throw cannot_write(path, reason(errno));
  int failed = write_all(file.fd, bytes);
  // A file that is replaced keeps its permissions; where that is not allowed the new one has the usual ones.
  if (failed == 0 && fs::exists(status)) ::fchmod(file.fd, mode_t(status.permissions()) & 07777);
  if (const int closing = file.close(); failed == 0) failed = closing;
  if (failed == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) failed = errno;
  if (failed != 0) {
    ::unlink(temporary.c_str());
    throw cannot_write(path, reason(failed));
  }
}

}  // namespace lambent
