// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dataset/recording.h"
#include "dataset/set/manifest.h"
#include "dataset/set/source_copies.h"
#include "sim/device/device.h"
#include "sim/scenario/scenario.h"

namespace beamgyro {

/// A device file with the command's overrides in it.
struct LoadedDevice {
  Device device;
  std::string text;  // byte for byte as read
};
LoadedDevice load_device(const std::filesystem::path& path,
                         const std::vector<std::string>& overrides);

/// A scenario, its device, and the texts a recording keeps.
struct LoadedScenario {
  Scenario scenario;
  Device device;
  std::string scenario_text, device_text, overrides_text;
  std::vector<std::filesystem::path> files;  // all that were read
};
/// Throws std::invalid_argument for anything wrong in either file or in an
/// override that neither of them knows.
LoadedScenario load_scenario(const std::filesystem::path& path,
                             const std::vector<std::string>& overrides);

/// read_recording(), with a warning for a file without a checksum when the
/// command has ended well.
Recording load_recording(const std::filesystem::path& path);

/// Throws std::invalid_argument unless `path` ends in .h5 or .csv.
void require_recording_name(const std::filesystem::path& path);

/// Throws what writing to `output` would throw at its start, and
/// std::invalid_argument when it is one of the files the command reads, under
/// whatever name: the same file on the same disk. `inputs` are all of them,
/// those that other inputs name, too; a directory is everything below it.
void require_output(const std::filesystem::path& output,
                    const std::vector<std::filesystem::path>& inputs);

/// The same of the files that generate makes in a directory.
void require_set_output(const std::filesystem::path& directory,
                        const ManifestHead& head,
                        const std::vector<SourceText>& inputs);

}  // namespace beamgyro
