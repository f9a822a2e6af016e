// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dataset/set/set_writer.h"
#include "sim/campaign/generation.h"

namespace beamgyro {

/// generate_shards() on `jobs` threads (0: one per core), with a line of
/// progress that shows rate, time left and failures.
void generate_with_progress(const std::string& activity, const ShardPlan& plan,
                            const std::vector<std::uint32_t>& files,
                            unsigned jobs, const ShardSink& publish);

/// Throws std::invalid_argument when files of the plan, each of which is made
/// in memory, are too large for that. `campaign` is its name in the message.
void require_moderate_files(const std::string& campaign, const ShardPlan& plan);

/// Tells when the file system keeps nobody else from working at the set.
void warn_without_lock(const SetWriter& set, const std::string& directory);

}  // namespace beamgyro
