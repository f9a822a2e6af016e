// SPDX-License-Identifier: MIT
#include "dataset/set/source_copies.h"

#include <gtest/gtest.h>

#include "dataset/files/atomic_file.h"
#include "dataset/files/sha256.h"
#include "dataset/files/text_file.h"
#include "tests/config/rejection.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::source_copies_test {
namespace {

using Sources = DirectoryFixture;

TEST_F(Sources, KeepTheirPlacesToEachOther) {
  const std::vector<SourceText> files = {
      {"/a/b/campaigns/small.toml", "one"},
      {"/a/b/campaigns/../devices/nominal.toml", "two"},
      {"/a/b/profiles/day 1/log.csv", std::string("\0\r\n", 3)},
      {"/a/b/devices/nominal.toml", "two"}};
  const std::vector<SourceEntry> entries = source_entries(files);
  copy_sources(directory, files);
  EXPECT_EQ(entries,
            (std::vector<SourceEntry>{
                {"source/campaigns/small.toml", sha256("one")},
                {"source/devices/nominal.toml", sha256("two")},
                {"source/profiles/day 1/log.csv", sha256(files[2].text)}}));
  for (std::size_t i = 0; i < entries.size(); ++i)
    EXPECT_EQ(read_text_file(directory / entries[i].file), files[i].text);
}

TEST_F(Sources, AFileAloneStandsAtTheTop) {
  const SourceText file{"campaign.toml", "x"};
  EXPECT_EQ(source_entries(std::span(&file, 1))[0].file,
            "source/campaign.toml");
  EXPECT_TRUE(source_entries({}).empty());
}

TEST_F(Sources, ANameThatIsNoUtf8IsRejected) {
  const SourceText file{"/a/\xff.toml", "x"};
  EXPECT_EQ(rejection([&] { source_entries(std::span(&file, 1)); }),
            "source/\xff.toml: the name is not UTF-8, which the manifest is");
}

TEST_F(Sources, TheNameOfTheHeadsCopyIsTaken) {
  const SourceText file{"/a/head.jsonl", "x"};
  EXPECT_TRUE(holds(rejection([&] { source_entries(std::span(&file, 1)); }),
                    "head.jsonl"));
}

TEST_F(Sources, ACopyStandsForTheFileThatANameMeans) {
  const std::vector<SourceText> copies = {{"set/source/campaigns/c.toml", "c"},
                                          {"set/source/devices/d.toml", "d"},
                                          {"set/source/a/p.csv", "a"},
                                          {"set/source/b/p.csv", "b"}};
  const auto text = [&](const char* name) {
    return copy_of(name, copies).text;
  };
  EXPECT_EQ(text("set/source/campaigns/../devices/d.toml"), "d");
  EXPECT_EQ(text("/elsewhere/devices/d.toml"), "d");
  EXPECT_EQ(text("/d.toml"), "d");
  EXPECT_EQ(text("/x/b/p.csv"), "b");
  for (const char* name : {"/p.csv", "/x/p.csv", "/etc/passwd", "../e.toml"})
    EXPECT_TRUE(holds(rejection([&] { text(name); }), "no copy")) << name;
}

TEST_F(Sources, CopiesAreReadWholeOrNotAtAll) {
  const std::vector<SourceText> files = {{"/a/c.toml", "one"},
                                         {"/a/b/d.toml", "two"}};
  copy_sources(directory, files);
  ManifestHead head;
  head.sources = source_entries(files);
  const std::vector<SourceText> copies = read_copies(directory, head);
  ASSERT_EQ(copies.size(), 2u);
  EXPECT_EQ(copies[1].path, directory / "source" / "b" / "d.toml");
  EXPECT_EQ(copies[1].text, "two");
  write_text_file(directory / "source" / "c.toml", "One");
  EXPECT_TRUE(holds(
      rejection<std::runtime_error>([&] { read_copies(directory, head); }),
      "other bytes"));
  head.sources.clear();
  EXPECT_THROW(read_copies(directory, head), std::runtime_error);
}

}  // namespace
}  // namespace beamgyro::internal::source_copies_test
