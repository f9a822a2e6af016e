// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace beamgyro {

/// Compensation by hardware: an NTC and three resistors divide a reference
/// voltage, and the part that is left is added to the output,
///
///   n(T)  = exp(B (1 / T - 1 / 298.15 K)),   the NTC over its value at 25 degC
///   p     = n r_p / (n + r_p),               with a resistor beside it
///   b(T)  = offset + gain r_d / (r_d + r_s + p)   [deg/s]
///
/// with all resistances over that of the NTC at 25 degC.
struct ThermistorNetwork {
  double b_K = 3950.0;    // [K], > 0, of the NTC
  double series = 1.0;    // r_s > 0
  double parallel = 1.0;  // r_p > 0
  double divider = 1.0;   // r_d > 0
  double offset = 0.0;    // [deg/s]
  double gain = 0.0;      // [deg/s]

  /// x in degC.
  Eigen::ArrayXd predict(const Eigen::Ref<const Eigen::ArrayXd>& x) const;
};

/// Offset, gain and the three resistances of least squared residual: each of
/// 216 starts on a grid of resistances is solved for offset and gain, the best
/// one refined in all five by Levenberg-Marquardt. Resistances are held within
/// 1e-3 .. 1e3. Throws std::invalid_argument for fewer than 5 points or points
/// of one temperature.
ThermistorNetwork fit_thermistor_network(
    const Eigen::Ref<const Eigen::ArrayXd>& x,
    const Eigen::Ref<const Eigen::ArrayXd>& y, double b_K);

}  // namespace beamgyro
