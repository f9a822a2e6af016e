// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include "config/document.h"
#include "sim/scenario/profile_keys.h"
#include "sim/scenario/scenario.h"

namespace beamgyro {

/// Reads a scenario and checks every key (docs/reference/scenario_file.md).
/// Files it names are found relative to its own folder; `device_file` is made
/// so, too. Throws std::invalid_argument naming file, line, key and value. The
/// caller rejects unknown keys once the device is read as well. Files among
/// `profiles` are not read again.
Scenario read_scenario(const ConfigDocument& document,
                       const ProfileTables* profiles = nullptr);

/// The CSV files that a scenario which can be read names.
std::vector<std::filesystem::path> profile_files(
    const ConfigDocument& document);

}  // namespace beamgyro
