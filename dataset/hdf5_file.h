// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "dataset/recording.h"

namespace beamgyro {

inline constexpr int kRecordingFormatVersion = 2;

/// Reads back everything write_recording() wrote: columns in the order of the
/// file, with units, long_name, role and values; texts /meta lacks are empty.
/// Variables that beamgyro knows are in its units, whatever unit the file has.
/// A checksum is verified before HDF5 sees the file; a file without one was
/// made or changed by another program; `has_checksum` tells. Throws
/// std::invalid_argument naming the file for one that is missing, damaged, not
/// HDF5, not a recording, of a newer format_version, that leads out of itself,
/// claims more than it can hold, has text of variable length or an unknown
/// unit, or whose content has a defect; std::runtime_error when the system
/// fails to read it.
Recording read_recording(const std::filesystem::path& path,
                         bool* has_checksum = nullptr);

}  // namespace beamgyro
