#include "sheet/text.h"

#include <algorithm>
#include <cmath>

#include "sheet/font.h"

namespace lambent {
namespace {

constexpr char32_t replacement = 0xfffd;
constexpr std::string_view ellipsis = "\u2026";

/// Length in bytes of the character that begins at text[i], and what it is.
struct Decoded {
  std::size_t length;
  char32_t character;
};

Decoded decode_one(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) -> unsigned {
    return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u;
  };
  const unsigned first = byte(i);
  if (first == '\t') return {1, U' '};
  if (first < 0x20 || first == 0x7f) return {1, replacement};
  if (first < 0x80) return {1, char32_t(first)};
  if (first < 0xc2 || first > 0xf4) return {1, replacement};
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  char32_t character = first & (0x7fu >> length);
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(i + k) & 0xc0) != 0x80) return {1, replacement};
    character = character << 6 | (byte(i + k) & 0x3f);
  }
  constexpr char32_t smallest[] = {0, 0, 0xa0, 0x800, 0x10000};  // U+0080 to U+009F are controls
  const bool surrogate = character >= 0xd800 && character <= 0xdfff;
  if (character < smallest[length] || character > 0x10ffff || surrogate) return {length, replacement};
  return {length, character};
}

struct PlacedGlyph {
  int glyph;
  double x;  ///< Of the pen, from the line's first.
};

struct PlacedLine {
  std::vector<PlacedGlyph> glyphs;
  double advance = 0;
};

PlacedLine place(std::string_view line, double size) {
  PlacedLine placed;
  for (const char32_t character : decode_utf8(line)) {
    const int glyph = glyph_of(character);
    if (!placed.glyphs.empty()) placed.advance += glyph_kerning(placed.glyphs.back().glyph, glyph) * size;
    placed.glyphs.push_back({glyph, placed.advance});
    placed.advance += glyph_advance(glyph) * size;
  }
  return placed;
}

struct Pen {
  int pixel;
  double shift;
};
Pen pen_at(double x) {
  const double pixel = std::floor(x);
  return {int(pixel), x - pixel};
}

/// What a line covers from left to right, with its first pen at 0.
struct Extent {
  int left = 0, right = 0;
};

Extent extent_of(const PlacedLine& line, double size) {
  Extent extent{0, int(std::ceil(line.advance))};
  for (const PlacedGlyph& placed : line.glyphs) {
    const Pen pen = pen_at(placed.x);
    const GlyphBox box = glyph_box(placed.glyph, size, pen.shift);
    if (box.left == box.right) continue;
    extent.left = std::min(extent.left, pen.pixel + box.left);
    extent.right = std::max(extent.right, pen.pixel + box.right);
  }
  return extent;
}

std::vector<std::string> split(std::string_view text, std::string_view separator) {
  std::vector<std::string> parts;
  for (std::size_t at; (at = text.find(separator)) != std::string_view::npos;) {
    if (at > 0) parts.emplace_back(text.substr(0, at));
    text.remove_prefix(at + separator.size());
  }
  if (!text.empty()) parts.emplace_back(text);
  return parts;
}

bool fits(std::string_view line, double size, int width) { return text_width(line, size) <= width; }

/// As many of `parts` in a line as fit, then the next line; a part that is longer than a line stays whole.
std::vector<std::string> filled(const std::vector<std::string>& parts, std::string_view separator,
                                double size, int width) {
  std::vector<std::string> lines;
  for (const std::string& part : parts) {
    if (!lines.empty()) {
      std::string longer = lines.back();
      longer.append(separator).append(part);
      if (fits(longer, size, width)) {
        lines.back() = std::move(longer);
        continue;
      }
    }
    lines.push_back(part);
  }
  return lines;
}

bool all_fit(const std::vector<std::string>& lines, double size, int width) {
  return std::all_of(lines.begin(), lines.end(), [&](const auto& line) { return fits(line, size, width); });
}

/// A word in pieces of at most `width` pixels, but of at least one character.
std::vector<std::string> pieces_of(const std::string& word, double size, int width) {
  std::vector<std::string> pieces(1);
  for (std::size_t i = 0; i < word.size();) {
    const std::string character = word.substr(i, decode_one(word, i).length);
    if (!pieces.back().empty() && !fits(pieces.back() + character, size, width)) pieces.emplace_back();
    pieces.back() += character;
    i += character.size();
  }
  return pieces;
}

/// `line` with an ellipsis at its end, shortened until that fits; empty where not even the ellipsis does.
std::string cut(std::string line, double size, int width) {
  for (;;) {
    while (!line.empty() && line.back() == ' ') line.pop_back();
    std::string shown = line + std::string(ellipsis);
    if (fits(shown, size, width)) return shown;
    if (line.empty()) return "";
    // A character's first byte stands before its others, which are 10xxxxxx.
    while (line.size() > 1 && (static_cast<unsigned char>(line.back()) & 0xc0) == 0x80) line.pop_back();
    line.pop_back();
  }
}

}  // namespace

