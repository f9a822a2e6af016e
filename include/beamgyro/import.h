// SPDX-License-Identifier: MIT
/// \file
/// Logs of real gyros.
#pragma once

#include <filesystem>
#include <string>

#include "beamgyro/recording.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

struct ImportOptions {
  std::string axis = {};  ///< "x", "y" or "z" where the map has several
  /// The second log of a map with a table [join].
  std::filesystem::path join = {};
};

struct ImportedRecording {
  Recording recording;
  std::string text;  ///< what `beamgyro import` prints
};

/// Converts a log of delimiter-separated text into a recording, as a map states
/// (docs/reference/log_map.md). write_recording() makes the bytes that
/// `beamgyro import` writes. Throws std::invalid_argument "file:line:column:
/// ..." for a log or a map that is not as it should be.
ImportedRecording import_log(const std::filesystem::path& log,
                             const std::filesystem::path& map,
                             const ImportOptions& options = {});
/// The same for the text of a map in memory, called `name` in messages.
ImportedRecording import_log(const std::filesystem::path& log,
                             const std::string& map_text,
                             const std::string& name,
                             const ImportOptions& options = {});

}  // namespace beamgyro
