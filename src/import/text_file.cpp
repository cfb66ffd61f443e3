#include "import/text_file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

namespace lambent {

namespace {

Diagnostic unreadable(const std::string& path, const char* verb, int error) {
  return {Severity::error,
          {path, 0, 0},
          std::string("cannot ") + verb + " '" + path + "': " + std::strerror(error),
          {},
          {},
          0};
}

void append_utf8(std::string& text, std::uint32_t code) {
  if (code < 0x80) {
    text += char(code);
  } else if (code < 0x800) {
    text += {char(0xc0 | code >> 6), char(0x80 | (code & 0x3f))};
  } else if (code < 0x10000) {
    text += {char(0xe0 | code >> 12), char(0x80 | (code >> 6 & 0x3f)), char(0x80 | (code & 0x3f))};
  } else {
    text += {char(0xf0 | code >> 18), char(0x80 | (code >> 12 & 0x3f)), char(0x80 | (code >> 6 & 0x3f)),
             char(0x80 | (code & 0x3f))};
  }
}

std::string utf8_from_utf16(std::string_view bytes, bool big_endian) {
  const auto unit = [&](std::size_t i) {
    const std::uint32_t a = std::uint8_t(bytes[i]), b = std::uint8_t(bytes[i + 1]);
    return big_endian ? a << 8 | b : b << 8 | a;
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (code >= 0xd800 && code < 0xe000) {
      // A surrogate: with its partner it is one character, alone it is none (U+FFFD).
      const std::uint32_t low = code < 0xdc00 && i + 3 < bytes.size() ? unit(i + 2) : 0;
      if (low >= 0xdc00 && low < 0xe000) {
        code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
        i += 2;
      } else {
        code = 0xfffd;
      }
    }
    append_utf8(text, code);
  }
  return text;
}

bool is_continuation(char c) { return (std::uint8_t(c) & 0xc0) == 0x80; }

/// Length of the UTF-8 character at text[i], or 0 where there is none (RFC 3629).
std::size_t utf8_length(std::string_view text, std::size_t i) {
  const std::uint8_t c = std::uint8_t(text[i]);
  if (c < 0x80) return 1;
  const std::size_t length = c >= 0xc2 && c < 0xe0   ? 2
                             : c >= 0xe0 && c < 0xf0 ? 3
                             : c >= 0xf0 && c < 0xf5 ? 4
                                                     : 0;
  if (length == 0 || i + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k)
    if (!is_continuation(text[i + k])) return 0;
  const std::uint8_t d = std::uint8_t(text[i + 1]);
  // Too long for what they say, surrogates, and what lies beyond the last character.
  if ((c == 0xe0 && d < 0xa0) || (c == 0xed && d > 0x9f) || (c == 0xf0 && d < 0x90) ||
      (c == 0xf4 && d > 0x8f))
    return 0;
  return length;
}

/// Index of the first byte from `i` on that is not ASCII; eight at a time, for most files have none.
std::size_t skip_ascii(std::string_view text, std::size_t i) {
  for (std::uint64_t eight; i + 8 <= text.size(); i += 8) {
    std::memcpy(&eight, text.data() + i, 8);
    if (eight & 0x8080808080808080u) break;
  }
  while (i < text.size() && std::uint8_t(text[i]) < 0x80) ++i;
  return i;
}

std::string valid_utf8(std::string bytes) {
  std::size_t i = skip_ascii(bytes, 0);
  while (i < bytes.size()) {
    const std::size_t length = utf8_length(bytes, i);
    if (length == 0) break;
    i = skip_ascii(bytes, i + length);
  }
  if (i == bytes.size()) return bytes;
  std::string text = bytes.substr(0, i);
  while (i < bytes.size()) {
    const std::size_t length = utf8_length(bytes, i);
    if (length > 0) {
      text.append(bytes, i, length);
      i += length;
    } else {
      append_utf8(text, std::uint8_t(bytes[i++]));  // Latin-1 is the first 256 characters of Unicode
    }
  }
  return text;
}

/// Control characters count as blanks, such as the Ctrl-Z that old systems end a file with.
bool is_blank(char c) { return std::uint8_t(c) <= ' '; }

/// Length of a line break that a backslash at text[i] takes away; 0 where it is a backslash like any other.
std::size_t continuation_length(std::string_view text, std::size_t i) {
  if (text[i] != '\\') return 0;
  std::size_t k = i + 1;
  while (k < text.size() && (text[k] == '\r' || text[k] == ' ' || text[k] == '\t')) ++k;
  return k < text.size() && text[k] == '\n' ? k + 1 - i : 0;
}

bool is_comment(std::string_view line) {
  for (char c : line)
    if (c != ' ' && c != '\t') return c == '#';
  return false;
}

std::size_t count_characters(std::string_view text) {
  std::size_t count = 0;
  for (char c : text) count += !is_continuation(c);
  return count;
}

/// The line that text[at] stands in, and where `at` is in it.
struct Found {
  std::string_view line;
  std::size_t offset;
};
Found line_around(std::string_view text, std::size_t at) {
  const std::size_t before = at == 0 ? std::string_view::npos : text.rfind('\n', at - 1);
  const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
  std::size_t end = std::min(text.find('\n', at), text.size());
  while (end > begin && text[end - 1] == '\r') --end;
  return {text.substr(begin, end - begin), std::min(at, end) - begin};
}

std::size_t offset_in(const TextFile& file, std::string_view word) {
  return std::min(std::size_t(word.data() - file.text.data()), file.text.size());
}

/// Each becomes one blank: for a caret, a tab is one column; and a terminal must not obey a file.
void blank_controls(std::string& text) {
  for (char& c : text)
    if (std::uint8_t(c) < 0x20 || c == 0x7f) c = ' ';
}

Diagnostic remark_at(Severity severity, const TextFile& file, std::string_view word, std::string message,
                     std::string hint) {
  Diagnostic result;
  result.severity = severity;
  result.place = place_of(file, word);
  result.message = std::move(message);
  result.hint = std::move(hint);
  auto [line, offset] = line_around(file.text, offset_in(file, word));
  // A very long line is shown around the place only. The cuts must not fall into a character.
  constexpr std::size_t before = 60, after = 60;
  std::size_t begin = offset > before + 20 ? offset - before : 0,
              end = line.size() > offset + after + 20 ? offset + after : line.size();
  while (begin < offset && is_continuation(line[begin])) ++begin;
  while (end < line.size() && is_continuation(line[end])) ++end;
  if (begin > 0) result.excerpt = "...";
  const std::size_t lead = result.excerpt.size();
  result.excerpt += line.substr(begin, end - begin);
  if (end < line.size()) result.excerpt += "...";
  blank_controls(result.excerpt);
  result.caret_column = int(lead + count_characters(line.substr(begin, offset - begin)) + 1);
  return result;
}

/// Whether a decimal number that double cannot hold is too small for it (else it is too large).
bool is_tiny(std::string_view word) {
  std::int64_t exponent = 0;
  const std::size_t e = word.find_first_of("eE");
  if (e != std::string_view::npos) {
    std::string_view digits = word.substr(e + 1);
    if (!digits.empty() && digits[0] == '+') digits.remove_prefix(1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    if (error == std::errc::result_out_of_range) return digits[0] == '-';
  }
  const std::string_view mantissa = word.substr(0, e);
  const std::size_t first = mantissa.find_first_of("123456789");
  if (first == std::string_view::npos) return true;
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  return std::int64_t(point) - std::int64_t(first) + exponent < 0;
}

/// Numbers as most are written, [-]digits[.digits]: where the digits and the power of ten are whole numbers
/// that double holds, one division rounds them correctly. False for all others.
bool parse_plain_number(std::string_view word, double& value) {
  static constexpr double powers[] = {1,    1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                      1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  const char *at = word.data(), *const end = at + word.size();
  const bool negative = at < end && *at == '-';
  at += negative;
  if (end - at > 19) return false;  // so that the digits fit 64 bits
  std::uint64_t digits = 0;
  const auto take_digits = [&] {
    const char* const begin = at;
    while (at < end && *at >= '0' && *at <= '9') digits = 10 * digits + std::uint64_t(*at++ - '0');
    return at - begin;
  };
  std::ptrdiff_t count = take_digits(), decimals = 0;
  if (at < end && *at == '.') {
    ++at;
    decimals = take_digits();
    count += decimals;
  }
  if (at != end || count == 0 || digits > std::uint64_t(1) << 53) return false;
  value = double(digits) / powers[decimals];
  if (negative) value = -value;
  return true;
}

using FileHandle = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

FileHandle open_file(const std::string& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (std::filesystem::is_character_file(status) || std::filesystem::is_block_file(status)) {
    Diagnostic diagnostic;
    diagnostic.place.file = path;
    diagnostic.message = "cannot read '" + path + "': it is a device, not a file";  // /dev/zero has no end
    throw InputError(std::move(diagnostic));
  }
  FileHandle file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) throw InputError(unreadable(path, "open", errno));
  return file;
}

/// Fewer than `most` only at the end of the file.
std::size_t read_some(const std::string& path, std::FILE* file, char* to, std::size_t most) {
  const std::size_t count = std::fread(to, 1, most, file);
  if (std::ferror(file)) throw InputError(unreadable(path, "read", errno));
  return count;
}

constexpr std::string_view utf8_mark = "\xef\xbb\xbf";
bool is_utf16(std::string_view bytes) {
  return bytes.starts_with("\xfe\xff") || bytes.starts_with("\xff\xfe");
}

void must_be_text(const TextFile& file) {
  if (const auto zero = file.text.find('\0'); zero != std::string::npos)
    throw InputError(error_at(file, std::string_view(file.text).substr(zero, 1),
                              "not a text file: it holds a zero byte",
                              "UTF-16 needs a byte order mark at its beginning"));
}

/// Behind the last line break that no backslash takes away; 0 where there is none.
std::size_t last_line_end(std::string_view text) {
  for (std::size_t end = text.rfind('\n'); end != std::string_view::npos && end > 0;
       end = text.rfind('\n', end - 1)) {
    std::size_t last = end;
    while (last > 0 && (text[last - 1] == '\r' || text[last - 1] == ' ' || text[last - 1] == '\t')) --last;
    if (last == 0 || text[last - 1] != '\\') return end + 1;
  }
  return 0;
}

}  // namespace

std::string read_file(const std::string& path) {
  const FileHandle file = open_file(path);
  std::error_code ignored;
  const auto size = std::filesystem::file_size(path, ignored);  // a guess only: pipes have none
  std::string text;
  std::size_t used = 0;
  text.resize(ignored ? 65536 : std::size_t(size) + 1);
  for (;;) {
    used += read_some(path, file.get(), text.data() + used, text.size() - used);
    if (used < text.size()) break;
    text.resize(2 * text.size());
  }
  text.resize(used);
  return text;
}

void check_file_size(const std::string& path, const Limits& limits) {
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  if (unknown || size <= limits.file_bytes) return;
  Diagnostic diagnostic;
  diagnostic.place.file = path;
  diagnostic.message =
      "the file has " + std::to_string(size) + " bytes; the limit is " + std::to_string(limits.file_bytes);
  throw InputError(std::move(diagnostic));
}

TextFile text_file(std::string name, std::string bytes) {
  TextFile file{std::move(name), {}};
  if (is_utf16(bytes)) {
    file.text = utf8_from_utf16(std::string_view(bytes).substr(2), bytes[0] == '\xfe');
  } else {
    if (bytes.starts_with(utf8_mark)) bytes.erase(0, utf8_mark.size());
    file.text = valid_utf8(std::move(bytes));
  }
  if (file.text.find('\n') == std::string::npos) std::replace(file.text.begin(), file.text.end(), '\r', '\n');
  must_be_text(file);
  return file;
}

TextFile read_text_file(const std::string& path) { return text_file(path, read_file(path)); }

TextPieces::TextPieces(const std::string& path, std::size_t piece_size)
    : path_(path), piece_size_(piece_size), file_(open_file(path)) {}

bool TextPieces::read_more(std::size_t most) {
  const std::size_t used = bytes_.size();
  bytes_.resize(used + most);
  bytes_.resize(used + read_some(path_, file_.get(), bytes_.data() + used, most));
  if (bytes_.size() < used + most) ended_ = true;
  return !ended_;
}

bool TextPieces::next(TextFile& piece) {
  const bool first = !std::exchange(begun_, true);
  std::size_t end = 0;
  while (!ended_ && end == 0) {
    read_more(std::max(piece_size_, bytes_.size()));
    if (first && is_utf16(bytes_))  // rare, and line breaks are harder to find: in one piece
      while (read_more(bytes_.size())) {
      }
    if (!ended_) end = last_line_end(bytes_);
  }
  if (ended_) end = bytes_.size();
  if (!first && end == 0) return false;
  std::string rest = bytes_.substr(end);
  bytes_.resize(end);
  if (first) {
    piece = text_file(path_, std::move(bytes_));
  } else {
    piece = {path_, valid_utf8(std::move(bytes_)), next_line_};
    must_be_text(piece);
  }
  bytes_ = std::move(rest);
  next_line_ += int(std::count(piece.text.begin(), piece.text.end(), '\n'));
  return true;
}

bool LineReader::next() {
  if (rest_.empty()) return false;
  number += number == 0 ? 1 : breaks_;
  breaks_ = 0;
  std::size_t end = 0;
  for (;;) {
    const void* found = std::memchr(rest_.data() + end, '\n', rest_.size() - end);
    ++breaks_;
    if (!found) {
      end = rest_.size();
      break;
    }
    end = std::size_t(static_cast<const char*>(found) - rest_.data());
    if (!continued_ || is_comment(rest_)) break;
    std::size_t last = end;
    while (last > 0 && (rest_[last - 1] == '\r' || rest_[last - 1] == ' ' || rest_[last - 1] == '\t')) --last;
    if (last == 0 || rest_[last - 1] != '\\') break;
    ++end;  // the break belongs to the line; go on behind it
  }
  line = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  while (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return true;
}

std::string_view next_word(std::string_view& rest) {
  std::size_t begin = 0;
  while (begin < rest.size()) {
    if (is_blank(rest[begin])) ++begin;
    else if (const std::size_t gap = continuation_length(rest, begin)) begin += gap;
    else break;
  }
  std::size_t end = begin;
  while (end < rest.size() && !is_blank(rest[end]) && !continuation_length(rest, end)) ++end;
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

void split_words(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) words.push_back(word);
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return result;
}

std::string_view end_of(std::string_view line) {
  while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
  return line.substr(line.size());
}

std::optional<double> parse_number(std::string_view word) {
  if (!word.empty() && word[0] == '+') {
    word.remove_prefix(1);
    if (!word.empty() && word[0] == '-') return {};
  }
  double value = 0;
  if (parse_plain_number(word, value)) return value;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || error == std::errc::invalid_argument) return {};
  if (error == std::errc::result_out_of_range) {
    if (is_tiny(word)) return word[0] == '-' ? -0.0 : 0.0;
    return {};
  }
  if (!std::isfinite(value)) return {};
  return value;
}

std::optional<std::int64_t> parse_integer(std::string_view word) {
  if (!word.empty() && word[0] == '+') {
    word.remove_prefix(1);
    if (!word.empty() && word[0] == '-') return {};
  }
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || error != std::errc()) return {};
  return value;
}

Place place_of(const TextFile& file, std::string_view word) {
  const std::string_view text = file.text;
  const std::size_t at = offset_in(file, word);
  const auto breaks = std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n');
  const auto [line, offset] = line_around(text, at);
  return {file.name, file.first_line + int(breaks), int(count_characters(line.substr(0, offset))) + 1};
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t longest = 80;
  std::size_t end = std::min(word.size(), longest);
  while (end > 0 && end < word.size() && is_continuation(word[end])) --end;
  std::string text(word.substr(0, end));
  blank_controls(text);
  return "'" + text + (end < word.size() ? "...'" : "'");
}

Diagnostic error_at(const TextFile& file, std::string_view word, std::string message, std::string hint) {
  return remark_at(Severity::error, file, word, std::move(message), std::move(hint));
}

Diagnostic warning_at(const TextFile& file, std::string_view word, std::string message, std::string hint) {
  return remark_at(Severity::warning, file, word, std::move(message), std::move(hint));
}

}  // namespace lambent
