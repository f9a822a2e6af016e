// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "planning/chamber_time.h"

namespace beamgyro::internal {

/// Slow noise of the bias of a device, 1-sigma, as soaks show it.
struct SlowNoise {
  double turn_on = 0.0;  // [deg/s], the same in all soaks
  double walk = 0.0;     // [deg/s/sqrt(s)], from power-on to the soaks
  double own = 0.0;      // [deg/s], of each soak alone
};

/// Returns L, so that L z with normal numbers z are the errors [deg/s] of these
/// soaks, a row for each in the order given, and with `start_row` of a row
/// right after power-on behind them.
Eigen::MatrixXd slow_noise_root(const SlowNoise& noise,
                                const std::vector<double>& soaks,
                                const ChamberTime& time,
                                bool start_row = false);

}  // namespace beamgyro::internal
