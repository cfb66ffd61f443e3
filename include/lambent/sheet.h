#pragma once
// Contact sheets: pictures side by side, each with its label; and the difference of two pictures as a
// picture.

#include <array>
#include <string>
#include <vector>

#include "lambent/image.h"

namespace lambent {

// ---- sheets
// ----------------------------------------------------------------------------------------------------------

/// One picture of a sheet, with what is written below it. Texts are UTF-8, left to right.
struct SheetCell {
  /// R, G and B, or a single channel, which becomes grey; channels beside these are left out. The values
  /// stand in the sheet as they are, every bit. Without pixels its place stays free.
  Image picture;
  std::string title;
  std::string subtitle;  ///< A newline begins a new line.
  /// Where there is no picture and this is above 0: in its place the colour bar of difference_picture, with
  /// this as its limit.
  double color_bar = 0;
};

struct SheetOptions {
  std::string title, subtitle;  ///< Above all cells; nothing where both are empty.
  /// How many stand side by side; 0: as many as bring the sheet near 16:9 and leave few places free.
  int columns = 0;
  /// This many cells that follow each other stand one below the other, and belong together: with 2, a picture
  /// and its difference.
  int stack = 1;
  /// Whether the sheet will be written sRGB-encoded (WriteOptions::png_encoded). Labels have sRGB colours and
  /// are put on the ground in linear light; where the file holds values as they are, those colours are too.
  bool encoded = true;
};

struct SheetBox {
  int x = 0, y = 0, width = 0, height = 0;
};

struct Sheet {
  Image image;                     ///< R, G, B, linear.
  std::vector<SheetBox> pictures;  ///< Where each cell's picture lies; of no size where it has none.
  std::vector<SheetBox> labels;    ///< Where each cell's texts lie; its colour bar lies in neither.
  SheetBox header;
};

/// Throws InputError where there are no cells, where a picture has neither R, G and B nor a single channel,
/// and where the sheet would be too large.
Sheet make_sheet(const std::vector<SheetCell>& cells, const SheetOptions& options = {});

// ---- differences
// -----------------------------------------------------------------------------------------------------

/// Where one picture is brighter than another, and where darker. Luminance is that of linear sRGB,
/// Y = 0.2126 R + 0.7152 G + 0.0722 B (IEC 61966-2-1): a difference of colour alone is none of it, and
/// compare_images shows those. Not clamped: the values are the equation's, not the screen's.
struct SignedDifference {
  Image values;               ///< One channel, "Y": luminance of a less that of b.
  double largest = 0;         ///< The one of the greatest magnitude, with its sign,
  int x = 0, y = 0;           ///< and where it is: of equal ones the first, row by row.
  double mean = 0;            ///< With signs, so that brighter and darker make up for each other,
  double mean_magnitude = 0;  ///< and without.
};

/// A picture with a single channel has that as its luminance. Where only one of the two is not a number, the
/// difference is infinite. Throws InputError where the sizes differ or a picture has no colours.
SignedDifference signed_difference(const Image& a, const Image& b);

/// The smallest of 1, 1.5, 2, 3, 5 and 7 times a power of ten that is not below |largest|: a common scale for
/// several differences. 1 where `largest` is 0 or not finite.
double color_bar_limit(double largest);

/// The colour of t, from -1 (blue) over 0 (dark grey) to 1 (orange), as linear R, G, B; beyond that the
/// ends'. Two straight lines in Ottosson's Oklab space, so that equal steps of t look equally large on either
/// side: L = 0.25 + 0.45 |t|, chroma 0.15 |t|, hue 250 degrees where t < 0 and 40 degrees where t > 0. Blue
/// and orange stay apart for all kinds of colour-blind eyes, and size can be read from lightness alone.
std::array<float, 3> diverging_color(double t);

/// Each value v of the single channel as diverging_color(t) with t = sign(v) sqrt(|v| / limit): the root,
/// because differences of light are large in few places, and would leave all others dark. `encoded` as in
/// SheetOptions. Throws InputError where `limit` is not above 0 or there is more than one channel.
Image difference_picture(const Image& values, double limit, bool encoded = true);

}  // namespace lambent
