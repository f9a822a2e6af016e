// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/campaign/shard_making.h"

namespace beamgyro::internal {

/// Runs generate_shards() on `jobs` threads (0 means one per core) with a line
/// of progress that has the rate, the time left and the failures.
void generate_with_progress(const std::string& activity, const ShardPlan& plan,
                            const std::vector<std::uint32_t>& files,
                            unsigned jobs, const ShardSink& publish);

}  // namespace beamgyro::internal
