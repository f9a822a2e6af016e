// SPDX-License-Identifier: MIT
#include "dataset/files/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "dataset/files/text_file.h"
#include "tests/config/rejection.h"
#include "tests/dataset/child_process.h"
#include "tests/dataset/system_calls.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::atomic_file_test {
namespace {

namespace fs = std::filesystem;

using AtomicFileTest = DirectoryFixture;

TEST_F(AtomicFileTest, TheFileAppearsWhenItIsPublished) {
  const fs::path path = directory / "a b.txt";
  write_text_file(path, "old");
  {
    AtomicFile file(path);
    EXPECT_EQ(file.partial_path().parent_path(), directory);
    EXPECT_NE(file.partial_path().extension(), ".txt");
    std::ofstream(file.partial_path()) << "new";
    EXPECT_EQ(read_text_file(path), "old");
    file.publish();
    EXPECT_EQ(read_text_file(path), "new");
  }
  EXPECT_EQ(read_text_file(path), "new");
  EXPECT_EQ(names().size(), 1u);
}

TEST_F(AtomicFileTest, NothingIsLeftWithoutPublishing) {
  const fs::path path = directory / "a.txt";
  write_text_file(path, "old");
  {
    const AtomicFile file(path);
    std::ofstream(file.partial_path()) << "half";
    EXPECT_EQ(names().size(), 2u);
  }
  EXPECT_EQ(names().size(), 1u);
  EXPECT_EQ(read_text_file(path), "old");
}

TEST_F(AtomicFileTest, TwoWritersOfOneNameDoNotMeet) {
  const fs::path path = directory / "a.txt";
  AtomicFile first(path);
  AtomicFile second(path);
  ASSERT_NE(first.partial_path(), second.partial_path());
  std::ofstream(first.partial_path()) << "first";
  std::ofstream(second.partial_path()) << "second";
  second.publish();
  first.publish();
  EXPECT_EQ(read_text_file(path), "first");
}

TEST_F(AtomicFileTest, WritesAnyBytes) {
  const std::string bytes =
      std::string("\0\r\n\xff", 4) + std::string(1 << 20, 'x');
  write_text_file(directory / "bytes", bytes);
  EXPECT_EQ(read_text_file(directory / "bytes"), bytes);
  write_text_file(directory / "empty", "");
  EXPECT_EQ(read_text_file(directory / "empty"), "");
}

TEST_F(AtomicFileTest, AWrongPlaceIsNamed) {
  const std::string f = directory.string();
  EXPECT_EQ(rejection([&] { require_writable(directory / "no" / "a.txt"); }),
            f + "/no/a.txt: cannot write: directory " + f +
                "/no: No such file or directory; expected one that is there "
                "and writable");
  EXPECT_EQ(rejection([&] { write_text_file(directory, "x"); }),
            f + ": cannot write: it is a directory; expected a file name");
  write_text_file(directory / "plain", "");
  EXPECT_EQ(rejection([&] { require_writable(directory / "plain" / "a.txt"); }),
            f + "/plain/a.txt: cannot write: directory " + f +
                "/plain: Not a directory; expected one that is there and "
                "writable");
  EXPECT_EQ(rejection([&] { require_writable(""); }),
            "an output file has no name");
  EXPECT_THROW(require_writable(directory / std::string(255, 'n')),
               std::invalid_argument);
  EXPECT_EQ(names().size(), 1u);
}

TEST_F(AtomicFileTest, DevicesAreNotReplaced) {
  EXPECT_EQ(rejection([&] { require_writable("/dev/null"); }),
            "/dev/null: cannot write: it is a device, pipe or socket; expected "
            "a file name");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(AtomicFileTest, ALinkStaysAndWhatItNamesIsReplaced) {
  write_text_file(directory / "target", "old");
  fs::create_symlink("target", directory / "link");
  write_text_file(directory / "link", "new");
  EXPECT_TRUE(fs::is_symlink(directory / "link"));
  EXPECT_EQ(read_text_file(directory / "target"), "new");
}

/// Takes away the superuser's right to write anywhere.
class OrdinaryUser {
 public:
  OrdinaryUser() {
    if (user_ == 0 && seteuid(65534) != 0) ADD_FAILURE() << "seteuid";
  }
  ~OrdinaryUser() {
    if (user_ == 0 && seteuid(user_) != 0) ADD_FAILURE() << "seteuid";
  }

 private:
  uid_t user_ = geteuid();
};

TEST_F(AtomicFileTest, UnwritableDirectoriesAndFilesAreRejected) {
  const fs::path path = directory / "a.txt";
  write_text_file(path, "old");
  fs::permissions(path, fs::perms{0444});
  fs::permissions(directory, fs::perms{0555});
  {
    const OrdinaryUser user;
    EXPECT_EQ(rejection([&] { require_writable(path); }),
              path.string() +
                  ": cannot write: the file that is there is write-protected");
    EXPECT_EQ(rejection([&] { require_writable(directory / "b.txt"); }),
              directory.string() + "/b.txt: cannot write: directory " +
                  directory.string() +
                  ": Permission denied; expected one that is there and "
                  "writable");
  }
  fs::permissions(directory, fs::perms::owner_all);
  EXPECT_EQ(read_text_file(path), "old");
}

// A limit on the size of files fails like a full disk.
TEST_F(AtomicFileTest, AFullDiskLeavesWhatWasThere) {
  const fs::path path = directory / "a.txt";
  write_text_file(path, "old");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto on_limit = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit = before;
  limit.rlim_cur = 1000;
  setrlimit(RLIMIT_FSIZE, &limit);
  const std::string message = rejection<std::runtime_error>(
      [&] { write_text_file(path, std::string(5000, 'x')); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, on_limit);
  EXPECT_EQ(message, path.string() + ": cannot write: File too large");
  EXPECT_EQ(read_text_file(path), "old");
  EXPECT_EQ(names().size(), 1u);
}

TEST_F(AtomicFileTest, ASignalHandlerCanRemovePartialFiles) {
  const fs::path path = directory / "a.txt";
  const int status = status_of_child([&] {
    std::signal(SIGTERM, [](int) {
      remove_partial_files();
      _exit(143);
    });
    const AtomicFile file(path);
    AtomicFile published(directory / "b.txt");
    published.publish();
    std::raise(SIGTERM);
    return 0;
  });
  EXPECT_EQ(status, 143);
  EXPECT_EQ(names().size(), 1u);
  EXPECT_TRUE(fs::exists(directory / "b.txt"));
}

TEST_F(AtomicFileTest, TheFileThatIsReplacedHandsOnItsMode) {
  const fs::path path = directory / "a.txt";
  for (const unsigned mode : {0600u, 0664u, 0755u, 0444u}) {
    write_text_file(path, "old");
    fs::permissions(path, fs::perms{mode});
    {
      const AtomicFile file(path);
      // Nor is the unfinished one for other eyes.
      EXPECT_EQ(fs::status(file.partial_path()).permissions() &
                    ~fs::perms{mode} & ~fs::perms{0600},
                fs::perms::none);
    }
    write_text_file(path, "new");
    EXPECT_EQ(fs::status(path).permissions(), fs::perms{mode});
  }
}

// Else a crash of the machine may leave an empty file under the name.
TEST_F(AtomicFileTest, BytesAreOnTheDiskBeforeTheName) {
  SystemCalls calls;
  write_text_file(directory / "a.txt", "text");
  std::vector<std::string> made = calls.made();
  std::erase_if(made, [](const std::string& name) {
    return name != "fsync" && name != "renameat";
  });
  EXPECT_EQ(made, (std::vector<std::string>{"fsync", "renameat", "fsync"}));
}

TEST_F(AtomicFileTest, AFileInThePlaceOfThePartialOneIsNotTouched) {
  write_text_file(directory / "victim", "victim");
  const fs::path path = directory / "a.txt";
  AtomicFile file(path);
  fs::remove(file.partial_path());
  fs::create_symlink("victim", file.partial_path());
  file.file().write(std::as_bytes(std::span("text", 4)));
  EXPECT_TRUE(holds(rejection<std::runtime_error>([&] { file.publish(); }),
                    "replaced"));
  EXPECT_EQ(read_text_file(directory / "victim"), "victim");
  EXPECT_FALSE(fs::exists(path));
}

TEST_F(AtomicFileTest, WhatADeadProcessLeftIsRemovedByTheNext) {
  const auto partial = [&](const std::string& name, const std::string& host,
                           pid_t process) {
    return directory /
           (name + ".partial-" + host + "-" + std::to_string(process) + "-0");
  };
  const fs::path dead = partial("a.txt", host_name(), dead_process());
  const std::vector<fs::path> others = {
      partial("a.txt", host_name(), getppid()),
      partial("a.txt", "elsewhere", dead_process()),
      partial("b.txt", host_name(), dead_process())};
  write_text_file(dead, "half");
  for (const fs::path& other : others) write_text_file(other, "half");
  write_text_file(directory / "a.txt", "text");
  EXPECT_FALSE(fs::exists(dead));
  for (const fs::path& other : others) EXPECT_TRUE(fs::exists(other)) << other;
}

TEST_F(AtomicFileTest, ALinkOfAnotherUserInADirectoryForAllIsNotFollowed) {
  if (geteuid() != 0) GTEST_SKIP() << "another user's files need root";
  write_text_file(directory / "target", "old");
  fs::create_directory(directory / "all");
  fs::permissions(directory / "all", fs::perms{01777});
  fs::create_symlink("../target", directory / "all" / "link");
  ASSERT_EQ(lchown((directory / "all" / "link").c_str(), 65534, 65534), 0);
  ASSERT_EQ(chown((directory / "all").c_str(), 65533, 65533), 0);
  EXPECT_TRUE(holds(
      rejection([&] { write_text_file(directory / "all" / "link", "new"); }),
      "another user"));
  EXPECT_EQ(read_text_file(directory / "target"), "old");
}

TEST_F(AtomicFileTest, ManyFilesAfterEachOtherAreNoProblem) {
  for (int i = 0; i < 1000; ++i) require_writable(directory / "a.txt");
  EXPECT_EQ(names().size(), 0u);
}

}  // namespace
}  // namespace beamgyro::internal::atomic_file_test
