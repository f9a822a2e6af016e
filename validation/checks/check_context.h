// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "validation/checks/checks.h"

namespace beamgyro::internal {

/// Returns the answers with those that are missing at powered samples replaced
/// by the recorded rate less the last correction, so that one missing answer
/// is found by the check of missing answers alone.
std::vector<double> bridged(const Recording& run, std::vector<double> answers);

/// Returns the compensator without its table of scale factors.
FittedCompensator without_scale_factor(FittedCompensator compensator);

/// How far from its temperature a recorded rate speaks.
constexpr double kRateReach = 10.5;  // [K]

/// Answers to altered recordings, bridged. Notes the faults that were seen.
/// Every member may be called from several threads at once.
class AlteredAnswers {
 public:
  explicit AlteredAnswers(const TestedCompensator& compensator)
      : compensator_(compensator) {}

  std::vector<double> operator()(const Recording& altered) const;

  bool has_seen(AnswerFault fault) const {
    return seen_[static_cast<std::size_t>(fault)];
  }

 private:
  static constexpr std::size_t kFaults =
      static_cast<std::size_t>(AnswerFault::kCount);

  const TestedCompensator& compensator_;
  mutable std::array<std::atomic<bool>, kFaults> seen_ = {};
};

/// The scale factor of the recorded rate over temperature, as rate tables show
/// it.
class ScaleFactorCurve {
 public:
  void add(double temperature, double scale_factor);
  bool empty() const { return points_.empty(); }
  bool has_point_near(double temperature, double reach) const;  // [K]
  double at(double temperature) const;  // linear between, constant beyond
  double largest_departure() const;     // from 1 [-]
  /// Returns the departure from 1 [-] of a gain that may be 1 / s for every s
  /// between those of the rate tables next to the temperature.
  double departure_of_corrected(double gain, double temperature) const;

 private:
  struct Point {
    double temperature;   // [degC]
    double scale_factor;  // [-]
  };
  std::vector<Point> points_;  // rising temperatures
};

/// The answers to a rate that is new at every sample.
struct RandomResponse {
  double gain = 1.0;         // [-], slope at the same sample
  double intercept = 0.0;    // [deg/s]
  double chance = 0.0;       // [deg/s], 3 sigma of a mean of the answers
  double lag = 0.0;          // [s], positive when answers come late
  double temperature = 0.0;  // [degC], at the begin; NaN if not measured
  double time = 0.0;         // [s], of the begin
};

/// What every check may use.
struct CheckContext {
  explicit CheckContext(const CheckedCompensator& all, std::size_t threads);

  const CheckedCompensator& checked;
  std::size_t threads;
  ScaleFactorCurve scale_factor;
  // A trained compensator whose table of scale factors no run tests is asked
  // without that table, so that its bias is judged all the same.
  std::unique_ptr<const TestedCompensator> without_table;
  AlteredAnswers altered;
  std::vector<std::vector<double>> answers;  // bridged, of checked.runs
  std::optional<RandomResponse> random;
  // Powered samples of all runs, and those without a finite answer.
  std::size_t samples = 0, missing = 0;

  /// Returns whether enough was answered to say anything else.
  bool answered() const;
  /// Returns what a rate may move in the gyro and no replay moves,
  /// "scale_factor" for a table, where no rate table is near a temperature of
  /// the runs.
  std::vector<std::string> untested_by_replay() const;
  /// Returns by how many samples of a run the answers come late.
  std::ptrdiff_t lag_in(const Recording& run) const;
  /// Returns the indices of the runs with one of the purposes, or those of all
  /// runs if there is none.
  std::vector<std::size_t> runs_of(
      const std::vector<RunPurpose>& purposes) const;
  /// Calls `work` with the position in `runs` of every run, on all threads.
  void for_each(const std::vector<std::size_t>& runs,
                const std::function<void(std::size_t)>& work) const;
};

/// Returns the lowest and highest measured temperature [degC] of the powered
/// samples of the runs; nothing where a run has none.
std::optional<TemperatureRange> temperatures_of(
    const CheckContext& context, const std::vector<std::size_t>& runs);

/// Purposes of runs that show the temperatures, most of them at rest.
std::vector<RunPurpose> thermal_purposes();

/// A check, which fills everything of its result but the name.
using CheckFunction = CheckResult (*)(const CheckContext&);

CheckResult check_jacobian(const CheckContext& context);
CheckResult check_injection(const CheckContext& context);
CheckResult check_true_rate(const CheckContext& context);
CheckResult check_allan_fingerprint(const CheckContext& context);
CheckResult check_shuffled_output(const CheckContext& context);
CheckResult check_rate_correlation(const CheckContext& context);
CheckResult check_hold_out(const CheckContext& context);
CheckResult check_extrapolation(const CheckContext& context);
CheckResult check_temperature_input(const CheckContext& context);
CheckResult check_causality(const CheckContext& context);
CheckResult check_answers(const CheckContext& context);
CheckResult check_finite(const CheckContext& context);
CheckResult check_reset(const CheckContext& context);
CheckResult check_output_stuck(const CheckContext& context);
CheckResult check_real_time(const CheckContext& context);

/// Returns a result without a figure; `why` is a sentence.
CheckResult not_tested(std::string why);

}  // namespace beamgyro::internal
