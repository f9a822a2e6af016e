// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace beamgyro::internal {

// HDF5's filters shuffle, deflate and fletcher32, computed outside of HDF5,
// whose lock admits one thread at a time.

/// Returns the checksum that HDF5 puts behind a chunk: Fletcher's over 16-bit
/// big-endian words, modulo 65535. An odd last byte is the upper half of a
/// word.
std::uint32_t fletcher32(std::span<const std::byte> bytes);

/// Writes the first bytes of all values, then their second bytes, and so on.
/// `values` has a whole number of values of `width` bytes; `out` has the same
/// size.
void shuffle(std::span<const std::byte> values, std::size_t width,
             std::span<std::byte> out);

/// A chunk in the form in which it stands in the file.
struct PackedChunk {
  std::vector<std::byte> bytes;
  std::uint32_t skipped_filters = 0;  // bit i: filter i was not applied
};

/// Packs chunks one after the other. Not safe for use by two threads at once.
class ChunkPacker {
 public:
  ChunkPacker();
  ~ChunkPacker();
  ChunkPacker(const ChunkPacker&) = delete;
  ChunkPacker& operator=(const ChunkPacker&) = delete;

  /// Shuffles, deflates and adds the checksum. If deflate saves less than a
  /// tenth, only the checksum is added.
  PackedChunk pack(std::span<const std::byte> values, std::size_t width);

 private:
  struct Deflate;

  std::unique_ptr<Deflate> deflate_;
  std::vector<std::byte> shuffled_, packed_;
};

}  // namespace beamgyro::internal
