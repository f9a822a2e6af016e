// SPDX-License-Identifier: MIT
#include "sim/campaign/generation.h"

#include <algorithm>
#include <optional>

#include "parallel/work_queue.h"

namespace beamgyro::internal {

void generate_shards(const ShardPlan& plan,
                     const std::vector<std::uint32_t>& files, unsigned jobs,
                     GenerationCounts& counts, const ShardSink& publish) {
  const std::size_t threads =
      std::min<std::size_t>(thread_count(jobs), files.size());
  std::vector<std::optional<ShardMaker>> makers(threads);  // one per thread
  for_each_task(files.size(), threads,
                [&](std::size_t index, std::size_t worker) {
                  std::optional<ShardMaker>& maker = makers[worker];
                  if (!maker) maker.emplace(plan);
                  publish(files[index], maker->make(files[index], counts));
                });
}

}  // namespace beamgyro::internal
