// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "planning/chamber.h"
#include "planning/device_resampling.h"
#include "planning/residual_forecast.h"
#include "planning/soak_design.h"
#include "planning/soak_length.h"
#include "planning/soak_model.h"

namespace beamgyro::internal {

/// Soaks of the chamber with what they cost and leave.
struct SoakPlan {
  std::vector<double> temperatures;  // [degC], increasing
  double hold = 0.0;                 // [s], of each soak
  double hours = 0.0;
  ResidualForecast expected;
  // Of a plan for few devices: the soaks chosen without the devices of each
  // fold, in the same way.
  std::vector<std::vector<double>> of_folds = {};
};

/// What soaks of a device show beside its curves, and how long they may last.
struct SoakBehaviour {
  std::vector<SoakRows> rows;               // slowest_rows()
  RowRule rule = {};                        // of these
  std::optional<SlowNoise> noise = {};      // none: that of SoakModel::noise()
  std::optional<std::size_t> minutes = {};  // of a hold, chosen by the user
  std::optional<StartRow> start_row = {};   // of ways down from the start
  double temperature_noise = 0.0;           // [K], 1-sigma of that of a soak
};

/// A number of soaks, planned and evenly spaced; and what straight lines leave
/// that go through the even ones and know no population. A population that has
/// no devices to try them on has none.
struct TradeOff {
  SoakPlan planned, even;
  std::optional<ResidualForecast> straight_lines = {};
};

/// Returns `count` temperatures from one end to the other at equal distances;
/// one is in the middle.
std::vector<double> even_spacing(TemperatureRange range, std::size_t count);

/// Plans the soaks of a device of a population.
///
/// What a plan leaves of a device is forecast with soaks that were chosen
/// without it: of up to kFewDevices devices each fifth in turn is left out of
/// the choice, and tried on the soaks of the others. The choice would have seen
/// it otherwise, and the forecast be too low. Of more devices a fifth hardly
/// changes the choice.
class Planner {
 public:
  /// Soaks may be at whole kelvins from the lower limit of the chamber on, as
  /// far as the population reaches. All soaks of a plan have the same hold: the
  /// user's, or the shortest whole number of minutes of which the median is no
  /// more than kHoldLoss above that of the best one: the beam lags in shorter
  /// holds, and the bias walks in longer ones. The model must outlive
  /// the planner. Throws std::invalid_argument for a user's hold that has too
  /// few rows, when every hold has, and for a chamber that reaches no
  /// temperature that the population knows.
  Planner(const SoakModel& model, TemperatureRange chamber,
          const ChamberTime& time, SoakBehaviour behaviour);

  const RowRule& rule() const { return behaviour_.rule; }

  /// The largest number of soaks that the limits hold apart, up to kMostSoaks.
  std::size_t most_soaks() const;

  /// The plan with `count` soaks whose mean variance over the range is least,
  /// never more than that of even spacing. Exchanges start from a greedy
  /// choice, from even spacing, and from greedy choices about a few first
  /// soaks; the best end is kept.
  SoakPlan with_soaks(std::size_t count) const;

  /// The plan of least mean variance that takes no more than `hours` and a
  /// rounding. Throws std::invalid_argument when these are too few for two
  /// soaks, or when the limits hold only one.
  SoakPlan within_hours(double hours, double rounding = 0.0) const;

  /// Of the plans of least mean variance that of fewest hours whose median
  /// residual is no more than `residual` and a rounding [deg/s]. Throws
  /// std::invalid_argument when no plan is that good.
  SoakPlan within_residual(double residual, double rounding = 0.0) const;

  /// Evenly spaced over the range, as far as the chamber reaches.
  SoakPlan even(std::size_t count) const;

  /// Returns what a plan leaves over another range, beyond the chamber for
  /// instance.
  ResidualForecast left_over(const SoakPlan& plan,
                             const TemperatureRange& range) const;

  /// Judges soaks at any temperatures. Throws std::invalid_argument for one
  /// that the population does not reach.
  SoakPlan judged(std::vector<double> soaks) const;

  /// Returns what `plan` leaves over what straight lines leave between the
  /// soaks of `even`, if the population has its devices.
  std::optional<MedianRatio> gain(const SoakPlan& plan,
                                  const SoakPlan& even) const;

  /// One entry for each number of soaks from 1 to `most`.
  std::vector<TradeOff> trade_offs(std::size_t most) const;

  /// Start and ramp, with the hold of a plan.
  ChamberTime time_of(const SoakPlan& plan) const;

 private:
  struct Ending {  // of exchanges
    std::vector<double> soaks;
    double mean_variance = std::numeric_limits<double>::infinity();
  };
  double longest_way(std::size_t count, double hours, double hold) const;
  std::vector<double> after_ramps(const std::vector<double>& soaks,
                                  std::size_t minutes,
                                  double SoakRows::*mean) const;
  std::vector<double> ways(const std::vector<double>& soaks) const;
  struct Shown {  // by the soaks, with a row of the start if there is one
    std::vector<double> soaks;
    SoakErrors errors;
  };
  Shown shown(const std::vector<double>& soaks, std::size_t minutes,
              const std::optional<StartRow>& row) const;
  ResidualDraws line_draws(const SoakPlan& even) const;  // no row of the start
  std::optional<ResidualForecast> straight_lines(const SoakPlan& even) const;
  ResidualForecast forecast(const SoakModel& model,
                            const std::vector<double>& soaks,
                            std::size_t minutes) const;
  ResidualForecast expected(const SoakModel& model, const SoakPlan& plan) const;
  ResidualDraws draws(const SoakModel& model, const SoakPlan& plan) const;
  bool has_folds() const;
  std::size_t hold_minutes(const std::vector<double>& soaks) const;
  double best_hold(const std::vector<double>& soaks) const;  // [s]
  SoakPlan judged_with(std::vector<double> soaks, double hold,
                       std::vector<std::vector<double>> of_folds = {}) const;
  SoakPlan planned_with(std::vector<double> soaks, double hold,
                        double longest) const;
  std::optional<std::vector<double>> best(
      std::size_t count, double longest,
      const Eigen::MatrixXd& root = {}) const;
  Ending best_of(const DesignLimits& limits, std::size_t count,
                 const Eigen::MatrixXd& root) const;
  std::optional<StartRow> start_row_of(const std::vector<double>& soaks) const;
  SoakPlan shortened(const SoakPlan& plan, double residual) const;

  const SoakModel& model_;
  ChamberTime time_;
  SoakBehaviour behaviour_;
  std::size_t shortest_ = 0;  // [min], hold with enough rows
  DesignLimits limits_;
  TemperatureRange even_range_;
  // Of each number of soaks, once it was asked for.
  mutable std::map<std::size_t, SoakPlan> planned_, even_;
};

constexpr std::size_t kFolds = 5;
constexpr Eigen::Index kFewDevices = 300;

constexpr double kHoldLoss = 0.05;  // [-], of the median

constexpr std::size_t kMostSoaks = 20;

}  // namespace beamgyro::internal
