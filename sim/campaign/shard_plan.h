// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dataset/set/manifest.h"
#include "dataset/set/shard/shard.h"
#include "sim/campaign/campaign.h"

namespace beamgyro::internal {

/// Version and revision of the program that makes a set. Files contain them.
struct ProgramRevision {
  std::string version, git_revision;
};

/// The files of a campaign in the order of the manifest. Each holds the devices
/// of one range in one run (docs/reference/set.md).
class ShardPlan {
 public:
  /// Simulates two samples of every run with the base device to learn its
  /// variables. Throws std::invalid_argument for a variable that no run has.
  ShardPlan(const CampaignPlan& campaign, const ProgramRevision& program);

  const ManifestHead& manifest_head() const { return manifest_head_; }

  std::uint32_t run_of(std::uint32_t file) const;
  std::uint32_t range_of(std::uint32_t file) const;
  ShardHead head_of(std::uint32_t file) const;
  /// Returns whether recordings of a run may have this column, whether or not
  /// it is stored.
  bool has_column(std::uint32_t run, const std::string& name) const;

  /// Returns the number of device runs in `files`.
  std::uint64_t device_runs(const std::vector<std::uint32_t>& files) const;
  /// Returns the mean length of a run [s].
  double run_duration() const;

  /// Returns the size of the values of the largest file before compression
  /// [bytes].
  double largest_file() const;

  const CampaignPlan& campaign() const { return *campaign_; }

 private:
  const CampaignPlan* campaign_;
  ManifestHead manifest_head_;
  // One per run, without what a file alone needs: devices, times, parameters
  // and texts, which would take memory for every run.
  std::vector<ShardHead> heads_;
  std::vector<std::vector<std::string>> columns_;  // names, one list per run
};

}  // namespace beamgyro::internal
