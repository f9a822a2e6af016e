// SPDX-License-Identifier: MIT
#pragma once

#include "config/table.h"
#include "sim/campaign/draw_plan.h"
#include "sim/dynamics/gyro.h"

namespace beamgyro::internal {

/// Reads `[spurious_modes]` of a campaign file
/// (docs/reference/campaign_file.md) as the draw of the key `spurious_mode`.
/// Heights become couplings with the drive frequency and the angular gain of
/// the base unit. Throws std::invalid_argument naming file, line, key and
/// value.
Draw read_spurious_population(const ConfigTable& root, const TrimmedGyro& base);

}  // namespace beamgyro::internal
