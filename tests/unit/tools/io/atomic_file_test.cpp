// SPDX-License-Identifier: Apache-2.0
#include "tools/io/atomic_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "tests/unit/tools/io/temp_folder.hpp"
#include "tools/io/text_rows.hpp"

namespace mapweld::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Files of this process may not grow beyond a size while this lives: the nearest thing to a full disk without one.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit now = before_;
    now.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &now);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(AtomicFile, PutsTheWholeFileInPlace) {
  const test::TempFolder folder;
  const std::string big(1'000'000, 'x');  // more than one buffer
  {
    AtomicFile file(folder / "map.ply");
    file.Write("head\n");
    file.Write(big);
    EXPECT_FALSE(std::filesystem::exists(folder / "map.ply")) << "visible before it is complete";
    file.Commit();
  }
  EXPECT_EQ(ReadFile(folder / "map.ply"), "head\n" + big);
  EXPECT_THAT(folder.Files(), ElementsAre("map.ply"));
}

TEST(AtomicFile, KeepsTheOldFileAndLeavesNothingWhenNotCommitted) {
  const test::TempFolder folder;
  folder.Put("map.ply", "old");
  {
    AtomicFile file(folder / "map.ply");
    file.Write("new");
  }
  EXPECT_EQ(ReadFile(folder / "map.ply"), "old");
  EXPECT_THAT(folder.Files(), ElementsAre("map.ply"));
}

TEST(AtomicFile, KeepsTheOldFileAndLeavesNothingWhenTheDiskIsFull) {
  const test::TempFolder folder;
  folder.Put("map.ply", "old");
  std::string error;
  {
    const FileSizeLimit limit(300'000);
    error = test::ErrorOf([&] {
      AtomicFile file(folder / "map.ply");
      for (int i = 0; i < 10; ++i) file.Write(std::string(100'000, 'x'));
      file.Commit();
    });
  }
  EXPECT_THAT(error, HasSubstr("map.ply"));
  EXPECT_THAT(error, HasSubstr("File too large"));
  EXPECT_EQ(ReadFile(folder / "map.ply"), "old");
  EXPECT_THAT(folder.Files(), ElementsAre("map.ply"));
}

TEST(AtomicFile, NoticesAFullDeviceAlsoWhenTheTextFitsItsBuffer) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this machine has no /dev/full";
  const std::string error = test::ErrorOf([] { WriteFileAtomically("/dev/full", "a few bytes"); });
  EXPECT_THAT(error, HasSubstr("cannot write /dev/full: No space left on device; free some space"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full")) << "the device was replaced";
}

TEST(AtomicFile, WritesThroughDevicesWithoutReplacingThem) {
  WriteFileAtomically("/dev/null", "gone");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(AtomicFile, ReplacesTheFileBehindALinkAndKeepsTheLink) {
  const test::TempFolder folder;
  folder.Put("real.txt", "old");
  std::filesystem::create_symlink("real.txt", folder / "link.txt");
  WriteFileAtomically(folder / "link.txt", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(ReadFile(folder / "real.txt"), "new");
}

TEST(AtomicFile, SaysWhatToDoWhenTheFolderIsMissing) {
  const test::TempFolder folder;
  const std::string error = test::ErrorOf([&] { AtomicFile file(folder / "no/such/map.ply"); });
  EXPECT_THAT(error, HasSubstr("no/such/map.ply"));
  EXPECT_THAT(error, HasSubstr("create the folder first"));
}

TEST(AtomicFile, RefusesAFolderAsTarget) {
  const test::TempFolder folder;
  EXPECT_THAT(test::ErrorOf([&] { AtomicFile file(folder.path()); }), HasSubstr("name a file, not a folder"));
  EXPECT_THAT(folder.Files(), IsEmpty());
}

TEST(AtomicFile, LeavesNothingBehindAProgramThatEndsInTheMiddle) {
  const test::TempFolder folder;
  WriteFileAtomically(folder / "map.ply", "old");
  const pid_t child = ::fork();
  if (child == 0) {
    AtomicFile file(folder / "map.ply");
    AtomicFile other(folder / "other.ply");
    file.Write(std::string(1 << 20, 'x'));
    AtomicFile::RemoveTemporaries();
    ::_exit(0);
  }
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_EQ(ReadFile(folder / "map.ply"), "old");
  EXPECT_THAT(folder.Files(), ElementsAre("map.ply"));
}

TEST(AtomicFile, LetsTwoWritersOfOneTargetEachWriteAWholeFile) {
  const test::TempFolder folder;
  AtomicFile first(folder / "map.ply");
  AtomicFile second(folder / "map.ply");
  first.Write("first");
  second.Write("second");
  first.Commit();
  EXPECT_EQ(ReadFile(folder / "map.ply"), "first");
  second.Commit();
  EXPECT_EQ(ReadFile(folder / "map.ply"), "second");
  EXPECT_THAT(folder.Files(), ElementsAre("map.ply"));
}

}  // namespace
}  // namespace mapweld::io
