// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"

namespace beamgyro::internal {

/// The gyro of an autopilot that the parameters are for.
struct AutopilotGyro {
  int instance = 0;    // PX4: 0 ... 3; ArduPilot: 1 ... 3
  long device_id = 0;  // PX4: TC_Gn_ID of the sensor
};

/// The bias of one axis of the gyro.
struct AutopilotAxis {
  char axis = 'z';  // 'x', 'y' or 'z'
  BiasModel cubic;  // autopilot_cubic()
  TemperatureRange range;
};

/// Returns the cubic that the parameters of an autopilot can hold: the bias of
/// the compensator if it is a constant or a polynomial of the temperature of
/// degree 3 or less without a scale-factor table; otherwise, with `fit_cubic`,
/// its baseline. Throws std::invalid_argument naming what the parameters cannot
/// hold, and the residual of the cubic.
BiasModel autopilot_cubic(const FittedCompensator& compensator, bool fit_cubic);

/// Returns the range of temperatures [degC] that all axes have seen. Autopilots
/// have one range for a gyro. Throws std::invalid_argument when there are none.
TemperatureRange common_range(const std::vector<AutopilotAxis>& axes);

/// Returns the parameter file of PX4: rows
/// "1<TAB>1<TAB>NAME<TAB>VALUE<TAB>TYPE" with type 6 for int32 and 9 for float.
/// With T clamped to TMIN ... TMAX, the common_range(),
///
///   corrected = raw - Σ_k X_k (T - TREF)^k   [rad/s]
///
/// Axes that are not given have X_k = 0. Throws std::invalid_argument for an
/// instance that PX4 does not have, and as common_range().
std::string px4_parameters(const std::vector<AutopilotAxis>& axes,
                           const AutopilotGyro& gyro);

/// Returns the parameter file of ArduPilot: lines "NAME,VALUE". With P(x) =
/// 1e-6 (c_1 x + c_2 x^2 + c_3 x^3) rad/s, and T as well as CALTEMP clamped to
/// TMIN ... TMAX, the common_range(),
///
///   corrected = raw - P(T - 35) + P(CALTEMP - 35) - GYROFFS   [rad/s]
///
/// CALTEMP is 35 degC, or the end of the range next to it, and GYROFFS the bias
/// there. Axes that are not given have c_k = GYROFFS = 0. Throws
/// std::invalid_argument for an instance that ArduPilot does not have, for a
/// range that it refuses (outside -70 ... 80 degC or under 10 K), and as
/// common_range().
std::string ardupilot_parameters(const std::vector<AutopilotAxis>& axes,
                                 const AutopilotGyro& gyro);

}  // namespace beamgyro::internal
