// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "config/document.h"
#include "dataset/log/csv_file.h"
#include "sim/scenario/scenario.h"

namespace beamgyro::internal {

/// Profile files that were read before, by their lexically normal path.
using ProfileTables = std::map<std::filesystem::path, CsvTable>;

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
