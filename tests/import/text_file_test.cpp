#include "import/text_file.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "support.h"

namespace lambent {
namespace {

std::vector<std::string> lines_of(std::string_view text, bool continued = false) {
  std::vector<std::string> result;
  LineReader lines(text, continued);
  while (lines.next()) result.push_back(std::to_string(lines.number) + ":" + std::string(lines.line));
  return result;
}

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  split_words(line, words);
  return {words.begin(), words.end()};
}

using Strings = std::vector<std::string>;

TEST(TextFile, LinesEndWithLfCrLfOrTheEnd) {
  EXPECT_EQ(lines_of("a\nb\r\n\nc"), (Strings{"1:a", "2:b", "3:", "4:c"}));
  EXPECT_EQ(lines_of("a\n"), (Strings{"1:a"}));
  EXPECT_EQ(lines_of(""), Strings{});
}

TEST(TextFile, OldLineEndsOfCrAlone) {
  EXPECT_EQ(lines_of(text_file("mac", "a\rb\r").text), (Strings{"1:a", "2:b"}));
}

TEST(TextFile, ABackslashJoinsLines) {
  EXPECT_EQ(lines_of("a \\\nb\nc", true), (Strings{"1:a \\\nb", "3:c"}));
  EXPECT_EQ(lines_of("a \\\r\nb\\\r\n c\r\nd", true), (Strings{"1:a \\\r\nb\\\r\n c", "4:d"}));
  EXPECT_EQ(lines_of("a \\\nb", false), (Strings{"1:a \\", "2:b"}));
  // A comment that ends with a folder's name does not swallow the next line.
  EXPECT_EQ(lines_of("# C:\\models\\\nb", true), (Strings{"1:# C:\\models\\", "2:b"}));
}

TEST(TextFile, WordsArePartedByBlanksTabsAndJoinedLines) {
  EXPECT_EQ(words_of("  f\t1 2   3 "), (Strings{"f", "1", "2", "3"}));
  EXPECT_EQ(words_of("f 1 \\\r\n2\\\n3"), (Strings{"f", "1", "2", "3"}));
  EXPECT_EQ(words_of("a\\b c\\ d"), (Strings{"a\\b", "c\\", "d"}));
  EXPECT_EQ(words_of(" \t"), Strings{});
  EXPECT_EQ(trim(" \ta b \r"), "a b");
}

TEST(TextFile, NumbersAsPeopleWriteThem) {
  EXPECT_EQ(parse_number("1"), 1.0);
  EXPECT_EQ(parse_number("+1"), 1.0);
  EXPECT_EQ(parse_number(".5"), 0.5);
  EXPECT_EQ(parse_number("+.5"), 0.5);
  EXPECT_EQ(parse_number("-5."), -5.0);
  EXPECT_EQ(parse_number("1e05"), 1e5);
  EXPECT_EQ(parse_number(".8e-001"), 0.08);
  EXPECT_EQ(parse_number("-2.5E-3"), -0.0025);
  EXPECT_EQ(parse_number("0.1"), 0.1);
  EXPECT_EQ(parse_number("9007199254740993"), 9007199254740992.0);  // 2^53 + 1: a tie, to even
}

TEST(TextFile, WhatIsNoNumber) {
  for (const char* word :
       {"",         "+",      "-",    ".",   "e5",   "+-1",   "--1",    "1e",
        "1.2.3",    "1,5",    "0x10", "nan", "-nan", "NAN",   "inf",    "-inf",
        "infinity", "1.#IND", "1f",   " 1",  "1 ",   "1e999", "-1e999", "1e99999999999999999999"})
    EXPECT_FALSE(parse_number(word).has_value()) << word;
}

TEST(TextFile, WhatIsTooSmallIsZero) {
  EXPECT_EQ(parse_number("1e-400"), 0.0);
  EXPECT_EQ(parse_number("1e-99999999999999999999"), 0.0);
  const auto negative = parse_number("-0." + std::string(400, '0') + "1");
  ASSERT_TRUE(negative.has_value());
  EXPECT_EQ(*negative, 0.0);
  EXPECT_TRUE(std::signbit(*negative));
  EXPECT_FALSE(parse_number("1" + std::string(400, '0')).has_value());
  EXPECT_EQ(parse_number("5e-324"), std::numeric_limits<double>::denorm_min());
}

TEST(TextFile, EveryDoubleComesBack) {
  EXPECT_TRUE(rc::check("17 digits name a double", [](double x) {
    char text[64];
    std::snprintf(text, sizeof text, "%.17g", x);
    RC_ASSERT(parse_number(text) == x);
  }));
}

TEST(TextFile, Integers) {
  EXPECT_EQ(parse_integer("12"), 12);
  EXPECT_EQ(parse_integer("+12"), 12);
  EXPECT_EQ(parse_integer("-12"), -12);
  for (const char* word : {"", "+", "+-1", "1.0", "1x", "99999999999999999999"})
    EXPECT_FALSE(parse_integer(word).has_value()) << word;
}

TEST(TextFile, ByteOrderMarksAndUtf16) {
  EXPECT_EQ(text_file("f",
                      "\xef\xbb\xbf"
                      "v 1")
                .text,
            "v 1");
  EXPECT_EQ(text_file("f", std::string("\xfe\xff\0v\0\n\0\xe4", 8)).text, "v\n\xc3\xa4");
  EXPECT_EQ(text_file("f", std::string("\xff\xfev\0\n\0\xe4\0", 8)).text, "v\n\xc3\xa4");
  // U+1F600 as a pair of surrogates; half of a pair is no character.
  EXPECT_EQ(text_file("f", "\xfe\xff\xd8\x3d\xde\x01").text, "\xf0\x9f\x98\x81");
  EXPECT_EQ(text_file("f", std::string("\xfe\xff\xd8\x3d\0v", 6)).text, "\xef\xbf\xbdv");
}

TEST(TextFile, BytesThatAreNoUtf8AreLatin1) {
  EXPECT_EQ(text_file("f", "Terraind\xe4k \xc3\xa4").text, "Terraind\xc3\xa4k \xc3\xa4");
  EXPECT_EQ(text_file("f", "\xc3").text, "\xc3\x83");
  EXPECT_EQ(text_file("f", "\xed\xa0\x80").text, "\xc3\xad\xc2\xa0\xc2\x80");  // a surrogate is no UTF-8
}

TEST(TextFile, ABinaryFileIsNoText) {
  try {
    text_file("f", std::string("solid\nab\0c", 10));
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().size(), 1u);
    EXPECT_EQ(to_string(error.diagnostics()[0].place), "f:2:3");
    EXPECT_EQ(error.diagnostics()[0].message, "not a text file: it holds a zero byte");
  }
}

