// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "planning/chamber_time.h"
#include "planning/residual_forecast.h"
#include "planning/soak_design.h"
#include "planning/soak_model.h"

namespace beamgyro {

/// Soaks of the chamber with what they cost and leave.
struct SoakPlan {
  std::vector<double> temperatures;  // [degC], increasing
  double hours = 0.0;
  ResidualForecast expected;
};

/// A number of soaks, planned and evenly spaced.
struct TradeOff {
  SoakPlan planned, even;
};

/// Returns `count` temperatures from one end to the other at equal distances;
/// one is in the middle.
std::vector<double> even_spacing(TemperatureRange range, std::size_t count);

/// Plans the soaks of a device of a population.
class Planner {
 public:
  /// Soaks may be at whole kelvins from the lower limit of the chamber on, as
  /// far as the population reaches. The model must outlive the planner.
  Planner(const SoakModel& model, TemperatureRange chamber,
          const ChamberTime& time);

  /// The largest number of soaks that the limits hold apart, up to kMostSoaks.
  std::size_t most_soaks() const;

  /// The plan with `count` soaks whose mean variance over the range is least,
  /// never more than that of even spacing. Exchanges start from a greedy
  /// choice, from even spacing, and from greedy choices about a few first
  /// soaks; the best end is kept.
  SoakPlan with_soaks(std::size_t count) const;

  /// The plan of least mean variance that takes no more than `hours`. Throws
  /// std::invalid_argument when these are too few for two soaks.
  SoakPlan within_hours(double hours) const;

  /// Of the plans of least mean variance that of fewest hours whose median
  /// residual is no more than `residual` [deg/s]. Throws std::invalid_argument
  /// when no plan is that good.
  SoakPlan within_residual(double residual) const;

  SoakPlan even(std::size_t count) const;

  /// Judges soaks at any temperatures. Throws std::invalid_argument for one
  /// that the population does not reach.
  SoakPlan judged(std::vector<double> soaks) const;

  /// One entry for each number of soaks from 1 to `most`.
  std::vector<TradeOff> trade_offs(std::size_t most) const;

  const ChamberTime& time() const { return time_; }

 private:
  double longest_way(std::size_t count, double hours) const;
  std::optional<std::vector<double>> best(std::size_t count,
                                          double longest) const;
  SoakPlan shortened(const SoakPlan& plan, double residual) const;

  const SoakModel& model_;
  ChamberTime time_;
  DesignLimits limits_;
};

constexpr std::size_t kMostSoaks = 20;

}  // namespace beamgyro
