// SPDX-License-Identifier: MIT
#include "dataset/files/directory.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>

#include <array>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <system_error>

#include "dataset/files/atomic_file.h"
#include "tests/dataset/child_process.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::directory_test {
namespace {

namespace fs = std::filesystem;

/// With and without openat2.
class DirectoryTest : public ::testing::TestWithParam<bool>,
                      public TestDirectory {
 protected:
  DirectoryTest() {
    fs::create_directories(directory / "mine" / "deep");
    fs::create_directory(directory / "theirs");
    write_text_file(directory / "theirs" / "secret", "secret");
    write_text_file(directory / "mine" / "deep" / "file", "mine");
    fs::create_symlink("../theirs/secret", directory / "mine" / "link");
    fs::create_directory_symlink("../theirs", directory / "mine" / "way");
  }
  /// Whether `check` holds, in a process of its own.
  bool holds(const std::function<bool(const Directory&)>& check) const {
    return status_of_child([&] {
             if (!GetParam() && !forbid_call(SYS_openat2, ENOSYS)) return 2;
             try {
               return check(Directory(directory / "mine")) ? 0 : 1;
             } catch (const std::exception&) {
               return 3;
             }
           }) == 0;
  }
};

int reason_of(const Directory& directory, const char* name, int flags) {
  try {
    directory.open(name, flags);
    return 0;
  } catch (const std::system_error& error) {
    return error.code().value();
  }
}

TEST_P(DirectoryTest, FilesBelowAreOpenedAndMade) {
  EXPECT_TRUE(holds([](const Directory& mine) {
    std::array<std::byte, 8> text{};
    return mine.open("deep/file", O_RDONLY).read(text) == 4 &&
           reason_of(mine, "deep/new", O_WRONLY | O_CREAT) == 0 &&
           mine.find("deep/new")->is_regular &&
           reason_of(mine, "none", O_RDONLY) == ENOENT;
  }));
}

TEST_P(DirectoryTest, NoLinkIsFollowed) {
  EXPECT_TRUE(holds([](const Directory& mine) {
    return reason_of(mine, "link", O_RDONLY) == ELOOP &&
           reason_of(mine, "way/secret", O_RDONLY) == ELOOP &&
           reason_of(mine, "way/new", O_WRONLY | O_CREAT) == ELOOP &&
           reason_of(mine, "link", O_WRONLY | O_CREAT | O_TRUNC) == ELOOP;
  }));
  EXPECT_EQ(fs::file_size(directory / "theirs" / "secret"), 6u);
  EXPECT_FALSE(fs::exists(directory / "theirs" / "new"));
}

TEST_P(DirectoryTest, ALinkIsFoundAsOne) {
  EXPECT_TRUE(holds([](const Directory& mine) {
    const auto link = mine.find("link");
    return link && link->is_link && !link->is_regular && !mine.find("none") &&
           !mine.find("deep/file/none") && mine.find("deep/file")->bytes == 4;
  }));
}

TEST_P(DirectoryTest, DirectoriesAreMadeBelowOnly) {
  EXPECT_TRUE(holds([](const Directory& mine) {
    mine.make_subdirectory("a/b/c");
    mine.make_subdirectory("a/b/c");
    try {
      mine.make_subdirectory("way/a");
      return false;
    } catch (const std::system_error&) {
      return true;
    }
  }));
  EXPECT_TRUE(fs::is_directory(directory / "mine" / "a" / "b" / "c"));
  EXPECT_FALSE(fs::exists(directory / "theirs" / "a"));
}

TEST_P(DirectoryTest, NamesThatLeadOutAreRejected) {
  EXPECT_TRUE(holds([](const Directory& mine) {
    for (const char* name :
         {"..", "../theirs/secret", "deep/../../theirs/secret", "/etc/passwd",
          "", ".", "deep/"}) {
      try {
        mine.open(name, O_RDONLY);
        return false;
      } catch (const std::invalid_argument&) {
      }
    }
    return true;
  }));
}

INSTANTIATE_TEST_SUITE_P(, DirectoryTest, ::testing::Values(true, false),
                         [](const auto& each) {
                           return each.param ? "WithOpenat2" : "WithoutOpenat2";
                         });

TEST(FileState, AFileThatWasSwappedAndSwappedBackIsAnother) {
  const TestDirectory directory;
  const auto file = directory.directory / "a",
             other = directory.directory / "b";
  std::ofstream(file) << "one";
  std::ofstream(other) << "two";
  const FileState before = state_of_file(file);
  EXPECT_EQ(before, state_of_file(file));
  // The clock of a file system ticks every few milliseconds.
  for (int tries = 0; tries < 100000; ++tries) {
    std::filesystem::rename(file, directory.directory / "c");
    std::filesystem::rename(other, file);
    std::filesystem::rename(file, other);
    std::filesystem::rename(directory.directory / "c", file);
    if (state_of_file(file) != before) return;
  }
  FAIL() << "the file still has the state it had before";
}

TEST(FileState, OfAFileThatIsNotThereIsZero) {
  EXPECT_EQ(state_of_file("/nowhere/at/all"), FileState{});
}

}  // namespace
}  // namespace beamgyro::internal::directory_test
