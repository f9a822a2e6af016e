// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compensation/inputs/features.h"
#include "planning/chamber.h"
#include "planning/planner.h"
#include "planning/residual_forecast.h"
#include "planning/soak_length.h"

namespace beamgyro::internal {

/// What a plan leaves where the chamber does not reach.
struct Extrapolated {
  TemperatureRange range;  // [degC]
  ResidualForecast expected;
};

/// What `plan` has found.
struct PlanResult {
  SoakPlan chosen, even;  // of the same number of soaks
  // Of the chosen plan over straight lines between the even soaks; none
  // without devices of the population.
  std::optional<MedianRatio> gain;
  std::optional<ResidualForecast> straight_lines;  // between the even soaks
  std::vector<TradeOff> trade_offs;
  std::vector<SoakPlan> candidates;        // of the user
  std::vector<Extrapolated> extrapolated;  // by the chosen plan
  ChamberTime time;                        // of the chosen plan
  RowRule rule;                            // of rows that are trained on
  TemperatureRange range;                  // [degC], of the chamber
  std::vector<std::string> observed;       // "bias" and channels
  int devices = 0;                         // of the population
  int devices_tried = 0;                   // of those, with coefficients
  ForecastBasis basis = ForecastBasis::kGaussian;
  // [deg/s], rms over devices and range of half of what falling and rising
  // temperatures differ by, which is in the forecasts; none: it is not known.
  std::optional<double> hysteresis = {};
  std::vector<std::string> warnings;
};

/// Returns the schedule, what it is expected to leave, and the tables.
std::string plan_text(const PlanResult& result);

/// Returns what `plan --json` writes (docs/planning.md).
nlohmann::ordered_json plan_json(const PlanResult& result);

}  // namespace beamgyro::internal
