// SPDX-License-Identifier: MIT
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <string>

namespace beamgyro::internal {

/// Checks how the values of a variable are stored. Throws Hdf5Error unless
/// - all of them stand in the variable's own file;
/// - they pass no other filters than shuffle, deflate and fletcher32, and
///   deflate once at most, because HDF5 inflates a chunk by up to 1032 to 1;
/// - the file is large enough for them, because HDF5 does not compare the
///   claims of a variable with the size of the file;
/// - a chunk of them takes no more than an eighth of room_for_values().
void check_storage(hid_t variable, const std::string& name);

/// Checks the chunks of one row of a variable of one or two dimensions, those
/// of one dimension all of them, before they are read: HDF5 reads one that is
/// smaller than it claims, or inflates to less, beyond its end. Throws
/// Hdf5Error for such a chunk, and when a variable of one dimension takes more
/// than room_for_values().
void check_chunks_of_row(hid_t variable, const std::string& name, hsize_t row);

/// Returns the memory that the values of a file may take [bytes]. Deflate
/// compresses signals with noise to a tenth, and constants to a thousandth.
std::uint64_t room_for_values(hid_t file);

/// Throws Hdf5Error: the values of `name` are in other files.
[[noreturn]] void reject_view(const std::string& name);

}  // namespace beamgyro::internal
