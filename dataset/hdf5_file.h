// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "dataset/recording.h"

namespace beamgyro {

inline constexpr int kRecordingFormatVersion = 1;

/// Reads back everything write_recording() wrote: columns in the order of the
/// file, with units, long_name, role and values; texts /meta lacks are empty.
/// Throws std::invalid_argument naming the file for one that is missing,
/// damaged, not HDF5, not a recording, of a newer format_version, or whose
/// content has a defect.
Recording read_recording(const std::filesystem::path& path);

}  // namespace beamgyro
