// SPDX-License-Identifier: MIT
#include "validation/external/isolation.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <utility>

#include "tests/config/rejection.h"
#include "tests/dataset/test_directory.h"
#include "tests/validation/external/isolation_attacks.h"
#include "tests/validation/external/tested_run.h"
#include "validation/external/answer_checks.h"
#include "validation/external/command_words.h"
#include "validation/external/compensator_source.h"

namespace beamgyro::internal::isolation_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHdf5 = "\x89HDF\r\n\x1a\n";
// By the file system, the kernel or the container.
constexpr const char* kNotEverywhere[] = {
    "flags of a file", "attribute of a file", "memory", "other memory", "key"};

bool has_landlock() { return isolation_of_system(test_limits()).holds(); }

ProcessLimits limits_with(int highest_landlock) {
  ProcessLimits limits = test_limits();
  limits.stall = 60.0;  // an interpreter that starts on a busy machine
  limits.isolation.highest_landlock = highest_landlock;
  return limits;
}

std::string listed(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

// Puts a folder before those of PATH.
class SearchPath {
 public:
  explicit SearchPath(const fs::path& first) : before_(std::getenv("PATH")) {
    ::setenv("PATH", (first.string() + ":" + before_).c_str(), 1);
  }
  ~SearchPath() { ::setenv("PATH", before_.c_str(), 1); }
  SearchPath(const SearchPath&) = delete;
  SearchPath& operator=(const SearchPath&) = delete;

 private:
  std::string before_;
};

class IsolatedCode : public DirectoryFixture {
 protected:
  void SetUp() override {
    if (!has_landlock()) GTEST_SKIP() << "no Landlock here";
    fs::permissions(directory, fs::perms::all);
    limits.stall = 60.0;
  }

  // A script that answers 0, or the number that `text` makes of `x`.
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(directory / name) << text;
    return (directory / name).string();
  }
  std::string answering(const std::string& name, const std::string& text) {
    return write(name, "import os, sys\nx = 0\n" + text +
                           "\nnext(sys.stdin)\n"
                           "for line in sys.stdin: print(x)\n");
  }
  double first_answer(const std::string& command) const {
    const Answer answer = open_tested_compensator("cmd:" + command, limits)
                              ->answer(tested_run(1.0));
    EXPECT_TRUE(answer.faults.empty()) << answer.faults[0].words;
    return answer.rate[0];
  }
  std::string refused_files(const fs::path& path) {
    limits.isolation.plugin_files = {path};
    return rejection([&] { isolation_of_command("cmd:true", limits); });
  }

  ProcessLimits limits = test_limits();
};

}  // namespace

class Attacks : public IsolatedCode, public testing::WithParamInterface<int> {
 protected:
  std::string working(bool is_user) {
    const std::string memory = "the truth of this run";
    return in_process(is_user, [&] {
      return listed(
          working_attacks(directory, limits_with(GetParam()), memory));
    });
  }
};

TEST_P(Attacks, FailAsRoot) {
  if (::geteuid() != 0) GTEST_SKIP() << "is not root";
  EXPECT_EQ(working(false), "");
}

TEST_P(Attacks, FailAsAUser) { EXPECT_EQ(working(true), ""); }

// Linux 5.13, Debian 12, and the newest that this kernel has.
INSTANTIATE_TEST_SUITE_P(Landlock, Attacks,
                         testing::Values(1, 2, kNewestLandlock));

// What the tests above prove is no more than this.
TEST_F(IsolatedCode, TheAttacksWorkWithoutIsolation) {
  const std::string memory = "the truth of this run";
  for (const bool is_user : {false, true}) {
    const std::string found = in_process(is_user, [&] {
      return listed(working_attacks(directory, limits_with(0), memory));
    });
    for (const std::string& name : attack_names()) {
      const bool is_usual = std::ranges::count(kNotEverywhere, name) == 0;
      EXPECT_TRUE(!is_usual || holds(found, name));
    }
    RecordProperty(is_user ? "as_user" : "as_root", found);
  }
}

TEST_F(IsolatedCode, NoDescriptorIsHandedOn) {
  const int opened =
      ::open(write("run.h5", "truth").c_str(), O_RDONLY);  // not O_CLOEXEC
  const std::string script =
      answering("reads.py", fmt::format("try: x = len(os.read({}, 3))\n"
                                        "except OSError: pass",
                                        opened));
  EXPECT_EQ(first_answer("/usr/bin/python3 '" + script + "'"), 0.0);
  limits.isolation.highest_landlock = 0;
  EXPECT_EQ(first_answer("/usr/bin/python3 '" + script + "'"), 0.0);
  ::close(opened);
}

