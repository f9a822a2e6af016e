// SPDX-License-Identifier: MIT
#include "dataset/files/file_checksum.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <string>

#include "dataset/files/atomic_file.h"
#include "dataset/files/sha256.h"
#include "dataset/files/text_file.h"
#include "dataset/netcdf/recording_file.h"
#include "dataset/netcdf/recording_reader.h"
#include "tests/config/rejection.h"
#include "tests/dataset/overwrite.h"
#include "tests/dataset/sample_recording.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::file_checksum_test {
namespace {

namespace fs = std::filesystem;

fs::path recorded(const fs::path& file) {
  write_recording(sample_recording(500), file);
  return file;
}

class FileChecksumLine : public DirectoryFixture {
 protected:
  std::string rejected() const {
    return rejection([&] { read_recording(file); });
  }
  std::string rejected(const std::string& damaged) const {
    write_text_file(file, damaged);
    return rejected();
  }
  /// What reading says of the file with one bit flipped, which is mended.
  std::string rejected_with_flipped(std::size_t byte, int bit) const {
    const char damaged = static_cast<char>(bytes[byte] ^ (1 << bit));
    overwrite(file, byte, {&damaged, 1});
    const std::string message = rejected();
    overwrite(file, byte, {&bytes[byte], 1});
    return message;
  }

  const fs::path file = recorded(directory / "checksum.h5");
  const std::string bytes = read_text_file(file);
};

constexpr std::size_t kLine = 95;  // [bytes]

TEST_F(FileChecksumLine, IsTheSha256OfAllBytesBefore) {
  ASSERT_GT(bytes.size(), kLine);
  EXPECT_EQ(bytes.substr(bytes.size() - kLine),
            "\nSHA-256 of all bytes before: " +
                sha256(bytes.substr(0, bytes.size() - kLine)) + "\n");
  OpenFile open(file, O_RDONLY);
  EXPECT_EQ(checksum_of(open), FileChecksum::kRight);
  EXPECT_TRUE(has_checksum(open));
  EXPECT_FALSE(has_bytes_after_hdf5(open));
}

TEST_F(FileChecksumLine, NoFlippedBitIsAcceptedWhereverItIs) {
  std::mt19937 random(20261122);
  for (int k = 0; k < 2000; ++k) {
    const std::size_t byte = random() % bytes.size();
    const std::string message = rejected_with_flipped(byte, k % 8);
    ASSERT_TRUE(holds(message, "the file is damaged"))
        << byte << ": " << message;
  }
  EXPECT_EQ(read_recording(file).time.size(), 500u);
}

TEST_F(FileChecksumLine, NoFlippedBitOfTheLineItselfIsAccepted) {
  for (std::size_t k = 1; k <= kLine; ++k)
    EXPECT_TRUE(holds(rejected_with_flipped(bytes.size() - k, 0),
                      "the file is damaged"))
        << k;
}

TEST_F(FileChecksumLine, NoCutAndNoAdditionIsAccepted) {
  const auto rejected_when_cut = [&](std::size_t cut) {
    fs::resize_file(file, bytes.size() - cut);
    return rejected();
  };
  for (std::size_t cut = 1; cut < kLine; ++cut)
    EXPECT_NE(rejected_when_cut(cut), "") << cut;
  for (const std::size_t cut : {kLine + 1, kLine + 100, bytes.size() / 2})
    EXPECT_NE(rejected_when_cut(cut), "") << cut;
  EXPECT_NE(rejected(bytes + '\n'), "");
  EXPECT_NE(rejected(bytes + bytes), "");
  EXPECT_NE(rejected(bytes.substr(0, bytes.size() - kLine) +
                     bytes.substr(bytes.size() - kLine / 2)),
            "");
}

TEST_F(FileChecksumLine, AFileWithoutTheLineIsReadAndHasNoChecksum) {
  write_text_file(file, bytes.substr(0, bytes.size() - kLine));
  OpenFile open(file, O_RDONLY);
  EXPECT_EQ(checksum_of(open), FileChecksum::kNone);
  EXPECT_FALSE(has_checksum(open));
  EXPECT_EQ(read_recording(file).time.size(), 500u);
}

}  // namespace
}  // namespace beamgyro::internal::file_checksum_test
