// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "compensation/methods/method.h"
#include "compensation/methods/population.h"

namespace beamgyro::internal {

/// Table [population]: what the devices of a set have in common.
struct PopulationSpec {
  double grid_K = 5.0;  // [K], > 0
  // [deg/s], > 0; usual_point_noise() unless it is given
  std::optional<double> point_noise = {};

  static constexpr const char* kName = "population";
  static constexpr InputRule kInputRule = InputRule::kChannels;
  using Function = CubicSpline;
  static PopulationSpec read(MethodSource& source);
  std::string method_name() const { return "mean of a population"; }
  Fit fit(const FitTask& task) const;
};

/// Table [adapted]: a device of a population, known from a few rows.
struct AdaptedSpec {
  Population population;
  std::string source;  // of it, for the provenance
  PointNoise noise;
  std::optional<double> steady_K_per_min = {};  // of [rows]

  static constexpr const char* kName = "adapted";
  static constexpr InputRule kInputRule = InputRule::kOfItsOwn;
  using Function = CubicSpline;
  static AdaptedSpec read(MethodSource& source);
  std::string method_name() const { return "spline adapted from a population"; }
  Fit fit(const FitTask& task) const;
  /// The rows that it is adapted to: rows_of_soaks(), if [rows] asks for steady
  /// ones.
  TrainingRows used_rows(const TrainingRows& rows) const;
};

}  // namespace beamgyro::internal
