// SPDX-License-Identifier: MIT
#include "dataset/set/shard/chunk_filters.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace beamgyro::internal::chunk_filters_test {
namespace {

std::vector<std::byte> noise(std::size_t size) {
  std::vector<std::byte> bytes;
  std::uint32_t x = 1;
  for (std::size_t i = 0; i < size; ++i) {
    x = x * 1664525u + 1013904223u;
    bytes.push_back(static_cast<std::byte>(x >> 24));
  }
  return bytes;
}

/// The definition, one word after the other.
std::uint32_t slow_fletcher32(const std::vector<std::byte>& bytes) {
  std::uint64_t sum = 0, weighted = 0;
  const auto reduced = [](std::uint64_t x) {
    return x == 0 ? 0 : (x - 1) % 65535 + 1;
  };
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    std::uint64_t word = std::to_integer<std::uint64_t>(bytes[i]) << 8;
    if (i + 1 < bytes.size())
      word |= std::to_integer<std::uint64_t>(bytes[i + 1]);
    sum = reduced(sum + word);
    weighted = reduced(weighted + sum);
  }
  return static_cast<std::uint32_t>(weighted << 16 | sum);
}

TEST(Fletcher32, IsTheSumOfWordsAndOfTheirSums) {
  for (const std::size_t size : {0u, 1u, 2u, 3u, 703u, 704u, 705u, 100001u})
    EXPECT_EQ(fletcher32(noise(size)), slow_fletcher32(noise(size))) << size;
}

TEST(Fletcher32, TellsNoZerosFromAMultipleOfTheModulus) {
  EXPECT_EQ(fletcher32(std::vector<std::byte>(1000)), 0u);
  EXPECT_EQ(fletcher32(std::vector<std::byte>(1000, std::byte{0xff})),
            slow_fletcher32(std::vector<std::byte>(1000, std::byte{0xff})));
  EXPECT_EQ(fletcher32(std::vector<std::byte>(2, std::byte{0xff})),
            0xffffffffu);
}

TEST(Shuffle, PutsBytesOfEqualWeightTogether) {
  for (const std::size_t width : {1u, 2u, 4u, 8u}) {
    for (const std::size_t count : {0u, 1u, 15u, 16u, 17u, 1000u}) {
      const std::vector<std::byte> values = noise(width * count);
      std::vector<std::byte> shuffled(values.size());
      shuffle(values, width, shuffled);
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t b = 0; b < width; ++b)
          ASSERT_EQ(shuffled[b * count + i], values[i * width + b])
              << width << ' ' << count << ' ' << i;
      }
    }
  }
}

TEST(ChunkPacker, LeavesAloneWhatDeflateDoesNotShrink) {
  ChunkPacker packer;
  const std::vector<std::byte> values = noise(10000);
  const PackedChunk chunk = packer.pack(values, 4);
  EXPECT_EQ(chunk.skipped_filters, 3u);
  ASSERT_EQ(chunk.bytes.size(), values.size() + 4);
  EXPECT_TRUE(std::equal(values.begin(), values.end(), chunk.bytes.begin()));
  std::uint32_t sum = 0;
  std::memcpy(&sum, chunk.bytes.data() + values.size(), 4);
  EXPECT_EQ(sum, fletcher32(values));
}

TEST(ChunkPacker, ShrinksSmoothValuesAndIsTheSameEveryTime) {
  std::vector<std::int32_t> smooth(10000);
  for (std::size_t i = 0; i < smooth.size(); ++i)
    smooth[i] = 9000000 - static_cast<std::int32_t>(i / 3);
  const auto values = std::as_bytes(std::span(smooth));
  ChunkPacker packer;
  const PackedChunk chunk = packer.pack(values, 4);
  EXPECT_EQ(chunk.skipped_filters, 0u);
  EXPECT_LT(chunk.bytes.size(), values.size() / 4);
  packer.pack(noise(5000), 2);
  EXPECT_EQ(packer.pack(values, 4).bytes, chunk.bytes);
}

}  // namespace
}  // namespace beamgyro::internal::chunk_filters_test
