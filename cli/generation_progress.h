// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dataset/set/set_writer.h"
#include "sim/campaign/shard_making.h"

namespace beamgyro::internal {

/// Runs generate_shards() on `jobs` threads (0 means one per core) with a line
/// of progress that has the rate, the time left and the failures.
void generate_with_progress(const std::string& activity, const ShardPlan& plan,
                            const std::vector<std::uint32_t>& files,
                            unsigned jobs, const ShardSink& publish);

/// Warns when the file system cannot keep other processes from working on the
/// set.
void warn_without_lock(const SetWriter& set, const std::string& directory);

}  // namespace beamgyro::internal
