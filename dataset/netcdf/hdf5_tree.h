// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

namespace beamgyro::internal {

/// Returns false for a node of a B-tree of version 1 that indexes chunks if
/// their places do not increase, or if one has passed filters that no file of
/// beamgyro has. HDF5 looks a chunk up in one way to tell of it and in another
/// to read it, and finds two then. True for other bytes.
bool is_sound_chunk_node(std::span<const std::byte> node);

// The header of a B-tree of version 2, and where it has the kind of records.
inline constexpr std::size_t kTreeHeaderBytes = 38, kTreeKind = 5;

/// Returns whether these are the first bytes of a B-tree of version 2.
bool is_tree(std::span<const std::byte> header);

/// Returns whether a tree, which a file of `file_size` bytes has, is as HDF5
/// 1.10 takes for granted that trees are; it crashes on others, or takes the
/// memory that they claim.
/// - Its records are links or attributes, and of their size.
/// - Its nodes fit into the file, all of them together.
/// - No node claims more records than it has room for.
/// - `is_sound_record`, if given, is true of each record.
/// `read` fills bytes from a place of the file, or returns false.
bool is_sound_tree(std::span<const std::byte> header, std::uint64_t file_size,
                   const std::function<bool(std::uint64_t place,
                                            std::span<std::byte> bytes)>& read,
                   const std::function<bool(std::span<const std::byte> record)>&
                       is_sound_record = {});

}  // namespace beamgyro::internal
