// SPDX-License-Identifier: MIT
#include "config/document.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>

#include "tests/config/rejection.h"

namespace beamgyro {
namespace {

namespace fs = std::filesystem;

fs::path test_folder() {
  const fs::path folder = fs::path(::testing::TempDir()) / "beamgyro config";
  fs::create_directories(folder);
  return folder;
}

TEST(Document, KeepsTheTextByteForByte) {
  const fs::path file = test_folder() / "unit \xc3\xa4.toml";
  const std::string text = "# unit\r\n\tx = 1 # last line without an end";
  std::ofstream(file, std::ios::binary) << text;
  const ConfigDocument document = ConfigDocument::read(file);
  EXPECT_EQ(document.text(), text);
  EXPECT_EQ(document.path(), file);
  EXPECT_EQ(document.root().number("x"), 1.0);
}

TEST(Document, TakesOverridesInWhenReadFromAFile) {
  const fs::path file = test_folder() / "overridden.toml";
  std::ofstream(file) << "x = 1\n";
  Overrides overrides({"x=2"});
  const ConfigDocument document = ConfigDocument::read(file, overrides);
  EXPECT_EQ(document.root().number("x"), 2.0);
  EXPECT_EQ(document.text(), "x = 1\n");
  EXPECT_NO_THROW(overrides.check_all_used());
}

TEST(Document, AMissingFileIsNamed) {
  const fs::path file = test_folder() / "nowhere.toml";
  EXPECT_EQ(rejection([&] { ConfigDocument::read(file); }),
            file.string() +
                ": cannot read: No such file or directory; expected a TOML "
                "file");
}

TEST(Document, ADirectoryIsNoFile) {
  EXPECT_EQ(rejection([&] { ConfigDocument::read(test_folder()); }),
            test_folder().string() +
                ": cannot read: it is a directory; expected a TOML file");
}

TEST(Document, AnEmptyTextHasNoKeys) {
  const ConfigDocument document = ConfigDocument::parse("", "empty.toml");
  EXPECT_EQ(rejection([&] { document.root().number("duration_s"); }),
            "empty.toml:1:1: duration_s: missing; expected a finite number");
  EXPECT_NO_THROW(document.reject_unknown_keys());
}

TEST(Document, ATableOutlivesItsDocumentAndItsOverrides) {
  std::optional<ConfigTable> beam;
  {
    Overrides overrides({"beam.x=3"});
    const ConfigDocument document =
        ConfigDocument::parse("[beam]\nx = 1\n", "unit.toml", overrides);
    beam = document.root().table("beam");
  }
  EXPECT_EQ(beam->number("x"), 3.0);
}

}  // namespace
}  // namespace beamgyro
