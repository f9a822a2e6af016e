// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "dataset/files/open_file.h"

namespace beamgyro::internal {

/// Returns whether the bytes begin like an HDF5 file, with or without a user
/// block. Throws std::system_error.
bool is_hdf5_file(OpenFile& file);

/// Returns how many bytes the file has by its first block (a superblock without
/// a block of the user before it), or 0 where that does not tell. Throws
/// std::system_error.
std::uint64_t stated_hdf5_size(OpenFile& file);

}  // namespace beamgyro::internal
