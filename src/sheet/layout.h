#pragma once
// Where everything of a sheet lies, before anything is drawn.

#include <string>
#include <vector>

#include "lambent/sheet.h"

namespace lambent {

/// A line of text, its box's upper left corner at (x, y).
struct SheetLine {
  std::string text;
  int x, y;
  double size;
  bool strong;    ///< A title, or a line below one.
  SheetBox clip;  ///< The box of the texts that it belongs to.
};

struct SheetLayout {
  int width = 0, height = 0;
  SheetBox header;
  std::vector<SheetBox> pictures, bars,
      labels;  ///< One of each for every cell; of no size where there is none.
  std::vector<SheetLine> lines;
};

/// How many columns of stacks, each of cell_width x cell_height and `stack` cells high, bring a sheet near
/// 16:9 and leave few places free.
int choose_columns(int stacks, int stack, int cell_width, int cell_height);

SheetLayout lay_out(const std::vector<SheetCell>& cells, const SheetOptions& options);

}  // namespace lambent
