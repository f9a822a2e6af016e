// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compensation/run_source.h"

namespace beamgyro {

/// Parts of a set as its files number them (DeviceRow::part).
enum class SetPartNumber : std::uint8_t { kTrain, kValidation, kTest };

/// Which runs of a set.
struct SetSelection {
  std::optional<SetPartNumber> part;        // of any part without
  std::vector<std::string> runs = {};       // names; all when empty
  std::vector<std::uint32_t> devices = {};  // all when empty
};

/// The runs of a set of virtual devices that were selected, each read when its
/// turn comes, file by file. Devices that could not be simulated are left out.
/// Every file of the runs is read once here and compared with the manifest.
/// Throws std::invalid_argument when the directory holds no finished set, the
/// manifest is damaged or a file holds other bytes, the set has no run of a
/// name or no such device, or as ShardFile.
RunSource runs_of_set(const std::filesystem::path& directory,
                      const SetSelection& selection);

}  // namespace beamgyro
