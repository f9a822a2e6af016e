// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

inline constexpr const char* kRecordingFiletype = "beamgyro-recording";

inline constexpr int kRecordingFormatVersion = 2;

/// Reads everything that write_recording() wrote: columns in the order of the
/// file, with units, long_name, role and values. Texts that /meta lacks are
/// empty. Variables that beamgyro knows are converted to its units. A checksum
/// is verified before HDF5 opens the file. `has_checksum` receives whether
/// there was one; a file without one was made or changed by another program.
/// Throws std::invalid_argument naming the file when it
/// - is missing, damaged, not HDF5, not a recording or of a newer
///   format_version;
/// - leads to other files, or claims more values than it can hold;
/// - has text of variable length or an unknown unit;
/// - has content with a defect (recording_defect()).
/// Throws std::runtime_error when the system fails to read it.
Recording read_recording(const std::filesystem::path& path,
                         bool* has_checksum = nullptr);

}  // namespace beamgyro::internal
