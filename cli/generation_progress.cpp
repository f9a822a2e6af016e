// SPDX-License-Identifier: MIT
#include "cli/generation_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "cli/progress.h"

namespace beamgyro {

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
                            fmt::format("{} of {} device runs, {:.3g} "
                                        "device-hours/s, {} failed",
                                        runs, total, runs * hours / elapsed,
                                        counts.failures.load())};
  };
  const Progress progress(activity, done);
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  generate_shards(plan, files, jobs == 0 ? cores : jobs, counts, publish);
}

}  // namespace beamgyro
