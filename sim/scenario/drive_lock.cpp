// SPDX-License-Identifier: MIT
#include "sim/scenario/drive_lock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/units.h"
#include "sim/numerics/simulation_failure.h"

namespace beamgyro {

bool is_locked(const DriveSignals& drive) {
  return !drive.limited &&
         std::abs(drive.amplitude_error()) < kAmplitudeErrorLocked &&
         std::abs(drive.phase) < kPhaseErrorLocked;
}

bool lock_is_due(const Scenario& scenario, double t) {
  return std::any_of(scenario.powered.begin(), scenario.powered.end(),
                     [&](const PowerInterval& interval) {
                       return is_same_time(t, interval.on + kLockTime) &&
                              t < interval.off &&
                              !is_same_time(t, interval.off);
                     });
}

std::vector<Border> power_borders(const Scenario& scenario) {
  std::vector<Border> borders;
  for (const PowerInterval& interval : scenario.powered) {
    borders.insert(
        borders.end(),
        {{interval.on, true}, {interval.on + kLockTime}, {interval.off, true}});
  }
  return borders;
}

void require_locked(const DriveSignals& drive, double t, double beam) {
  if (is_locked(drive)) return;
  throw SimulationFailure(fmt::format(
      "drive loop: not locked {:g} s after power-on at {:g} s, beam at {:.2f} "
      "degC: amplitude {:.3g} % of its set value, phase off by {:.2g} rad, "
      "drive at {:.3g} V{}; the device does not oscillate as it should",
      kLockTime, t - kLockTime, beam - kZeroCelsius, 100 * drive.amplitude,
      drive.phase, drive.voltage, drive.limited ? ", its limit" : ""));
}

}  // namespace beamgyro
