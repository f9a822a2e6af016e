// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "config/units.h"
#include "sim/device/device_file.h"

namespace beamgyro::internal {

/// The shipped nominal unit, with `overrides` as on the command line.
inline DeviceParameters nominal_device(
    const std::vector<std::string>& overrides = {}) {
  Overrides set(overrides);
  const ConfigDocument document = ConfigDocument::read(
      std::string(BEAMGYRO_SCENARIOS) + "/devices/nominal.toml", set);
  const DeviceParameters device = read_device(document);
  document.reject_unknown_keys();
  set.check_all_used();
  return device;
}

/// Verification values hold for a Coriolis mass equal to the modal mass.
inline DeviceParameters verification_device(
    std::vector<std::string> overrides = {}) {
  overrides.push_back("beam.angular_gain=1.0");
  return nominal_device(overrides);
}

}  // namespace beamgyro::internal
