// SPDX-License-Identifier: MIT
/// \file
/// Campaigns: populations of gyros, and the sets that are generated from them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "beamgyro/device.h"
#include "beamgyro/progress.h"
#include "beamgyro/shared.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {
namespace internal {
struct CampaignPlan;
}

/// A population of devices and the runs of each of them, read from a campaign
/// file (docs/reference/campaign_file.md) and checked. Immutable; copies share
/// their state, and many threads may use one at once.
class Campaign : public Shared<internal::CampaignPlan> {
 public:
  /// Reads a campaign and every file that it names. `devices` replaces the
  /// number of devices in the file. Throws std::invalid_argument
  /// "file:line:column: key: ..." for what is wrong in one of them.
  static Campaign read(const std::filesystem::path& file,
                       std::optional<std::uint32_t> devices = {});

  /// The same from texts in memory: the campaign first, then every file that it
  /// names, in any order. No file is read. Also throws std::invalid_argument
  /// for a file that is not among them.
  static Campaign parse(const std::vector<InputFile>& files,
                        std::optional<std::uint32_t> devices = {});

  std::string name() const;
  std::string text() const;  ///< byte for byte as read
  /// Campaign, device, scenarios and their profiles in the order of reading.
  std::vector<InputFile> files() const;
  std::uint32_t devices() const;
  std::uint64_t seed() const;
  std::vector<std::string> runs() const;  ///< their names

  /// Returns the KEY=VALUE lines that make device `number` of the base device.
  /// Throws std::invalid_argument for a number of devices() or more, and
  /// std::runtime_error for a device that cannot be built.
  std::vector<std::string> device_overrides(std::uint32_t number) const;
  /// Returns the device itself. Throws as device_overrides().
  Device device(std::uint32_t number) const;

  using Shared::Shared;
};

struct GenerationOptions {
  unsigned jobs = 0;       ///< threads; 0: one per core
  bool resume = false;     ///< continues the set that is in the directory
  Progress progress = {};  ///< after each run of a device
  /// Makes only the files of task `shard` of `shards`, which share the
  /// directory and may run at once on any hosts; 0: all files.
  std::uint32_t shard = 0, shards = 0;
};

/// What is in a directory after a generation.
struct GenerationOutcome {
  std::size_t files = 0, planned_files = 0;
  bool is_whole = false;       ///< every file is there, and the manifest merged
  std::size_t files_made = 0;  ///< by this call
  std::uint64_t device_runs = 0;  ///< in all files
  std::uint64_t failures = 0;     ///< of them, devices that do not work
  std::vector<std::string> warnings;
  std::string text;  ///< what `beamgyro generate` prints
};

/// Simulates every device of a campaign and writes the set to a directory, as
/// `beamgyro generate` does: the bytes do not depend on the number of threads,
/// nor on interruptions. Throws OptionError for a task that is none of 1 to
/// `shards`, std::invalid_argument for a directory that
/// cannot hold the set or holds another one, std::runtime_error when writing
/// fails, when another process works on the same set, or when no device works,
/// and Cancelled, after which `resume` goes on.
GenerationOutcome generate(const Campaign& campaign,
                           const std::filesystem::path& directory,
                           const GenerationOptions& options = {});

}  // namespace beamgyro
