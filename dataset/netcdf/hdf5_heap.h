// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

namespace beamgyro::internal {

/// Returns whether bytes are anything else than the header of a fractal heap,
/// or one with which HDF5 1.10 does not
/// - delete a tree when it closes the file: in one that is only read this
///   fails, and the half closed file crashes the library at the end of the
///   process;
/// - make room for rows of blocks without number.
bool is_sound_heap(std::span<const std::byte> bytes);

/// Where an object of a heap stands in the file.
struct HeapObject {
  std::uint64_t place, size;
};

/// A fractal heap of a file: rows of blocks, each twice as large as the one
/// before.
class FractalHeap {
 public:
  using Read =
      std::function<bool(std::uint64_t place, std::span<std::byte> bytes)>;

  /// The heap at a place; nothing where none is, or one that is not sound or
  /// packed, which no heap of links and attributes is.
  static std::optional<FractalHeap> at(std::uint64_t place, const Read& read);

  /// Finds the object of an identifier; nothing if it is not within one block
  /// of the heap, or is too large for the heap or so small that it stands in
  /// its identifier.
  std::optional<HeapObject> object(std::span<const std::byte> identifier,
                                   const Read& read) const;

 private:
  FractalHeap() = default;
  struct Block {
    std::uint64_t place, start, bytes, rows;  // without rows a direct one
  };
  /// The block below `above` that has an offset of the heap.
  std::optional<Block> below(const Block& above, std::uint64_t offset,
                             const Read& read) const;
  /// Whether a block has its signature and says where in the heap it begins.
  bool is_at_its_place(const Block& block, const Read& read) const;
  std::uint64_t block_bytes(std::uint64_t row) const;

  std::uint64_t width_ = 0;            // blocks in a row
  std::uint64_t first_ = 0;            // bytes of a block in the first row
  std::uint64_t largest_ = 0;          // bytes of the largest direct block
  std::uint64_t root_ = 0, rows_ = 0;  // of the block above all
  std::size_t offset_bytes_ = 0, size_bytes_ = 0;  // in an identifier
};

}  // namespace beamgyro::internal
