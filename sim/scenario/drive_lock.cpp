// SPDX-License-Identifier: MIT
#include "sim/scenario/drive_lock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "config/units.h"

namespace beamgyro {

bool is_locked(const DriveSignals& drive) {
  return !drive.limited &&
         std::abs(drive.amplitude_error()) < kAmplitudeErrorLocked &&
         std::abs(drive.phase) < kPhaseErrorLocked;
}

bool lock_is_due(const Scenario& scenario, double t) {
  return std::any_of(scenario.powered.begin(), scenario.powered.end(),
                     [&](const PowerInterval& interval) {
                       return t == interval.on + kLockTime && t < interval.off;
                     });
}

void require_locked(const DriveSignals& drive, double t, double beam) {
  if (is_locked(drive)) return;
  throw std::runtime_error(fmt::format(
      "drive loop: not locked {:g} s after power-on at {:g} s, beam at {:.2f} "
      "degC: amplitude {:.3g} % of its set value, phase off by {:.2g} rad, "
      "drive at {:.3g} V{}; the device does not oscillate as it should",
      kLockTime, t - kLockTime, beam - kZeroCelsius, 100 * drive.amplitude,
      drive.phase, drive.voltage, drive.limited ? ", its limit" : ""));
}

bool powered_at(const Scenario& scenario, double t) {
  return std::any_of(scenario.powered.begin(), scenario.powered.end(),
                     [t](const PowerInterval& interval) {
                       return interval.on <= t && t < interval.off;
                     });
}

}  // namespace beamgyro
