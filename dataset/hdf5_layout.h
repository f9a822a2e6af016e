// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "dataset/open_file.h"
#include "dataset/recording.h"

namespace beamgyro {

/// Where in a file the values of each variable begin [bytes]; little-endian
/// doubles, the status bytes.
struct Hdf5Layout {
  std::uint64_t time = 0, status = 0;
  std::vector<std::uint64_t> columns;
};

/// Makes `file` an HDF5 file for `samples` samples, complete but for the
/// values, which are written around the library: after a write of its own that
/// failed (a full disk), HDF5 1.10 is not to be relied on. Throws Hdf5Error.
Hdf5Layout make_hdf5_file(const Recording& head, std::size_t samples,
                          OpenFile& file);

}  // namespace beamgyro
