// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/methods/method.h"
#include "compensation/models/polynomial.h"

namespace beamgyro::internal {

/// The cubic as PX4 fits it; fit_as_px4().
struct Px4Spec {
  static constexpr const char* kName = "px4";
  static constexpr InputRule kInputRule = InputRule::kMeasuredOnly;
  static constexpr bool kFitsSamples = true;
  using Function = Polynomial;
  static Px4Spec read(MethodSource& source);
  std::string method_name() const;
  Fit fit(const FitTask& task) const;
};

/// Table [ardupilot]; fit_as_ardupilot().
struct ArduPilotSpec {
  int least_samples = 100;  // of a point, >= 1

  static constexpr const char* kName = "ardupilot";
  static constexpr InputRule kInputRule = InputRule::kMeasuredOnly;
  static constexpr bool kFitsSamples = true;
  using Function = Polynomial;
  static ArduPilotSpec read(MethodSource& source);
  std::string method_name() const;
  Fit fit(const FitTask& task) const;
};

}  // namespace beamgyro::internal
