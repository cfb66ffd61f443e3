// A contact sheet, painted as it is laid out.

#include "lambent/sheet.h"

#include "sheet/layout.h"
#include "sheet/picture.h"
#include "sheet/text.h"

namespace lambent {
namespace {

using Tone = std::array<float, 3>;

/// An sRGB colour of 8 bits as the numbers of the sheet.
Tone tone(int r, int g, int b, bool encoded) {
  const auto channel = [&](int code) {
    return float(encoded ? linear_from_srgb(code / 255.0) : code / 255.0);
  };
  return {channel(r), channel(g), channel(b)};
}

/// Dark and without a hue, so that the pictures' own colours stand as they are.
struct Palette {
  Tone ground, frame, strong, quiet;
  explicit Palette(bool encoded)
      : ground(tone(26, 26, 27, encoded)),
        frame(tone(58, 58, 60, encoded)),
        strong(tone(236, 236, 234, encoded)),
        quiet(tone(168, 169, 172, encoded)) {}
};

void fill(Image& canvas, const SheetBox& box, const Tone& color) {
  for (int y = box.y; y < box.y + box.height; ++y)
    for (int x = box.x; x < box.x + box.width; ++x)
      for (std::size_t c = 0; c < 3; ++c) canvas.pixel(x, y)[c] = color[c];
}

SheetBox around(const SheetBox& box) { return {box.x - 1, box.y - 1, box.width + 2, box.height + 2}; }

void put(Image& canvas, const SheetBox& box, const Image& picture) {
  const ColorChannels channels = color_channels_of(picture);
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        canvas.pixel(box.x + x, box.y + y)[c] = picture.pixel(x, y)[channels[c]];
}

/// Colours in even steps from end to end, as difference_picture gives them, in every row of the box.
void put_bar(Image& canvas, const SheetBox& box, bool encoded) {
  Image values{box.width, 1, {"Y"}, {}};
  for (int x = 0; x < box.width; ++x) {
    const double t = (2 * x + 1) / double(box.width) - 1;
    values.data.push_back(float(t < 0 ? -t * t : t * t));  // difference_picture takes the root
  }
  const Image row = difference_picture(values, 1, encoded);
  for (int y = 0; y < box.height; ++y) put(canvas, {box.x, box.y + y, box.width, 1}, row);
}

}  // namespace

Sheet make_sheet(const std::vector<SheetCell>& cells, const SheetOptions& options) {
  const SheetLayout layout = lay_out(cells, options);
  const Palette palette(options.encoded);
  Sheet sheet;
  sheet.pictures = layout.pictures;
  sheet.labels = layout.labels;
  sheet.header = layout.header;
  Image& canvas = sheet.image;
  canvas.width = layout.width;
  canvas.height = layout.height;
  canvas.data.resize(std::size_t(layout.width) * std::size_t(layout.height) * 3);
  fill(canvas, {0, 0, layout.width, layout.height}, palette.ground);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    // A frame of one pixel: a black picture would have no edge otherwise.
    if (layout.pictures[i].width > 0) {
      fill(canvas, around(layout.pictures[i]), palette.frame);
      put(canvas, layout.pictures[i], cells[i].picture);
    }
    if (layout.bars[i].width > 0) {
      fill(canvas, around(layout.bars[i]), palette.frame);
      put_bar(canvas, layout.bars[i], options.encoded);
    }
  }
  for (const SheetLine& line : layout.lines)
    draw_line(canvas, line.clip, line.x, line.y, line.text, line.size,
              line.strong ? palette.strong : palette.quiet);
  return sheet;
}

}  // namespace lambent
