// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "dataset/files/open_file.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Positions in a file [bytes] at which the values of each variable begin:
/// little-endian doubles, and the bytes of the status.
struct Hdf5Layout {
  std::uint64_t time = 0, status = 0;
  std::vector<std::uint64_t> columns;
};

/// Makes `file` an HDF5 file for `samples` samples that is complete except for
/// the values. The caller writes these without the library, because HDF5 1.10
/// is unreliable after one of its own writes has failed (a full disk). Throws
/// Hdf5Error.
Hdf5Layout make_hdf5_file(const Recording& head, std::size_t samples,
                          OpenFile& file);

}  // namespace beamgyro::internal
