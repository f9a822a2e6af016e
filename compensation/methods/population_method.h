// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/methods/method.h"
#include "compensation/methods/population.h"

namespace beamgyro::internal {

/// Table [population]: what the devices of a set have in common.
struct PopulationSpec {
  double grid_K = 5.0;  // [K], > 0

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

  static constexpr const char* kName = "adapted";
  static constexpr InputRule kInputRule = InputRule::kOfItsOwn;
  using Function = CubicSpline;
  static AdaptedSpec read(MethodSource& source);
  std::string method_name() const { return "spline adapted from a population"; }
  Fit fit(const FitTask& task) const;
};

}  // namespace beamgyro::internal
