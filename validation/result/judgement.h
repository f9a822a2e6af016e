// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "validation/result/decided_limits.h"
#include "validation/result/device_evidence.h"
#include "validation/result/validation_result.h"
#include "validation/specification/specification_file.h"

namespace beamgyro::internal {

/// A result and the evidence that it is drawn from.
struct CompletedValidation {
  ValidationResult result;
  DeviceEvidence evidence;
  std::optional<FittedCompensator> trained = {};  // of a model, on the device
};

/// Evaluates metrics before, after and of every baseline, each on the
/// `runs` that are named for it, or on all. `names` are those to evaluate;
/// none: all of metrics(), without those of sigma where no rate has one.
std::vector<MetricResult> metric_results(const DeviceEvidence& found,
                                         const MetricRuns& runs,
                                         std::span<const std::string> names,
                                         std::size_t threads);

/// Compares what the compensator leaves with what the recorded rate, the
/// baselines and a constant of the runs themselves leave. The last is only
/// there where the runs differ by kLeastSpanOfRuns or more, because at one
/// temperature no correction can be better than it.
std::vector<ResidualComparison> comparisons_of(
    const SpecificationFile& specification, const DeviceEvidence& found);

/// Returns a sentence on the least of the rates that the compensator has to be
/// better than and is not; empty where there is none.
std::string words_of_no_use(const std::vector<ResidualComparison>& comparisons);

/// Writes the verdict, its reason and the next step into `result`, from its
/// limits, checks and comparisons: kFail when one of them fails or the
/// compensator has no effect, else kUndecided when a limit is, or when a check
/// was not tested that the specification wants tested, else kPass. Where the
/// specification wants none tested, one that shows whether rates come out must
/// be.
void decide_on(const SpecificationFile& specification,
               ValidationResult& result);

/// What a compensator is judged by, beside the evidence.
struct JudgedBy {
  const SpecificationFile& specification;
  const MetricRuns& metric_runs;
  const TestedCompensator& compensator;
  const FittedCompensator* trained;  // the same, if it is one of a file
  const TrainingSet* set = nullptr;  // of the runs, where they are of one
  bool requires_provenance = false;  // the compensator states its training
  std::span<const OwnMetricSource> own_metrics = {};
};

/// Evaluates every metric, decides on the limits, runs the checks and writes
/// them, what is found of a sigma, and the verdict into `result`.
void judge(const JudgedBy& by, const DeviceEvidence& found, std::size_t threads,
           ValidationResult& result);

/// Returns what each run shows alone; NaN without a block or an answer.
std::vector<RunResidual> run_residuals(const DeviceEvidence& found);

/// Returns the runs with their answers, as checks want them.
CheckedCompensator checked_runs(const DeviceEvidence& found,
                                const TestedCompensator& compensator);

}  // namespace beamgyro::internal
