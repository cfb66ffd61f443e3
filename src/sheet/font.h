#pragma once
// The one font of labels, glyph by glyph.

#include <vector>

namespace lambent {

/// How much of each pixel a glyph covers. (x, y) is the pixel of the upper left corner, as seen from the pen
/// on the baseline; y grows downwards.
struct GlyphImage {
  int x = 0, y = 0, width = 0, height = 0;
  std::vector<unsigned char> coverage;  ///< 0 to 255, row by row.
};

/// What a glyph covers, without its picture: [left, right) x [top, bottom).
struct GlyphBox {
  int left = 0, top = 0, right = 0, bottom = 0;
};

// `size` is that of the em, in pixels.

/// The glyph of a character; 0, an empty box, where the font has none.
int glyph_of(char32_t character);

/// How far the pen moves on: behind `glyph`, where `next` follows it. In ems.
double glyph_advance(int glyph);
double glyph_kerning(int glyph, int next);

/// With the pen `shift` pixels, 0 to 1, to the right of a pixel's left edge.
GlyphBox glyph_box(int glyph, double size, double shift);
GlyphImage glyph_image(int glyph, double size, double shift);

/// How far letters reach above and below the baseline, in ems; both positive.
double font_ascent();
double font_descent();

}  // namespace lambent
