// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compensation/rows/run_source.h"

namespace beamgyro::internal {

/// Parts of a set as its files number them (DeviceRow::part).
enum class SetPartNumber : std::uint8_t { kTrain, kValidation, kTest };

/// Selection of runs of a set.
struct SetSelection {
  std::optional<SetPartNumber> part;        // of any part without
  std::vector<std::string> runs = {};       // names; all when empty
  std::vector<std::uint32_t> devices = {};  // all when empty
};

/// Returns a source of the selected runs of a set, each read when it is needed,
/// file by file. Devices that could not be simulated are left out. This call
/// reads every file of the runs once and compares it with the manifest. Throws
/// as ShardFile, and std::invalid_argument when
/// - the directory has no finished set, or its manifest is damaged;
/// - a file has other bytes than the manifest says;
/// - the set has no such run or no such device.
RunSource runs_of_set(const std::filesystem::path& directory,
                      const SetSelection& selection);

}  // namespace beamgyro::internal
