// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "compensation/scoring/rate_injection.h"
#include "compensation/scoring/scale_factor.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Recorded rates that test what a replay cannot: inputs that a replayed rate
/// does not move, and the values of a scale-factor table.
struct RecordedRates {
  // Plateaus whose true rate departs by kTableRate.
  std::vector<PlateauSlope> plateaus;
  // [degC], where the true rate reaches half of full scale; one each kelvin
  std::vector<double> large;
};

/// Returns whether the compensator has such an input, or a table.
bool needs_recorded_rates(const Compensator& compensator);

/// Adds the recorded rates of a run. `compensated` are the answers to it.
void add_recorded_rates(const Recording& recording,
                        std::span<const double> compensated, double full_scale,
                        RecordedRates& rates);

/// Result of the replay of a run through the whole compensator.
struct ReplayedScaleFactor {
  double full_scale = 0.0;  // [deg/s], the largest rate replayed
  TemperatureRange temperatures = {HUGE_VAL, -HUGE_VAL};  // [degC], of blocks
  // Where recorded rates confirm a scale-factor table, the share that a block
  // retains is multiplied by the value of the table.
  WorstBlocks worst = {};
  // Inputs that the replayed rate does not move, although a real rate might.
  std::vector<std::string> fixed_inputs = {};
  // Those of these inputs, and "scale_factor" for the table, that no recorded
  // rate tests.
  std::vector<std::string> untested = {};
  double untested_temperature = 0.0;  // [degC], one of those where it is so
  // Scale factor retained on the worst plateau with recorded rates, if there
  // are inputs that a replay does not move.
  std::optional<double> worst_plateau = {};

  // worst_over_temperature() of a compensator that sees the rate.
  WorstBlocks over_temperature = {};

  /// Keeps the worst of both.
  void add(const ReplayedScaleFactor& other);
};

constexpr double kRateReach = 10.5;     // [K], as far as a recorded rate speaks
constexpr double kLargeShare = 0.5;     // [-], of full scale
constexpr double kTableSupport = 1e-2;  // [-], of a table's value

/// Replays a run. A block is also tested by recorded rates if its temperature
/// lies within kRateReach of a plateau and of a large rate of `rates`. A value
/// of the compensator's table that differs from 1 by more than `tolerance` is
/// confirmed when a plateau within kRateReach has a scale factor within
/// kTableSupport of it; a replay moves the rate by the nominal scale factor and
/// cannot tell. Returns nothing where replay() returns nothing.
std::optional<ReplayedScaleFactor> replayed_scale_factor(
    const Compensator& compensator, const Recording& recording,
    std::span<const double> answers, double full_scale,
    const ScaleFactorTolerance& tolerance, const RecordedRates& rates);

}  // namespace beamgyro::internal
