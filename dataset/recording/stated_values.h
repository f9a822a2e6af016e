// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Returns the number with a dotted key in the device file and the overrides of
/// a recording, or nothing where there is none.
std::optional<double> stated_device_number(const Recording& recording,
                                           std::string_view key);

/// Returns whether the device file of a recording has the table of that name,
/// or its overrides make one.
bool states_device_table(const Recording& recording, std::string_view name);

/// The same for the scenario of a recording.
bool states_scenario_table(const Recording& recording, std::string_view name);

/// Returns the number with a dotted key in the scenario and the overrides of a
/// recording, or nothing where there is none.
std::optional<double> stated_scenario_number(const Recording& recording,
                                             std::string_view key);

/// Returns the flag with a dotted key in the scenario and the overrides of a
/// recording, or nothing where there is none.
std::optional<bool> stated_scenario_flag(const Recording& recording,
                                         std::string_view key);

/// Returns the values of the device file of a recording, with those that its
/// overrides replaced: the same for files that differ in comments and blanks.
/// Whether noise is enabled does not count. Empty of a log.
std::string stated_device(const Recording& recording);

}  // namespace beamgyro::internal
