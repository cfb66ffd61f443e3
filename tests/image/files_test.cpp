#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "lambent/diagnostics.h"
#include "lambent/image.h"
#include "support.h"

namespace lambent {
namespace {

namespace fs = std::filesystem;

const Image red{2, 1, {"R", "G", "B"}, {1, 0, 0, 1, 0, 0}};

/// What the action throws, as "InputError: ..." or "Failure: ...".
template <class Action> std::string thrown_by(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return std::string("InputError: ") + error.what();
  } catch (const Failure& error) {
    return std::string("Failure: ") + error.what();
  }
  return "";
}

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  return names;
}

TEST(ImageFiles, TheEndingNamesTheFormatInAnyCase) {
  const test::TemporaryDirectory folder;
  for (const char* name : {"a.png", "b.PNG", "c.Exr", "d.v2.exr"}) {
    write_image(folder.file(name), red, {{"Title", "red"}});
    const ReadImage read = read_image(folder.file(name));
    EXPECT_EQ(read.image.data, red.data) << name;
    EXPECT_EQ(read.metadata, (Metadata{{"Title", "red"}})) << name;
  }
  EXPECT_EQ(test::read_text(folder.file("b.PNG")).substr(1, 3), "PNG");
  EXPECT_EQ(test::read_text(folder.file("c.Exr")).substr(0, 4), "\x76\x2f\x31\x01");
  EXPECT_EQ(names_in(folder.path()).size(), 4u);  // no temporary file is left
}

TEST(ImageFiles, UnknownEndings) {
  EXPECT_EQ(thrown_by([] { write_image("out/a.jpg", red); }),
            "InputError: out/a.jpg: error: unknown picture format '.jpg'\n    hint: the endings known are "
            ".png and .exr");
  EXPECT_EQ(thrown_by([] { write_image("picture", red); }),
            "InputError: picture: error: the name has no ending that says the picture's format\n"
            "    hint: the endings known are .png and .exr");
}

TEST(ImageFiles, PicturesThatAreNone) {
  EXPECT_EQ(thrown_by([] { write_image("a.png", Image{}); }),
            "InputError: a.png: error: a picture of 0 x 0 pixels with 3 channels cannot be written");
  EXPECT_EQ(thrown_by([] {
              write_image("a.exr", {2, 2, {"R"}, {1, 2, 3}});
            }),
            "InputError: a.exr: error: the picture holds 3 values where 4 belong");
  EXPECT_EQ(thrown_by([] {
              write_image("a.exr", {1, 1, {"R", "R"}, {1, 2}});
            }),
            "InputError: a.exr: error: the picture has two channels of the name 'R'");
}

TEST(ImageFiles, AMissingFolderIsNotCreated) {
  const test::TemporaryDirectory folder;
  const std::string path = folder.file("none/a.png");
  EXPECT_EQ(thrown_by([&] { write_image(path, red); }),
            "Failure: cannot write " + path + ": the folder " + folder.file("none") + " does not exist");
  EXPECT_FALSE(fs::exists(folder.file("none")));
}

TEST(ImageFiles, AFolderIsNoPicture) {
  const test::TemporaryDirectory folder;
  fs::create_directory(folder.file("a.png"));
  EXPECT_EQ(thrown_by([&] { write_image(folder.file("a.png"), red); }),
            "Failure: cannot write " + folder.file("a.png") + ": it is a folder");
  EXPECT_EQ(thrown_by([&] { read_image(folder.file("a.png")); }),
            "InputError: " + folder.file("a.png") + ": error: cannot open the picture: it is a folder");
}

/// Files may grow to `bytes` only, as on a full disk; the write then fails with EFBIG ("File too large").
struct FileSizeLimit {
  explicit FileSizeLimit(rlim_t bytes) {
    previous = std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &limit);
    const rlimit small{bytes, limit.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, previous);
  }
  rlimit limit{};
  void (*previous)(int) = nullptr;
};

