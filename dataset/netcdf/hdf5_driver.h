// SPDX-License-Identifier: MIT
#pragma once

#include "dataset/files/open_file.h"
#include "dataset/netcdf/hdf5_id.h"

namespace beamgyro::internal {

// Lets HDF5 read and write through our own file descriptor. Calls that a signal
// interrupts are repeated, and the reason of a failed system call is kept,
// whatever the library makes of it. `file` must outlive the id.

H5Id open_hdf5_file(OpenFile& file);

/// Makes a new HDF5 file in a file that is open for reading and writing, and
/// discards its content.
H5Id create_hdf5_file(OpenFile& file);

/// Throws Hdf5Error when a system call has failed since QuietHdf5 began, even
/// if the library ignored the failure.
void check_system_calls();

/// Returns whether HDF5 asked for a global heap since this was called last. A
/// file that is open to be read does not give it: HDF5 1.10 does not check such
/// a heap, and damage in it crashes or hangs the library. Only texts of
/// variable length and views of other files need one.
bool take_met_global_heap();

}  // namespace beamgyro::internal
