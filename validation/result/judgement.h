// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "validation/result/device_evidence.h"
#include "validation/result/validation_result.h"
#include "validation/specification/specification_file.h"

namespace beamgyro::internal {

/// Evaluates metrics before, after and of every baseline, each on the
/// `runs` that are named for it, or on all. `names` are those to evaluate;
/// none: all of metrics(), without those of sigma where no rate has one.
std::vector<MetricResult> metric_results(const DeviceEvidence& found,
                                         const MetricRuns& runs,
                                         std::span<const std::string> names,
                                         std::size_t threads);

/// Decides on every limit of a specification.
std::vector<DecidedLimit> decided_limits(
    const SpecificationFile& specification,
    const std::vector<MetricResult>& metrics);

/// A verdict in words.
struct WordedVerdict {
  Conformity verdict;
  std::string words;
};

/// Returns kFail when a limit or a check fails, else kUndecided when one is
/// undecided or not tested that must be, else kPass; and which ones.
WordedVerdict verdict_of(const std::vector<DecidedLimit>& limits,
                         const std::vector<CheckResult>& checks);

/// What a compensator is judged by, beside the evidence.
struct JudgedBy {
  const SpecificationFile& specification;
  const MetricRuns& metric_runs;
  const TestedCompensator& compensator;
  const Provenance* provenance;      // of its training, where it is known
  const TrainingSet* set = nullptr;  // of the runs, where they are of one
};

/// Evaluates every metric, decides on the limits, runs the checks and writes
/// them, what is found of a sigma, and the verdict into `result`.
void judge(const JudgedBy& by, const DeviceEvidence& found, std::size_t threads,
           ValidationResult& result);

/// Returns the runs with their answers, as checks want them.
CheckedCompensator checked_runs(const DeviceEvidence& found,
                                const TestedCompensator& compensator);

}  // namespace beamgyro::internal
