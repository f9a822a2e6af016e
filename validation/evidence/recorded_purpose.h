// SPDX-License-Identifier: MIT
#pragma once

#include "dataset/recording/recording.h"
#include "validation/evidence/evidence.h"

namespace beamgyro::internal {

/// Returns what a recording shows, told from its columns:
/// - a rate that is held at seven values or more, or at five for less than five
///   minutes each: kRateTable; at fewer, for five minutes: kConstantRate; else
///   kRateStep;
/// - a rate that swings at one frequency: kSineRate; any other: kRandomRate;
/// - at rest, accelerations that are held: kTumble; other motion: kVibration;
/// - at rest with two power-ons or more: kPowerCycle;
/// - at rest at one ambient temperature, or with a measured temperature within
///   8 K: kRest if it is longer than kRestBegins and half an hour, else
///   kWarmUp;
/// - at rest with three plateaus of ambient temperature or more: kSoak; else
///   kRamp.
/// Throws std::invalid_argument without true_rate.
RunPurpose recorded_purpose(const Recording& recording);

/// A recording at rest shows noise and not warm-up from here on [s].
constexpr double kRestBegins = 7200.0;

}  // namespace beamgyro::internal
