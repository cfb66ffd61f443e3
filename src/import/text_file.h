#pragma once
// A text file in memory, read line by line, with words and numbers taken from it and errors that name the
// place.
//
// Lines and words are views into the file's text. Where a word stands is therefore found from its address,
// and only when a message needs it: reading costs nothing for it.
//
//   const TextFile file = read_text_file(path);
//   LineReader lines(file.text);
//   std::vector<std::string_view> words;
//   while (lines.next()) {
//     split_words(lines.line, words);
//     if (words.empty()) continue;
//     if (auto x = parse_number(words[0])) ...
//     else throw InputError(error_at(file, words[0], "..."));
//   }

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lambent/diagnostics.h"
#include "lambent/limits.h"

namespace lambent {

/// The whole file, or all that comes out of a pipe. Throws InputError ("cannot open ...: No such file or
/// directory"), also for devices.
std::string read_file(const std::string& path);

/// Throws InputError where the file is larger than the limits allow; says nothing of one that is not there.
void check_file_size(const std::string& path, const Limits& limits);

/// A file's text, or a piece of it, as valid UTF-8 without a byte order mark.
struct TextFile {
  std::string name;  ///< As it was given; it stands in messages.
  std::string text;
  int first_line = 1;  ///< The number of the text's first line.
};

/// The file, converted: UTF-16 is known by its byte order mark, and bytes that are no UTF-8 are taken as
/// Latin-1, as old exporters write it. Throws InputError where the file cannot be read or is not text (it
/// holds a zero byte).
TextFile read_text_file(const std::string& path);
/// The same from bytes in memory.
TextFile text_file(std::string name, std::string bytes);

/// The same file piece by piece, so that a large one never lies in memory as a whole. A piece ends with a
/// line that no backslash joins to the next.
class TextPieces {
 public:
  /// Throws InputError where there is no such file.
  explicit TextPieces(const std::string& path, std::size_t piece_size = std::size_t(1) << 18);

  /// Replaces `piece` by the next one, at least one of them, though it be empty; false at the end of the
  /// file. Throws InputError where the file cannot be read or is not text.
  bool next(TextFile& piece);

 private:
  bool read_more(std::size_t most);

  std::string path_;
  std::size_t piece_size_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::string bytes_;  ///< Read, and not yet handed out.
  bool begun_ = false, ended_ = false;
  int next_line_ = 1;
};

/// Walks over the lines of a text, which must outlive it. Lines end with LF, CR LF or the end of the text.
class LineReader {
 public:
  /// With `continued`, a backslash at the end of a line joins the next one to it; the line's view then spans
  /// several physical lines, and split_words and next_word take the break for white space.
  explicit LineReader(std::string_view text, bool continued = false) : rest_(text), continued_(continued) {}

  /// To the next line, blank ones too; false at the end of the text.
  bool next();

  std::string_view line;  ///< Without its end.
  int number = 0;         ///< From 1; of a continued line, its first physical line's.

 private:
  std::string_view rest_;
  bool continued_;
  int breaks_ = 0;  ///< Physical lines that the present line spans.
};

/// Takes the next word from the front of `rest`; an empty view when there is none.
std::string_view next_word(std::string_view& rest);
/// All words of a line; `words` is cleared first and keeps its memory. Words are parted by blanks and tabs.
void split_words(std::string_view line, std::vector<std::string_view>& words);
/// `text` without blanks and tabs at both ends.
std::string_view trim(std::string_view text);
/// `text` with small letters for the capitals of ASCII.
std::string lower_case(std::string_view text);

/// The whole word as a finite decimal number, correctly rounded whatever the locale: 1, +1, .5, 5., 1e05,
/// -2.5E-3. Nothing for anything else: nan, inf, hexadecimal, trailing characters, values beyond double's
/// range. What is too small for double is 0.
std::optional<double> parse_number(std::string_view word);
/// The whole word as a decimal integer, with an optional sign.
std::optional<std::int64_t> parse_integer(std::string_view word);

/// Where `word`, a view into file.text, begins; counts the lines before it, so it is meant for messages only.
/// Columns count characters, not bytes.
Place place_of(const TextFile& file, std::string_view word);
/// A diagnostic about `word`, with the line it stands in and a caret under it. An empty view into the text is
/// a place too.
Diagnostic error_at(const TextFile& file, std::string_view word, std::string message, std::string hint = {});
Diagnostic warning_at(const TextFile& file, std::string_view word, std::string message,
                      std::string hint = {});
/// `word` in single quotes for a message: without control characters, and shortened where it is very long.
std::string in_quotes(std::string_view word);
/// The place just behind `line`'s last word: where something is missing.
std::string_view end_of(std::string_view line);

}  // namespace lambent
