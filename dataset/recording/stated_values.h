// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Returns the number with a dotted key in the device file and the overrides of
/// a recording, or nothing where there is none.
std::optional<double> stated_device_number(const Recording& recording,
                                           std::string_view key);

/// Returns the flag with a dotted key in the scenario and the overrides of a
/// recording, or nothing where there is none.
std::optional<bool> stated_scenario_flag(const Recording& recording,
                                         std::string_view key);

}  // namespace beamgyro::internal
