// SPDX-License-Identifier: MIT
#pragma once

#include "config/table.h"
#include "sim/memory/memory_parameters.h"

namespace beamgyro::internal {

/// Reads `[memory]` of a device file: the tables relaxation, hysteresis and
/// ageing, of which each is optional and switches its effect on. Their keys
/// have the defaults of docs/reference/device_file.md.
MemoryParameters read_memory(const ConfigTable& memory);

}  // namespace beamgyro::internal
