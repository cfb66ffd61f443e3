#include "sheet/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sheet/picture.h"
#include "sheet/text.h"

namespace lambent {
namespace {

/// Narrower places than this leave no room for legible words; smaller pictures stand in their middle.
constexpr int narrowest_place = 120;
/// Letters below this size cannot be read.
constexpr double smallest_letters = 9;

/// Distances and sizes of letters, all in proportion to the width of a place.
struct Measures {
  double unit;
  int margin, between_columns, between_rows, above_label, below_header, bar_height;
  TextStyle title, subtitle, header_title, header_subtitle;

  explicit Measures(int place_width) : unit(std::clamp(place_width / 22.0, 9.0, 28.0)) {
    const auto pixels = [&](double units) { return int(std::lround(units * unit)); };
    const auto style = [&](double units, int lines) {
      return TextStyle{std::max(smallest_letters, units * unit), smallest_letters, lines};
    };
    margin = pixels(1.5);
    between_columns = pixels(1.2);
    between_rows = pixels(1.3);
    above_label = pixels(0.35);
    below_header = pixels(0.9);
    bar_height = pixels(0.9);
    title = style(0.95, 2);
    subtitle = style(0.72, 4);
    header_title = style(1.4, 2);
    header_subtitle = style(0.78, 2);
  }
};

bool has_picture(const SheetCell& cell) { return cell.picture.width > 0 && cell.picture.height > 0; }
bool has_bar(const SheetCell& cell) { return !has_picture(cell) && cell.color_bar > 0; }

int label_height(const std::vector<std::string>& title, double title_size,
                 const std::vector<std::string>& subtitle, double subtitle_size) {
  return int(title.size()) * line_height(title_size) + int(subtitle.size()) * line_height(subtitle_size);
}

/// The texts of all cells, fitted: titles in one size, subtitles in one size.
struct Labels {
  FittedTexts titles, subtitles;

  Labels(const std::vector<SheetCell>& cells, int width, const Measures& measures) {
    std::vector<std::string> title_texts, subtitle_texts;
    for (const SheetCell& cell : cells) {
      title_texts.push_back(cell.title);
      subtitle_texts.push_back(cell.subtitle);
    }
    titles = fit_texts(title_texts, width, measures.title);
    subtitles = fit_texts(subtitle_texts, width, measures.subtitle);
  }
  int height(std::size_t cell) const {
    return label_height(titles.texts[cell], titles.size, subtitles.texts[cell], subtitles.size);
  }
};

/// Lines one below the other from (x, y) on; the y below the last.
int add_lines(SheetLayout& layout, const std::vector<std::string>& lines, int x, int y, double size,
              bool strong, const SheetBox& clip) {
  for (const std::string& line : lines) {
    layout.lines.push_back({line, x, y, size, strong, clip});
    y += line_height(size);
  }
  return y;
}

/// The sheet's own title on the left and its subtitle on the right, on one baseline; one below the other
/// where that is too narrow.
void add_header(SheetLayout& layout, const SheetOptions& options, const Measures& measures, int width) {
  layout.header = {measures.margin, measures.margin, 0, 0};
  if (options.title.empty() && options.subtitle.empty()) return;
  const FittedTexts title = fit_texts({options.title}, width, measures.header_title);
  const FittedTexts subtitle = fit_texts({options.subtitle}, width, measures.header_subtitle);
  const std::vector<std::string>&large = title.texts[0], &small = subtitle.texts[0];
  SheetBox& box = layout.header;
  box.width = width;

  if (large.size() == 1 && small.size() == 1) {
    const int small_width = text_width(small[0], subtitle.size);
    if (text_width(large[0], title.size) + int(2 * measures.unit) + small_width <= width) {
      box.height = std::max(line_height(title.size), line_height(subtitle.size));
      const int lower = baseline_in_line(title.size) - baseline_in_line(subtitle.size);
      add_lines(layout, large, box.x, box.y, title.size, true, box);
      add_lines(layout, small, box.x + width - small_width, box.y + lower, subtitle.size, false, box);
      return;
    }
  }
  box.height = label_height(large, title.size, small, subtitle.size);
  const int y = add_lines(layout, large, box.x, box.y, title.size, true, box);
  add_lines(layout, small, box.x, y, subtitle.size, false, box);
}

/// The bar in the middle of the place, with numbers at its ends, its middle, and between them where that
/// leaves them apart. The root stands between the ends: half way lies a quarter of the limit.
void add_bar(SheetLayout& layout, std::size_t cell, const SheetBox& place, double limit,
             const Measures& measures) {
  const double size = measures.subtitle.size;
  const int inset = int(1.2 * measures.unit);
  SheetBox& bar = layout.bars[cell];
  bar = {place.x + inset, 0, place.width - 2 * inset, measures.bar_height};
  bar.y = place.y + (place.height - bar.height - line_height(size)) / 2;

  struct Number {
    std::string text;
    int at;  ///< Of four parts of the bar.
  };
  const std::string end = fmt::format("{:.3g}", limit), half_way = fmt::format("{:.3g}", limit / 4);
  std::vector<Number> numbers{{"\u2212" + end, 0}, {"0", 2}, {"+" + end, 4}};
  const Number between[] = {{"\u2212" + half_way, 1}, {"+" + half_way, 3}};
  if (2 * text_width(between[0].text, size) < bar.width / 4 + int(measures.unit))
    numbers.insert(numbers.end(), std::begin(between), std::end(between));
  const int y = bar.y + bar.height + measures.above_label / 2;
  const SheetBox clip{place.x, y, place.width, line_height(size)};
  for (const Number& number : numbers) {
    const int middle = bar.x + number.at * bar.width / 4, width = text_width(number.text, size);
    const int x = std::clamp(middle - width / 2, place.x, std::max(place.x, place.x + place.width - width));
    layout.lines.push_back({number.text, x, y, size, false, clip});
  }
}

}  // namespace

int choose_columns(int stacks, int stack, int cell_width, int cell_height) {
  constexpr double wanted = 16.0 / 9.0, price_of_free_places = 2;
  int best = 1;
  double lowest = HUGE_VAL;
  for (int columns = 1; columns <= stacks; ++columns) {
    const int rows = (stacks + columns - 1) / columns;
    const double shape = double(columns) * cell_width / (double(rows) * stack * cell_height);
    const double free = 1 - double(stacks) / (double(columns) * rows);
    const double cost = std::max(shape / wanted, wanted / shape) * (1 + price_of_free_places * free);
    if (cost < lowest) {
      lowest = cost;
      best = columns;
    }
  }
  return best;
}

SheetLayout lay_out(const std::vector<SheetCell>& cells, const SheetOptions& options) {
  if (cells.empty()) refuse("a sheet has at least one picture");
  if (options.stack < 1) refuse("a stack of cells is at least 1 high");
  if (options.columns < 0) refuse("a sheet has at least one column");
  int place_width = narrowest_place, place_height = 0;
  for (const SheetCell& cell : cells) {
    color_channels_of(cell.picture);
    if (!has_picture(cell)) continue;
    place_width = std::max(place_width, cell.picture.width);
    place_height = std::max(place_height, cell.picture.height);
  }
  const Measures measures(place_width);
  const Labels labels(cells, place_width, measures);

  const std::size_t stack = std::size_t(options.stack);
  const std::size_t stacks = (cells.size() + stack - 1) / stack;
  int highest_label = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) highest_label = std::max(highest_label, labels.height(i));
  const int chosen =
      options.columns > 0
          ? options.columns
          : choose_columns(int(stacks), options.stack, place_width + measures.between_columns,
                           place_height + measures.above_label + highest_label + measures.between_rows);
  const std::size_t columns = std::min(std::size_t(chosen), stacks);
  const std::size_t rows = (stacks + columns - 1) / columns * stack;
  // The widths of a row in numbers that cannot overflow: columns and places may both be large.
  const double width =
      2.0 * measures.margin + double(columns) * place_width + double(columns - 1) * measures.between_columns;
  const double height_of_pictures = double(rows) * place_height;
  constexpr double most_values = 1 << 30;  // what write_image's formats read again
  if (width * height_of_pictures * 3 > most_values)
    refuse(fmt::format("the sheet would be too large: {} pictures of {} x {} pixels", cells.size(),
                       place_width, place_height),
           "smaller pictures, or fewer of them");

