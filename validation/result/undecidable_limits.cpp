// SPDX-License-Identifier: MIT
#include "validation/result/undecidable_limits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>

#include "compensation/inputs/sample_ranges.h"
#include "config/units.h"
#include "dataset/recording/stated_values.h"
#include "parallel/work_queue.h"
#include "sim/signal/noise.h"
#include "validation/result/decided_limits.h"
#include "validation/result/device_evidence.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kMostOfDraws = 2;  // of three
constexpr std::array kTimesAsLong = {2.0, 4.0, 8.0, 16.0, 32.0, 64.0};

/// A gyro without an error: the true rate, with noise of the device.
class NoisyTruth : public TestedCompensator {
 public:
  NoisyTruth(const NoiseParameters& noise, std::uint64_t draw)
      : noise_(noise), draw_(draw) {}

  std::vector<std::string> inputs() const override { return {"rate"}; }

  std::vector<Answer> answers(
      const std::vector<const Recording*>& runs) const override {
    std::vector<Answer> all;
    for (const Recording* run : runs) all.push_back({.rate = rate_of(*run)});
    return all;
  }

 private:
  std::vector<double> rate_of(const Recording& run) const {
    const std::uint64_t seed = run.seed + (draw_ << 32U);
    if (stated_scenario_flag(run, "noise.enabled") == false)
      return column_values(run, "true_rate");
    std::vector<double> noise(run.time.size(), 0.0);  // [rad/s]
    RateNoise(noise_, 1.0 / usual_step(run), seed, 0, 0).add_next(noise);
    const auto stretches = powered_stretches(run);
    std::vector<double> off_times(stretches.size(), HUGE_VAL);
    for (std::size_t i = 1; i < stretches.size(); ++i)
      off_times[i] =
          run.time[stretches[i].begin] - run.time[stretches[i - 1].end - 1];
    const auto offsets = turn_on_offsets(noise_, stretches.size(), seed, 0, 0);
    const auto transients = turn_on_transients(noise_, off_times, seed, 0, 0);
    for (std::size_t i = 0; i < stretches.size(); ++i)
      for (std::size_t k = stretches[i].begin; k < stretches[i].end; ++k)
        noise[k] += offsets[i] +
                    transients[i] *
                        std::exp((run.time[stretches[i].begin] - run.time[k]) /
                                 noise_.turn_on_settling);
    std::vector<double> rate = column_values(run, "true_rate");
    for (std::size_t k = 0; k < rate.size(); ++k) rate[k] += noise[k] / kDegree;
    return rate;
  }

  NoiseParameters noise_;
  std::uint64_t draw_;
};

/// The runs that a metric reads, as they are without noise.
struct QuietRuns {
  std::vector<ReadRun> read;
  std::vector<Recording> recordings;
};

/// What comes of a limit in the draws of the noise.
struct Foreseen {
  std::size_t undecided = 0;
  std::optional<Estimate> seen;  // of the last that is undecided
  std::size_t decided = 0;
  bool is_undecided() const { return undecided >= kMostOfDraws; }
};

/// What a gyro without an error shows of metrics that read the same runs.
class Foresight {
 public:
  Foresight(const QuietRuns& runs, const QualifiedDevice& device, double risk,
            std::size_t threads)
      : runs_(runs), device_(device), risk_(risk), threads_(threads) {}

  /// Of runs that take `times` as long, with as many samples. The third draw
  /// decides where two differ.
  std::vector<Foreseen> of(std::span<const Limit* const> limits,
                           double times) const {
    std::vector<Foreseen> found(limits.size());
    std::array<std::vector<std::optional<Estimate>>, kMostOfDraws> seen;
    for_each_task(seen.size(), threads_, [&](std::size_t draw, std::size_t) {
      seen.at(draw) = drawn(limits, times, draw);
    });
    std::vector<const Limit*> split;
    std::vector<Foreseen*> split_found;
    for (std::size_t k = 0; k < limits.size(); ++k) {
      for (const auto& of_draw : seen) add(*limits[k], of_draw[k], found[k]);
      if (found[k].undecided < kMostOfDraws &&
          found[k].decided < kMostOfDraws) {
        split.push_back(limits[k]);
        split_found.push_back(&found[k]);
      }
    }
    if (split.empty()) return found;
    const auto last = drawn(split, times, kMostOfDraws);
    for (std::size_t k = 0; k < split.size(); ++k)
      add(*split[k], last[k], *split_found[k]);
    return found;
  }

