// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/device/device.h"
#include "sim/scenario/scenario.h"

namespace beamgyro::internal {

/// A device, with the overrides of the command applied.
struct LoadedDevice {
  Device device;
  std::string text;  // byte for byte as read
};
LoadedDevice load_device(const std::filesystem::path& path,
                         const std::vector<std::string>& overrides);

/// A scenario, its device, and the texts that a recording stores.
struct LoadedScenario {
  Scenario scenario;
  Device device;
  std::string scenario_text, device_text, overrides_text;
  std::vector<std::filesystem::path> files;  // all that were read
};
/// Reads a scenario and its device. Throws std::invalid_argument for an error
/// in either file and for an override whose key neither of them has.
LoadedScenario load_scenario(const std::filesystem::path& path,
                             const std::vector<std::string>& overrides);

}  // namespace beamgyro::internal