TEST(TextFile, ReadsWhatIsThereAndNamesWhatIsNot) {
  const test::TemporaryDirectory folder;
  std::string content = "a\n";
  for (int i = 0; i < 100000; ++i) content += "line\n";
  test::write_text(folder.file("x"), content);
  EXPECT_EQ(read_file(folder.file("x")), content);
  test::write_text(folder.file("empty"), "");
  EXPECT_EQ(read_file(folder.file("empty")), "");
  try {
    read_file(folder.file("missing"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().at(0).message,
              "cannot open '" + folder.file("missing") + "': No such file or directory");
    EXPECT_EQ(error.diagnostics().at(0).place.file, folder.file("missing"));
  }
  EXPECT_THROW(read_file(folder.path()), InputError);
}

TEST(TextFile, WhatHasNoEndIsNotRead) {
  if (!std::filesystem::exists("/dev/zero")) GTEST_SKIP() << "This system has no /dev/zero.";
  const test::TemporaryDirectory folder;
  const std::string link = folder.file("zero.obj");
  std::filesystem::create_symlink("/dev/zero", link);
  try {
    read_file(link);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().at(0).message, "cannot read '" + link + "': it is a device, not a file");
  }
  EXPECT_THROW(TextPieces{link}, InputError);
}

struct Pieces {
  std::string text;
  Strings lines;  ///< With their numbers.
  int count = 0;
};
Pieces pieces_of(const std::string& path, std::size_t size) {
  TextPieces pieces(path, size);
  Pieces result;
  for (TextFile piece; pieces.next(piece); ++result.count) {
    LineReader lines(piece.text, true);
    while (lines.next())
      result.lines.push_back(std::to_string(piece.first_line + lines.number - 1) + ":" +
                             std::string(lines.line));
    result.text += piece.text;
  }
  return result;
}

