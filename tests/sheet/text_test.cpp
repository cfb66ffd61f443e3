#include "sheet/text.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sheet/font.h"

namespace lambent {
namespace {

const std::string sentences[] = {
    "Il / r [ Kd (N.L)+ + Ks ((R.V)+)^n ],  R = 2 (N.L) N - L",
    "jumping fjords, AVATAR, To Wj",
    "\u00c5ngstr\u00f6m \u2212 \u0159\u00edp",
    "blinn_phong_halfway",
};

/// The smallest box around all pixels that differ from 0; of no size where there are none.
SheetBox drawn(const Image& canvas) {
  int left = canvas.width, right = 0, top = canvas.height, bottom = 0;
  for (int y = 0; y < canvas.height; ++y)
    for (int x = 0; x < canvas.width; ++x) {
      const float* pixel = canvas.pixel(x, y);
      if (pixel[0] == 0 && pixel[1] == 0 && pixel[2] == 0) continue;
      left = std::min(left, x);
      right = std::max(right, x + 1);
      top = std::min(top, y);
      bottom = std::max(bottom, y + 1);
    }
  return right > left ? SheetBox{left, top, right - left, bottom - top} : SheetBox{};
}

Image black(int width, int height) {
  return {width, height, {"R", "G", "B"}, std::vector<float>(std::size_t(width) * std::size_t(height) * 3)};
}

TEST(Font, IsDejaVuSans) {
  // Of the file's 2048 units to the em: A is 1401 wide, the space 651, a digit 1303; AV is kerned by -131.
  EXPECT_DOUBLE_EQ(glyph_advance(glyph_of(U'A')), 1401 / 2048.0);
  EXPECT_DOUBLE_EQ(glyph_advance(glyph_of(U' ')), 651 / 2048.0);
  for (char32_t digit = U'0'; digit <= U'9'; ++digit)
    EXPECT_DOUBLE_EQ(glyph_advance(glyph_of(digit)), 1303 / 2048.0);
  EXPECT_DOUBLE_EQ(glyph_kerning(glyph_of(U'A'), glyph_of(U'V')), -131 / 2048.0);
  EXPECT_EQ(glyph_of(0x10fffd), 0);
}

TEST(Font, AGlyphLiesInItsBox) {
  for (const char32_t character : U"Agj\u00c5_^") {
    if (character == 0) continue;
    for (const double shift : {0.0, 0.3, 0.9}) {
      const GlyphBox box = glyph_box(glyph_of(character), 17, shift);
      const GlyphImage image = glyph_image(glyph_of(character), 17, shift);
      EXPECT_EQ(image.x, box.left);
      EXPECT_EQ(image.y, box.top);
      EXPECT_EQ(image.width, box.right - box.left);
      EXPECT_EQ(image.height, box.bottom - box.top);
      EXPECT_GT(*std::max_element(image.coverage.begin(), image.coverage.end()), 100);
    }
  }
}

TEST(Text, DecodesUtf8) {
  EXPECT_EQ(decode_utf8("a\u00e9\u2212\U0001f600"), U"a\u00e9\u2212\U0001f600");
  EXPECT_EQ(decode_utf8("a\tb"), U"a b");
}

TEST(Text, WhatIsNoCharacterIsReplaced) {
  EXPECT_EQ(decode_utf8("\x1b[1m"), U"\ufffd[1m");
  EXPECT_EQ(decode_utf8("\xff\xfe"), U"\ufffd\ufffd");
  EXPECT_EQ(decode_utf8("\xc3"), U"\ufffd");            // cut off
  EXPECT_EQ(decode_utf8("\xe2\x88"), U"\ufffd\ufffd");  // likewise
  EXPECT_EQ(decode_utf8("\xed\xa0\x80"), U"\ufffd");    // half of a surrogate pair
  EXPECT_EQ(decode_utf8("\xe0\x80\xaf"), U"\ufffd");    // longer than it need be
  EXPECT_EQ(decode_utf8("\xc2\x85"), U"\ufffd");        // a control of two bytes
}

TEST(Text, StaysInTheBoxThatItIsSaidToTake) {
  for (const std::string& sentence : sentences)
    for (const double size : {9.0, 12.5, 20.0, 31.0}) {
      Image canvas = black(1200, 100);
      draw_line(canvas, {0, 0, 1200, 100}, 40, 30, sentence, size, {1, 1, 1});
      const SheetBox box = drawn(canvas);
      ASSERT_GT(box.width, 0);
      EXPECT_GE(box.x, 40) << sentence << " at " << size;
      EXPECT_LE(box.x + box.width, 40 + text_width(sentence, size)) << sentence << " at " << size;
      EXPECT_GE(box.y, 30) << sentence << " at " << size;
      EXPECT_LE(box.y + box.height, 30 + line_height(size)) << sentence << " at " << size;
    }
}

TEST(Text, NothingIsDrawnOutsideTheClip) {
  Image canvas = black(200, 60), whole = black(200, 60);
  const SheetBox clip{23, 14, 31, 9};
  draw_line(canvas, clip, 5, 5, "AVATAR", 24, {1, 0.5f, 0.25f});
  draw_line(whole, {0, 0, 200, 60}, 5, 5, "AVATAR", 24, {1, 0.5f, 0.25f});
  int touched = 0;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 200; ++x) {
      const bool inside = x >= clip.x && x < clip.x + clip.width && y >= clip.y && y < clip.y + clip.height;
      for (int c = 0; c < 3; ++c) EXPECT_EQ(canvas.pixel(x, y)[c], inside ? whole.pixel(x, y)[c] : 0);
      touched += canvas.pixel(x, y)[0] > 0;
    }
  EXPECT_GT(touched, 30);
  // A clip that reaches over the canvas does no harm.
  draw_line(canvas, {-50, -50, 400, 400}, -10, -10, "AVATAR", 24, {1, 1, 1});
  draw_line(canvas, {-50, -50, 400, 400}, 180, 45, "AVATAR", 24, {1, 1, 1});
}

TEST(Text, EdgesAreMixedInLinearLight) {
  // Over any ground, a pixel is (1 - c) ground + c ink with one c for all channels.
  Image on_black = black(60, 40), on_grey = black(60, 40);
  std::fill(on_grey.data.begin(), on_grey.data.end(), 0.5f);
  draw_line(on_black, {0, 0, 60, 40}, 2, 2, "Rs", 24, {1, 1, 1});
  draw_line(on_grey, {0, 0, 60, 40}, 2, 2, "Rs", 24, {1, 0, 0.25f});
  int partly = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x) {
      const float c = on_black.pixel(x, y)[0];
      partly += c > 0.1f && c < 0.9f;
      const float* pixel = on_grey.pixel(x, y);
      // Glyphs whose boxes overlap are put down one after the other: half a step of 8 bits at most.
      EXPECT_NEAR(pixel[0], 0.5f * (1 - c) + c, 2e-3);
      EXPECT_NEAR(pixel[1], 0.5f * (1 - c), 2e-3);
      EXPECT_NEAR(pixel[2], 0.5f * (1 - c) + 0.25f * c, 2e-3);
    }
  EXPECT_GT(partly, 20) << "the letters have no soft edges";
}

