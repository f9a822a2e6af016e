// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/bias_model.h"
#include "compensation/training_rows.h"

namespace beamgyro {

constexpr double kArduPilotReference = 35.0;  // [degC]
constexpr double kArduPilotSpan = 10.0;       // [K], the least it accepts

/// The cubic as PX4's calibration from logs fits it: the rate through a median
/// filter of 31 samples, averaged in 2000 equal temperature bins, then least
/// squares about the middle of the temperature range. Rows are samples.
BiasModel fit_as_px4(const TrainingRows& samples);

/// The cubic as ArduPilot's temperature calibration fits it: both signals
/// averaged over 2 s, then a point for every rise of the temperature by 0.5 K
/// or more over at least `least_samples` samples, at the mean of the rise's two
/// ends, then least squares about 35 degC. While the temperature lies below the
/// last point samples are passed over; each power-on begins anew. Rows are
/// samples. Throws std::invalid_argument when the temperature spans less than
/// kArduPilotSpan or the rises give fewer than 4 points.
BiasModel fit_as_ardupilot(const TrainingRows& samples, int least_samples);

}  // namespace beamgyro
