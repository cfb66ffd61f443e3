#include "sheet/font.h"

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb_truetype.h>

#include "lambent/diagnostics.h"
#include "sheet/font_file.h"

namespace lambent {
namespace {

struct Font {
  stbtt_fontinfo info;
  double ascent, descent;  // in ems

  Font() {
    const unsigned char* data = font_file().data();
    if (!stbtt_InitFont(&info, data, stbtt_GetFontOffsetForIndex(data, 0)))
      throw Failure("the library was built with a font that cannot be read");
    int up, down, gap;
    stbtt_GetFontVMetrics(&info, &up, &down, &gap);
    ascent = up * em();
    descent = -down * em();
  }
  /// One of the font's units, in ems.
  double em() const { return double(scale(1)); }
  float scale(double size) const { return stbtt_ScaleForMappingEmToPixels(&info, float(size)); }
};

const Font& font() {
  static const Font font;
  return font;
}

}  // namespace

int glyph_of(char32_t character) { return stbtt_FindGlyphIndex(&font().info, int(character)); }

double glyph_advance(int glyph) {
  int advance, bearing;
  stbtt_GetGlyphHMetrics(&font().info, glyph, &advance, &bearing);
  return advance * font().em();
}

double glyph_kerning(int glyph, int next) {
  return stbtt_GetGlyphKernAdvance(&font().info, glyph, next) * font().em();
}

GlyphBox glyph_box(int glyph, double size, double shift) {
  const float scale = font().scale(size);
  GlyphBox box;
  stbtt_GetGlyphBitmapBoxSubpixel(&font().info, glyph, scale, scale, float(shift), 0, &box.left, &box.top,
                                  &box.right, &box.bottom);
  return box;
}

GlyphImage glyph_image(int glyph, double size, double shift) {
  const float scale = font().scale(size);
  const GlyphBox box = glyph_box(glyph, size, shift);
  GlyphImage image{box.left, box.top, box.right - box.left, box.bottom - box.top, {}};
  image.coverage.resize(std::size_t(image.width) * std::size_t(image.height));
  if (!image.coverage.empty())
    stbtt_MakeGlyphBitmapSubpixel(&font().info, image.coverage.data(), image.width, image.height, image.width,
                                  scale, scale, float(shift), 0, glyph);
  return image;
}

double font_ascent() { return font().ascent; }
double font_descent() { return font().descent; }

}  // namespace lambent
