// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "dataset/files/open_file.h"

namespace beamgyro::internal {

/// With which every HDF5 file begins, behind a block of the user if it has one.
inline constexpr std::string_view kHdf5Signature = "\x89HDF\r\n\x1a\n";

/// Returns whether the bytes begin like an HDF5 file, with or without a user
/// block. Throws std::system_error.
bool is_hdf5_file(OpenFile& file);

}  // namespace beamgyro::internal
