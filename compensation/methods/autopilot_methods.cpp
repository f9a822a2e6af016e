// SPDX-License-Identifier: MIT
#include "compensation/methods/autopilot_methods.h"

#include "compensation/methods/autopilot_fits.h"
#include "compensation/methods/fit.h"

namespace beamgyro::internal {

Px4Spec Px4Spec::read(MethodSource&) { return {}; }

std::string Px4Spec::method_name() const { return "cubic as PX4 fits it"; }

Fit Px4Spec::fit(const FitTask& task) const { return fit_as_px4(task.rows); }

ArduPilotSpec ArduPilotSpec::read(MethodSource& source) {
  return {static_cast<int>(
      source.table(kName).integer_or("least_samples", 100, 1, 1000000))};
}

std::string ArduPilotSpec::method_name() const {
  return "cubic as ArduPilot fits it";
}

Fit ArduPilotSpec::fit(const FitTask& task) const {
  return fit_as_ardupilot(task.rows, least_samples);
}

}  // namespace beamgyro::internal
