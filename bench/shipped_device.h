// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sim/device/device_file.h"

namespace beamgyro::internal {

inline DeviceParameters shipped_device() {
  const ConfigDocument document = ConfigDocument::read(
      std::string(BEAMGYRO_SCENARIOS) + "/devices/nominal.toml");
  return read_device(document);
}

}  // namespace beamgyro::internal
