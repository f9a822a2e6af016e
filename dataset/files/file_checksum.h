// SPDX-License-Identifier: MIT
#pragma once

#include "dataset/files/open_file.h"

namespace beamgyro::internal {

// A recording ends with a line that HDF5 ignores: the SHA-256 of all bytes
// before it. It is verified before HDF5 opens the file, because HDF5 can crash
// on damage. Failures to read are std::system_error without the name of the
// file.

/// Appends the line to `file`, which is open for reading and writing.
void append_checksum(OpenFile& file);

enum class FileChecksum {
  kNone,   // no such line
  kRight,  // of these bytes
  kWrong,  // of others: the file is damaged
};

FileChecksum checksum_of(OpenFile& file);

/// Returns whether there is such a line, whether its checksum is right or not.
bool has_checksum(OpenFile& file);

/// Returns whether other bytes than such a line follow the end of the HDF5
/// file, which the file itself states. HDF5 cuts off what follows when it
/// changes a file.
bool has_bytes_after_hdf5(OpenFile& file);

}  // namespace beamgyro::internal
