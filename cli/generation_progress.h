// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/campaign/generation.h"

namespace beamgyro {

/// generate_shards() on `jobs` threads (0: one per core), with a line of
/// progress that shows rate, time left and failures.
void generate_with_progress(const std::string& activity, const ShardPlan& plan,
                            const std::vector<std::uint32_t>& files,
                            unsigned jobs, const ShardSink& publish);

}  // namespace beamgyro
