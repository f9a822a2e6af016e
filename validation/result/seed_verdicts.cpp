// SPDX-License-Identifier: MIT
#include "validation/result/seed_verdicts.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

#include "parallel/work_queue.h"
#include "validation/result/population_yield.h"

namespace beamgyro::internal {
namespace {

// Keeps the verdicts of all seeds, and one result whole.
class SeedJudge {
 public:
  SeedJudge(const SeedRange& seeds, const ProgressOfWork& progress)
      : first_(seeds.first), results_(seeds.count), progress_(progress) {}

  // Takes the validation with seed number `k`. It keeps metrics and words, and
  // everything of the first of the worst.
  void add(std::size_t k, CompletedValidation one) {
    const std::lock_guard lock(one_at_a_time_);
    const Verdict verdict = one.result.verdict;
    results_[k].verdict = verdict;
    results_[k].words = one.result.words;
    results_[k].metrics = one.result.metrics;
    const bool is_first =
        done_ == 0 || is_more_severe(verdict, shown_.result.verdict) ||
        (verdict == shown_.result.verdict && k < shown_index_);
    if (is_first) {
      shown_ = std::move(one);
      shown_index_ = k;
    }
    ++done_;
    if (progress_)
      progress_(static_cast<double>(done_) /
                static_cast<double>(results_.size()));
  }

  CompletedValidation finish(const SpecificationFile& specification) {
    std::vector<Verdict> verdicts;
    SeedVerdicts all;
    all.shown = first_ + shown_index_;
    all.metrics = followed_metrics(specification);
    for (std::size_t k = 0; k < results_.size(); ++k) {
      const ValidationResult& one = results_[k];
      verdicts.push_back(one.verdict);
      all.seeds.push_back({first_ + k, one.verdict, one.words});
      add_figures(one, all.metrics);
    }
    static_cast<VerdictCount&>(all) = count_of(verdicts);
    ValidationResult& result = shown_.result;
    result.words = fmt::format("{} of {} seeds pass. Seed {}: {}", all.passed,
                               all.seeds.size(), all.shown, result.words);
    result.seeds = std::move(all);
    return std::move(shown_);
  }

 private:
  std::uint64_t first_;
  std::vector<ValidationResult> results_;  // verdict, words and metrics
  const ProgressOfWork& progress_;
  std::mutex one_at_a_time_;
  CompletedValidation shown_;
  std::size_t shown_index_ = 0, done_ = 0;
};

}  // namespace

CompletedValidation seed_verdicts(const SeedRange& seeds,
                                  const JudgeOfSeed& judge,
                                  const SpecificationFile& specification,
                                  std::size_t threads,
                                  const ProgressOfWork& progress) {
  SeedJudge all(seeds, progress);
  const std::size_t side_by_side = std::min(threads, seeds.count);
  for_each_task(seeds.count, threads, [&](std::size_t k, std::size_t) {
    all.add(k, judge(seeds.first + k, threads / side_by_side));
  });
  return all.finish(specification);
}

}  // namespace beamgyro::internal
