// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/methods/method.h"
#include "compensation/models/polynomial.h"
#include "compensation/rows/training_rows.h"

namespace beamgyro::internal {

constexpr double kArduPilotReference = 35.0;  // [degC]
constexpr double kArduPilotSpan = 10.0;       // [K], the least it accepts

/// Fits the cubic as PX4's calibration from logs does: the rate passes a median
/// filter of 31 samples and is averaged in 2000 equal temperature bins; then a
/// cubic is fitted by least squares about the middle of the temperature range.
/// Rows are samples.
BiasModel fit_as_px4(const TrainingRows& samples);

/// Fits the cubic as ArduPilot's temperature calibration does:
/// - both signals are averaged over 2 s;
/// - every rise of the temperature by 0.5 K or more over at least
///   `least_samples` samples makes a point, at the mean of the two ends of the
///   rise;
/// - samples below the temperature of the last point are skipped, and each
///   power-on starts again;
/// - a cubic about 35 degC is fitted by least squares.
/// Rows are samples. Throws std::invalid_argument when the temperature spans
/// less than kArduPilotSpan or the rises give fewer than 4 points.
BiasModel fit_as_ardupilot(const TrainingRows& samples, int least_samples);

/// The cubic as PX4 fits it; fit_as_px4().
struct Px4Spec {
  static constexpr const char* kName = "px4";
  static constexpr InputRule kInputRule = InputRule::kMeasuredOnly;
  static constexpr bool kFitsSamples = true;
  using Function = Polynomial;
  static Px4Spec read(MethodSource&) { return {}; }
  std::string method_name() const { return "cubic as PX4 fits it"; }
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
  std::string method_name() const { return "cubic as ArduPilot fits it"; }
  Fit fit(const FitTask& task) const;
};

}  // namespace beamgyro::internal
