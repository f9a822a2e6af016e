// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compensation/scoring/rate_injection.h"
#include "validation/checks/checks.h"

namespace beamgyro::internal {

/// Returns the answers with those that are missing at powered samples replaced
/// by the recorded rate less the last correction, so that one missing answer
/// is found by the check of missing answers alone.
std::vector<double> bridged(const Recording& run, std::vector<double> answers);

/// Returns the smallest difference [deg/s] other than that of numbers as they
/// are stored between neighbouring answers, both of at least `least` [deg/s]
/// and more than `ready_after` [s] after a power-on; infinite where there is
/// none.
double smallest_step(const Recording& run, std::span<const double> answers,
                     double ready_after, double least = 0.0);

/// Returns the compensator without its table of scale factors.
FittedCompensator without_scale_factor(FittedCompensator compensator);

/// Answers may be rounded to this without having to declare it.
constexpr double kUndeclaredResolution = 0.01;  // [deg/s]

/// How far from its temperature a recorded rate speaks.
constexpr double kRateReach = 10.5;  // [K]

/// Answers to altered recordings, bridged. Notes the faults that were seen.
/// Every member may be called from several threads at once.
class AlteredAnswers {
 public:
  AlteredAnswers(const TestedCompensator& compensator, double full_scale,
                 double ready_after)
      : compensator_(compensator),
        full_scale_(full_scale),
        ready_after_(ready_after) {}

  std::vector<double> operator()(const Recording& altered) const;

  /// Returns the smallest_step() [deg/s] that was seen among answers beyond
  /// half of full scale; infinite before there are any.
  double step_near_full_scale() const { return step_near_full_scale_; }

  bool has_seen(AnswerFault fault) const {
    return seen_[static_cast<std::size_t>(fault)];
  }

 private:
  static constexpr std::size_t kFaults =
      static_cast<std::size_t>(AnswerFault::kCount);

  const TestedCompensator& compensator_;
  double full_scale_;   // [deg/s]
  double ready_after_;  // [s]
  mutable std::atomic<double> step_near_full_scale_ = HUGE_VAL;
  mutable std::array<std::atomic<bool>, kFaults> seen_ = {};
};

/// The scale factor of the recorded rate over temperature, as held rates show
/// it (held_slopes()).
class ScaleFactorCurve {
 public:
  /// `uncertainty` [-] is half of the 95 % interval of the scale factor.
  void add(double temperature, double scale_factor, double uncertainty);
  bool empty() const { return points_.empty(); }
  bool has_point_near(double temperature, double reach) const;  // [K]
  double at(double temperature) const;  // linear between, constant beyond
  double largest_departure() const;     // from 1 [-]
  /// Returns the departure from 1 [-] of a gain that may be 1 / s for every s
  /// between those of the points next to the temperature, each with its
  /// uncertainty.
  double departure_of_corrected(double gain, double temperature) const;
  /// Returns which curve this is, for a user: "1.0005 to 1.0255 at 5 points
  /// of held rates from -33.0 to 41.2 degC".
  std::string words() const;

 private:
  struct Point {
    double temperature;   // [degC]
    double scale_factor;  // [-]
    double uncertainty;   // [-]
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

class GainJudge;

/// What every check may use.
struct CheckContext {
  explicit CheckContext(const CheckedCompensator& all, std::size_t threads);

  const CheckedCompensator& checked;
  std::size_t threads;
  ScaleFactorCurve scale_factor;
  // A trained compensator whose table of scale factors no run tests is asked
  // without that table, so that its bias is judged all the same.
  std::unique_ptr<const TestedCompensator> without_table;
  // With the answers before it is ready bridged, where that is declared.
  std::unique_ptr<const TestedCompensator> ready;
  AlteredAnswers altered;
  double answer_step = 0.0;  // [deg/s], smallest_step() of all answers, or 0
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
  /// Returns to what [deg/s] the answers are rounded: as declared, or
  /// answer_step, unless that is beyond kUndeclaredResolution.
  double resolution() const;
  const DeclaredResponse& declared() const { return checked.declared; }
  /// Returns what a replay leaves out of a run with samples `step` [s] apart.
  ReplayPauses pauses(double step) const;
  /// Returns a run with a rate added to it, which is set to zero where the
  /// compensator may take it for its bias; nothing as with_injected_rate().
  std::optional<Recording> with_rate(const Recording& run,
                                     std::vector<double>& added) const;
  /// Returns a judge of gains.
  GainJudge judge() const;
  /// Returns the largest step [deg/s] of the answers that was seen.
  double coarsest_step() const;
  /// Returns "" for answers that step by less than 1e-4 deg/s, else a sentence
  /// that names the step, after a space.
  std::string rounding_words() const;
  /// Returns by how many samples of a run the answers come late.
  std::ptrdiff_t lag_in(const Recording& run) const;
  /// Returns the indices of the runs with one of the purposes, or those of all
  /// runs if there is none.
  std::vector<std::size_t> runs_of(
      const std::vector<RunPurpose>& purposes) const;
  /// Returns the temperatures_of() those runs.
  std::optional<TemperatureRange> temperatures_of(
      const std::vector<std::size_t>& runs) const;
  /// Calls `work` with the position in `runs` of every run, on all threads.
  void for_each(const std::vector<std::size_t>& runs,
                const std::function<void(std::size_t)>& work) const;
};

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
CheckResult check_declared(const CheckContext& context);
CheckResult check_output_stuck(const CheckContext& context);
CheckResult check_real_time(const CheckContext& context);

/// The response of the answers to a sine that was added.
struct SineResponse {
  double frequency;  // [Hz]
  double gain;       // [-]
  double delay;      // [s]
};

/// Returns the responses of a run.
std::vector<SineResponse> sine_responses(const CheckContext& context,
                                         std::size_t number);

/// Returns, for a compensator that fails and declares nothing, what it may
/// declare to pass; nothing where no declaration explains it.
std::optional<DeclaredResponse> possible_declaration(
    const CheckContext& context);

/// Returns a result without a figure; `why` is a sentence.
CheckResult not_tested(std::string why);

}  // namespace beamgyro::internal
