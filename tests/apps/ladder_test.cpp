// `lambent compare --ladder`: every rung on one sheet.

#include <gtest/gtest.h>

#include "lambent/image.h"
#include "run_program.h"
#include "support.h"

namespace lambent::test {
namespace {

TEST(Ladder, ShowsEveryRungOnOneSheet) {
  const TemporaryDirectory folder;
  const std::string sheet = folder.file("sheet.png");
  const std::string box = std::string(LAMBENT_SOURCE_DIR) + "/scenes/cornell.yaml";
  const ProgramResult result = run_program(
      {"compare", box, "--ladder", "--size", "24x24", "--samples", "2", "-o", sheet}, folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("9 pictures of 24 x 24"), std::string::npos) << result.err;
  EXPECT_GT(read_image(sheet).image.width, 3 * 24);
}

TEST(Ladder, IsInPlaceOfModels) {
  const TemporaryDirectory folder;
  EXPECT_EQ(run_program({"compare", "scene.yaml", "--ladder", "--models", "phong"}, folder.path()).exit_code,
            2);
}

}  // namespace
}  // namespace lambent::test