  /// How many times as long the runs have to be; nothing where that is no way.
  std::optional<double> times_as_long(const Limit& limit) const {
    const bool is_steady =
        std::ranges::all_of(runs_.read, [](const ReadRun& run) {
          return run.purpose == RunPurpose::kRest ||
                 run.purpose == RunPurpose::kRateTable;
        });
    if (!is_steady) return std::nullopt;
    for (const double times : kTimesAsLong)
      if (!of(std::array{&limit}, times).front().is_undecided()) return times;
    return std::nullopt;
  }

 private:
  std::vector<std::optional<Estimate>> drawn(
      std::span<const Limit* const> limits, double times,
      std::size_t draw) const {
    std::vector<ReadRun> read = runs_.read;
    std::vector<Recording> recordings = runs_.recordings;
    for (ReadRun& run : read) run.from *= times;
    for (Recording& recording : recordings)
      for (double& time : recording.time) time *= times;
    const NoisyTruth gyro(device_.device.noise, draw);
    const DeviceEvidence evidence = answered_evidence(
        std::move(read), std::move(recordings),
        {gyro, {}, device_.device.readout.full_scale / kDegree}, 1);
    std::vector<std::optional<Estimate>> seen;
    for (const Limit* limit : limits)
      seen.push_back(find_metric(limit->metric)->evaluate(evidence.after));
    return seen;
  }

  void add(const Limit& limit, const std::optional<Estimate>& seen,
           Foreseen& found) const {
    if (decide(limit, seen, {}, risk_).result != Verdict::kUndecided) {
      ++found.decided;
      return;
    }
    ++found.undecided;
    found.seen = seen;
  }

  const QuietRuns& runs_;
  const QualifiedDevice& device_;
  double risk_;
  std::size_t threads_;
};

std::string words_of_purposes(const Metric& metric) {
  std::vector<std::string_view> names;
  for (const RunPurpose purpose : metric.reads)
    names.push_back(purpose_name(purpose));
  return fmt::format("{}", fmt::join(names, ", "));
}

bool reads_moving_rates(const Metric& metric) {
  using enum RunPurpose;
  return std::ranges::any_of(metric.reads, [](RunPurpose purpose) {
    return purpose == kSineRate || purpose == kRateStep ||
           purpose == kRandomRate;
  });
}

std::vector<QualificationRun> runs_read(const Qualification& qualification,
                                        const Metric& metric) {
  std::vector<QualificationRun> runs;
  for (const QualificationRun& run : qualification.runs)
    if (reads_run(metric, qualification.metric_runs, run.name, run.purpose))
      runs.push_back(run);
  return runs;
}

std::vector<std::string> run_names(const std::vector<QualificationRun>& runs) {
  std::vector<std::string> names;
  for (const QualificationRun& run : runs) names.push_back(run.name);
  return names;
}

/// Limits on metrics that read the same runs.
struct LimitsOfRuns {
  std::vector<QualificationRun> runs;
  std::vector<const Limit*> limits;
};

/// The runs of a qualification without noise, each simulated when it is first
/// asked for.
class RunsWithoutNoise {
 public:
  RunsWithoutNoise(const QualifiedDevice& device, std::size_t threads)
      : device_(device), threads_(threads) {}

  QuietRuns of(const std::vector<QualificationRun>& runs) {
    simulate(runs);
    QuietRuns quiet;
    for (const QualificationRun& run : runs) {
      quiet.read.push_back({run.name, run.purpose, run.from});
      quiet.recordings.push_back(simulated_.at(run.name));
    }
    return quiet;
  }