std::u32string decode_utf8(std::string_view text) {
  std::u32string characters;
  for (std::size_t i = 0; i < text.size();) {
    const auto [length, character] = decode_one(text, i);
    characters += character;
    i += length;
  }
  return characters;
}

int text_width(std::string_view line, double size) {
  const Extent extent = extent_of(place(line, size), size);
  return extent.right - extent.left;
}

int line_height(double size) { return int(std::ceil(1.3 * size)); }

int baseline_in_line(double size) {
  const double leading = line_height(size) - (font_ascent() + font_descent()) * size;
  return int(std::lround(leading / 2 + font_ascent() * size));
}

BrokenLines break_lines(std::string_view paragraph, double size, int width) {
  const std::vector<std::string> phrases = filled(split(paragraph, "  "), "  ", size, width);
  if (all_fit(phrases, size, width)) return {phrases, true};
  const std::vector<std::string> words = split(paragraph, " ");
  if (all_fit(words, size, width)) return {filled(words, " ", size, width), true};
  BrokenLines broken{{}, false};
  for (const std::string& word : words) {
    std::vector<std::string> pieces = pieces_of(word, size, width);
    // Only a word's first piece has a space before it.
    if (!broken.lines.empty() && fits(broken.lines.back() + " " + pieces.front(), size, width)) {
      broken.lines.back() += " " + pieces.front();
      pieces.erase(pieces.begin());
    }
    broken.lines.insert(broken.lines.end(), pieces.begin(), pieces.end());
  }
  return broken;
}

FittedTexts fit_texts(const std::vector<std::string>& texts, int width, const TextStyle& style) {
  constexpr double step = 0.5, a_little_smaller = 0.85;
  const double smallest = std::min(style.smallest, style.size);
  std::vector<std::vector<std::string>> paragraphs;
  for (const std::string& text : texts) paragraphs.push_back(split(text, "\n"));

  for (int lines = 1; lines <= style.lines; ++lines) {
    const double end = lines < style.lines ? std::max(smallest, a_little_smaller * style.size) : smallest;
    for (double size = style.size; size >= end; size -= step) {
      FittedTexts fitted{size, {}};
      bool good = true;
      for (std::size_t i = 0; i < texts.size() && good; ++i) {
        fitted.texts.emplace_back();
        for (const std::string& paragraph : paragraphs[i]) {
          const BrokenLines broken = break_lines(paragraph, size, width);
          good = good && broken.whole_words && broken.lines.size() <= std::size_t(lines);
          fitted.texts.back().insert(fitted.texts.back().end(), broken.lines.begin(), broken.lines.end());
        }
      }
      if (good) return fitted;
    }
  }

  FittedTexts fitted{smallest, {}};
  for (const auto& text : paragraphs) {
    fitted.texts.emplace_back();
    for (const std::string& paragraph : text) {
      std::vector<std::string> lines = break_lines(paragraph, smallest, width).lines;
      if (lines.size() > std::size_t(style.lines)) {
        lines.resize(std::size_t(style.lines));
        lines.back() = cut(lines.back(), smallest, width);
      }
      for (std::string& line : lines)  // a single character may be wider than the line
        fitted.texts.back().push_back(fits(line, smallest, width) ? line : cut(line, smallest, width));
    }
  }
  return fitted;
}

void draw_line(Image& canvas, const SheetBox& clip, int x, int y, std::string_view line, double size,
               const std::array<float, 3>& color) {
  const PlacedLine placed = place(line, size);
  const int left = x - extent_of(placed, size).left;
  const int baseline = y + baseline_in_line(size);
  for (const PlacedGlyph& one : placed.glyphs) {
    const Pen pen = pen_at(one.x);
    const GlyphImage glyph = glyph_image(one.glyph, size, pen.shift);
    const int x0 = left + pen.pixel + glyph.x, y0 = baseline + glyph.y;
    const int from_x = std::max({0, clip.x - x0, -x0}), from_y = std::max({0, clip.y - y0, -y0});
    const int to_x = std::min({glyph.width, clip.x + clip.width - x0, canvas.width - x0});
    const int to_y = std::min({glyph.height, clip.y + clip.height - y0, canvas.height - y0});
    for (int gy = from_y; gy < to_y; ++gy)
      for (int gx = from_x; gx < to_x; ++gx) {
        const float covered =
            float(glyph.coverage[std::size_t(gy) * std::size_t(glyph.width) + std::size_t(gx)]) / 255;
        float* pixel = canvas.pixel(x0 + gx, y0 + gy);
        for (std::size_t c = 0; c < 3; ++c) pixel[c] = (1 - covered) * pixel[c] + covered * color[c];
      }
  }
}

}  // namespace lambent
