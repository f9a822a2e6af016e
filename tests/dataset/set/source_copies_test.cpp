// SPDX-License-Identifier: MIT
#include "dataset/set/source_copies.h"

#include <gtest/gtest.h>

#include "dataset/sha256.h"
#include "dataset/text_file.h"
#include "tests/dataset/rejection.h"
#include "tests/dataset/set/set_directory.h"

namespace beamgyro {
namespace {

using Sources = SetDirectory;

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

}  // namespace
}  // namespace beamgyro
