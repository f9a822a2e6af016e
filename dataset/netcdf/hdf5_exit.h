// SPDX-License-Identifier: MIT
#pragma once

namespace beamgyro::internal {

/// Keeps HDF5 from tidying up at the end of the process, where 1.10 crashes
/// after a full disk. For programs, before any other use of HDF5.
void keep_hdf5_open_at_exit();

}  // namespace beamgyro::internal
