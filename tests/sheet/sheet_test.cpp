#include "lambent/sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "lambent/diagnostics.h"
#include "sheet/layout.h"

namespace lambent {
namespace {

/// A picture that is different in every value, and not all of it within [0, 1].
Image pattern(int width, int height, float start) {
  Image image{width, height, {"R", "G", "B"}, {}};
  for (int i = 0; i < width * height * 3; ++i) image.data.push_back(start + 0.37f * float(i % 101) - 3);
  return image;
}

SheetCell cell(Image picture, std::string title, std::string subtitle = "") {
  SheetCell one;
  one.picture = std::move(picture);
  one.title = std::move(title);
  one.subtitle = std::move(subtitle);
  return one;
}

std::vector<SheetCell> five_cells() {
  return {cell(pattern(200, 100, 0), "conventional", "Il Kd (N.L)+"),
          cell(pattern(200, 100, 1), "attenuated", "Il / r^2  Kd (N.L)+\nin this scene: attenuation 1/r"),
          cell(pattern(200, 100, 2), "phong", "Il / r [ Kd (N.L)+ + Ks ((R.V)+)^n ],  R = 2 (N.L) N - L"),
          cell(pattern(150, 90, 3), "blinn_phong \u2212 conventional"),
          cell(pattern(31, 17, 4), "", "a small one")};
}

bool overlap(const SheetBox& a, const SheetBox& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}
bool inside(const SheetBox& box, const Image& sheet) {
  return box.x >= 0 && box.y >= 0 && box.x + box.width <= sheet.width && box.y + box.height <= sheet.height;
}
bool in(const SheetBox& box, int x, int y) {
  return x >= box.x && x < box.x + box.width && y >= box.y && y < box.y + box.height;
}
/// The box and its frame.
SheetBox framed(const SheetBox& box) { return {box.x - 1, box.y - 1, box.width + 2, box.height + 2}; }

std::string message_of(const std::vector<SheetCell>& cells, const SheetOptions& options = {}) {
  try {
    make_sheet(cells, options);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Sheet, HoldsEveryPictureBitForBit) {
  std::vector<SheetCell> cells = five_cells();
  cells[0].picture.data[7] = NAN;
  cells[1].picture.data[8] = -INFINITY;
  for (const bool encoded : {true, false})
    for (const int columns : {0, 1, 2, 3, 5, 9}) {
      SheetOptions options;
      options.title = "scene.yaml";
      options.columns = columns;
      options.encoded = encoded;
      const Sheet sheet = make_sheet(cells, options);
      ASSERT_EQ(sheet.pictures.size(), cells.size());
      for (std::size_t i = 0; i < cells.size(); ++i) {
        const SheetBox& box = sheet.pictures[i];
        const Image& picture = cells[i].picture;
        ASSERT_EQ(box.width, picture.width);
        ASSERT_EQ(box.height, picture.height);
        ASSERT_TRUE(inside(framed(box), sheet.image));
        int changed = 0;
        for (int y = 0; y < box.height; ++y)
          for (int x = 0; x < box.width; ++x)
            for (int c = 0; c < 3; ++c)
              changed += std::bit_cast<std::uint32_t>(sheet.image.pixel(box.x + x, box.y + y)[c]) !=
                         std::bit_cast<std::uint32_t>(picture.pixel(x, y)[c]);
        EXPECT_EQ(changed, 0) << "cell " << i << ", columns " << columns;
      }
    }
}

TEST(Sheet, BoxesLieApartAndWithinTheSheet) {
  for (const int columns : {0, 1, 2, 3, 5})
    for (const int stack : {1, 2, 3}) {
      SheetOptions options;
      options.title = "scene.yaml";
      options.subtitle = "480 x 270 pixels, 16 samples per pixel";
      options.columns = columns;
      options.stack = stack;
      const Sheet sheet = make_sheet(five_cells(), options);
      std::vector<SheetBox> boxes = sheet.labels;
      for (const SheetBox& picture : sheet.pictures) boxes.push_back(framed(picture));
      boxes.push_back(sheet.header);
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        EXPECT_TRUE(inside(boxes[i], sheet.image)) << i;
        for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(overlap(boxes[i], boxes[k])) << i << " and " << k;
      }
    }
}

TEST(Sheet, TextStaysInItsBoxesAndDiffersFromTheGround) {
  SheetOptions options;
  options.title = "a scene with a long name, jumping fjords.yaml";
  options.subtitle = "480 x 270 pixels, 16 samples per pixel";
  const std::vector<SheetCell> cells = five_cells();
  std::vector<SheetCell> bare = cells;
  for (SheetCell& one : bare) one.title = one.subtitle = "";
  const Sheet sheet = make_sheet(cells, options);
  const float* ground = sheet.image.pixel(0, 0);
  std::vector<int> bright(cells.size() + 1);
  for (int y = 0; y < sheet.image.height; ++y)
    for (int x = 0; x < sheet.image.width; ++x) {
      const float* pixel = sheet.image.pixel(x, y);
      bool picture = false;
      for (const SheetBox& box : sheet.pictures) picture = picture || in(framed(box), x, y);
      if (picture) continue;
      std::size_t label = 0;
      while (label < cells.size() && !in(sheet.labels[label], x, y)) ++label;
      if (label == cells.size() && !in(sheet.header, x, y)) {
        for (int c = 0; c < 3; ++c) ASSERT_EQ(pixel[c], ground[c]) << "at " << x << "," << y;
      } else {
        bright[label] += pixel[1] > ground[1] + 0.2f;
      }
    }
  for (std::size_t i = 0; i < bright.size(); ++i)
    EXPECT_GT(bright[i], 20) << "label " << i << " is not there";
}

TEST(Sheet, LinesLieWithinTheTextsThatTheyBelongTo) {
  for (const int columns : {0, 1, 3}) {
    SheetOptions options;
    options.title = "scene.yaml";
    options.subtitle = "480 x 270 pixels, 16 samples per pixel";
    options.columns = columns;
    const SheetLayout layout = lay_out(five_cells(), options);
    EXPECT_GT(layout.lines.size(), 9u);
    for (const SheetLine& line : layout.lines) {
      EXPECT_GE(line.x, line.clip.x) << line.text;
      EXPECT_GE(line.y, line.clip.y) << line.text;
      EXPECT_LT(line.y, line.clip.y + line.clip.height) << line.text;
      EXPECT_GE(line.size, 9) << line.text;
    }
  }
}

TEST(Sheet, MarginsAreEven) {
  const std::vector<SheetCell> cells(4, cell(pattern(200, 100, 0), "one"));
  SheetOptions options;
  options.columns = 2;
  const Sheet sheet = make_sheet(cells, options);
  const int left = sheet.pictures[0].x, top = sheet.pictures[0].y;
  const int right = sheet.image.width - (sheet.pictures[3].x + 200);
  const int bottom = sheet.image.height - (sheet.labels[3].y + sheet.labels[3].height);
  EXPECT_EQ(left, right);
  EXPECT_EQ(left, top);
  EXPECT_EQ(left, bottom);
  EXPECT_EQ(sheet.pictures[0].x, sheet.pictures[2].x);
  EXPECT_EQ(sheet.pictures[0].y, sheet.pictures[1].y);
}

TEST(Sheet, StacksStandBelowEachOther) {
  std::vector<SheetCell> cells;
  for (int i = 0; i < 6; ++i) cells.push_back(cell(pattern(160, 90, float(i)), "cell"));
  SheetOptions options;
  options.columns = 2;
  options.stack = 2;
  const Sheet sheet = make_sheet(cells, options);
  const auto& box = sheet.pictures;
  // 0 2
  // 1 3
  // 4
  // 5
  for (const int i : {0, 2, 4}) {
    EXPECT_EQ(box[std::size_t(i)].x, box[std::size_t(i) + 1].x);
    EXPECT_LT(box[std::size_t(i)].y + 90, box[std::size_t(i) + 1].y);
  }
  EXPECT_EQ(box[0].y, box[2].y);
  EXPECT_EQ(box[1].y, box[3].y);
  EXPECT_LT(box[1].y, box[4].y);
  EXPECT_EQ(box[0].x, box[4].x);
}

TEST(Sheet, ColumnsBringItNearSixteenToNine) {
  // Cells of 16:9: as many columns as rows, where they fill the sheet.
  EXPECT_EQ(choose_columns(1, 1, 480, 270), 1);
  EXPECT_EQ(choose_columns(4, 1, 480, 270), 2);
  EXPECT_EQ(choose_columns(9, 1, 480, 270), 3);
  EXPECT_EQ(choose_columns(16, 1, 480, 270), 4);
  EXPECT_EQ(choose_columns(5, 1, 480, 330), 3);
  // High cells stand side by side, wide ones below each other.
  EXPECT_EQ(choose_columns(4, 1, 100, 400), 4);
  EXPECT_EQ(choose_columns(4, 1, 900, 100), 1);
  // Four stacks of two in one row; seldom is a place left free.
  EXPECT_EQ(choose_columns(4, 2, 480, 330), 4);
}

TEST(Sheet, APlaceWithoutAPictureStaysFreeOrHoldsTheColourBar) {
  SheetCell scale;
  scale.title = "difference of luminance";
  scale.color_bar = 0.5;
  SheetOptions options;
  options.columns = 2;
  const Sheet sheet = make_sheet({cell(pattern(200, 100, 0), "phong"), scale}, options);
  EXPECT_EQ(sheet.pictures[1].width, 0);
  const SheetBox place{sheet.labels[1].x, sheet.pictures[0].y, 200, 100};
  // Somewhere in the place is a row with the colours of the bar's ends on its left and on its right.
  const std::array<float, 3> low = diverging_color(-1), high = diverging_color(1);
  bool found = false;
  for (int y = place.y; y < place.y + place.height && !found; ++y) {
    int begin = -1, end = -1;
    for (int x = place.x; x < place.x + place.width; ++x) {
      const float* pixel = sheet.image.pixel(x, y);
      const auto near = [&](const std::array<float, 3>& color) {
        return std::abs(pixel[0] - color[0]) + std::abs(pixel[1] - color[1]) + std::abs(pixel[2] - color[2]) <
               0.03f;
      };
      if (begin < 0 && near(low)) begin = x;
      if (near(high)) end = x;
    }
    found = begin >= 0 && end > begin + 100;
  }
  EXPECT_TRUE(found);

  SheetCell nothing;
  nothing.title = "phong";  // as wide and high as the other's, so that the rows are alike
  const Sheet free = make_sheet({cell(pattern(200, 100, 0), "phong"), nothing}, options);
  for (int y = place.y; y < place.y + 100; ++y)
    for (int x = place.x; x < place.x + 200; ++x)
      ASSERT_EQ(free.image.pixel(x, y)[0], free.image.pixel(0, 0)[0]);
}

TEST(Sheet, GreyAndFurtherChannels) {
  const Image grey{2, 1, {"Y"}, {0.25f, 0.5f}};
  const Image more{1, 1, {"A", "B", "G", "R"}, {9, 3, 2, 1}};
  const Sheet sheet = make_sheet({cell(grey, "grey"), cell(more, "more")});
  const SheetBox a = sheet.pictures[0], b = sheet.pictures[1];
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(sheet.image.pixel(a.x + 1, a.y)[c], 0.5f);
    EXPECT_EQ(sheet.image.pixel(b.x, b.y)[c], float(c + 1));
  }
}

TEST(Sheet, LabelsHaveTheSameCodesHoweverTheyAreWritten) {
  const std::vector<SheetCell> cells{cell(pattern(200, 100, 0), "phong")};
  SheetOptions as_they_are;
  as_they_are.encoded = false;
  const Image encoded = make_sheet(cells).image, plain = make_sheet(cells, as_they_are).image;
  EXPECT_NEAR(srgb_from_linear(double(encoded.pixel(0, 0)[0])), double(plain.pixel(0, 0)[0]), 1e-6);
}

TEST(Sheet, RefusesWhatItCannotShow) {
  EXPECT_EQ(message_of({}), "error: a sheet has at least one picture");
  EXPECT_EQ(message_of({cell({1, 1, {"X", "Y"}, {1, 2}}, "")}),
            "error: a sheet shows the channels R, G and B, or a single one; a picture has X, Y");
  EXPECT_EQ(message_of({cell({2, 2, {"R", "G", "B"}, {1, 2, 3}}, "")}),
            "error: a picture of 2 x 2 pixels holds 3 values");
  SheetOptions options;
  options.stack = 0;
  EXPECT_EQ(message_of({cell(pattern(9, 9, 0), "")}, options), "error: a stack of cells is at least 1 high");
  options.stack = 1;
  options.columns = -1;
  EXPECT_EQ(message_of({cell(pattern(9, 9, 0), "")}, options), "error: a sheet has at least one column");
  // 9 x 20000 pixels each, but every place is as large as the largest picture.
  EXPECT_EQ(message_of({cell({1, 20000, {"Y"}, std::vector<float>(20000)}, ""),
                        cell({20000, 1, {"Y"}, std::vector<float>(20000)}, "")}),
            "error: the sheet would be too large: 2 pictures of 20000 x 20000 pixels\n"
            "    hint: smaller pictures, or fewer of them");
}

}  // namespace
}  // namespace lambent