TEST(ImageFiles, AFailureLeavesWhatStoodThere) {
  const test::TemporaryDirectory folder;
  for (const char* name : {"a.png", "a.exr"}) {
    const std::string path = folder.file(name);
    write_image(path, red);
    const std::string before = test::read_text(path);
    Image noise{200, 200, {"R", "G", "B"}, {}};
    for (unsigned i = 0; i < 200 * 200 * 3; ++i)
      noise.data.push_back(float(i * 2654435761u % 1009u) / 1009.0f);
    std::string message;
    {
      const FileSizeLimit limit(4096);
      message = thrown_by([&] { write_image(path, noise); });
    }
    EXPECT_EQ(message, "Failure: cannot write " + path + ": File too large");
    EXPECT_EQ(test::read_text(path), before);
    EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{name});  // the temporary file is gone
    fs::remove(path);
  }
}

TEST(ImageFiles, AFailedEncodingTouchesNothing) {
  const test::TemporaryDirectory folder;
  test::write_text(folder.file("a.png"), "old");
  EXPECT_NE(thrown_by([&] { write_image(folder.file("a.png"), {1, 1, {"X", "Y", "Z"}, {0, 0, 0}}); }), "");
  EXPECT_EQ(test::read_text(folder.file("a.png")), "old");
  EXPECT_EQ(names_in(folder.path()).size(), 1u);
}

TEST(ImageFiles, ReplacingKeepsPermissionsAndLinks) {
  const test::TemporaryDirectory folder;
  const std::string real = folder.file("real.png"), link = folder.file("link.png");
  test::write_text(real, "old");
  ASSERT_EQ(::chmod(real.c_str(), 0640), 0);
  fs::create_symlink("real.png", link);
  write_image(link, red);
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_image(real).image.data, red.data);
  EXPECT_EQ(fs::status(real).permissions(), fs::perms(0640));
}

TEST(ImageFiles, ADeviceIsWrittenToAndNotReplaced) {
  const test::TemporaryDirectory folder;
  const std::string link = folder.file("nothing.png");
  fs::create_symlink("/dev/null", link);
  write_image(link, red);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(names_in(folder.path()).size(), 1u);
}

TEST(ImageFiles, AFullDiskIsNamedAsTheReason) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "This system has no /dev/full.";
  const test::TemporaryDirectory folder;
  const std::string link = folder.file("a.png");
  fs::create_symlink("/dev/full", link);
  EXPECT_EQ(thrown_by([&] { write_image(link, red); }),
            "Failure: cannot write " + link + ": No space left on device");
}

TEST(ImageFiles, ReadingSaysWhyNot) {
  const test::TemporaryDirectory folder;
  const std::string path = folder.file("a.png");
  EXPECT_EQ(thrown_by([&] { read_image(path); }),
            "InputError: " + path + ": error: cannot open the picture: No such file or directory");
  test::write_text(path, "");
  EXPECT_EQ(thrown_by([&] { read_image(path); }), "InputError: " + path + ": error: the file is empty");
  test::write_text(path, "P6 1 1 255 ...");
  EXPECT_EQ(thrown_by([&] { read_image(path); }),
            "InputError: " + path +
                ": error: this is no image of a known format\n"
                "    hint: PNG, JPEG, Radiance HDR, OpenEXR, TGA and BMP are read");
  EXPECT_EQ(thrown_by([] { read_image("/dev/zero"); }),
            "InputError: /dev/zero: error: cannot open the picture: it is not a file");
}

TEST(ImageFiles, TheContentNamesTheFormatWhenReading) {
  const test::TemporaryDirectory folder;
  write_image(folder.file("a.exr"), red);
  fs::rename(folder.file("a.exr"), folder.file("a.png"));
  EXPECT_EQ(read_image(folder.file("a.png")).image.data, red.data);
}

}  // namespace
}  // namespace lambent
