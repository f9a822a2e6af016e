// SPDX-License-Identifier: MIT
#include "dataset/netcdf/hdf5_heap.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <string_view>

#include "dataset/netcdf/hdf5_bytes.h"

namespace beamgyro::internal {

namespace {

// "Fractal Heap" of the HDF5 File Format Specification 3.0, with addresses and
// lengths of 8 bytes: where the header has
constexpr std::size_t kPacked = 7;          // size of what tells the filters
constexpr std::size_t kLargestObject = 10;  // that the heap holds
constexpr std::size_t kTree = 22;           // of objects too large for the heap
constexpr std::size_t kObjects = 86;        // their number
constexpr std::size_t kWidth = 110;         // blocks in a row
constexpr std::size_t kFirst = 112;         // bytes of a block in the first row
constexpr std::size_t kLargestBlock = 120;  // bytes of the largest direct block
constexpr std::size_t kBits = 128;          // of offsets in the heap
constexpr std::size_t kRoot = 132;          // place of the block above all
constexpr std::size_t kRows = 140;          // that the root has now
constexpr std::size_t kHeapHeaderBytes = 142;

// Blocks: signature, version, place of the header, offset in the heap.
constexpr std::size_t kBlockSignature = 4, kPointer = 8;
constexpr std::size_t kBeforeOffset = kBlockSignature + 1 + kPointer;

std::uint64_t bits_of(std::uint64_t power) {
  return static_cast<std::uint64_t>(std::countr_zero(power));
}

/// Without it the number of rows, for which HDF5 makes room, is below 0.
bool has_sound_rows(std::span<const std::byte> header) {
  constexpr std::uint64_t kMostBits = 64;
  const std::uint64_t width = little_number(header, kWidth, 2);
  const std::uint64_t first = little_number(header, kFirst, 8);
  const std::uint64_t largest = little_number(header, kLargestBlock, 8);
  const std::uint64_t bits = little_number(header, kBits, 2);
  for (const std::uint64_t size : {width, first, largest})
    if (!std::has_single_bit(size)) return false;
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

std::optional<FractalHeap> FractalHeap::at(std::uint64_t place,
                                           const Read& read) {
  constexpr std::uint64_t kMostBits = 56;  // all sums below are within 64
  std::array<std::byte, kHeapHeaderBytes> header{};
  if (!read(place, header) || !starts_with(header, "FRHP") ||
      !is_sound_heap(header) || little_number(header, kPacked, 2) != 0)
    return std::nullopt;
  FractalHeap heap;
  heap.width_ = little_number(header, kWidth, 2);
  heap.first_ = little_number(header, kFirst, 8);
  heap.largest_ = little_number(header, kLargestBlock, 8);
  heap.root_ = little_number(header, kRoot, 8);
  heap.rows_ = little_number(header, kRows, 2);
  const std::uint64_t bits = little_number(header, kBits, 2);
  if (bits > kMostBits || bits_of(heap.largest_) > bits) return std::nullopt;
  const std::uint64_t object = little_number(header, kLargestObject, 4);
  heap.offset_bytes_ = (bits + 7) / 8;
  heap.size_bytes_ = std::min(
      (bits_of(heap.largest_) + 7) / 8,
      (static_cast<std::uint64_t>(std::bit_width(object | 1)) + 7) / 8);
  return heap;
}

std::uint64_t FractalHeap::block_bytes(std::uint64_t row) const {
  return row == 0 ? first_ : first_ << (row - 1);
}

bool FractalHeap::is_at_its_place(const Block& block, const Read& read) const {
  std::array<std::byte, kBeforeOffset + kPointer> head{};
  const auto bytes = std::span(head).first(kBeforeOffset + offset_bytes_);
  return read(block.place, bytes) &&
         starts_with(bytes, block.rows == 0 ? "FHDB" : "FHIB") &&
         little_number(bytes, kBeforeOffset, offset_bytes_) == block.start;
}

std::optional<FractalHeap::Block> FractalHeap::below(const Block& above,
                                                     std::uint64_t offset,
                                                     const Read& read) const {
  const std::uint64_t within = offset - above.start;
  std::uint64_t row = 0, begin = 0;
  for (; row < above.rows; ++row) {
    if (within - begin < width_ * block_bytes(row)) break;
    begin += width_ * block_bytes(row);
  }
  if (row == above.rows) return std::nullopt;
  const std::uint64_t bytes = block_bytes(row);
  const std::uint64_t column = (within - begin) / bytes;
  std::array<std::byte, kPointer> address{};
  if (!read(above.place + kBeforeOffset + offset_bytes_ +
                kPointer * (row * width_ + column),
            address))
    return std::nullopt;
  const std::uint64_t rows =
      bytes <= largest_ ? 0 : bits_of(bytes) - bits_of(first_ * width_) + 1;
  if (rows >= above.rows) return std::nullopt;
  return Block{little_number(address, 0, kPointer),
               above.start + begin + column * bytes, bytes, rows};
}

std::optional<HeapObject> FractalHeap::object(
    std::span<const std::byte> identifier, const Read& read) const {
  ByteReader in(identifier);
  const bool is_managed = in.take(1) == 0;  // version 0, in a block
  const std::uint64_t offset = in.take(offset_bytes_);
  const std::uint64_t size = in.take(size_bytes_);
  if (!in.is_within() || !is_managed) return std::nullopt;
  Block block{root_, 0, first_, rows_};
  while (block.rows > 0) {
    if (!is_at_its_place(block, read)) return std::nullopt;
    const std::optional<Block> next = below(block, offset, read);
    if (!next) return std::nullopt;
    block = *next;
  }
  const std::uint64_t within = offset - block.start;
  if (!is_at_its_place(block, read) || within > block.bytes ||
      size > block.bytes - within)
    return std::nullopt;
  return HeapObject{block.place + within, size};
}

}  // namespace beamgyro::internal
