// SPDX-License-Identifier: MIT
#include "cli/generation_progress.h"

#include <fmt/format.h>

#include <chrono>

#include "cli/progress.h"

namespace beamgyro::internal {

void generate_with_progress(const std::string& activity, const ShardPlan& plan,
                            const std::vector<std::uint32_t>& files,
                            unsigned jobs, const ShardSink& publish) {
  using Clock = std::chrono::steady_clock;
  const auto total = static_cast<double>(plan.device_runs(files));
  const double hours = plan.run_duration() / 3600;
  const Clock::time_point start = Clock::now();
  GenerationCounts counts;
  const auto done = [&] {
    const auto runs = static_cast<double>(counts.device_runs.load());
    const double elapsed =
        std::chrono::duration<double>(Clock::now() - start).count();
    return Progress::Status{runs / total,
                            fmt::format("{} of {} runs, {} failed, {:.3g} "
                                        "device-h/s",
                                        runs, total, counts.failures.load(),
                                        runs * hours / elapsed)};
  };
  const Progress progress(activity, done);
  generate_shards(plan, files, jobs, counts, publish);
}

}  // namespace beamgyro::internal
