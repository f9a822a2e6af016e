// SPDX-License-Identifier: MIT
#include "config/document.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>

#include "config/config_node.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::document_test {
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

TEST(Document, CopiesWithOtherOverridesStartUnread) {
  Overrides first({"a.x=2"}), second({"a.y=3"});
  const ConfigDocument document =
      ConfigDocument::parse("[a]\nx = 1\ny = 1\n", "d.toml", first);
  EXPECT_EQ(document.root().table("a").number("x"), 2);
  const ConfigDocument copy = document.with(second);
  EXPECT_EQ(copy.root().table("a").number("x"), 1);
  EXPECT_FALSE(second.all_used());
  EXPECT_EQ(copy.root().table("a").number("y"), 3);
  EXPECT_TRUE(second.all_used());
  EXPECT_EQ(document.root().table("a").number("y"), 1);
  EXPECT_EQ(copy.text(), document.text());
}

TEST(Document, OverridesThatAreSettledStayUnderLaterOnes) {
  Overrides first, later;
  first.add({"a", "x"}, number_node(2));
  first.add({"a", "y"}, number_node(3));
  later.add({"a", "y"}, number_node(4));
  const ConfigDocument settled =
      ConfigDocument::parse("[a]\nx = 1\n", "unit.toml", first).settled();
  EXPECT_EQ(settled.text(), "[a]\nx = 1\n");
  EXPECT_TRUE(settled.value("a.y") != nullptr);
  const ConfigTable a = settled.with(later).root().table("a");
  EXPECT_EQ(a.number("x"), 2);
  EXPECT_EQ(a.number("y"), 4);
  EXPECT_TRUE(later.all_used());
  EXPECT_EQ(settled.root().table("a").number("y"), 3);
  // A wrong value has its place in the file.
  EXPECT_TRUE(holds(rejection([&] { settled.root().table("a").text("x"); }),
                    "unit.toml:2:1"));
}

TEST(Document, FindsTheValueOfADottedKey) {
  const ConfigDocument document =
      ConfigDocument::parse("[a.b]\nc = [1, 2]\n", "d.toml");
  ASSERT_NE(document.value("a.b.c"), nullptr);
  EXPECT_EQ(document.value("a.b.c")->children.size(), 2u);
  EXPECT_EQ(document.value("a.c"), nullptr);
  EXPECT_EQ(document.value("a.b.c.d"), nullptr);
  EXPECT_THROW(document.reject_unknown_keys(), std::invalid_argument);
}

TEST(Document, ArraysOfTablesAreReadAndCheckedOneByOne) {
  const ConfigDocument document = ConfigDocument::parse(
      "[[run]]\nx = 1\n[[run]]\nx = 2\ny = 3\n", "d.toml");
  const std::vector<ConfigTable> runs = document.root().tables("run");
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[1].keys(), (std::vector<std::string>{"x", "y"}));
  for (const ConfigTable& run : runs) run.number("x");
  EXPECT_EQ(rejection([&] { document.reject_unknown_keys(); }),
            "d.toml:5:1: run[1].y: unknown key; [run[1]] takes x");
  EXPECT_TRUE(document.root().tables("none").empty());
  EXPECT_EQ(rejection([] {
              ConfigDocument::parse("run = [1]", "d.toml").root().tables("run");
            }),
            "d.toml:1:7: run: 1 is wrong here; expected an array of tables "
            "[[run]]");
}

}  // namespace
}  // namespace beamgyro::internal::document_test
