// SPDX-License-Identifier: MIT
#include "dataset/files/directory.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <system_error>

#include "dataset/files/atomic_file.h"

namespace beamgyro::internal::directory_test {
namespace {

namespace fs = std::filesystem;

/// From now on this process has no openat2.
bool forbid_openat2() {
  std::array<sock_filter, 4> filter = {
      {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
       BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_openat2, 0, 1),
       BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | ENOSYS),
       BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)}};
  const sock_fprog program{filter.size(), filter.data()};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

/// With and without openat2.
class DirectoryTest : public ::testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    folder = fs::path(::testing::TempDir()) /
             ("directory " + std::to_string(getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder / "mine" / "deep");
    fs::create_directory(folder / "theirs");
    write_text_file(folder / "theirs" / "secret", "secret");
    write_text_file(folder / "mine" / "deep" / "file", "mine");
    fs::create_symlink("../theirs/secret", folder / "mine" / "link");
    fs::create_directory_symlink("../theirs", folder / "mine" / "way");
  }
  void TearDown() override { fs::remove_all(folder); }

  /// Whether `check` holds, in a process of its own.
  bool holds(const std::function<bool(const Directory&)>& check) const {
    const pid_t child = fork();
    if (child == 0) {
      if (!GetParam() && !forbid_openat2()) _exit(2);
      try {
        _exit(check(Directory(folder / "mine")) ? 0 : 1);
      } catch (const std::exception&) {
        _exit(3);
      }
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

  fs::path folder;
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
  EXPECT_TRUE(holds([](const Directory& directory) {
    std::array<std::byte, 8> text{};
    return directory.open("deep/file", O_RDONLY).read(text) == 4 &&
           reason_of(directory, "deep/new", O_WRONLY | O_CREAT) == 0 &&
           directory.find("deep/new")->is_regular &&
           reason_of(directory, "none", O_RDONLY) == ENOENT;
  }));
}

TEST_P(DirectoryTest, NoLinkIsFollowed) {
  EXPECT_TRUE(holds([](const Directory& directory) {
    return reason_of(directory, "link", O_RDONLY) == ELOOP &&
           reason_of(directory, "way/secret", O_RDONLY) == ELOOP &&
           reason_of(directory, "way/new", O_WRONLY | O_CREAT) == ELOOP &&
           reason_of(directory, "link", O_WRONLY | O_CREAT | O_TRUNC) == ELOOP;
  }));
  EXPECT_EQ(fs::file_size(folder / "theirs" / "secret"), 6u);
  EXPECT_FALSE(fs::exists(folder / "theirs" / "new"));
}

TEST_P(DirectoryTest, ALinkIsFoundAsOne) {
  EXPECT_TRUE(holds([](const Directory& directory) {
    const auto link = directory.find("link");
    return link && link->is_link && !link->is_regular &&
           !directory.find("none") && !directory.find("deep/file/none") &&
           directory.find("deep/file")->bytes == 4;
  }));
}

TEST_P(DirectoryTest, DirectoriesAreMadeBelowOnly) {
  EXPECT_TRUE(holds([](const Directory& directory) {
    directory.make_subdirectory("a/b/c");
    directory.make_subdirectory("a/b/c");
    try {
      directory.make_subdirectory("way/a");
      return false;
    } catch (const std::system_error&) {
      return true;
    }
  }));
  EXPECT_TRUE(fs::is_directory(folder / "mine" / "a" / "b" / "c"));
  EXPECT_FALSE(fs::exists(folder / "theirs" / "a"));
}

TEST_P(DirectoryTest, NamesThatLeadOutAreRejected) {
  EXPECT_TRUE(holds([](const Directory& directory) {
    for (const char* name :
         {"..", "../theirs/secret", "deep/../../theirs/secret", "/etc/passwd",
          "", ".", "deep/"}) {
      try {
        directory.open(name, O_RDONLY);
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

}  // namespace
}  // namespace beamgyro::internal::directory_test
