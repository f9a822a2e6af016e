// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dataset/set/set_writer.h"
#include "sim/campaign/shard_plan.h"

namespace beamgyro::internal {

/// Throws std::invalid_argument when a file of the plan is too large to be made
/// in memory. `campaign` is the name for the message.
void require_moderate_files(const std::string& campaign, const ShardPlan& plan);

/// Returns a warning when the file system cannot keep other processes from
/// working on the set, in a list of none or one.
std::vector<std::string> lock_warnings(const SetWriter& set,
                                       const std::filesystem::path& directory);

/// Returns what a generation that made `made` files has come to, in lines.
std::string outcome_text(const SetState& state, std::uint64_t made);

/// Throws std::runtime_error when files of the task that were made have
/// vanished, and when no device of a finished set has values.
void require_nothing_lost(const std::filesystem::path& directory,
                          const SetTask& task, const ManifestHead& head,
                          const SetState& state);

}  // namespace beamgyro::internal
