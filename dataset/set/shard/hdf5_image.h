// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "dataset/netcdf/hdf5_id.h"

namespace beamgyro::internal {

/// Makes a new HDF5 file in memory. Throws Hdf5Error.
H5Id make_image();

/// Returns the present bytes of such a file. They are valid until its next
/// change. All its variables must be closed. Throws Hdf5Error.
std::span<const std::byte> image_bytes(const H5Id& file);

}  // namespace beamgyro::internal
