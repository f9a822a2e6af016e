// SPDX-License-Identifier: MIT
#include "validation/external/compensator_source.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::compensator_source_test {
namespace {

TEST(SourceKind, IsWhatTheBytesAreWhateverTheName) {
  const TestDirectory made;
  const std::filesystem::path& folder = made.directory;
  const auto kind = [&](const std::string& name, const std::string& bytes) {
    std::ofstream(folder / name) << bytes;
    return source_kind(folder / name);
  };
  for (const char* name : {"x.json", "x.comp", "x.JSON", "x", "x.so", "x.toml"})
    EXPECT_EQ(kind(name, " {\"filetype\": 1}"), SourceKind::kFile) << name;
  for (const char* name : {"lib.json", "lib.so", "lib", "lib.toml"})
    EXPECT_EQ(kind(name,
                   "\x7f"
                   "ELF..."),
              SourceKind::kLibrary)
        << name;
  for (const char* name : {"m.toml", "m", "m.model"})
    EXPECT_EQ(kind(name, "# mine\nkind = \"bp\"\n"), SourceKind::kModel)
        << name;
  EXPECT_EQ(kind("damaged.json", "kind = 3"), SourceKind::kFile);
  EXPECT_EQ(kind("damaged.so", ""), SourceKind::kLibrary);
  EXPECT_EQ(kind("kinds", "kinds = 3"), SourceKind::kFile);
  EXPECT_EQ(source_kind("cmd:python3 mine.py x.json"), SourceKind::kCommand);
  EXPECT_EQ(source_kind("cmd:./mine lib.so"), SourceKind::kCommand);
  EXPECT_EQ(source_kind(folder), SourceKind::kFile);
}

}  // namespace
}  // namespace beamgyro::internal::compensator_source_test
