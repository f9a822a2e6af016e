// SPDX-License-Identifier: MIT
#include "dataset/set/set_check.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>

#include "dataset/files/atomic_file.h"
#include "dataset/files/text_file.h"
#include "tests/dataset/overwrite.h"
#include "tests/dataset/set/sample_set.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::set_check_test {
namespace {

namespace fs = std::filesystem;

class CheckSet : public DirectoryFixture {
 protected:
  std::vector<FileDefect> defects() const {
    return check_set(directory, read_manifest(directory, kManifestName));
  }
  /// The only defect there is, as "FILE WHAT INDEX".
  std::string defect() const {
    const std::vector<FileDefect> found = defects();
    if (found.size() != 1) return std::to_string(found.size()) + " defects";
    return found[0].file + ' ' + found[0].what +
           (found[0].index ? ' ' + std::to_string(*found[0].index) : "");
  }
  void flip(const fs::path& file, std::size_t byte, int bit) const {
    const char flipped =
        static_cast<char>(read_text_file(file)[byte] ^ (1 << bit));
    overwrite(file, byte, {&flipped, 1});
  }

  Manifest manifest = write_sample_set(directory);
};

TEST_F(CheckSet, FindsNothingInAWholeSet) {
  EXPECT_TRUE(defects().empty());
  std::uint64_t last = 0, total = 0;
  check_set(directory, manifest, [&](std::uint64_t done, std::uint64_t all) {
    EXPECT_GE(done, last);
    EXPECT_LE(done, all);
    last = done;
    total = all;
  });
  EXPECT_GT(last, 0u);
  EXPECT_EQ(last, total);
}

TEST_F(CheckSet, FindsEveryFlippedBitInEveryFile) {
  std::vector<std::string> files = {"rest.nc", "warm_up.nc",
                                    "source/campaign.toml", kHeadCopyName};
  for (const ManifestEntry& entry : manifest.entries)
    files.push_back(entry.file);
  for (std::size_t f = 0; f < files.size(); ++f) {
    const fs::path path = directory / files[f];
    const std::size_t size = fs::file_size(path);
    for (std::size_t i = 0; i < 12; ++i) {
      const std::size_t byte = (i * 7919 + f) * 104729 % size;
      const int bit = static_cast<int>(i % 8);
      flip(path, byte, bit);
      std::string expected = files[f] + " holds other bytes than were written";
      if (f >= 4) expected += ' ' + std::to_string(f - 4);
      ASSERT_EQ(defect(), expected) << byte;
      flip(path, byte, bit);
    }
  }
  EXPECT_TRUE(defects().empty());
}

TEST_F(CheckSet, FindsEveryFlippedBitInTheManifest) {
  const fs::path path = directory / kManifestName;
  const std::size_t size = fs::file_size(path);
  for (std::size_t byte = 0; byte < size; byte += 13) {
    flip(path, byte, static_cast<int>(byte % 8));
    ASSERT_FALSE(defects().empty()) << byte;
    flip(path, byte, static_cast<int>(byte % 8));
  }
}

TEST_F(CheckSet, AFileWhoseLineIsDamagedCanBeNamed) {
  const fs::path path = directory / kManifestName;
  flip(path, read_text_file(path).find("\"index\":3"), 0);
  const std::vector<FileDefect> found = defects();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].file, kManifestName);
  EXPECT_EQ(found[0].what, "line 5 is damaged");
  EXPECT_EQ(found[1].file, "warm_up_00001.h5");
  EXPECT_EQ(found[1].what, "is not in the manifest");
  EXPECT_EQ(found[1].index, 3u);
}

