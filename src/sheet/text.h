#pragma once
// Text as it stands in a picture: how wide it is, where it breaks, how it is drawn. Sizes are those of the
// em, in pixels.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "lambent/sheet.h"

namespace lambent {

/// The characters of UTF-8 text; U+FFFD in place of what is none, and of control characters: names come from
/// files by anybody.
std::u32string decode_utf8(std::string_view text);

/// How many pixels a line takes: the pen's way, or all that is drawn where that reaches further.
int text_width(std::string_view line, double size);

/// The height of a line's box, and the baseline in it, from its upper edge.
int line_height(double size);
int baseline_in_line(double size);

/// `paragraph` in lines of at most `width` pixels: broken where two spaces separate phrases, if that will do;
/// else at spaces; and inside a word that is longer than a line.
struct BrokenLines {
  std::vector<std::string> lines;
  bool whole_words = true;
};
BrokenLines break_lines(std::string_view paragraph, double size, int width);

/// How a set of texts may be made to fit.
struct TextStyle {
  double size, smallest;  ///< From the one, if need be down to the other.
  int lines;              ///< At most, for each paragraph.
};

/// Texts of one size, each in lines.
struct FittedTexts {
  double size = 0;
  std::vector<std::vector<std::string>> texts;
};

/// The texts, all in one size, in lines of at most `width` pixels: rather a little smaller than with one line
/// more. A paragraph that does not fit even in the smallest size ends with an ellipsis.
FittedTexts fit_texts(const std::vector<std::string>& texts, int width, const TextStyle& style);

/// Draw one line into `canvas` (R, G, B), its box's upper left corner at (x, y); only what lies in `clip` is
/// touched. `color` is linear, and so is the mixture at the edges.
void draw_line(Image& canvas, const SheetBox& clip, int x, int y, std::string_view line, double size,
               const std::array<float, 3>& color);

}  // namespace lambent
