// SPDX-License-Identifier: MIT
#include "planning/device_resampling.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

#include "planning/residual_forecast.h"
#include "planning/soak_model.h"
#include "random/random_stream.h"
#include "tests/planning/small_population.h"

namespace beamgyro::internal::device_resampling_test {
namespace {

TEST(RatioOfMedians, HasAnIntervalOfTheDevices) {
  const SoakModel model = model_of(small_population(200));
  const ResidualDraws lines = straight_line_draws(model, {2.0, 20.0});
  ResidualDraws halves = lines;
  for (double& rms : halves.rms) rms *= 0.5;
  const MedianRatio exact = ratio_of_medians(halves, lines);
  EXPECT_EQ(exact.value, 0.5);
  EXPECT_EQ(exact.interval.low, 0.5);
  EXPECT_EQ(exact.interval.high, 0.5);

  const auto width = [](int devices) {
    const SoakModel of = model_of(small_population(devices));
    const auto [low, high] =
        ratio_of_medians(residual_draws(of, {2.0, 20.0}),
                         straight_line_draws(of, {2.0, 20.0}))
            .interval;
    return high - low;
  };
  EXPECT_GT(width(20), 2.0 * width(800));
}

// Devices of a uniform distribution, each with the same value in two rounds.
ResidualDraws uniform_draws(std::size_t devices, std::uint64_t seed) {
  ResidualDraws draws{devices, {}};
  RandomStream stream(seed, 0, 0, kIntervalStream);
  for (std::size_t d = 0; d < devices; ++d)
    draws.rms.push_back(stream.uniform());
  for (std::size_t d = 0; d < devices; ++d) draws.rms.push_back(draws.rms[d]);
  return draws;
}

TEST(ForecastIntervals, HoldTheQuantilesOfFurtherDevices) {
  int median = 0, p90 = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const ResidualForecast forecast =
        forecast_with_intervals(uniform_draws(100, seed));
    ASSERT_TRUE(forecast.intervals);
    const auto holds = [](const Interval& interval, double value) {
      return interval.low <= value && value <= interval.high ? 1 : 0;
    };
    median += holds(forecast.intervals->median, 0.5);
    p90 += holds(forecast.intervals->p90, 0.9);
  }
  // 190 of 200, within three standard deviations, 9.2; intervals of a quantile
  // of 100 values by resampling hold a little less than they say.
  EXPECT_NEAR(median, 190, 10);
  EXPECT_NEAR(p90, 188, 12);
}

TEST(ForecastIntervals, AreAboutTheForecast) {
  const ResidualDraws draws = uniform_draws(100, 3);
  const ResidualForecast plain = forecast_of(draws);
  const ResidualForecast forecast = forecast_with_intervals(draws);
  EXPECT_EQ(plain.median, forecast.median);
  EXPECT_EQ(plain.p95, forecast.p95);
  EXPECT_LT(forecast.intervals->p95.low, forecast.p95);
  EXPECT_LT(forecast.p95, forecast.intervals->p95.high);
}

}  // namespace
}  // namespace beamgyro::internal::device_resampling_test
