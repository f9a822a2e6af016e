// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "sim/device/device.h"
#include "sim/dynamics/gyro.h"

namespace beamgyro::internal {

/// Temperatures at which a curve is computed, evenly from `low` to `high`
/// [degC].
struct CurveGrid {
  double low = -40, high = 50;  // [degC]
  int count = 37;

  Eigen::ArrayXd temperatures() const {
    return Eigen::ArrayXd::LinSpaced(count, low, high);
  }
};

/// The settled state of a gyro at rest over temperature, beam and board at the
/// same one, free of noise: what `characterise` tabulates.
struct StaticCurve {
  Eigen::ArrayXd temperature;      // [degC]
  Eigen::ArrayXd bias;             // [deg/s]
  Eigen::ArrayXd quadrature;       // [deg/s]
  Eigen::ArrayXd drive_frequency;  // [Hz]
  Eigen::ArrayXd drive_voltage;    // [V]
};

/// Throws SimulationFailure where the drive loop does not lock.
StaticCurve static_curve(const Gyro& gyro, const CurveGrid& grid);

/// Returns the scale factor relative to that at T_0 at each temperature of the
/// grid (rate_slope()). Throws as static_curve().
Eigen::ArrayXd scale_factor_curve(const Gyro& gyro, const CurveGrid& grid);

/// Returns the bias [deg/s] of the settled gyro at `ambient` [degC] in still
/// air less that at power-on, when every part is at ambient: the change of an
/// hour's warm-up by self-heating. With an oven it holds the mount at its set
/// point then. Throws as static_curve(), and when the temperatures do not
/// settle.
double warm_up_change(const Gyro& gyro, double ambient);

}  // namespace beamgyro::internal
