// Pictures of others: all features of the formats, and files made to break readers.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "image/srgb.h"
#include "lambent/diagnostics.h"
#include "lambent/image.h"
#include "support.h"

namespace lambent {
namespace {

namespace fs = std::filesystem;

/// The files under `folder` of the data, in order; none where the data is not there.
std::vector<std::string> files_in(const std::string& folder) {
  const auto data = test::data_dir();
  std::vector<std::string> files;
  std::error_code error;
  if (data)
    for (const auto& entry : fs::recursive_directory_iterator(*data + "/" + folder, error))
      if (entry.is_regular_file()) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

/// The most memory that this program has held so far.
long peak_memory_megabytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

#define SKIP_WITHOUT(files) \
  if ((files).empty()) GTEST_SKIP() << "The data of others is not here: set LAMBENT_DATA to its folder."

/// The picture, whole in itself; or nothing where the reader refuses it, with an error that names the file.
std::optional<Image> read_or_refuse(const std::string& path) {
  try {
    Image image = read_image(path).image;
    EXPECT_GT(image.width, 0) << path;
    EXPECT_EQ(image.data.size(), std::size_t(image.width) * std::size_t(image.height) * image.channels.size())
        << path;
    return image;
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().at(0).place.file, path);
    EXPECT_GT(error.diagnostics().at(0).message.size(), 10u) << path;
    return std::nullopt;
  }
}

TEST(Corpus, PngSuiteIsReadAndItsCorruptFilesAreRefused) {
  std::vector<std::string> files = files_in("png/pngsuite");
  SKIP_WITHOUT(files);
  int read = 0, refused = 0;
  for (const std::string& path : files) {
    if (fs::path(path).extension() != ".png") continue;
    const std::string name = fs::path(path).filename().string();
    const bool corrupt = name[0] == 'x';
    EXPECT_EQ(read_or_refuse(path).has_value(), !corrupt) << name;
    ++(corrupt ? refused : read);
  }
  EXPECT_GT(read, 80);
  EXPECT_GT(refused, 5);
}

TEST(Corpus, PngSuiteInterlacedPicturesEqualTheirTwins) {
  const std::vector<std::string> files = files_in("png/pngsuite");
  SKIP_WITHOUT(files);
  int compared = 0;
  for (const std::string& path : files) {
    const std::string name = fs::path(path).filename().string();
    if (name.compare(0, 1, "s") != 0 || name.find('i') != 3) continue;  // s01i3p01.png: size 1, interlaced
    std::string twin = path;
    twin[path.size() - name.size() + 3] = 'n';
    if (!fs::exists(twin)) continue;
    EXPECT_EQ(compare_images(read_image(path).image, read_image(twin).image).differing_pixels, 0u) << name;
    ++compared;
  }
  EXPECT_GT(compared, 4);
}

TEST(Corpus, PngMetadataOfOthers) {
  const auto data = test::data_dir();
  if (!data || !fs::exists(*data + "/png/pngsuite/ctzn0g04.png"))
    GTEST_SKIP() << "The data of others is not here: set LAMBENT_DATA to its folder.";
  const auto value = [&](const std::string& name, const std::string& key) -> std::string {
    for (const auto& [k, v] : read_image(*data + "/png/pngsuite/" + name).metadata)
      if (k == key) return v;
    return "(none)";
  };
  EXPECT_EQ(value("ct1n0g04.png", "Title"), "PngSuite");  // tEXt
  EXPECT_EQ(value("ctzn0g04.png", "Title"), "PngSuite");  // zTXt
  EXPECT_NE(value("cthn0g04.png", "Title"), "(none)");    // iTXt with a translated keyword: still "Title"
  EXPECT_NE(value("ct1n0g04.png", "Author").find("Willem"), std::string::npos);
}

TEST(Corpus, PngCrashersAreReadOrRefused) {
  const std::vector<std::string> files = files_in("png/libpng-crashers");
  SKIP_WITHOUT(files);
  for (const std::string& path : files) {
    const long before = peak_memory_megabytes();
    read_or_refuse(path);
    // Chunks in these files of 57 bytes claim a gigabyte.
    EXPECT_LT(peak_memory_megabytes() - before, 100) << path;
  }
  EXPECT_GE(files.size(), 10u);
}

TEST(Corpus, EveryOpenExrImageIsRead) {
  const std::vector<std::string> files = files_in("exr/openexr-images");
  SKIP_WITHOUT(files);
  for (const std::string& path : files) EXPECT_TRUE(read_or_refuse(path).has_value()) << path;
}

TEST(Corpus, OpenExrDataWindowsDecideTheSize) {
  const auto data = test::data_dir();
  const std::string folder = data.value_or("") + "/exr/openexr-images/";
  if (!data || !fs::exists(folder))
    GTEST_SKIP() << "The data of others is not here: set LAMBENT_DATA to its folder.";
  const auto size = [&](const std::string& name) {
    const Image image = read_image(folder + name).image;
    return std::pair(image.width, image.height);
  };
  // The data is 400 x 300 in all; the display window is smaller in t04, larger in t07, elsewhere in t09 and
  // t14, and the data of t08 begins at (30, 40).
  for (const char* name : {"t01.exr", "t04.exr", "t07.exr", "t08.exr", "t09.exr", "t14.exr"})
    EXPECT_EQ(size(std::string("DisplayWindow/") + name), std::pair(400, 300)) << name;
  EXPECT_EQ(size("ScanLines/Desk.exr"), std::pair(644, 874));
}

TEST(Corpus, AllHalfValuesAreExact) {
  const auto data = test::data_dir();
  const std::string path = data.value_or("") + "/exr/openexr-images/TestImages/AllHalfValues.exr";
  if (!fs::exists(path)) GTEST_SKIP() << "The data of others is not here: set LAMBENT_DATA to its folder.";
  const Image image = read_image(path).image;
  ASSERT_EQ(image.width * image.height, 65536);
  int nans = 0, infinities = 0;
  float smallest = 1, largest = 0;
  for (std::size_t i = 0; i < image.data.size(); i += image.channels.size()) {
    const float value = image.data[i];
    nans += std::isnan(value);
    infinities += std::isinf(value);
    if (value > 0) smallest = std::min(smallest, value);
    if (std::isfinite(value)) largest = std::max(largest, value);
  }
  EXPECT_EQ(infinities, 2);
  EXPECT_EQ(nans, 2 * 1023);
  EXPECT_EQ(smallest, 0x1p-24f);
  EXPECT_EQ(largest, 65504.0f);
}

TEST(Corpus, DamagedExrFilesAreReadOrRefused) {
  const std::vector<std::string> files = files_in("exr/damaged");
  SKIP_WITHOUT(files);
  int refused = 0;
  const long before = peak_memory_megabytes();
  for (const std::string& path : files) refused += !read_or_refuse(path).has_value();
  EXPECT_LT(peak_memory_megabytes() - before, 500);
  EXPECT_GT(refused, int(files.size()) / 2);
}

}  // namespace
}  // namespace lambent
