// docs/lecture.md quotes the source and shows pictures. This sees to it that the quotes are true, that each
// picture is what the command beside it makes, and that the links of every page lead somewhere.

#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "lambent/image.h"
#include "run_program.h"
#include "support.h"

namespace lambent {
namespace {

const std::string root = LAMBENT_SOURCE_DIR;

/// A fenced block of a page: ```kind ... ```.
struct Block {
  std::string kind, text;
  std::string
      file;  ///< Where the line before it is `some/file`: and nothing else, that file; otherwise empty.
  int line = 0;
};

std::vector<Block> blocks_of(const std::string& page) {
  std::vector<Block> blocks;
  std::istringstream lines(test::read_text(root + "/" + page));
  std::string line, last_with_text;
  bool inside = false;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.starts_with("```")) {
      inside = !inside;
      if (!inside) continue;
      Block block{line.substr(3), "", "", number};
      const std::string& name = last_with_text;
      if (name.size() > 3 && name.front() == '`' && name.ends_with("`:"))
        block.file = name.substr(1, name.size() - 3);
      blocks.push_back(block);
    } else if (inside) {
      blocks.back().text += line + "\n";
    } else if (!line.empty()) {
      last_with_text = line;
    }
  }
  EXPECT_FALSE(inside) << page << ": a block of code has no end";
  return blocks;
}

/// Without white space: a quote stays true when its lines are broken elsewhere.
std::string squeezed(const std::string& text) {
  std::string result;
  for (const char c : text)
    if (!std::isspace(static_cast<unsigned char>(c))) result += c;
  return result;
}

TEST(Lecture, QuotesTheSource) {
  int quotes = 0;
  for (const Block& block : blocks_of("docs/lecture.md")) {
    if (block.kind != "cpp") continue;
    SCOPED_TRACE("docs/lecture.md:" + std::to_string(block.line));
    ASSERT_NE(block.file, "") << "the line above a quote names its file: `src/...`:";
    ASSERT_TRUE(std::filesystem::exists(root + "/" + block.file)) << block.file;
    EXPECT_NE(squeezed(test::read_text(root + "/" + block.file)).find(squeezed(block.text)),
              std::string::npos)
        << block.file << " does not read like this any more:\n"
        << block.text;
    ++quotes;
  }
  EXPECT_GT(quotes, 0);
}

TEST(Lecture, PicturesAreWhatTheCommandsMake) {
  const test::TemporaryDirectory folder;
  const std::string program = "build/release/lambent ", output = " -o docs/pictures/";
  int pictures = 0;
  for (const Block& block : blocks_of("docs/lecture.md")) {
    if (block.kind != "sh") continue;
    SCOPED_TRACE("docs/lecture.md:" + std::to_string(block.line));
    const std::size_t o = block.text.find(output);
    ASSERT_TRUE(block.text.starts_with(program) && o != std::string::npos) << block.text;
    const std::string options = block.text.substr(program.size(), o - program.size());
    std::string name = block.text.substr(o + output.size());
    name.erase(name.find_last_not_of('\n') + 1);

    const auto run =
        test::run_shell("exec \"$LAMBENT\" " + options + " --quiet -o " + folder.file(name), root);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Difference difference = compare_images(read_image(root + "/docs/pictures/" + name).image,
                                                 read_image(folder.file(name)).image);
    EXPECT_EQ(difference.differing_pixels, 0u) << "docs/pictures/" << name << " is old: run script/docs";
    ++pictures;
  }
  EXPECT_GT(pictures, 0);
}

TEST(Readme, ShowsTheSheetThatItsCommandMakes) {
  const std::string begin = "\n    build/release/lambent compare ";
  const std::string page = test::read_text(root + "/README.md");
  const std::size_t at = page.find(begin);
  ASSERT_NE(at, std::string::npos);
  const std::string options =
      page.substr(at + begin.size(), page.find('\n', at + begin.size()) - at - begin.size());
  const test::TemporaryDirectory folder;
  const std::string sheet = folder.file("sheet.png");
  const auto run = test::run_shell("exec \"$LAMBENT\" compare " + options + " -q -o " + sheet, root);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Difference difference =
      compare_images(read_image(root + "/docs/pictures/compare.png").image, read_image(sheet).image);
  const int pixels = difference.picture.width * difference.picture.height;
  // Letters take up 2 % of the sheet, and another version of the font may draw their edges otherwise.
  EXPECT_LT(difference.differing_pixels, std::size_t(pixels / 100))
      << "docs/pictures/compare.png is old: run script/pictures compare";
}

TEST(Pages, PointAtWhatIsThere) {
  for (const char* page : {"README.md", "HACKING.md", "CONTRIBUTING.md", "docs/lecture.md", "docs/layers.md",
                           "docs/denoising.md", "docs/explain.md", "docs/benchmarks.md", "docs/gallery.md",
                           "docs/gltf.md", "scenes/README.md", "fuzz/README.md"}) {
    const auto folder = std::filesystem::path(root + "/" + page).parent_path();
    std::istringstream lines(test::read_text(root + "/" + page));
    std::string line;
    bool code = false;
    while (std::getline(lines, line)) {
      if (line.find("```") != std::string::npos) code = !code;
      if (code) continue;
      // What follows "](" and is no address elsewhere or in the page itself is a file of ours.
      const std::string opening = "](";
      for (std::size_t at = line.find(opening); at != std::string::npos; at = line.find(opening, at + 1)) {
        const std::size_t from = at + opening.size();
        const std::string link = line.substr(from, line.find_first_of(")#", from) - from);
        if (link.empty() || link.find("://") != std::string::npos) continue;
        EXPECT_TRUE(std::filesystem::exists(folder / link)) << page << " points at " << link;
      }
    }
  }
}

}  // namespace
}  // namespace lambent
