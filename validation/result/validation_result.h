// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "validation/checks/checks.h"
#include "validation/external/isolation.h"
#include "validation/metrics/metric.h"
#include "validation/metrics/paired_residual.h"
#include "validation/metrics/sigma_report.h"
#include "validation/specification/decision.h"
#include "validation/specification/own_metrics.h"

namespace beamgyro::internal {

/// The value of a metric that a baseline leaves.
struct BaselineEstimate {
  std::string name;  // "none", "constant", "cubic", "spline", "straight_lines"
  std::optional<Estimate> estimate;
};

/// A metric of the recorded rate (before) and of the compensated rate (after).
struct MetricResult {
  const Metric* metric = nullptr;  // of metrics()
  std::optional<Estimate> before = {}, after = {};
  std::vector<BaselineEstimate> baselines = {};
};

/// A limit of the specification and what was decided.
struct DecidedLimit {
  Limit limit;
  Decision decision;
};

/// The compensated rate beside another one, on the same runs.
struct ResidualComparison {
  // "before", a baseline, or "constant_of_runs", fitted to the runs themselves.
  std::string with;
  PairedResidual found;
  bool is_required = false;  // by the specification: to be better than it
  bool is_same = false;      // they leave the same, sample by sample
};

/// What a run shows alone.
struct RunResidual {
  std::string name, purpose;
  double before = 0.0, after = 0.0;  // [deg/s], rms
};

/// A file or run that a result depends on.
struct ResultFile {
  std::string group;  // "compensator", "device", "qualification", ...
  std::string name;   // without its folder
  std::string sha256;
};

/// The difference from the compensator that firmware was exported from, over
/// all samples that both answer.
struct WorkbenchDifference {
  std::string name;                 // of its file
  double largest = 0.0, rms = 0.0;  // [deg/s]
  std::size_t samples = 0;

  /// Adds further samples, of an AnswerDifference or of the same.
  template <class Difference>
  void add(const Difference& more) {
    const auto here = static_cast<double>(samples);
    const auto there = static_cast<double>(more.samples);
    if (there == 0.0) return;
    largest = std::max(largest, more.largest);
    rms = std::sqrt((here * rms * rms + there * more.rms * more.rms) /
                    (here + there));
    samples += more.samples;
  }
};

/// What was judged.
struct JudgedCompensator {
  std::string name;         // of the file without its ending, or the command
  std::string kind;         // "compensator", "library", "command", "model"
  std::string method = {};  // "cubic, ..." where it is known
  std::vector<std::string> inputs = {};  // the measured variables that it reads
  std::optional<WorkbenchDifference> workbench = {};
};

/// A figure of merit of each device of a population, or with each seed; NaN
/// where there is none.
struct PopulationMetric {
  const Metric* metric;
  std::vector<double> before, after;  // one for each device

  /// Adds what this metric is of another device.
  void add(const MetricResult& device);
};

/// The answer for one device of a population.
struct DeviceVerdict {
  Verdict verdict = Verdict::kUndecided;
  std::string words = {};   // the first reason against it
  std::string number = {};  // of the device, if it is not its place in the list
};

/// How many of several verdicts are which.
struct VerdictCount {
  std::size_t passed = 0, failed = 0, undecided = 0;
  Interval interval = {};  // 95 %, of the share that passes

  double share() const {
    return static_cast<double>(passed) /
           static_cast<double>(passed + failed + undecided);
  }
};

/// The share of a population, or of the devices of a set, that passes.
struct PopulationYield : VerdictCount {
  std::string campaign;                // or the name of the set
  std::string shown;                   // number of the device of a set whose
                                       // metrics, limits and checks these are
  bool trained_on_each = false;        // or one compensator for all
  std::vector<DeviceVerdict> devices;  // by number
  std::size_t not_simulated = 0;       // of the failed
  std::vector<PopulationMetric> metrics;
};

/// The answer with one seed of the qualification.
struct SeedVerdict {
  std::uint64_t seed = 0;
  Verdict verdict = Verdict::kUndecided;
  std::string words = {};
};

/// The share of the seeds of a qualification with which a compensator passes.
struct SeedVerdicts : VerdictCount {
  std::uint64_t shown = 0;  // whose metrics, limits and checks stand beside it
  std::vector<SeedVerdict> seeds;
  std::vector<PopulationMetric> metrics;  // a value for each seed
};

/// How a metric compares with another value of it.
enum class Change {
  kSame,    // within the interval of the difference
  kBetter,  // beyond it, closer to the best value
  kWorse,
  kUnknown,  // another value, and neither has an interval
};

/// A metric of the compensated rate beside another value of it.
struct MetricChange {
  const Metric* metric = nullptr;  // of metrics()
  Estimate own, other;
  Estimate difference = {0.0};  // own less other
  Change change = Change::kSame;
};

/// A result beside an earlier one.
struct EarlierComparison {
  std::string name;     // of the file of the earlier one
  std::string verdict;  // that it had
  std::vector<MetricChange> metrics;
  // Limits and checks that passed and do not pass any more.
  std::vector<std::string> lost;
  // Groups of files, such as "device", that are not the same.
  std::vector<std::string> other_inputs;

  bool is_worse() const {
    return !lost.empty() || std::ranges::count(metrics, Change::kWorse,
                                               &MetricChange::change) > 0;
  }
};

/// Another compensator on the same runs.
struct SideBySide {
  JudgedCompensator compensator;
  Verdict verdict = Verdict::kUndecided;
  std::string words;     // the reason for it
  std::string sentence;  // which of the two is better, or that it is open
  std::optional<PairedResidual> residual = {};  // of the first, less the other
  std::vector<MetricChange> metrics = {};
  std::vector<DecidedLimit> limits = {};  // in the order of the specification
  std::vector<CheckResult> checks = {};   // in the order of check_definitions()
};

/// Where a result comes from.
struct ResultProvenance {
  std::string program_version, git_revision;
  std::string device, qualification, specification;  // names
  std::optional<std::uint64_t> seed = {};       // that the runs are drawn with
  double false_accept_risk = kFalseAcceptRisk;  // [-]
  std::vector<ResultFile> files;                // in the order of reading
  std::vector<std::pair<std::string, std::uint64_t>> seeds;  // of the runs
};

/// The answer of the validator.
struct ValidationResult {
  Verdict verdict = Verdict::kUndecided;
  std::string words;  // the reason for it, in a sentence or two
  std::string next;   // what to do next, in a sentence
  JudgedCompensator compensator;
  std::string no_effect = {};  // a sentence on a compensator that does nothing
  std::vector<ResidualComparison> comparisons;
  std::vector<RunResidual> runs;      // of one device, in their order
  std::vector<MetricResult> metrics;  // in the order of metrics()
  std::vector<OwnMetricResult> own_metrics = {};  // of the user
  std::vector<DecidedLimit> limits;  // in the order of the specification
  std::vector<CheckResult> checks;   // in the order of check_definitions()
  std::optional<PopulationYield> population = {};
  std::optional<SeedVerdicts> seeds = {};
  // Sentences on runs that have their seed of noise from a training run.
  std::vector<std::string> shared_seeds = {};
  // Where the compensator states a sigma; over all devices of a set.
  std::optional<SigmaReport> sigma = {};
  std::optional<SideBySide> against = {};
  std::optional<EarlierComparison> earlier = {};
  // Of code of others.
  std::optional<Isolation> isolation = {};
  std::vector<std::string> warnings = {};
  ResultProvenance provenance = {};
};

}  // namespace beamgyro::internal
