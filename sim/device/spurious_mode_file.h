// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "config/table.h"
#include "sim/device/device.h"

namespace beamgyro::internal {

/// Reads the tables `[spurious_mode.NAME]` of a device file
/// (docs/reference/device_file.md). A mode of which both couplings are 0 is
/// left out. `memory` says which effects can move a mode. Throws
/// std::invalid_argument "file:line:column: key: ..." for
/// - more than kMostSpuriousModes tables;
/// - a value out of its range;
/// - a drift without [memory.ageing], a slip without [memory.hysteresis].
std::vector<SpuriousModeParameters> read_spurious_modes(
    const ConfigTable& root, const MemoryParameters& memory);

}  // namespace beamgyro::internal
