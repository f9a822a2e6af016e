// SPDX-License-Identifier: MIT
// Damage in HDF5's own structures, with their checksums mended: what HDF5
// itself does not find, or finds too late.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "dataset/files/atomic_file.h"
#include "dataset/files/text_file.h"
#include "dataset/netcdf/recording_file.h"
#include "dataset/netcdf/recording_reader.h"
#include "tests/dataset/sample_recording.h"
#include "tests/dataset/test_directory.h"
#include "tests/fuzz/mended_hdf5.h"

namespace beamgyro::internal::hdf5_damage_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

long peak_memory() {  // [KiB]
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return used.ru_maxrss;
}

class Hdf5Damage : public DirectoryFixture {
 protected:
  /// A recording without the line of its checksum.
  Bytes recording_bytes(const Recording& recording) const {
    write_recording(recording, file);
    const std::string text = read_text_file(file);
    const std::size_t end = text.rfind("\nSHA-256 of all bytes before: ");
    EXPECT_NE(end, text.npos);
    return {text.begin(), text.begin() + static_cast<long>(end)};
  }

  /// Why these bytes are refused, or nothing for a recording.
  std::string rejected(const Bytes& bytes) const {
    write_text_file(file, std::string(bytes.begin(), bytes.end()));
    try {
      read_recording(file);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return {};
  }

  const std::filesystem::path file = directory / "run.h5";
};

std::size_t place_of(const Bytes& bytes, const std::string& text) {
  const std::string all(bytes.begin(), bytes.end());
  EXPECT_NE(all.find(text), all.npos);
  return all.find(text);
}

/// Writes a number, the least byte first.
template <class Number>
void put(Bytes& bytes, std::size_t place, Number value) {
  std::memcpy(bytes.data() + place, &value, sizeof value);
}

TEST_F(Hdf5Damage, ABlockOfDriverInformationTakesNoMemory) {
  Bytes bytes = recording_bytes(sample_recording(20));
  const std::size_t end = bytes.size();
  bytes.resize(end + 80);
  put(bytes, end + 4, std::uint32_t{0xfffffef0});  // its size
  std::memcpy(bytes.data() + end + 8, "NCSAmult", 8);
  put(bytes, 40, std::uint64_t{bytes.size()});  // where the file ends
  put(bytes, 48, std::uint64_t{end});           // where the block begins
  const long before = peak_memory();
  // Without it the file is as it was: HDF5 is told to pass over the block.
  write_text_file(file, std::string(bytes.begin(), bytes.end()));
  EXPECT_EQ(read_recording(file).time.size(), 20u);
  EXPECT_LT(peak_memory() - before, 100'000);
}

TEST_F(Hdf5Damage, TreesThatClaimMoreThanTheyHaveAreRefused) {
  const Bytes whole = recording_bytes(sample_recording(20));
  const std::vector<MetadataSum> sums = metadata_sums(whole);
  const std::size_t tree = place_of(whole, "BTHD");
  const long before = peak_memory();
  const auto rejected_with = [&](std::size_t offset, auto value) {
    Bytes bytes = whole;
    put(bytes, tree + offset, value);
    mend_metadata(bytes, sums);
    return rejected(bytes);
  };
  const std::string why = file.string() + ": cannot ";
  EXPECT_TRUE(rejected_with(5, std::uint8_t{2}).starts_with(why));  // kind
  EXPECT_TRUE(rejected_with(6, std::uint32_t{0xf0000000}).starts_with(why));
  EXPECT_TRUE(rejected_with(10, std::uint16_t{0xff0b}).starts_with(why));
  EXPECT_TRUE(rejected_with(12, std::uint16_t{1}).starts_with(why));  // depth
  EXPECT_TRUE(rejected_with(24, std::uint16_t{0xff05}).starts_with(why));
  EXPECT_LT(peak_memory() - before, 100'000);
}

TEST_F(Hdf5Damage, AttributesWithPartsThatEndBehindThemAreRefused) {
  const Bytes whole = recording_bytes(sample_recording(20));
  const std::vector<MetadataSum> sums = metadata_sums(whole);
  for (const char* name : {"filetype", "DIMENSION_LIST", "long_name"})
    for (const std::size_t before : {4u, 2u}) {  // sizes of type and of shape
      Bytes bytes = whole;
      put(bytes, place_of(whole, name) - before, std::uint16_t{0xff08});
      mend_metadata(bytes, sums);
      EXPECT_TRUE(rejected(bytes).starts_with(file.string() + ": cannot "))
          << name;
    }
}

// HDF5 copies as many bytes as type and shape ask for, from the header or from
// the heap that has the attribute.
TEST_F(Hdf5Damage, AttributesWithMoreValuesThanTheyHaveRoomForAreRefused) {
  const Bytes whole = recording_bytes(sample_recording(20));
  const std::vector<MetadataSum> sums = metadata_sums(whole);
  for (const std::string name : {"filetype", "long_name", "role"}) {
    Bytes bytes = whole;
    // Behind the name, in a multiple of 8 bytes: class and bits of the type,
    // then its size.
    const std::size_t size =
        place_of(whole, name) + name.size() / 8 * 8 + 8 + 4;
    ASSERT_EQ(bytes[size - 4] & 0xf, 3) << name;  // a text
    put(bytes, size, std::uint32_t{0x0fff});
    mend_metadata(bytes, sums);
    EXPECT_TRUE(rejected(bytes).ends_with("driver read request failed"))
        << name << ": " << rejected(bytes);
  }
}

TEST_F(Hdf5Damage, HeapsThatHdf5CannotHoldAreRefused) {
  const Bytes whole = recording_bytes(sample_recording(20));
  const std::vector<MetadataSum> sums = metadata_sums(whole);
  const std::size_t heap = place_of(whole, "FRHP");
  const auto is_refused_with = [&](std::size_t offset, std::uint8_t value) {
    Bytes bytes = whole;
    bytes[heap + offset] = value;
    mend_metadata(bytes, sums);
    return rejected(bytes).ends_with("driver read request failed");
  };
  // A tree of nothing, which HDF5 would delete when it closes the file: it
  // fails, and crashes at the end of a process that tidies up, as Python does.
  EXPECT_TRUE(is_refused_with(25, 0));
  EXPECT_TRUE(is_refused_with(110, 3));   // blocks in a row
  EXPECT_TRUE(is_refused_with(112, 1));   // first block, now of two bits
  EXPECT_TRUE(is_refused_with(128, 2));   // bits of offsets: rows below 0
  EXPECT_TRUE(is_refused_with(129, 1));   // of a heap beyond all addresses
  EXPECT_TRUE(is_refused_with(140, 99));  // rows
}

TEST_F(Hdf5Damage, ARecordingOfHundredsOfVariablesHasADeepTreeAndIsRead) {
  Recording recording = sample_recording(5);
  const Column column = recording.columns.front();
  for (int k = 0; k < 1500; ++k) {
    recording.columns.push_back(column);
    recording.columns.back().name = "extra_" + std::to_string(k);
  }
  Bytes bytes = recording_bytes(recording);
  const std::size_t tree = place_of(bytes, "BTHD");
  EXPECT_EQ(bytes[tree + 12], 2);  // depth
  EXPECT_EQ(rejected(bytes), "");
  // A child of the root that claims more records than it has room for.
  std::uint64_t root = 0;
  std::memcpy(&root, bytes.data() + tree + 16, sizeof root);
  const std::size_t records = bytes[tree + 24];
  const std::size_t record_size = bytes[tree + 10];
  const std::vector<MetadataSum> sums = metadata_sums(bytes);
  bytes[root + 6 + records * record_size + 8] = 0xff;
  mend_metadata(bytes, sums);
  EXPECT_NE(rejected(bytes), "");
}

/// Changes one or two bytes, mostly of summed metadata, and mends the sums.
Bytes damaged(const Bytes& whole, const std::vector<MetadataSum>& sums,
              std::mt19937& draw) {
  Bytes bytes = whole;
  const auto below = [&draw](std::size_t most) { return draw() % most; };
  for (std::size_t k = 0; k <= below(2); ++k) {
    std::size_t place = below(whole.size());
    if (below(5) > 0) {
      const MetadataSum& sum = sums[below(sums.size())];
      place = sum.begin + below(sum.end - sum.begin);
    }
    bytes[place] = below(2) == 0 ? (below(2) == 0 ? 0 : 255)
                                 : static_cast<std::uint8_t>(draw());
  }
  mend_metadata(bytes, sums);
  return bytes;
}

// What a reader must not do ends the process. The program and Python get more
// of them in tests/program/mended_damage_test.py.
TEST_F(Hdf5Damage, ChangesOfSummedMetadataAreReadOrRefused) {
  const Bytes whole = recording_bytes(sample_recording(20));
  const std::vector<MetadataSum> sums = metadata_sums(whole);
  ASSERT_GT(sums.size(), 30u);
  const long before = peak_memory();
  std::mt19937 draw(1);
  int refused = 0;
  constexpr int kChanges = 500;
  for (int k = 0; k < kChanges; ++k) {
    try {
      refused += rejected(damaged(whole, sums, draw)).empty() ? 0 : 1;
    } catch (const std::exception& error) {
      ADD_FAILURE() << k << ": " << error.what();
    }
  }
  EXPECT_GT(refused, kChanges / 5);
  EXPECT_LT(refused, kChanges * 4 / 5);
  EXPECT_LT(peak_memory() - before, 400'000);
}

}  // namespace
}  // namespace beamgyro::internal::hdf5_damage_test
