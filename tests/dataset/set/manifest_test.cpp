// SPDX-License-Identifier: MIT
#include "dataset/set/manifest.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "dataset/atomic_file.h"
#include "dataset/text_file.h"
#include "tests/dataset/rejection.h"
#include "tests/dataset/set/sample_set.h"
#include "tests/dataset/set/set_directory.h"

namespace beamgyro {
namespace {

class ManifestFile : public SetDirectory {
 protected:
  std::filesystem::path file() const { return directory / kManifestName; }
};

ManifestHead sample_manifest_head() {
  ManifestHead head;
  head.campaign = "source/small.toml";
  head.campaign_sha256 = std::string(64, 'a');
  head.program_version = "1.2.3";
  head.seed = 18446744073709551615u;
  head.devices = 5;
  head.devices_per_file = 2;
  head.runs = {"rest", "warm_up"};
  head.sources = {{"source/small.toml", std::string(64, 'a')},
                  {"source/devices/gr\xc3\xbcn.toml", std::string(64, 'b')}};
  return head;
}

ManifestEntry sample_entry(std::uint32_t index) {
  ManifestEntry entry = expected_entry(sample_manifest_head(), index);
  entry.bytes = 5000000000u + index;
  entry.sha256 = std::string(64, 'c');
  if (index == 2) entry.failures = {{3, "beam.length_m: \"too\" long\n"}};
  return entry;
}

Manifest sample_manifest() {
  Manifest manifest;
  manifest.head = sample_manifest_head();
  for (std::uint32_t i = 0; i < 6; ++i)
    manifest.entries.push_back(sample_entry(i));
  return manifest;
}

TEST_F(ManifestFile, FilesAreNumberedByRangeThenRun) {
  const ManifestHead head = sample_manifest_head();
  ASSERT_EQ(file_count(head), 6u);
  EXPECT_EQ(expected_entry(head, 0).file, "rest_00000.h5");
  EXPECT_EQ(expected_entry(head, 3).file, "warm_up_00001.h5");
  EXPECT_EQ(expected_entry(head, 3).first_device, 2u);
  EXPECT_EQ(expected_entry(head, 3).devices, 2u);
  EXPECT_EQ(expected_entry(head, 4).first_device, 4u);
  EXPECT_EQ(expected_entry(head, 4).devices, 1u);
}

TEST_F(ManifestFile, GivesBackWhatWasAppended) {
  start_manifest(file(), sample_manifest_head());
  append_entry(file(), sample_entry(2));
  append_entry(file(), sample_entry(0));
  const Manifest found = read_manifest(file());
  EXPECT_EQ(found.head, sample_manifest_head());
  EXPECT_EQ(found.entries,
            (std::vector<ManifestEntry>{sample_entry(0), sample_entry(2)}));
  EXPECT_FALSE(found.is_finished);
  EXPECT_TRUE(found.damaged_lines.empty());
}

TEST_F(ManifestFile, ALineCutShortCountsAsNotThereWhereverItIsCut) {
  start_manifest(file(), sample_manifest_head());
  append_entry(file(), sample_entry(0));
  const std::string before = read_text_file(file());
  append_entry(file(), sample_entry(1));
  const std::string after = read_text_file(file());
  for (std::size_t size = before.size(); size < after.size() - 1; size += 9) {
    write_text_file(file(), after.substr(0, size));
    const Manifest torn = read_manifest(file());
    ASSERT_EQ(torn.entries, std::vector<ManifestEntry>{sample_entry(0)})
        << size;
    ASSERT_TRUE(torn.damaged_lines.empty()) << size;
    append_entry(file(), sample_entry(3));
    ASSERT_EQ(read_manifest(file()).entries,
              (std::vector<ManifestEntry>{sample_entry(0), sample_entry(3)}))
        << size;
  }
}

TEST_F(ManifestFile, OfTwoLinesForOneFileTheLaterCounts) {
  start_manifest(file(), sample_manifest_head());
  append_entry(file(), sample_entry(1));
  ManifestEntry again = sample_entry(1);
  again.sha256 = std::string(64, 'd');
  append_entry(file(), again);
  EXPECT_EQ(read_manifest(file()).entries, std::vector<ManifestEntry>{again});
}

TEST_F(ManifestFile, TheFinishedOneIsSortedAndDoesNotDependOnTheOrder) {
  Manifest manifest;
  manifest.head = sample_manifest_head();
  for (std::uint32_t i = 6; i-- > 0;)
    manifest.entries.push_back(sample_entry(i));
  manifest.views = {{"warm_up.nc", 20, "e"}, {"rest.nc", 10, "f"}};
  write_manifest(file(), manifest);
  const std::string text = read_text_file(file());
  const Manifest found = read_manifest(file());
  EXPECT_TRUE(found.is_finished);
  EXPECT_EQ(found.entries.size(), 6u);
  EXPECT_EQ(found.entries[2], sample_entry(2));
  EXPECT_EQ(found.views[0].file, "rest.nc");
  write_manifest(file(), found);
  EXPECT_EQ(read_manifest(file()).entries, found.entries);
  EXPECT_EQ(read_text_file(file()), text);
}

TEST_F(ManifestFile, EveryFlippedBitIsFoundAndCostsAtMostTwoLines) {
  const Manifest manifest = sample_manifest();
  write_manifest(file(), manifest);
  const std::string text = read_text_file(file());
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string flipped = text;
    flipped[i] = static_cast<char>(flipped[i] ^ (1 << (i % 8)));
    write_text_file(file(), flipped);
    const Manifest found = read_manifest(file());
    ASSERT_TRUE(!found.damaged_lines.empty() || !found.is_finished) << i;
    ASSERT_TRUE(found.head == manifest.head) << i;  // it is there twice
    ASSERT_GE(found.entries.size(), 4u) << i;
  }
}

TEST_F(ManifestFile, ALineThatIsLostOrMovedIsFound) {
  const Manifest manifest = sample_manifest();
  write_manifest(file(), manifest);
  const std::string text = read_text_file(file());
  const std::size_t second = text.find('\n') + 1;
  const std::size_t third = text.find('\n', second) + 1;
  std::string changed = text;
  changed.erase(second, third - second);
  write_text_file(file(), changed);
  EXPECT_EQ(read_manifest(file()).damaged_lines.size(), 1u);
  changed.insert(0, text.substr(second, third - second));
  write_text_file(file(), changed);
  EXPECT_EQ(read_manifest(file()).damaged_lines.size(), 1u);
}

TEST_F(ManifestFile, AMissingOneIsNamedAndAnythingElseIsDamage) {
  EXPECT_EQ(rejection([&] { read_manifest(file()); }),
            file().string() + ": cannot read: No such file or directory");
  write_text_file(file(), std::string("\0\n\n{}\n[1]\n\xff\xfe", 12));
  const Manifest found = read_manifest(file());
  EXPECT_EQ(found.damaged_lines, (std::vector<std::size_t>{1, 2, 3, 4}));
  EXPECT_FALSE(found.head.has_value());
  write_text_file(file(), "");
  EXPECT_FALSE(read_manifest(file()).is_finished);
}

}  // namespace
}  // namespace beamgyro
