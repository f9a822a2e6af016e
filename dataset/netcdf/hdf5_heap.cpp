// SPDX-License-Identifier: MIT
#include "dataset/netcdf/hdf5_heap.h"

#include <bit>
#include <cstdint>
#include <limits>

#include "dataset/netcdf/hdf5_bytes.h"

namespace beamgyro::internal {

namespace {

// "Fractal Heap" of the HDF5 File Format Specification 3.0, with addresses and
// lengths of 8 bytes: where the header has
constexpr std::size_t kTree = 22;           // of objects too large for the heap
constexpr std::size_t kObjects = 86;        // their number
constexpr std::size_t kWidth = 110;         // blocks in a row
constexpr std::size_t kFirst = 112;         // bytes of a block in the first row
constexpr std::size_t kLargestBlock = 120;  // bytes of the largest direct block
constexpr std::size_t kBits = 128;          // of offsets in the heap
constexpr std::size_t kRows = 140;          // that the root has now
constexpr std::size_t kHeapHeaderBytes = 142;

/// Without it the number of rows, for which HDF5 makes room, is below 0.
bool has_sound_rows(std::span<const std::byte> header) {
  constexpr std::uint64_t kMostBits = 64;
  const std::uint64_t width = little_number(header, kWidth, 2);
  const std::uint64_t first = little_number(header, kFirst, 8);
  const std::uint64_t largest = little_number(header, kLargestBlock, 8);
  const std::uint64_t bits = little_number(header, kBits, 2);
  for (const std::uint64_t size : {width, first, largest})
    if (!std::has_single_bit(size)) return false;
  const auto bits_of = [](std::uint64_t power) {
    return static_cast<std::uint64_t>(std::countr_zero(power));
  };
  const std::uint64_t in_first_row = bits_of(width) + bits_of(first);
  return first <= largest && in_first_row <= bits && bits <= kMostBits &&
         little_number(header, kRows, 2) <= bits - in_first_row + 1;
}

}  // namespace

bool is_sound_heap(std::span<const std::byte> bytes) {
  constexpr auto kUndefined = std::numeric_limits<std::uint64_t>::max();
  if (!starts_with(bytes, "FRHP")) return true;
  if (bytes.size() < kHeapHeaderBytes) return false;
  const bool has_tree = little_number(bytes, kTree, 8) != kUndefined;
  return has_tree == (little_number(bytes, kObjects, 8) > 0) &&
         has_sound_rows(bytes);
}

}  // namespace beamgyro::internal
