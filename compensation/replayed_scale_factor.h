// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compensation/compensator.h"
#include "compensation/rate_injection.h"
#include "compensation/scale_factor.h"
#include "dataset/recording.h"

namespace beamgyro {

/// What recorded rates test where a replay cannot: inputs that a replayed rate
/// does not move, and the values of a scale-factor table.
struct RecordedRates {
  // Plateaus whose true rate departs by kTableRate.
  std::vector<PlateauSlope> plateaus;
  // [degC], where the true rate reaches half of full scale; one each kelvin
  std::vector<double> large;
};

/// Whether the compensator has any such input, or a table.
bool needs_recorded_rates(const Compensator& compensator);

/// Adds those of a run. `compensated` are the answers to it.
void add_recorded_rates(const Recording& recording,
                        std::span<const double> compensated, double full_scale,
                        RecordedRates& rates);

/// What the replay of a run shows of the whole compensator.
struct ReplayedScaleFactor {
  double full_scale = 0.0;  // [deg/s], the largest rate replayed
  TemperatureRange temperatures = {HUGE_VAL, -HUGE_VAL};  // [degC], of blocks
  // Where recorded rates bear out a scale-factor table, what a block retains is
  // multiplied by the table's value.
  WorstBlocks worst = {};
  // Inputs that the replayed rate does not move, though a real one might.
  std::vector<std::string> not_moved = {};
  // Of these, and "scale_factor" for the table, what no recorded rate tests.
  std::vector<std::string> untested = {};
  double untested_temperature = 0.0;  // [degC], one of those where it is so
  // Retained on the worst plateau with recorded rates, if inputs are not moved.
  std::optional<double> worst_plateau = {};

  // worst_over_temperature(), of a compensator that sees the rate.
  WorstBlocks over_temperature = {};

  /// The worst of both.
  void add(const ReplayedScaleFactor& other);
};

constexpr double kRateReach = 10.5;     // [K], as far as a recorded rate speaks
constexpr double kLargeShare = 0.5;     // [-], of full scale
constexpr double kTableSupport = 1e-2;  // [-], of a table's value

/// Replays a run. Each block whose temperature lies within kRateReach of a
/// plateau and of a large rate of `rates` is tested by these, too. A value of
/// the compensator's table that is not 1 within `tolerance` is borne out when a
/// plateau within kRateReach shows the gyro's own scale factor within
/// kTableSupport of it; a replay moves the rate by the nominal one and cannot
/// tell. Nothing where replay() has nothing.
std::optional<ReplayedScaleFactor> replayed_scale_factor(
    const Compensator& compensator, const Recording& recording,
    std::span<const double> answers, double full_scale,
    const ScaleFactorTolerance& tolerance, const RecordedRates& rates);

}  // namespace beamgyro
