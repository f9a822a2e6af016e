// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "compensation/compensator.h"

namespace beamgyro {

/// Where a compensator goes in an autopilot.
struct AutopilotPlace {
  char axis = 'z';     // 'x', 'y' or 'z'
  int instance = 0;    // PX4: 0 ... 3; ArduPilot: 1 ... 3
  long device_id = 0;  // PX4: TC_Gn_ID of the sensor
};

/// The cubic an autopilot's parameters can hold: the compensator's own bias
/// when it is a polynomial of the temperature of degree 3 or less (or a
/// constant) without a scale-factor table, else, with `fit_cubic`, its
/// baseline. Throws std::invalid_argument naming what cannot be held and the
/// residual the cubic has in its place.
BiasModel autopilot_cubic(const Compensator& compensator, bool fit_cubic);

/// Parameter file of PX4: rows "1<TAB>1<TAB>NAME<TAB>VALUE<TAB>TYPE" with type
/// 6 for int32 and 9 for float. With T clamped to TMIN ... TMAX
///
///   corrected = raw - Σ_k X_k (T - TREF)^k   [rad/s]
///
/// Throws std::invalid_argument for an instance PX4 does not have.
std::string px4_parameters(const BiasModel& cubic,
                           const TemperatureRange& range,
                           const AutopilotPlace& place);

/// Parameter file of ArduPilot: lines "NAME,VALUE". With
/// P(x) = 1e-6 (c_1 x + c_2 x^2 + c_3 x^3) rad/s and T clamped to TMIN ... TMAX
///
///   corrected = raw - P(T - 35) + P(CALTEMP - 35) - GYROFFS   [rad/s]
///
/// CALTEMP is 35 degC, so that GYROFFS is the constant term. Throws
/// std::invalid_argument for an instance ArduPilot does not have and for a
/// range it refuses: outside -70 ... 80 degC or under 10 K.
std::string ardupilot_parameters(const BiasModel& cubic,
                                 const TemperatureRange& range,
                                 const AutopilotPlace& place);

}  // namespace beamgyro