TEST(Text, BreaksBetweenPhrasesBeforeItBreaksBetweenWords) {
  const std::string equation = "Il / r [ Kd (N.L)+ + Ks ((R.V)+)^n ],  R = 2 (N.L) N - L";
  const int whole = text_width(equation, 14);
  EXPECT_EQ(break_lines(equation, 14, whole).lines, std::vector<std::string>{equation});
  EXPECT_EQ(break_lines(equation, 14, whole - 1).lines,
            (std::vector<std::string>{"Il / r [ Kd (N.L)+ + Ks ((R.V)+)^n ],", "R = 2 (N.L) N - L"}));
  EXPECT_EQ(break_lines("one two three", 14, text_width("one two", 14)).lines,
            (std::vector<std::string>{"one two", "three"}));
}

TEST(Text, EveryLineFits) {
  for (const std::string& sentence : sentences)
    for (int width = 12; width < 500; width += 7) {
      const BrokenLines broken = break_lines(sentence, 12, width);
      std::string together, squeezed;
      for (const std::string& line : broken.lines) {
        EXPECT_LE(text_width(line, 12), width) << line;
        together += line;
      }
      // Nothing is lost but spaces.
      together.erase(std::remove(together.begin(), together.end(), ' '), together.end());
      std::remove_copy(sentence.begin(), sentence.end(), std::back_inserter(squeezed), ' ');
      EXPECT_EQ(together, squeezed);
    }
}

TEST(Text, IsMadeToFit) {
  const TextStyle style{20, 9, 2};
  for (int width = 40; width < 900; width += 13) {
    const FittedTexts fitted =
        fit_texts({sentences[0], sentences[1] + "\n" + sentences[2], ""}, width, style);
    EXPECT_LE(fitted.size, 20);
    EXPECT_GE(fitted.size, 9);
    ASSERT_EQ(fitted.texts.size(), 3u);
    EXPECT_LE(fitted.texts[0].size(), 2u);
    EXPECT_GE(fitted.texts[1].size(), 2u) << "each paragraph begins a line";
    EXPECT_LE(fitted.texts[1].size(), 4u);
    EXPECT_TRUE(fitted.texts[2].empty());
    for (const auto& text : fitted.texts)
      for (const std::string& line : text) EXPECT_LE(text_width(line, fitted.size), width) << line;
  }
  EXPECT_EQ(fit_texts({"short"}, 400, style).size, 20) << "no smaller than it need be";
}

TEST(Text, WhatCannotFitEndsWithAnEllipsis) {
  const FittedTexts fitted = fit_texts({"a sentence of many words that is far too long"}, 60, {12, 9, 2});
  ASSERT_EQ(fitted.texts[0].size(), 2u);
  EXPECT_TRUE(fitted.texts[0][1].ends_with("\u2026")) << fitted.texts[0][1];
  EXPECT_TRUE(fitted.texts[0][0].starts_with("a sentence")) << fitted.texts[0][0];
  // Characters of several bytes are cut between them, never inside.
  const FittedTexts accents =
      fit_texts({"\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9\u00e9"}, 40, {12, 9, 1});
  ASSERT_EQ(accents.texts[0].size(), 1u);
  const std::u32string characters = decode_utf8(accents.texts[0][0]);
  EXPECT_EQ(characters.back(), U'\u2026');
  EXPECT_EQ(characters.find(U'\ufffd'), std::u32string::npos);
}

}  // namespace
}  // namespace lambent
