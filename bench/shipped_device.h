// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sim/device/device_file.h"

namespace beamgyro::internal {

/// scenarios/devices/`name`.toml.
inline DeviceParameters shipped_device(const std::string& name = "nominal") {
  const ConfigDocument document = ConfigDocument::read(
      std::string(BEAMGYRO_SCENARIOS) + "/devices/" + name + ".toml");
  return read_device(document);
}

}  // namespace beamgyro::internal
