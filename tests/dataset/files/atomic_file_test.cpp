// SPDX-License-Identifier: MIT
#include "dataset/files/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
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
#include "tests/dataset/system_calls.h"

namespace beamgyro::internal::atomic_file_test {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder =
        fs::path(::testing::TempDir()) / ("atomic " + std::to_string(getpid()));
    fs::create_directory(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  std::size_t files_there() const {
    return static_cast<std::size_t>(std::distance(
        fs::directory_iterator(folder), fs::directory_iterator()));
  }

  fs::path folder;
};

TEST_F(AtomicFileTest, TheFileAppearsWhenItIsPublished) {
  const fs::path path = folder / "a b.txt";
  write_text_file(path, "old");
  {
    AtomicFile file(path);
    EXPECT_EQ(file.partial_path().parent_path(), folder);
    EXPECT_NE(file.partial_path().extension(), ".txt");
    std::ofstream(file.partial_path()) << "new";
    EXPECT_EQ(read_text_file(path), "old");
    file.publish();
    EXPECT_EQ(read_text_file(path), "new");
  }
  EXPECT_EQ(read_text_file(path), "new");
  EXPECT_EQ(files_there(), 1u);
}

TEST_F(AtomicFileTest, NothingIsLeftWithoutPublishing) {
  const fs::path path = folder / "a.txt";
  write_text_file(path, "old");
  {
    const AtomicFile file(path);
    std::ofstream(file.partial_path()) << "half";
    EXPECT_EQ(files_there(), 2u);
  }
  EXPECT_EQ(files_there(), 1u);
  EXPECT_EQ(read_text_file(path), "old");
}

TEST_F(AtomicFileTest, TwoWritersOfOneNameDoNotMeet) {
  const fs::path path = folder / "a.txt";
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
  write_text_file(folder / "bytes", bytes);
  EXPECT_EQ(read_text_file(folder / "bytes"), bytes);
  write_text_file(folder / "empty", "");
  EXPECT_EQ(read_text_file(folder / "empty"), "");
}

TEST_F(AtomicFileTest, AWrongPlaceIsNamed) {
  const std::string f = folder.string();
  EXPECT_EQ(rejection([&] { require_writable(folder / "no" / "a.txt"); }),
            f + "/no/a.txt: cannot write: directory " + f +
                "/no: No such file or directory; expected one that is there "
                "and writable");
  EXPECT_EQ(rejection([&] { write_text_file(folder, "x"); }),
            f + ": cannot write: it is a directory; expected a file name");
  write_text_file(folder / "plain", "");
  EXPECT_EQ(rejection([&] { require_writable(folder / "plain" / "a.txt"); }),
            f + "/plain/a.txt: cannot write: directory " + f +
                "/plain: Not a directory; expected one that is there and "
                "writable");
  EXPECT_EQ(rejection([&] { require_writable(""); }),
            "an output file has no name");
  EXPECT_THROW(require_writable(folder / std::string(255, 'n')),
               std::invalid_argument);
  EXPECT_EQ(files_there(), 1u);
}

TEST_F(AtomicFileTest, DevicesAreNotReplaced) {
  EXPECT_EQ(rejection([&] { require_writable("/dev/null"); }),
            "/dev/null: cannot write: it is a device, pipe or socket; expected "
            "a file name");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(AtomicFileTest, ALinkStaysAndWhatItNamesIsReplaced) {
  write_text_file(folder / "target", "old");
  fs::create_symlink("target", folder / "link");
  write_text_file(folder / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_text_file(folder / "target"), "new");
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
  const fs::path path = folder / "a.txt";
  write_text_file(path, "old");
  fs::permissions(path, fs::perms{0444});
  fs::permissions(folder, fs::perms{0555});
  {
    const OrdinaryUser user;
    EXPECT_EQ(rejection([&] { require_writable(path); }),
              path.string() +
                  ": cannot write: the file that is there is write-protected");
    EXPECT_EQ(rejection([&] { require_writable(folder / "b.txt"); }),
              folder.string() + "/b.txt: cannot write: directory " +
                  folder.string() +
                  ": Permission denied; expected one that is there and "
                  "writable");
  }
  fs::permissions(folder, fs::perms::owner_all);
  EXPECT_EQ(read_text_file(path), "old");
}

// A limit on the size of files fails like a full disk.
TEST_F(AtomicFileTest, AFullDiskLeavesWhatWasThere) {
  const fs::path path = folder / "a.txt";
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
  EXPECT_EQ(files_there(), 1u);
}

TEST_F(AtomicFileTest, ASignalHandlerCanRemovePartialFiles) {
  const fs::path path = folder / "a.txt";
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGTERM, [](int) {
      remove_partial_files();
      _exit(143);
    });
    const AtomicFile file(path);
    AtomicFile published(folder / "b.txt");
    published.publish();
    std::raise(SIGTERM);
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 143);
  EXPECT_EQ(files_there(), 1u);
  EXPECT_TRUE(fs::exists(folder / "b.txt"));
}

