// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dataset/recording.h"

namespace beamgyro {

/// A recording given for training or held out from it.
struct TrainingRun {
  std::string name;    // file name, for messages and the provenance
  std::string sha256;  // of the file; empty of a run of a set
  Recording recording;
  std::string device = {};  // whose run it is; empty: of a gyro of its own
  std::string run = {};     // of a set: which of its runs
};

/// Recordings of many devices that a source yields runs of.
struct SetPart {
  std::string name;             // of the set's directory
  std::string manifest_sha256;  // tells every file of the set
  std::size_t devices = 0;
  std::size_t files = 0;  // shard files
  // What the devices were drawn by, the runs taken, and which devices; empty
  // when an older program wrote them.
  std::string campaign_sha256 = {};
  std::uint64_t seed = 0;
  std::vector<std::string> runs = {};
  std::vector<std::uint32_t> device_numbers = {};  // increasing

  bool operator==(const SetPart&) const = default;
};

/// Runs one after the other, so that one at a time is in memory.
struct RunSource {
  using Visitor = std::function<void(const TrainingRun&)>;

  std::size_t count = 0;  // of runs
  /// Calls the visitor with each run, in the same order every time. What it
  /// throws for a run that cannot be read names the file.
  std::function<void(const Visitor&)> each;
  std::optional<SetPart> set = {};  // nothing for runs in files of their own
};

/// Runs already in memory, which must outlive the source.
RunSource source_of(const std::vector<TrainingRun>& runs);

}  // namespace beamgyro
