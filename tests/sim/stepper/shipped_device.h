// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "sim/device/device_file.h"

namespace beamgyro::internal {

/// scenarios/devices/`name`.toml with `overrides` as on the command line.
inline DeviceParameters shipped_device(
    const std::string& name, const std::vector<std::string>& overrides = {}) {
  Overrides set(overrides);
  const ConfigDocument document = ConfigDocument::read(
      std::string(BEAMGYRO_SCENARIOS) + "/devices/" + name + ".toml", set);
  const DeviceParameters device = read_device(document);
  document.reject_unknown_keys();
  set.check_all_used();
  return device;
}

}  // namespace beamgyro::internal