  SheetLayout layout;
  layout.width = int(width);
  const std::size_t count = cells.size();
  layout.pictures.resize(count);
  layout.bars.resize(count);
  layout.labels.resize(count);
  add_header(layout, options, measures, layout.width - 2 * measures.margin);
  int y = layout.header.y + layout.header.height;
  if (layout.header.height > 0) y += measures.below_header;

  for (std::size_t row = 0; row < rows; ++row) {
    const auto cell_at = [&](std::size_t column) {
      return (row / stack * columns + column) * stack + row % stack;
    };
    int row_height = 0, row_label_height = 0;
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t i = cell_at(column);
      if (i >= count) continue;
      const int bar_needs =
          has_bar(cells[i]) ? 2 * measures.bar_height + line_height(measures.subtitle.size) : 0;
      row_height = std::max({row_height, has_picture(cells[i]) ? cells[i].picture.height : 0, bar_needs});
      row_label_height = std::max(row_label_height, labels.height(i));
    }
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t i = cell_at(column);
      if (i >= count) continue;
      const int x = measures.margin + int(column) * (place_width + measures.between_columns);
      const Image& picture = cells[i].picture;
      if (has_picture(cells[i]))
        layout.pictures[i] = {x + (place_width - picture.width) / 2, y + (row_height - picture.height) / 2,
                              picture.width, picture.height};
      else if (has_bar(cells[i]))
        add_bar(layout, i, {x, y, place_width, row_height}, cells[i].color_bar, measures);
      SheetBox& box = layout.labels[i];
      box = {x, y + row_height + measures.above_label, place_width, labels.height(i)};
      const int below = add_lines(layout, labels.titles.texts[i], x, box.y, labels.titles.size, true, box);
      add_lines(layout, labels.subtitles.texts[i], x, below, labels.subtitles.size, false, box);
    }
    y += row_height + row_label_height + (row_label_height > 0 ? measures.above_label : 0);
    y += row + 1 < rows ? measures.between_rows : measures.margin;
  }
  layout.height = y;
  return layout;
}

}  // namespace lambent
