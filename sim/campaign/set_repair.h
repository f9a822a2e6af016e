// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dataset/set/manifest.h"
#include "dataset/set/set_check.h"
#include "dataset/set/set_writer.h"
#include "sim/campaign/shard_making.h"

namespace beamgyro::internal {

/// Returns what belongs to the set of a directory, by its manifest or by those
/// of the tasks that are not merged yet. Of a set whose manifests are lost the
/// copy of the first line still says it. Throws as set_contents().
Manifest manifest_of_set(const std::filesystem::path& directory);

/// Makes damaged and missing files of a set again, from the campaign that the
/// set keeps copies of. The campaign alone decides what is written.
class SetRepair {
 public:
  /// Restores copies of the campaign's sources from each other. Throws
  /// std::runtime_error when the campaign cannot be found again, when the
  /// manifest is not that of the campaign, or for a set of another program.
  SetRepair(const std::filesystem::path& directory, const Manifest& manifest,
            const std::vector<FileDefect>& defects,
            const ProgramRevision& program);

  /// The files to make, of plan().
  const std::vector<std::uint32_t>& files() const { return files_; }
  const ShardPlan& plan() const { return plan_; }

  /// Locks the set; must be called before add(). Throws as SetWriter.
  void begin();
  const SetWriter& set() const { return *set_; }

  /// Publishes a file. Throws std::runtime_error when its bytes are not those
  /// of the manifest.
  void add(std::uint32_t file, const MadeShard& shard);

  /// Makes views and manifest whole.
  void finish() { set_->finish(true); }

 private:
  std::filesystem::path directory_;
  ManifestHead head_;
  CampaignPlan campaign_;
  ShardPlan plan_;
  std::vector<std::uint32_t> files_;
  std::map<std::uint32_t, std::string> hashes_;  // that the manifest states
  std::optional<SetWriter> set_;
};

}  // namespace beamgyro::internal
