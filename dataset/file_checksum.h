// SPDX-License-Identifier: MIT
#pragma once

#include "dataset/open_file.h"

namespace beamgyro {

// A recording ends with a line that HDF5 does not look at: the SHA-256 of all
// bytes before it. It tells damage before HDF5, which can crash on damage, gets
// to see the file. Failures to read are std::system_error without the name of
// the file.

/// Ends `file`, which is open for reading and writing, with the line.
void append_checksum(OpenFile& file);

enum class FileChecksum {
  kNone,   // no such line
  kRight,  // of these bytes
  kWrong,  // of others: the file is damaged
};

FileChecksum checksum_of(OpenFile& file);

/// Whether there is a line, right or wrong.
bool has_checksum(OpenFile& file);

/// Whether something that is no such line follows the end of an HDF5 file, as
/// the file itself tells it. HDF5 cuts off what follows when it changes a file.
bool has_bytes_after_hdf5(OpenFile& file);

}  // namespace beamgyro
