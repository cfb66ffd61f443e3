#include "lambent/diagnostics.h"

#include <cstddef>
#include <string_view>
#include <utility>

namespace lambent {
namespace {

constexpr std::size_t excerpt_columns = 100;  // what a terminal shows without wrapping, more or less
constexpr const char* excerpt_indent = "    ";

/// Length in bytes of the printable UTF-8 character that starts at text[i]; 0 where there is none. A terminal
/// obeys control characters, so what stands in a file must not reach it as it is.
std::size_t printable_length(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) {
    return k < text.size() ? unsigned(static_cast<unsigned char>(text[k])) : 0u;
  };
  const unsigned first = byte(i);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  static constexpr unsigned smallest[] = {0, 0, 0xa0, 0x800, 0x10000};  // U+0080 to U+009F are controls
  if (first < 0xc2 || first > 0xf4) return 0;
  unsigned code = first & (0x7fu >> length);
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(i + k) & 0xc0) != 0x80) return 0;
    code = code << 6 | (byte(i + k) & 0x3f);
  }
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  const bool bidi =
      (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);  // reorders the line
  return code >= smallest[length] && code <= 0x10ffff && !surrogate && !bidi ? length : 0;
}

/// One column of an excerpt: what is shown, and where in the line it comes from.
struct Cell {
  std::string text;
  std::size_t byte;
};

std::vector<Cell> cells_of(std::string_view line) {
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < line.size();) {
    const std::size_t length = printable_length(line, i);
    if (length > 0) cells.push_back({std::string(line.substr(i, length)), i});
    else cells.push_back({line[i] == '\t' ? "\t" : "?", i});
    i += length > 0 ? length : 1;
  }
  return cells;
}

/// Text for people with nothing in it that a terminal would obey; lines and tabs stay.
std::string printable(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = printable_length(text, i);
    if (length > 0) result += text.substr(i, length);
    else result += text[i] == '\n' || text[i] == '\t' ? text[i] : '?';
    i += length > 0 ? length : 1;
  }
  return result;
}

/// The excerpt, and under it the caret; both cut around the caret where the line is long. `caret_column`
/// counts bytes, as the readers do; the cells translate it into what the eye counts.
std::string excerpt_and_caret(std::string_view line, int caret_column) {
  line = line.substr(0, line.find_first_of("\r\n"));
  const std::vector<Cell> cells = cells_of(line);
  std::size_t caret = cells.size();  // one past the end: something is missing there
  if (caret_column > 0)
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (cells[i].byte + cells[i].text.size() >= std::size_t(caret_column)) {
        caret = i;
        break;
      }
  std::size_t begin = 0, end = cells.size();
  if (cells.size() > excerpt_columns) {
    const std::size_t middle = caret_column > 0 ? caret : 0;
    begin = middle > excerpt_columns / 2 ? middle - excerpt_columns / 2 : 0;
    if (begin + excerpt_columns > cells.size()) begin = cells.size() - excerpt_columns;
    end = begin + excerpt_columns;
  }
  std::string shown = excerpt_indent, below = excerpt_indent;
  if (begin > 0) {
    shown += "...";
    below += "   ";
  }
  for (std::size_t i = begin; i < end; ++i) shown += cells[i].text;
  if (end < cells.size()) shown += "...";
  if (caret_column <= 0) return shown;
  // A tab is as wide as the terminal makes it: the same tab in the line below is as wide.
  for (std::size_t i = begin; i < caret; ++i) below += cells[i].text == "\t" ? "\t" : " ";
  return shown + "\n" + below + "^";
}

std::string joined(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) {
    if (!text.empty()) text += '\n';
    text += to_string(diagnostic);
  }
  return text;
}

}  // namespace

std::string to_string(const Place& place) {
  std::string text = printable(place.file);
  if (place.line <= 0) return text;
  if (!text.empty()) text += ':';
  text += std::to_string(place.line);
  if (place.column > 0) text.append(":").append(std::to_string(place.column));
  return text;
}

std::string to_string(const Diagnostic& diagnostic) {
  std::string text = to_string(diagnostic.place);
  if (!text.empty()) text += ": ";
  text += diagnostic.severity == Severity::warning ? "warning: " : "error: ";
  text += printable(diagnostic.message);
  if (!diagnostic.excerpt.empty())
    text.append("\n").append(excerpt_and_caret(diagnostic.excerpt, diagnostic.caret_column));
  if (!diagnostic.hint.empty())
    text.append("\n").append(excerpt_indent).append("hint: ").append(printable(diagnostic.hint));
  return text;
}

InputError::InputError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(joined(diagnostics)), diagnostics_(std::move(diagnostics)) {}

InputError::InputError(Diagnostic diagnostic) : InputError(std::vector<Diagnostic>{std::move(diagnostic)}) {}

}  // namespace lambent