TEST_F(IsolatedCode, ItsFolderIsEmptyAtEachStart) {
  const std::string script =
      answering("notes.py",
                "import tempfile\n"
                "assert tempfile.gettempdir() == os.environ['HOME']\n"
                "x = len(os.listdir(os.environ['HOME']))\n"
                "open(os.environ['HOME'] + '/note', 'w').write('x')");
  const auto command =
      open_tested_compensator("cmd:/usr/bin/python3 '" + script + "'", limits);
  const Answer answer = command->answer(tested_run());
  ASSERT_TRUE(answer.faults.empty()) << answer.faults[0].words;
  EXPECT_EQ(answer.rate[0], 0.0);
  EXPECT_EQ(answer.rate[950], 0.0);  // after a power-on
}

TEST_F(IsolatedCode, NothingIsLeftInTheFolderForTemporaryFiles) {
  const auto count = [] {
    std::size_t folders = 0;
    for (const auto& entry : fs::directory_iterator(fs::temp_directory_path()))
      folders += entry.path().filename().string().starts_with("beamgyro-");
    return folders;
  };
  ::setenv("TMPDIR", directory.c_str(), 1);
  first_answer("/usr/bin/python3 '" +
               answering("full.py",
                         "os.makedirs(os.environ['HOME'] + '/a/b')\n"
                         "open(os.environ['HOME'] + '/a/b/c', 'w').close()") +
               "'");
  EXPECT_EQ(count(), 0U);
  ::unsetenv("TMPDIR");
}

TEST_F(IsolatedCode, OnlyCodeThatTheCommandNamesMayBeRead) {
  write("run.h5", kHdf5);
  write("data.txt", "1 2 3");
  write("hidden.py", "# judged by");
  write("late.py", "#!/bin/sh\n");
  limits.isolation.hidden = {directory / "hidden.py"};
  write("a.py", "");
  const Isolation isolation = isolation_of_command(
      fmt::format("cmd:/usr/bin/python3 '{0}/a.py' '{0}/run.h5' "
                  "'{0}/data.txt' '{0}/hidden.py' '{0}' \"x '{0}/late.py'\"",
                  directory.string()),
      limits);
  std::vector<std::string> names;
  for (const AllowedFile& file : isolation.files) names.push_back(file.name);
  EXPECT_EQ(listed(names), "a.py, late.py");
  EXPECT_EQ(isolation.files[1].sha256,
            "a8076d3d28d21e02012b20eaf7dbf75409a6277134439025f282e368e3305abf");
}

TEST_F(IsolatedCode, PluginFilesAreRead) {
  fs::create_directories(directory / "own" / "deep");
  write("own/deep/part.py", "value = 7\n");
  const std::string command =
      "/usr/bin/python3 '" +
      answering("uses.py",
                fmt::format("sys.path.insert(0, '{}/own/deep')\n"
                            "try:\n    import part\n    x = part.value\n"
                            "except ImportError: pass",
                            directory.string())) +
      "'";
  EXPECT_EQ(first_answer(command), 0.0);
  limits.isolation.plugin_files = {directory / "own"};
  EXPECT_EQ(first_answer(command), 7.0);
  const auto sum = [&] {
    return isolation_of_command("cmd:" + command, limits).files[1].sha256;
  };
  const std::string before = sum();
  EXPECT_EQ(sum(), before);
  write("own/deep/part.py", "value = 8\n");
  EXPECT_NE(sum(), before);
}

TEST_F(IsolatedCode, WhatItIsJudgedByIsNoPluginFile) {
  fs::create_directory(directory / "set");
  write("set/run.csv", "time,rate\n");
  write("set/own.py", "");
  limits.isolation.hidden = {directory / "set" / "run.csv"};
  for (const char* name : {"set/run.csv", "set", "."})
    EXPECT_TRUE(holds(refused_files(directory / name), "is judged by")) << name;
  limits.isolation.hidden = {directory / "set"};
  EXPECT_TRUE(holds(refused_files(directory / "set/own.py"), "is judged by"));
  limits.isolation.hidden.clear();
  EXPECT_TRUE(holds(refused_files(directory / "none"), "No such file"));
  write("set/other", std::string(512, 'x') + kHdf5);  // after a user block
  EXPECT_TRUE(holds(refused_files(directory / "set/other"), "HDF5"));
  EXPECT_TRUE(holds(refused_files(directory), "set/other"));
}

TEST_F(IsolatedCode, WhatIsHiddenInAFolderOfTheSystemStaysHidden) {
  limits.isolation.hidden = {"/usr/bin/env", "/etc"};
  const std::string command =
      "/usr/bin/python3 '" +
      answering("looks.py",
                "for p in ['/usr/bin/env', '/usr/bin/awk', '/etc/passwd']:\n"
                "    try: open(p, 'rb').close(); x = 2 * x + 1\n"
                "    except OSError: x = 2 * x") +
      "'";
  EXPECT_EQ(first_answer(command), 2.0);  // awk alone
  limits.isolation.hidden.clear();
  EXPECT_EQ(first_answer(command), 7.0);
}

