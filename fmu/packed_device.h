// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/document.h"
#include "config/range.h"
#include "sim/device/device.h"
#include "sim/stepper/step_inputs.h"

namespace beamgyro::internal {

// The resources of an FMU.
inline constexpr const char* kPackedDevice = "device.toml";
inline constexpr const char* kPackedOverrides = "overrides.txt";
inline constexpr const char* kPackedFidelity = "fidelity.txt";

/// A number of a device file, as a parameter of the FMU.
struct DeviceKey {
  std::string name;                  // "beam.length_m", "patches.offset_m[1]"
  std::vector<std::string> path;     // without the index
  std::optional<std::size_t> index;  // in an array, from 0
  double value;
  Range range;
  bool whole;  // an integer
};

/// The device inside an FMU: its text with the overrides of the command that
/// packed it, and the fidelity that it is stepped in. It does not change; many
/// threads may use it at once.
class PackedDevice {
 public:
  /// `overrides` has one KEY=VALUE a line. Throws std::invalid_argument with
  /// file, line and key, and for a fidelity in which no gyro is stepped.
  PackedDevice(const std::string& text, const std::string& overrides,
               const std::string& fidelity = "quasistatic");

  /// Reads the resources of an unpacked FMU. Throws as the constructor, and for
  /// files that cannot be read.
  static PackedDevice read(const std::filesystem::path& resources);

  /// The SHA-256 of the resources, by which an FMU names what it needs.
  const std::string& token() const { return token_; }

  /// Every number of the device file that the program reads, in a fixed order.
  /// An index counts from 1 in a name, as FMI has it.
  const std::vector<DeviceKey>& keys() const { return keys_; }

  const DeviceParameters& parameters() const { return parameters_; }
  StepFidelity fidelity() const { return fidelity_; }

  /// Returns the device with `values` in place of those of keys(). Throws
  /// std::invalid_argument for values that do not fit each other.
  DeviceParameters with(const std::vector<double>& values) const;

 private:
  ConfigDocument document_;
  StepFidelity fidelity_;
  std::string token_;
  DeviceParameters parameters_;
  std::vector<DeviceKey> keys_;
};

}  // namespace beamgyro::internal