TEST(TextFile, PiecesAreTheWholeFile) {
  const test::TemporaryDirectory folder;
  const std::string path = folder.file("x");
  EXPECT_TRUE(rc::check("pieces of any size", [&](const std::vector<std::uint8_t>& numbers) {
    const std::string parts[] = {"a",      "\n",   "\\",       "\\\n",   "\r\n",
                                 " \\ \n", "\xe4", "\xc3\xa4", "# \\\n", "\r"};
    std::string bytes;
    for (const std::uint8_t n : numbers) bytes += parts[n % std::size(parts)];
    if (numbers.size() % 5 == 0) bytes = "\xef\xbb\xbf" + bytes;
    test::write_text(path, bytes);
    const TextFile whole = read_text_file(path);
    for (const std::size_t size : {1u, 2u, 7u, 1000u}) {
      const Pieces pieces = pieces_of(path, size);
      RC_ASSERT(pieces.text == whole.text);
      RC_ASSERT(pieces.lines == lines_of(whole.text, true));
    }
  }));
  test::write_text(path, "one\ntwo\nthree\n");
  EXPECT_EQ(pieces_of(path, 5).count, 3);
  test::write_text(path, "");
  EXPECT_EQ(pieces_of(path, 5).count, 1) << "an empty file is a piece, too";
  test::write_text(path, std::string("\xff\xfev\0\n\0\xe4\0\n\0", 10));
  EXPECT_EQ(pieces_of(path, 1).text, "v\n\xc3\xa4\n");
}

TEST(TextFile, PiecesOfABinaryFileAndOfNone) {
  const test::TemporaryDirectory folder;
  test::write_text(folder.file("x"), std::string("solid\nab\nab\0c", 13));
  try {
    pieces_of(folder.file("x"), 1);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(to_string(error.diagnostics().at(0).place), folder.file("x") + ":3:3");
  }
  EXPECT_THROW(TextPieces(folder.file("missing")), InputError);
}

TEST(TextFile, PlacesCountCharacters) {
  const TextFile file = text_file("f.obj", "one\n\xc3\xa4\tv 1 x\n");
  std::string_view rest = std::string_view(file.text).substr(4);
  next_word(rest);
  const std::string_view v = next_word(rest);
  EXPECT_EQ(to_string(place_of(file, v)), "f.obj:2:3");
  const Diagnostic d = error_at(file, v, "what", "remedy");
  EXPECT_EQ(d.severity, Severity::error);
  EXPECT_EQ(d.message, "what");
  EXPECT_EQ(d.hint, "remedy");
  EXPECT_EQ(d.excerpt, "\xc3\xa4 v 1 x");
  EXPECT_EQ(d.caret_column, 3);
  EXPECT_EQ(warning_at(file, v, "what").severity, Severity::warning);
  // Just behind the last word of a line, and at the end of the text.
  EXPECT_EQ(to_string(place_of(file, end_of(std::string_view(file.text).substr(0, 3)))), "f.obj:1:4");
  EXPECT_EQ(to_string(place_of(file, end_of(file.text))), "f.obj:2:8");
  const TextFile empty = text_file("e", "");
  EXPECT_EQ(to_string(place_of(empty, end_of(empty.text))), "e:1:1");
}

TEST(TextFile, LongLinesAreShownAroundThePlace) {
  const TextFile file = text_file("f", std::string(1000, 'a') + " x " + std::string(1000, 'b'));
  const Diagnostic d = error_at(file, std::string_view(file.text).substr(1001, 1), "what");
  EXPECT_EQ(d.place.column, 1002);
  EXPECT_LT(d.excerpt.size(), 200u);
  EXPECT_EQ(d.excerpt.substr(0, 4), "...a");
  EXPECT_EQ(d.excerpt.at(std::size_t(d.caret_column) - 1), 'x');
}

TEST(TextFile, QuotedWordsAreShortAndHarmless) {
  EXPECT_EQ(in_quotes("abc"), "'abc'");
  EXPECT_EQ(in_quotes("a\x1b[31m"), "'a [31m'");
  EXPECT_EQ(in_quotes(std::string(1000, 'a')), "'" + std::string(80, 'a') + "...'");
  EXPECT_EQ(in_quotes(std::string(79, 'a') + "\xc3\xa4"
                                             "b"),
            "'" + std::string(79, 'a') + "...'");
}

}  // namespace
}  // namespace lambent
