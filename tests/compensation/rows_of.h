// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "compensation/rows/training_rows.h"

namespace beamgyro::internal {

/// Temperatures from `from` to `to` [degC] in even steps, of one leg.
struct Leg {
  int run, cycle;
  double from, to;
  int rows;
};

/// One input, the temperature; a row a minute; `bias` of temperature and row.
TrainingRows rows_of(const std::vector<Leg>& legs,
                     const std::function<double(double, int)>& bias);

/// -40, -35, ... 50 degC.
std::vector<double> every_five_kelvins();

/// Normal numbers of mean 0 and deviation 1, the same for the same `run`.
std::vector<double> white(int count, std::uint32_t run);

}  // namespace beamgyro::internal
