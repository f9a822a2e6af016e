// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "dataset/hdf5_id.h"

namespace beamgyro {

/// A new HDF5 file that is only in memory. Throws Hdf5Error.
H5Id make_image();

/// The bytes of such a file so far, which live until its next change. All its
/// variables must be closed. Throws Hdf5Error.
std::span<const std::byte> image_bytes(const H5Id& file);

}  // namespace beamgyro
