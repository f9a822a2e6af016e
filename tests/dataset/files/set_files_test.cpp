// SPDX-License-Identifier: MIT
#include "dataset/files/set_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <exception>

#include "dataset/files/atomic_file.h"
#include "dataset/files/text_file.h"
#include "tests/config/rejection.h"
#include "tests/dataset/child_process.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::set_files_test {
namespace {

using Publish = DirectoryFixture;
using ::testing::HasSubstr;

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

TEST_F(Publish, PutsTheBytesUnderTheName) {
  const std::string bytes(3000000, 'x');
  publish_file(directory, "a.h5", bytes_of(bytes));
  publish_file(directory, "b.h5", bytes_of(""));
  EXPECT_TRUE(read_text_file(directory / "a.h5") == bytes);
  EXPECT_EQ(read_text_file(directory / "b.h5"), "");
  publish_file(directory, "a.h5", bytes_of("new"));
  EXPECT_EQ(read_text_file(directory / "a.h5"), "new");
  EXPECT_EQ(names(), (std::set<std::string>{"a.h5", "b.h5"}));
}

TEST_F(Publish, AWrongPlaceIsNamed) {
  EXPECT_THAT(rejection([&] { publish_file(directory / "no", "a.h5", {}); }),
              HasSubstr("no: cannot write: No such file or directory"));
  for (const char* name : {"../a.h5", "/tmp/a.h5", "b/../../a.h5"})
    EXPECT_THAT(rejection([&] { publish_file(directory, name, {}); }),
                HasSubstr("below its directory"));
}

TEST_F(Publish, NoLinkLeadsOutOfTheDirectory) {
  const std::filesystem::path set = directory / "set";
  std::filesystem::create_directories(directory / "theirs");
  std::filesystem::create_directory(set);
  write_text_file(directory / "victim", "victim");
  std::filesystem::create_symlink("../victim", set / "a.h5");
  std::filesystem::create_directory_symlink("../theirs", set / "source");
  publish_file(set, "a.h5", bytes_of("new"));
  EXPECT_EQ(read_text_file(directory / "victim"), "victim");
  EXPECT_FALSE(std::filesystem::is_symlink(set / "a.h5"));
  EXPECT_EQ(read_text_file(set / "a.h5"), "new");
  EXPECT_THROW(publish_file(set, "source/a", {}), std::exception);
  EXPECT_TRUE(std::filesystem::is_empty(directory / "theirs"));
}

TEST_F(Publish, AFullDiskTellsWhatIsNeededAndWhatIsFree) {
  if (unshare(CLONE_NEWNS) != 0 ||
      mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
      mount("tmpfs", directory.c_str(), "tmpfs", 0, "size=65536") != 0)
    GTEST_SKIP() << "cannot mount a file system here";
  publish_file(directory, "a.h5", bytes_of("old"));
  const std::string message = rejection<std::runtime_error>([&] {
    publish_file(directory, "a.h5", bytes_of(std::string(100000, 'x')));
  });
  EXPECT_THAT(message, HasSubstr("a.h5: cannot write: No space left on device; "
                                 "100000 bytes are needed, "));
  EXPECT_THAT(message, HasSubstr(" are free there"));
  EXPECT_EQ(read_text_file(directory / "a.h5"), "old");
  EXPECT_EQ(names(), std::set<std::string>{"a.h5"});
  publish_file(directory, "b.h5", bytes_of(std::string(40000, 'x')));
  EXPECT_EQ(umount(directory.c_str()), 0);
}

TEST_F(Publish, OnlyPartialFilesOfTheDeadAreRemoved) {
  const pid_t alive = fork();
  if (alive == 0) {
    pause();
    _exit(0);
  }
  const std::string dead = "a.h5.partial-" + host_name() + '-' +
                           std::to_string(dead_process()) + "-0";
  const std::string reused =
      "a.h5.partial-" + host_name() + '-' + std::to_string(getpid()) + "-7";
  const std::string living =
      "a.h5.partial-" + host_name() + '-' + std::to_string(alive) + "-0";
  const std::string far = "a.h5.partial-node-17.cluster-99-0";
  const std::set<std::string> others = {"a.h5", "a.h5.partial-", "a.partial-x",
                                        "a.partial-host-1x-0"};
  for (const std::string& name : others) write_text_file(directory / name, "");
  for (const std::string& name : {dead, reused, living, far})
    write_text_file(directory / name, "");
  const AtomicFile own(directory / "b.h5");
  const std::string ours = own.partial_path().filename().string();

  remove_dead_partial_files(Directory(directory), false);
  std::set<std::string> expected = others;
  expected.insert({living, far, ours});
  EXPECT_EQ(names(), expected);
  remove_dead_partial_files(Directory(directory), true);
  expected = others;
  expected.insert(ours);
  EXPECT_EQ(names(), expected);
  EXPECT_TRUE(is_partial_file(ours));
  EXPECT_FALSE(is_partial_file("a.h5"));
  kill(alive, SIGKILL);
  waitpid(alive, nullptr, 0);
}

}  // namespace
}  // namespace beamgyro::internal::set_files_test
