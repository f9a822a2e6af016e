// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "dataset/recording.h"

namespace beamgyro {

inline constexpr int kRecordingFormatVersion = 1;

/// Writes `recording` as an HDF5 file that netCDF-4 tools read too: /time as
/// the dimension scale of every variable, /status, one variable per column,
/// the texts below /meta. The bytes depend on the recording only. The file
/// appears under its name when it is complete (AtomicFile). Throws
/// std::runtime_error for a recording with a defect (recording_defect()), named
/// with variable and sample, and when writing fails; std::invalid_argument for
/// a name that cannot be written.
void write_recording(const Recording& recording,
                     const std::filesystem::path& path);

/// Reads back everything write_recording() wrote: columns in the order of the
/// file, with units, long_name, role and values; texts /meta lacks are empty.
/// Throws std::invalid_argument naming the file for one that is missing,
/// damaged, not HDF5, not a recording, of a newer format_version, or whose
/// content has a defect.
Recording read_recording(const std::filesystem::path& path);

}  // namespace beamgyro