TEST_F(IsolatedCode, AnInterpreterOutOfReachIsNamed) {
  fs::create_directories(directory / "bin");
  fs::copy("/usr/bin/env", directory / "bin" / "python3");
  const SearchPath path(directory / "bin");
  write("a.py", "");
  write("b.py", "#!/usr/bin/env python3\n");
  fs::permissions(directory / "b.py", fs::perms::all);
  const std::string program = (directory / "bin" / "python3").string();
  const std::string allowed = "plugin_files = " + directory.string() + ",";
  const std::vector<std::string> commands = {
      "python3 '" + directory.string() + "/a.py'", "true; nice -n 1 python3 x",
      "sh -c 'true && python3 x'", "'" + directory.string() + "/b.py'"};
  for (const std::string& command : commands) {
    const std::string words =
        rejection([&] { isolation_of_command("cmd:" + command, limits); });
    EXPECT_TRUE(holds(words, program + " lies where"));
    EXPECT_TRUE(holds(words, allowed));
  }
  // It is the command's own program by its path, as of a compiler's output.
  EXPECT_NO_THROW(isolation_of_command("cmd:'" + program + "' x", limits));
  limits.isolation.plugin_files = {directory / "bin"};
  EXPECT_NO_THROW(isolation_of_command("cmd:python3 x", limits));
}

TEST_F(IsolatedCode, AVirtualEnvironmentIsNotReplacedByTheSystem) {
  fs::create_directories(directory / "venv" / "bin");
  fs::create_symlink("/usr/bin/python3", directory / "venv/bin/python3");
  write("venv/pyvenv.cfg", "home = /usr/bin\n");
  const std::string program = (directory / "venv/bin/python3").string();
  const std::string command = "cmd:'" + program + "' x.py";
  EXPECT_TRUE(holds(rejection([&] { isolation_of_command(command, limits); }),
                    "plugin_files = " + (directory / "venv").string() + ","));
  limits.isolation.plugin_files = {directory / "venv"};
  EXPECT_NO_THROW(isolation_of_command(command, limits));
}

TEST_F(IsolatedCode, ALibraryIsIsolatedAsWell) {
  const CompensatorSource source =
      open_source(std::string(BEAMGYRO_FAULTY_PLUGINS) + "/NONE.so", limits);
  EXPECT_TRUE(source.isolation->holds());
  EXPECT_TRUE(source.isolation->files.empty());
  EXPECT_TRUE(source.tested->answer(tested_run()).faults.empty());
}

TEST(Isolation, WithoutLandlockTheReasonIsSaid) {
  for (const auto& [error, says] :
       {std::pair(ENOSYS, "the kernel has no Landlock"),
        std::pair(EOPNOTSUPP, "was started without Landlock"),
        std::pair(EPERM, "is refused here")}) {
    const auto words = [error = error](bool required) {
      return in_process(true, [=] {
        lose_landlock(error);
        ProcessLimits limits = test_limits();
        limits.isolation.required = required;
        return isolation_words(isolation_of_command("cmd:true", limits));
      });
    };
    EXPECT_TRUE(holds(words(false), "not isolated: "));
    EXPECT_TRUE(holds(words(false), says));
    EXPECT_TRUE(holds(words(true), "require_isolation: cmd:true is not"));
  }
}

TEST(Isolation, WithoutTheProgramCommandsRunAndSayIt) {
  ProcessLimits limits = test_limits();
  limits.program.clear();
  const CompensatorSource source = open_source("cmd:yes 1 | head -950", limits);
  EXPECT_TRUE(holds(isolation_words(*source.isolation), "is not named"));
  EXPECT_EQ(source.tested->answer(tested_run(1.0)).rate[0], 1.0);
}

TEST(CommandWords, AreThoseOfTheShell) {
  const auto words = [](const std::string& command) {
    std::string text;
    for (const CommandWord& word : command_words(command))
      text += (word.is_program      ? "!"
               : word.within_quotes ? "?"
                                    : "") +
              word.text + "|";
    return text;
  };
  EXPECT_EQ(words("python3 -u x.py"), "!python3|-u|x.py|");
  EXPECT_EQ(words("A=1 exec 'a b' \"c\"d\\ e;f|g&&h"),
            "A=1|!exec|!a b|?a|?b|cd e|?cd|?e|!f|!g|!h|");
  EXPECT_EQ(words("sh -c \"if x; then y; fi\" # no\n<in z >out"),
            "!sh|-c|if x; then y; fi|?if|?x|?then|?y|?fi|in|!z|out|");
  EXPECT_EQ(words("$(p q) `r`"), "!$|!p|q|!r|");
  EXPECT_EQ(words("''"), "!|");
}

}  // namespace beamgyro::internal::isolation_test
