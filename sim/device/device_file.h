// SPDX-License-Identifier: MIT
#pragma once

#include "config/document.h"
#include "sim/device/device.h"

namespace beamgyro::internal {

/// Reads one unit from a device file and checks every key
/// (docs/reference/device_file.md). Throws std::invalid_argument naming file,
/// line, key and value. The caller rejects unknown keys once every document of
/// the command is read.
DeviceParameters read_device(const ConfigDocument& document);

}  // namespace beamgyro::internal
