#include "lambent/diagnostics.h"

#include <gtest/gtest.h>

namespace lambent {
namespace {

Diagnostic with_excerpt(const std::string& excerpt, int caret_column) {
  return {Severity::error, {"a.yaml", 3, caret_column}, "no", "", excerpt, caret_column};
}

TEST(Diagnostics, APlaceSaysWhatIsKnown) {
  EXPECT_EQ(to_string(Place{"a.yaml", 3, 7}), "a.yaml:3:7");
  EXPECT_EQ(to_string(Place{"a.yaml", 3, 0}), "a.yaml:3");
  EXPECT_EQ(to_string(Place{"a.yaml", 0, 0}), "a.yaml");
  EXPECT_EQ(to_string(Place{"", 3, 7}), "3:7");
  EXPECT_EQ(to_string(Place{}), "");
}

TEST(Diagnostics, AllPartsInTheirOrder) {
  Diagnostic diagnostic = with_excerpt("  - difuse: 1", 5);
  diagnostic.place.file = "scene.yaml";
  diagnostic.message = "unknown key 'difuse'";
  diagnostic.hint = "did you mean 'diffuse'?";
  EXPECT_EQ(to_string(diagnostic),
            "scene.yaml:3:5: error: unknown key 'difuse'\n"
            "      - difuse: 1\n"
            "        ^\n"
            "    hint: did you mean 'diffuse'?");
}

TEST(Diagnostics, OnlyTheMessage) {
  EXPECT_EQ(to_string(Diagnostic{Severity::warning, {}, "odd", "", "", 0}), "warning: odd");
  EXPECT_EQ(to_string(Diagnostic{Severity::error, {"a.obj", 0, 0}, "empty", "", "", 0}),
            "a.obj: error: empty");
}

TEST(Diagnostics, TabsAreCopiedSoThatTheCaretLinesUp) {
  EXPECT_EQ(to_string(with_excerpt("\ta\tbad", 4)), "a.yaml:3:4: error: no\n    \ta\tbad\n    \t \t^");
}

TEST(Diagnostics, ACharacterOfSeveralBytesIsOneColumn) {
  // The readers count bytes: the e with its accent is two of them, and "bad" starts at byte 5.
  EXPECT_EQ(to_string(with_excerpt("\xc3\xa9: bad", 5)),
            "a.yaml:3:5: error: no\n    \xc3\xa9: bad\n       ^");
}

TEST(Diagnostics, TheCaretMayStandPastTheEnd) {
  EXPECT_EQ(to_string(with_excerpt("ab", 3)), "a.yaml:3:3: error: no\n    ab\n      ^");
  EXPECT_EQ(to_string(with_excerpt("ab", 99)), "a.yaml:3:99: error: no\n    ab\n      ^");
  EXPECT_EQ(to_string(with_excerpt("ab\r\n", 3)), "a.yaml:3:3: error: no\n    ab\n      ^");
}

TEST(Diagnostics, NothingThatATerminalWouldObeyIsShown) {
  EXPECT_EQ(
      to_string(with_excerpt("a\x1b[31m\xff\x7f\xc2\x9b\xe2\x80\xae", 0)),
      "a.yaml:3: error: no\n    a?[31m??????\?");  // ESC, 0xff, DEL, two bytes of U+009B, three of U+202E
  Diagnostic diagnostic{Severity::error, {"\x1b.obj", 1, 0}, "key '\x07'", "not '\xc0\x80'", "", 0};
  EXPECT_EQ(to_string(diagnostic), "?.obj:1: error: key '?'\n    hint: not '?\?'");
}

TEST(Diagnostics, ALongLineIsCutAroundTheCaret) {
  const std::string line = std::string(150, 'a') + "X" + std::string(150, 'b');
  EXPECT_EQ(to_string(with_excerpt(line, 151)), "a.yaml:3:151: error: no\n    ..." + std::string(50, 'a') +
                                                    "X" + std::string(49, 'b') + "...\n" +
                                                    std::string(57, ' ') + "^");
  EXPECT_EQ(to_string(with_excerpt(line, 1)),
            "a.yaml:3:1: error: no\n    " + std::string(100, 'a') + "...\n    ^");
  EXPECT_EQ(to_string(with_excerpt(line, 301)),
            "a.yaml:3:301: error: no\n    ..." + std::string(100, 'b') + "\n" + std::string(106, ' ') + "^");
  EXPECT_EQ(to_string(with_excerpt(line, 0)), "a.yaml:3: error: no\n    " + std::string(100, 'a') + "...");
  EXPECT_EQ(to_string(with_excerpt(std::string(100, 'a'), 0)),
            "a.yaml:3: error: no\n    " + std::string(100, 'a'));
}

TEST(Diagnostics, AnInputErrorSaysEverythingInTheOrderOfTheFile) {
  const InputError error({{Severity::error, {"a.nff", 2, 1}, "first", "", "", 0},
                          {Severity::error, {"a.nff", 5, 3}, "second", "", "", 0}});
  EXPECT_STREQ(error.what(), "a.nff:2:1: error: first\na.nff:5:3: error: second");
  ASSERT_EQ(error.diagnostics().size(), 2u);
  EXPECT_EQ(error.diagnostics()[1].place.line, 5);

  const InputError single(Diagnostic{Severity::error, {"a.nff", 2, 1}, "only", "", "", 0});
  EXPECT_STREQ(single.what(), "a.nff:2:1: error: only");
  EXPECT_EQ(single.diagnostics().size(), 1u);
}

}  // namespace
}  // namespace lambent
