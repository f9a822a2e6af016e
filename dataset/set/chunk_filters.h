// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace beamgyro {

// HDF5's filters shuffle, deflate and fletcher32 outside of HDF5, whose lock
// lets one thread through at a time.

/// The checksum HDF5 puts behind a chunk: Fletcher's over 16-bit big-endian
/// words, modulo 65535; an odd last byte is the upper half of a word.
std::uint32_t fletcher32(std::span<const std::byte> bytes);

/// First bytes of all values, then their second bytes, and so on. `values` is
/// a whole number of values of `width` bytes; `out` has its size.
void shuffle(std::span<const std::byte> values, std::size_t width,
             std::span<std::byte> out);

/// A chunk as it stands in the file.
struct PackedChunk {
  std::vector<std::byte> bytes;
  std::uint32_t skipped_filters = 0;  // bit i: filter i was not applied
};

/// Packs chunks one after the other; not for two threads at once.
class ChunkPacker {
 public:
  ChunkPacker();
  ~ChunkPacker();
  ChunkPacker(const ChunkPacker&) = delete;
  ChunkPacker& operator=(const ChunkPacker&) = delete;

  /// Shuffled, deflated and summed, or only summed when deflate saves less than
  /// a tenth.
  PackedChunk pack(std::span<const std::byte> values, std::size_t width);

 private:
  struct Deflate;

  std::unique_ptr<Deflate> deflate_;
  std::vector<std::byte> shuffled_, packed_;
};

}  // namespace beamgyro
