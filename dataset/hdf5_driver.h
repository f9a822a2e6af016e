// SPDX-License-Identifier: MIT
#pragma once

#include "dataset/hdf5_id.h"
#include "dataset/open_file.h"

namespace beamgyro {

// HDF5 reads and writes through a descriptor of ours in place of a name: what a
// signal interrupts is done again, and the reason of a failed system call is
// known whatever the library makes of it. `file` outlives the id.

H5Id open_hdf5_file(OpenFile& file);

/// Of a file that is open for reading and writing, in place of what it held.
H5Id create_hdf5_file(OpenFile& file);

/// Whether the bytes begin as HDF5 files do, with or without a block of the
/// user before them. Throws std::system_error.
bool is_hdf5_file(OpenFile& file);

/// Throws Hdf5Error when a system call has failed since QuietHdf5 began, also
/// one that the library took for an answer.
void check_system_calls();

}  // namespace beamgyro
