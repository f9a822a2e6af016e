// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sim/campaign/shard_making.h"

namespace beamgyro::internal {

/// Receives a finished shard file. It is called from several threads at once.
using ShardSink =
    std::function<void(std::uint32_t file, const MadeShard& shard)>;

/// Makes the shard files `files` of `plan` on `jobs` threads; 0 means one per
/// core. The bytes of a file do not depend on `jobs`. Rethrows exceptions, also
/// those of `publish`, as for_each_task().
void generate_shards(const ShardPlan& plan,
                     const std::vector<std::uint32_t>& files, unsigned jobs,
                     GenerationCounts& counts, const ShardSink& publish);

}  // namespace beamgyro::internal
