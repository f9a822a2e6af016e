// SPDX-License-Identifier: MIT
/// \file
/// Compensators as C source, autopilot parameters and noise of filters.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "beamgyro/compensator.h"

namespace beamgyro {

struct ExportOptions {
  std::string name = {};  ///< of files and functions; else of the compensator
  /// Of the autopilot's gyro for each compensator, or of the robot: "x", "y",
  /// "z"; z for one compensator, x, y, z for three without.
  std::vector<std::string> axes = {};
  bool force = false;      ///< c: also where the firmware would be wrong
  bool fit_cubic = false;  ///< px4, ardupilot: the cubic of the same rows
  std::optional<int> instance = {};                ///< px4, ardupilot
  std::optional<std::int64_t> device_id = {};      ///< px4
  std::optional<std::filesystem::path> rest = {};  ///< ekf: recording at rest
  std::optional<double> ramp_K_per_min = {};    ///< ekf; 0 to 1000; 1 without
  std::optional<double> correlation_K = {};     ///< ekf; above 0; 10 without
  std::optional<double> temperature_degC = {};  ///< ekf; -273.15 to 1000
};

/// A text file without its folder.
struct ExportedFile {
  std::string name, text;
};

struct ExportResult {
  std::vector<ExportedFile> files;
  std::vector<std::string> warnings;
};

/// Returns the files that `beamgyro export` writes. `format` is "c", "px4",
/// "ardupilot" or "ekf"; px4 and ardupilot take up to three compensators, one
/// for each axis. Throws std::invalid_argument for an option that the format
/// does not have, and for a compensator that it cannot express.
ExportResult export_files(const std::vector<Compensator>& compensators,
                          const std::string& format,
                          const ExportOptions& options = {});

/// Writes up to 16 files to a directory. The directory and those above it are
/// made where they are missing. Files that are there keep their contents until
/// all new ones are complete; a failure while these are renamed can leave some
/// new and some old. Throws std::invalid_argument for a name that cannot be
/// written, has a directory in it or is that of two files, and
/// std::runtime_error when writing fails.
void write_exported(const std::filesystem::path& directory,
                    const std::vector<ExportedFile>& files);

}  // namespace beamgyro
