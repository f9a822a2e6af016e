// SPDX-License-Identifier: MIT
/// \file
/// Compensators as C source, autopilot parameters and noise of filters; devices
/// as parameters of simulators.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "beamgyro/compensator.h"
#include "beamgyro/device.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

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
  /// What the files say and leave out, with figures; comments in them, too.
  std::vector<std::string> remarks = {};
};

/// Returns the files that `beamgyro export` writes. `format` is "c", "px4",
/// "ardupilot" or "ekf"; px4 and ardupilot take up to three compensators, one
/// for each axis. Throws std::invalid_argument for an option that the format
/// does not have, and for a compensator that it cannot express.
ExportResult export_files(const std::vector<Compensator>& compensators,
                          const std::string& format,
                          const ExportOptions& options = {});

struct SimulatorExportOptions {
  std::string name = {};  ///< of the files; else of the device or compensator
  /// Of the simulator's gyro for each device: "x", "y", "z"; z for one, x, y, z
  /// for three without.
  std::vector<std::string> axes = {};
  bool fit_cubic = false;            ///< as in ExportOptions
  std::optional<int> instance = {};  ///< ardupilot-sitl: 1 to 3; 1 without
  /// ardupilot-sitl: of the chamber in which the devices are swept;
  /// -40 to 50 without
  std::optional<std::pair<double, double>> range_degC = {};
  /// Still air at power-on; 25 without
  std::optional<double> temperature_degC = {};
  std::optional<double> update_rate_Hz = {};  ///< sdf; 100 without
};

/// Returns the files that `beamgyro export` writes for simulators
/// (docs/reference/simulator_parameters.md). `format` is
/// - "ardupilot-sitl": up to three devices, one for each axis, or as many
///   compensators, or both. The drift of the devices becomes the disturbance,
///   the compensators become the compensation; either stands for the other
///   where it is not given;
/// - "sdf": one device and no compensator.
/// Throws std::invalid_argument for an option that the format does not have,
/// for a range that the parameters cannot hold and for a compensator that is
/// no cubic, and as simulate().
ExportResult export_for_simulator(const std::vector<Device>& devices,
                                  const std::vector<Compensator>& compensators,
                                  const std::string& format,
                                  const SimulatorExportOptions& options = {});

/// Writes up to 16 files to a directory. The directory and those above it are
/// made where they are missing. Files that are there keep their contents until
/// all new ones are complete; a failure while these are renamed can leave some
/// new and some old. Throws std::invalid_argument for a name that cannot be
/// written, has a directory in it or is that of two files, and
/// std::runtime_error when writing fails.
void write_exported(const std::filesystem::path& directory,
                    const std::vector<ExportedFile>& files);

}  // namespace beamgyro
