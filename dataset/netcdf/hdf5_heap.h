// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

namespace beamgyro::internal {

/// Returns whether bytes are anything else than the header of a fractal heap,
/// or one with which HDF5 1.10 does not
/// - delete a tree when it closes the file: in one that is only read this
///   fails, and the half closed file crashes the library at the end of the
///   process;
/// - make room for rows of blocks without number.
bool is_sound_heap(std::span<const std::byte> bytes);

}  // namespace beamgyro::internal
