// SPDX-License-Identifier: MIT
#pragma once

#include "dataset/files/open_file.h"

namespace beamgyro::internal {

/// Returns whether the bytes begin like an HDF5 file, with or without a user
/// block. Throws std::system_error.
bool is_hdf5_file(OpenFile& file);

}  // namespace beamgyro::internal
