// SPDX-License-Identifier: MIT
#pragma once

#include <hdf5.h>

#include <string>

namespace beamgyro {

/// Throws Hdf5Error unless all values of `variable` stand in its own file, as
/// they are or through shuffle, deflate (once, as HDF5 inflates a chunk by up
/// to 1032 to 1 whatever it claims) and fletcher32, and unless the file is
/// large enough for them: HDF5 does not compare what a variable claims with the
/// size of the file.
void check_storage(hid_t variable, const std::string& name);

}  // namespace beamgyro