TEST_F(AtomicFileTest, TheFileThatIsReplacedHandsOnItsMode) {
  const fs::path path = folder / "a.txt";
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
  write_text_file(folder / "a.txt", "text");
  std::vector<std::string> made = calls.made();
  std::erase_if(made, [](const std::string& name) {
    return name != "fsync" && name != "renameat";
  });
  EXPECT_EQ(made, (std::vector<std::string>{"fsync", "renameat", "fsync"}));
}

TEST_F(AtomicFileTest, AFileInThePlaceOfThePartialOneIsNotTouched) {
  write_text_file(folder / "victim", "victim");
  const fs::path path = folder / "a.txt";
  AtomicFile file(path);
  fs::remove(file.partial_path());
  fs::create_symlink("victim", file.partial_path());
  file.file().write(std::as_bytes(std::span("text", 4)));
  EXPECT_TRUE(holds(rejection<std::runtime_error>([&] { file.publish(); }),
                    "replaced"));
  EXPECT_EQ(read_text_file(folder / "victim"), "victim");
  EXPECT_FALSE(fs::exists(path));
}

/// Number of a process that is no more.
pid_t dead_process() {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  return child;
}

TEST_F(AtomicFileTest, WhatADeadProcessLeftIsRemovedByTheNext) {
  const auto partial = [&](const std::string& name, const std::string& host,
                           pid_t process) {
    return folder /
           (name + ".partial-" + host + "-" + std::to_string(process) + "-0");
  };
  const fs::path dead = partial("a.txt", host_name(), dead_process());
  const std::vector<fs::path> others = {
      partial("a.txt", host_name(), getppid()),
      partial("a.txt", "elsewhere", dead_process()),
      partial("b.txt", host_name(), dead_process())};
  write_text_file(dead, "half");
  for (const fs::path& other : others) write_text_file(other, "half");
  write_text_file(folder / "a.txt", "text");
  EXPECT_FALSE(fs::exists(dead));
  for (const fs::path& other : others) EXPECT_TRUE(fs::exists(other)) << other;
}

TEST_F(AtomicFileTest, ALinkOfAnotherUserInADirectoryForAllIsNotFollowed) {
  if (geteuid() != 0) GTEST_SKIP() << "another user's files need root";
  write_text_file(folder / "target", "old");
  fs::create_directory(folder / "all");
  fs::permissions(folder / "all", fs::perms{01777});
  fs::create_symlink("../target", folder / "all" / "link");
  ASSERT_EQ(lchown((folder / "all" / "link").c_str(), 65534, 65534), 0);
  ASSERT_EQ(chown((folder / "all").c_str(), 65533, 65533), 0);
  EXPECT_TRUE(
      holds(rejection([&] { write_text_file(folder / "all" / "link", "new"); }),
            "another user"));
  EXPECT_EQ(read_text_file(folder / "target"), "old");
}

TEST_F(AtomicFileTest, ManyFilesAfterEachOtherAreNoProblem) {
  for (int i = 0; i < 1000; ++i) require_writable(folder / "a.txt");
  EXPECT_EQ(files_there(), 0u);
}

}  // namespace
}  // namespace beamgyro::internal::atomic_file_test
