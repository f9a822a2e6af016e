// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sim/campaign/shard_making.h"

namespace beamgyro {

/// Takes a shard file that is made. Called from several threads at once.
using ShardSink =
    std::function<void(std::uint32_t file, const MadeShard& shard)>;

/// Makes the shard files `files` of `plan` on `jobs` threads, or with 0 on as
/// many as there are cores; the bytes of a file do not depend on it. Rethrows
/// an exception of the making or of `publish` as for_each_task().
void generate_shards(const ShardPlan& plan,
                     const std::vector<std::uint32_t>& files, unsigned jobs,
                     GenerationCounts& counts, const ShardSink& publish);

}  // namespace beamgyro
