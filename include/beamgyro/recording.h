// SPDX-License-Identifier: MIT
/// \file
/// Recordings: what a run of a gyro leaves, in memory and in files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

/// Role of a variable: `kMeasured` is measured by the gyro and may be an input
/// of a compensator, `kTruth` is known to a simulator only, `kCompensated` is
/// the answer of a compensator.
enum class Role { kMeasured, kTruth, kCompensated };

/// Returns the name of a role in files: "measured", "truth", "compensated".
std::string_view role_name(Role role);

/// Bits of `Recording::status`.
enum StatusBit : std::uint8_t {
  kUnpowered = 1,
  kOutputSaturated = 2,
  kLoopNotLocked = 4,
};

/// A variable of a recording.
struct Column {
  std::string name;  ///< as in files: output, rate, temperature, true_rate, ...
  /// As in files: V, degree/s, degC, Hz. Of a variable that beamgyro knows, the
  /// unit of docs/reference/recording.md; calls take none for that one, but a
  /// file without it cannot be read.
  std::string units;
  std::string long_name;
  Role role = Role::kMeasured;
  std::vector<double> values;  ///< one per time; NaN = measured while unpowered
  std::string comment = {};    ///< attribute of the variable; mostly empty
};

/// One run of one gyro in memory, in the units of the file
/// (docs/reference/recording.md): columns over a common time axis. Simulator
/// and compensators exchange data in this form only.
struct Recording {
  std::vector<double> time;          ///< [s], strictly increasing
  std::vector<std::uint8_t> status;  ///< StatusBit mask, one per time
  std::vector<Column> columns;

  std::string fidelity;  ///< "quasistatic", ...
  std::uint64_t seed = 0;
  std::string title;    ///< of the scenario; empty in old files
  std::string history;  ///< a line for each command that made it
  /// Of the variable compensated_rate.
  std::string compensator, compensator_sha256;
  std::string program_version;  ///< of the program that made the recording
  std::string git_revision;
  std::string scenario_text;  ///< both files byte for byte as read
  std::string device_text;
  std::string overrides_text;  ///< one KEY=VALUE per line
  std::string run;             ///< its name where it is validated; not in files
};

/// Returns the column called `name`, or nullptr.
const Column* find_column(const Recording& recording, std::string_view name);

/// Returns the values of the column called `name`. Throws std::invalid_argument
/// that names the column and lists the columns of the recording.
const std::vector<double>& column_values(const Recording& recording,
                                         std::string_view name);

/// Reads a recording, as CSV when the name ends in .csv, else as HDF5.
/// Variables that beamgyro knows are converted to its units. A file without a
/// checksum, which another program made or changed, gives a line in `warnings`.
/// Throws std::invalid_argument naming the file, and the line of a CSV, for a
/// file that is missing, damaged, no recording or of a newer format, and
/// std::runtime_error when the system fails to read it. Calls for different
/// files may run at once; HDF5 lets one thread in at a time.
Recording read_recording(const std::filesystem::path& path,
                         std::vector<std::string>* warnings = nullptr);

/// Writes a recording, as CSV when the name ends in .csv, else as HDF5 in the
/// layout of netCDF-4. The file appears under its name when it is complete. The
/// same recording gives the same bytes. Throws std::invalid_argument for a name
/// that cannot be written, and std::runtime_error for a recording with a defect
/// (times that do not increase, columns of another length, a NaN while powered,
/// a value beyond +-1e12, another unit or role than the table of variables has)
/// and when writing fails.
void write_recording(const Recording& recording,
                     const std::filesystem::path& path);

}  // namespace beamgyro
