#include "import/gltf_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <filesystem>

#include "import/gltf_json.h"
#include "import/text_file.h"

namespace lambent::gltf {

namespace {

constexpr std::string_view magic = "glTF";
constexpr std::uint32_t json_chunk = 0x4e4f534a, data_chunk = 0x004e4942;  // "JSON", "BIN\0"

/// The GLB container, version 2: a header of 12 bytes, then chunks: length, type, data.
class GlbReader {
 public:
  GlbReader(const std::string& path, Container& file) : remarks_(path), file_(file) {}

  void read() {
    const std::size_t size = file_.bytes.size();
    if (size < 12) fail(size, "the file ends within its header of 12 bytes");
    if (!file_.bytes.starts_with(magic))
      fail(0, "a GLB file must begin with 'glTF'", "a JSON file must end with .gltf");
    if (const std::uint32_t version = number(4); version != 2)
      fail(4, "the container's version is " + std::to_string(version) + "; only version 2 is known");
    if (const std::uint32_t length = number(8); length != size)
      fail(8,
           "the header says " + std::to_string(length) + " bytes, but the file has " + std::to_string(size));
    std::size_t at = 12;
    for (int chunk = 0; at < size; ++chunk) at = read_chunk(at, chunk);
    if (file_.json_begin == 0) fail(size, "there is no JSON chunk");
  }

 private:
  /// Answers where the next one begins.
  std::size_t read_chunk(std::size_t at, int position) {
    const std::size_t size = file_.bytes.size();
    if (size - at < 8) fail(at, "the file ends within the header of a chunk");
    const std::uint32_t length = number(at), type = number(at + 4);
    if (position == 0 && type != json_chunk) fail(at, "the first chunk must be JSON");
    if (length > size - at - 8)
      fail(at, "the chunk is to have " + std::to_string(length) + " bytes, but only " +
                   std::to_string(size - at - 8) + " follow");
    if (length % 4 != 0) fail(at, "the length of a chunk must be a multiple of 4");
    if (type == json_chunk) {
      if (position != 0) fail(at, "there is a second JSON chunk");
      if (length == 0) fail(at, "the JSON chunk is empty");
      file_.json_begin = at + 8, file_.json_size = length;
    } else if (type == data_chunk) {
      if (file_.has_data) fail(at, "there is a second chunk of data");
      if (position != 1) fail(at, "the chunk of data must be the second one");
      file_.has_data = true, file_.data_begin = at + 8, file_.data_size = length;
    }
    return at + 8 + length;
  }

  std::uint32_t number(std::size_t at) const {
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i) value = value << 8 | std::uint8_t(file_.bytes[at + std::size_t(i)]);
    return value;
  }
  [[noreturn]] void fail(std::size_t byte, const std::string& message, const std::string& hint = {}) {
    remarks_.fail("", "byte " + std::to_string(byte) + ": " + message, hint);
  }

  Remarks remarks_;
  Container& file_;
};

/// The value of each digit of base64, 64 for what is none.
constexpr std::array<std::uint8_t, 256> base64_values = [] {
  std::array<std::uint8_t, 256> values{};
  for (auto& value : values) value = 64;
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < digits.size(); ++i) values[std::uint8_t(digits[i])] = std::uint8_t(i);
  return values;
}();

/// RFC 4648, with its padding; nothing where it is malformed.
std::optional<std::string> base64_decoded(std::string_view text) {
  if (text.size() % 4 != 0) return std::nullopt;
  std::size_t padding = 0;
  while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') ++padding;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  const std::size_t digits = text.size() - padding;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::uint8_t value = i < digits ? base64_values[std::uint8_t(text[i])] : 0;
    if (value == 64) return std::nullopt;
    bits = bits << 6 | value;
    if (i % 4 == 3) bytes += {char(bits >> 16 & 0xff), char(bits >> 8 & 0xff), char(bits & 0xff)};
  }
  bytes.resize(bytes.size() - padding);
  return bytes;
}

int hex_digit(char c) {
  return c >= '0' && c <= '9'   ? c - '0'
         : c >= 'a' && c <= 'f' ? c - 'a' + 10
         : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                : -1;
}

}  // namespace

Container read_container(const std::string& path, const Limits& limits) {
  check_file_size(path, limits);
  Container file;
  file.bytes = read_file(path);
  file.binary = file.bytes.starts_with(magic) || lower_case(path).ends_with(".glb");
  if (file.binary) GlbReader(path, file).read();
  else file.json_size = file.bytes.size();
  return file;
}

bool is_data_uri(std::string_view uri) { return lower_case(uri.substr(0, 5)) == "data:"; }

std::optional<DataUri> read_data_uri(std::string_view uri, std::string& complaint) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) {
    complaint = "the data URI has no comma before its data";
    return std::nullopt;
  }
  const std::string head = lower_case(uri.substr(5, comma - 5));
  DataUri result;
  result.media_type = head.substr(0, head.find(';'));
  if (!head.ends_with(";base64")) {
    complaint = "only data URIs with base64 are known";
    return std::nullopt;
  }
  if (head.find(";;") != std::string::npos) {
    complaint = "the data URI's media type is malformed";
    return std::nullopt;
  }
  auto bytes = base64_decoded(uri.substr(comma + 1));
  if (!bytes) {
    complaint = "the data URI's base64 is malformed";
    return std::nullopt;
  }
  result.bytes = std::move(*bytes);
  return result;
}

std::optional<std::string> percent_decoded(std::string_view uri) {
  std::string result;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      result += uri[i];
      continue;
    }
    const int high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1,
              low = high < 0 ? -1 : hex_digit(uri[i + 2]);
    if (low < 0) return std::nullopt;
    result += char(high * 16 + low);
    i += 2;
  }
  return result;
}

bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  // One letter is a drive.
  return colon != std::string_view::npos && colon > 1 &&
         std::all_of(uri.begin(), uri.begin() + std::ptrdiff_t(colon), [](char c) {
           return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.';
         });
}

std::string image_type(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return "image/png";
  if (bytes.starts_with("\xff\xd8\xff")) return "image/jpeg";
  if (bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("WEBP")) return "image/webp";
  if (bytes.starts_with("\xabKTX 20\xbb\r\n\x1a\n")) return "image/ktx2";
  return {};
}

}  // namespace lambent::gltf
