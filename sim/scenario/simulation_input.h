// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/document.h"
#include "dataset/log/csv_file.h"
#include "sim/device/device.h"
#include "sim/scenario/scenario.h"
#include "sim/scenario/scenario_file.h"

namespace beamgyro::internal {

/// A file that is in memory.
struct InputText {
  std::string text;
  std::string name;  // in messages; files that it names are relative to it
};

/// A device, with the overrides of the command applied.
struct LoadedDevice {
  DeviceParameters device;
  std::string text;  // byte for byte as read
};
LoadedDevice load_device(const std::filesystem::path& path,
                         const std::vector<std::string>& overrides);
/// The same for a text in memory.
LoadedDevice load_device(const InputText& input,
                         const std::vector<std::string>& overrides);

/// Texts of profile files by their lexically normal path.
using ProfileTexts = std::map<std::filesystem::path, std::string>;

/// A scenario, its device, and the texts that a recording stores.
struct LoadedScenario {
  ScenarioPlan scenario;
  DeviceParameters device;
  std::string scenario_text, device_text, overrides_text;
  std::vector<std::filesystem::path> files;  // all that were read
  ProfileTexts profiles;                     // those among them
};
/// Reads a scenario and its device. Throws std::invalid_argument for an error
/// in either file and for an override whose key neither of them has.
LoadedScenario load_scenario(const std::filesystem::path& path,
                             const std::vector<std::string>& overrides);
/// The same for texts in memory. The file that the scenario names as its device
/// is not read, nor are files that are among `profiles`; `files` of the result
/// are the profiles.
LoadedScenario load_scenario(const InputText& scenario, const InputText& device,
                             const std::vector<std::string>& overrides,
                             const ProfileTexts& profiles = {});

/// A scenario and its device whose texts are parsed once, to be read with other
/// overrides again and again. Each thread needs its own copy.
class ScenarioVariants {
 public:
  /// `profiles` are the texts of all files that the scenario names.
  ScenarioVariants(const InputText& scenario, const InputText& device,
                   const ProfileTexts& profiles);

  /// Reads the plan of the scenario and the device with these overrides. Throws
  /// as load_scenario().
  void read(const std::vector<std::string>& overrides);

  const ScenarioPlan& scenario() const { return scenario_; }
  const DeviceParameters& device() const { return *device_; }
  /// Whether the last read() gave another device than the one before.
  bool has_new_device() const { return has_new_device_; }

 private:
  ConfigDocument scenario_document_, device_document_;
  ProfileTables tables_;
  ScenarioPlan scenario_;
  std::optional<DeviceParameters> device_;
  std::optional<std::vector<std::string>> device_overrides_;  // of `device_`
  bool has_new_device_ = false;
};

}  // namespace beamgyro::internal
