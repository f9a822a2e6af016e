// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "config/document.h"
#include "sim/scenario/profile_keys.h"
#include "sim/scenario/scenario.h"

namespace beamgyro::internal {

/// Reads a scenario and checks every key (docs/reference/scenario_file.md).
/// Files that it names are relative to its own folder; `device_file` is
/// resolved likewise. Files that are in `profiles` are not read again. Throws
/// std::invalid_argument naming file, line, key and value. The caller rejects
/// unknown keys after the device has been read, too.
ScenarioPlan read_scenario(const ConfigDocument& document,
                           const ProfileTables* profiles = nullptr);

/// Returns the CSV files that a valid scenario names.
std::vector<std::filesystem::path> profile_files(
    const ConfigDocument& document);

}  // namespace beamgyro::internal
