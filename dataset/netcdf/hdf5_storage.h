// SPDX-License-Identifier: MIT
#pragma once

#include <hdf5.h>

#include <string>

namespace beamgyro::internal {

/// Checks how the values of a variable are stored. Throws Hdf5Error unless
/// - all of them stand in the variable's own file;
/// - they pass no other filters than shuffle, deflate and fletcher32, and
///   deflate once at most, because HDF5 inflates a chunk by up to 1032 to 1;
/// - the file is large enough for them, because HDF5 does not compare the
///   claims of a variable with the size of the file.
void check_storage(hid_t variable, const std::string& name);

/// Checks the chunks of one row of a variable of one or two dimensions, those
/// of one dimension all of them. Throws Hdf5Error for one that was not deflated
/// and has fewer bytes than it claims; check_storage() looks at variables of
/// one dimension.
void check_chunks_of_row(hid_t variable, const std::string& name, hsize_t row);

/// Throws Hdf5Error: the values of `name` are in other files.
[[noreturn]] void reject_view(const std::string& name);

}  // namespace beamgyro::internal
