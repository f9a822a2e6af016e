// SPDX-License-Identifier: MIT
#include "sim/campaign/generation.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>

namespace beamgyro {

void generate_shards(const ShardPlan& plan,
                     const std::vector<std::uint32_t>& files, unsigned jobs,
                     GenerationCounts& counts, const ShardSink& publish) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      ShardMaker maker(plan);
      for (std::size_t k = next++; k < files.size(); k = next++)
        publish(files[k], maker.make(files[k], counts));
    } catch (...) {
      next = files.size();
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  {
    const std::size_t threads =
        std::min<std::size_t>(std::max(1U, jobs), files.size());
    std::vector<std::jthread> others;
    try {
      for (std::size_t n = 1; n < threads; ++n) others.emplace_back(work);
    } catch (const std::system_error&) {
      // The system grants no more threads; fewer make the same files.
    }
    if (threads > 0) work();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace beamgyro
