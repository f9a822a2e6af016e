// SPDX-License-Identifier: MIT
#pragma once

#include "planning/residual_forecast.h"
#include "statistics/intervals.h"

namespace beamgyro::internal {

/// Returns the forecast of `draws` with intervals that say how few devices they
/// come from: the devices are drawn again with replacement, each with all its
/// draws (random stream kPlanGainStream). They are no more certain than the
/// devices of the population are a random sample of those to come.
ResidualForecast forecast_with_intervals(const ResidualDraws& draws);

/// A quotient of medians over devices, with its 95 % interval.
struct MedianRatio {
  double value;
  Interval interval;
};

/// Returns the median of `draws` over that of `others`, of the same devices.
/// The interval is by resampling the devices likewise, the same for both. A
/// population of few devices has a wide one.
MedianRatio ratio_of_medians(const ResidualDraws& draws,
                             const ResidualDraws& others);

}  // namespace beamgyro::internal