TEST_F(CheckSet, FindsFilesCutShortZeroedMissingOrReplaced) {
  const fs::path path = directory / "warm_up_00000.h5";
  const std::string text = read_text_file(path);
  write_text_file(path, text.substr(0, text.size() - 1));
  EXPECT_EQ(defect(),
            "warm_up_00000.h5 has " + std::to_string(text.size() - 1) +
                " bytes; expected " + std::to_string(text.size()) + " 1");
  std::string zeroed = text;
  zeroed.replace(4096, 4096, std::string(4096, '\0'));
  write_text_file(path, zeroed);
  EXPECT_EQ(defect(), "warm_up_00000.h5 holds other bytes than were written 1");
  write_text_file(path, "");
  EXPECT_EQ(defect(), "warm_up_00000.h5 has 0 bytes; expected " +
                          std::to_string(text.size()) + " 1");
  fs::remove(path);
  EXPECT_EQ(defect(), "warm_up_00000.h5 is missing 1");
  fs::create_directory(path);
  EXPECT_EQ(defect(), "warm_up_00000.h5 is no ordinary file 1");
}

TEST_F(CheckSet, TellsWhoseBytesASwappedFileHolds) {
  fs::rename(directory / "rest_00000.h5", directory / "x");
  fs::rename(directory / "rest_00001.h5", directory / "rest_00000.h5");
  fs::rename(directory / "x", directory / "rest_00001.h5");
  const std::vector<FileDefect> found = defects();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].what, "holds the bytes of rest_00001.h5");
  EXPECT_EQ(found[0].index, 0u);
  EXPECT_EQ(found[1].what, "holds the bytes of rest_00000.h5");
  EXPECT_EQ(found[1].index, 2u);
}

TEST_F(CheckSet, FindsFilesThatDoNotBelong) {
  fs::copy(directory / "rest_00000.h5", directory / "rest_00003.h5");
  EXPECT_EQ(defect(), "rest_00003.h5 does not belong to the set");
  fs::rename(directory / "rest_00003.h5", directory / "source" / "b.toml");
  EXPECT_EQ(defect(), "source/b.toml does not belong to the set");
  fs::remove(directory / "source" / "b.toml");
  write_text_file(directory / "notes.txt", "mine");
  write_text_file(directory / "rest_00000.h5.partial-host-12-0", "");
  EXPECT_TRUE(defects().empty());
}

TEST_F(CheckSet, FindsACopyOfTheHeadThatIsMissingOrOfAnotherSet) {
  fs::remove(directory / kHeadCopyName);
  EXPECT_EQ(defect(), "source/head.jsonl is missing");
  ManifestHead other = *manifest.head;
  ++other.seed;
  start_manifest(directory, kHeadCopyName, other);
  EXPECT_EQ(defect(), "source/head.jsonl holds other bytes than were written");
}

TEST_F(CheckSet, AnUnfinishedSetLacksWhatIsNotMadeYet) {
  fs::remove_all(directory);
  fs::create_directory(directory);
  const ManifestHead& head = *manifest.head;
  fs::create_directory(directory / "source");
  start_manifest(directory, kHeadCopyName, head);
  start_manifest(directory, kManifestName, head);
  const std::vector<FileDefect> found = defects();
  ASSERT_EQ(found.size(), 8u);
  EXPECT_EQ(found[0].what, "is not finished");
  EXPECT_EQ(found[7].file, "source/campaign.toml");
  for (std::uint32_t i = 0; i < 6; ++i) {
    EXPECT_EQ(found[i + 1].index, i);
    EXPECT_EQ(found[i + 1].what, "is not in the manifest");
  }
}

TEST_F(CheckSet, AHeadMayClaimMoreFilesThanMemoryHolds) {
  manifest.head->devices = 4'000'000'000;
  write_manifest(directory, kManifestName, manifest);
  const std::vector<FileDefect> found = defects();
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  EXPECT_LT(used.ru_maxrss, 500'000);  // [KiB]
  EXPECT_EQ(found.back().what,
            "lacks the lines of 3999899994 of 4000000000 files");
}

}  // namespace
}  // namespace beamgyro::internal::set_check_test
