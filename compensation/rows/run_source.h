// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// A recording that is trained on or held out.
struct TrainingRun {
  std::string name;    // file name, for messages and the provenance
  std::string sha256;  // of the file; empty of a run of a set
  Recording recording;
  std::string device = {};  // whose run it is; empty: of a gyro of its own
  std::string run = {};     // of a set: which of its runs
};

/// The set of devices that the runs of a source come from.
struct TrainingSet {
  std::string name;             // of the set's directory
  std::string manifest_sha256;  // tells every file of the set
  std::size_t devices = 0;
  std::size_t files = 0;  // shard files
  // Campaign and seed by which the devices were drawn, the runs, and which
  // devices. Empty when an older program wrote the file.
  std::string campaign_sha256 = {};
  std::uint64_t seed = 0;
  std::vector<std::string> runs = {};
  std::vector<std::uint32_t> device_numbers = {};  // increasing

  bool operator==(const TrainingSet&) const = default;
};

/// A source of runs, one after the other, so that only one is in memory at a
/// time.
struct RunSource {
  using Visitor = std::function<void(const TrainingRun&)>;

  std::size_t count = 0;  // of runs
  /// Calls the visitor with each run, in the same order every time. An
  /// exception for a run that cannot be read names the file.
  std::function<void(const Visitor&)> for_each;
  std::optional<TrainingSet> set =
      {};  // nothing for runs in files of their own
  /// The same in another order: the runs of a device follow each other. Of sets
  /// only.
  std::function<void(const Visitor&)> for_each_by_device = {};
};

/// Returns a source of runs in memory, which must outlive the source.
RunSource source_of(const std::vector<TrainingRun>& runs);

/// Returns a source of recordings that calls `read`, read_recording() for one,
/// for each file when it is needed. `paths` must outlive the source.
RunSource runs_of_files(
    const std::vector<std::string>& paths,
    const std::function<Recording(const std::filesystem::path&)>& read);

/// Throws std::invalid_argument when a recording is there twice, under whatever
/// name: it would count twice.
void require_different_runs(const std::vector<std::string>& paths);

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