 private:
  void simulate(const std::vector<QualificationRun>& runs) {
    std::vector<QualificationRun> lacking;
    for (const QualificationRun& run : runs)
      if (!simulated_.contains(run.name))
        lacking.emplace_back(run).scenario.noise_enabled = false;
    std::vector<Recording> recordings =
        qualified_runs(lacking, device_, threads_);
    for (std::size_t k = 0; k < lacking.size(); ++k)
      simulated_.emplace(lacking[k].name, std::move(recordings[k]));
  }

  const QualifiedDevice& device_;
  std::size_t threads_;
  std::map<std::string, Recording> simulated_;  // by the name of the run
};

/// Length [s] of what is read of the longest run.
double longest_read(const std::vector<QualificationRun>& runs) {
  double length = 0.0;
  for (const QualificationRun& run : runs)
    length = std::max(length, run.scenario.duration - run.from);
  return length;
}

std::string undecidable_words(const Limit& limit, const Foreseen& found,
                              const std::optional<double>& times,
                              const std::vector<QualificationRun>& runs) {
  std::string why;
  if (!found.seen)
    why = "the noise of the gyro does not show it in these runs";
  else if (found.seen->interval)
    why = fmt::format(
        "a gyro without any error shows {:.3g} [{:.3g}, {:.3g}] by its noise "
        "alone",
        found.seen->value, found.seen->interval->low,
        found.seen->interval->high);
  else
    why = "it is not a number";
  const std::string way =
      times ? fmt::format(
                  "runs {:g} times as long would decide it ({:.3g} h "
                  "in place of {:.3g} h)",
                  *times, *times * longest_read(runs) / 3600.0,
                  longest_read(runs) / 3600.0)
            : "longer runs of this kind would not";
  return fmt::format("limit on {}, {}: cannot be decided, because {}; {}",
                     limit.metric, text_of(limit), why, way);
}

}  // namespace

std::vector<std::string> undecidable_limits(
    const Qualification& qualification, const QualifiedDevice& device,
    const SpecificationFile& specification, std::size_t threads) {
  const std::vector<Limit>& limits = specification.limits;
  std::vector<std::string> sentences(limits.size());
  std::map<std::vector<std::string>, LimitsOfRuns> foreseeable;  // by runs
  for (std::size_t k = 0; k < limits.size(); ++k) {
    if (limits[k].is_own) continue;
    const Metric& metric = *find_metric(limits[k].metric);
    if (metric.is_of_sigma) continue;
    const std::vector<QualificationRun> runs = runs_read(qualification, metric);
    if (runs.empty()) {
      sentences[k] = fmt::format(
          "limit on {}, {}: cannot be decided, because no run shows it; a run "
          "for one of these purposes would: {}",
          limits[k].metric, text_of(limits[k]), words_of_purposes(metric));
      continue;
    }
    const bool has_noise = std::ranges::any_of(
        runs,
        [](const QualificationRun& run) { return run.scenario.noise_enabled; });
    if (!has_noise || !limits[k].relative_to.empty() ||
        reads_moving_rates(metric))
      continue;
    LimitsOfRuns& same = foreseeable[run_names(runs)];
    same.runs = runs;
    same.limits.push_back(&limits[k]);
  }
  RunsWithoutNoise without_noise(device, threads);
  for (const auto& [names, same] : foreseeable) {
    const QuietRuns quiet = without_noise.of(same.runs);
    const Foresight foresight(quiet, device, specification.false_accept_risk,
                              threads);
    const std::vector<Foreseen> found = foresight.of(same.limits, 1.0);
    for (std::size_t k = 0; k < found.size(); ++k)
      if (found[k].is_undecided())
        sentences[static_cast<std::size_t>(same.limits[k] - limits.data())] =
            undecidable_words(*same.limits[k], found[k],
                              foresight.times_as_long(*same.limits[k]),
                              same.runs);
  }
  std::erase(sentences, "");
  return sentences;
}

}  // namespace beamgyro::internal
